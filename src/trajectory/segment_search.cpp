#include "segment_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace screwline {
namespace {

constexpr double kGain = 1e-6;       ///< What a step has to gain: less is not worth its place.
constexpr double kNarrowest = 1e-3;  ///< Of the longest segment.
constexpr double kBalanced = 1e-7;   ///< Of the use of limits.
constexpr long kMostMotions = 600;   ///< Looked at in one search.
constexpr long kMostWork = 1200000;  ///< Pieces times joints, in units of a cubic.
constexpr int kFirstRounds = 40;     ///< Of balancing.
constexpr int kRounds = 12;          ///< The same, from a balanced state.
constexpr double kDamping = 0.4;

/// Greatest magnitude over [0, 1] of a polynomial of low degree, nearly: of equidistant places and the parabola through
/// the three about the greatest. Much cheaper than the roots of the derivative, and exact for parabolas.
double nearPeak(const Polynomial& p, int places) {
  std::array<double, 9> values{};
  const double sign = [&] {
    double most = 0.0;
    for (int i = 0; i < places; ++i) {
      const double value = p(static_cast<double>(i) / (places - 1));
      values[static_cast<std::size_t>(i)] = value;
      if (std::abs(value) > std::abs(most)) most = value;
    }
    return most < 0.0 ? -1.0 : 1.0;
  }();
  std::size_t top = 0;
  for (std::size_t i = 1; i < static_cast<std::size_t>(places); ++i)
    top = sign * values[i] > sign * values[top] ? i : top;
  const double peak = sign * values[top];
  const std::size_t middle = std::clamp<std::size_t>(top, 1, static_cast<std::size_t>(places) - 2);
  const double slope = 0.5 * sign * (values[middle + 1] - values[middle - 1]);
  const double bend = sign * (values[middle + 1] - 2.0 * values[middle] + values[middle - 1]);
  if (!(bend < 0.0) || std::abs(slope) > -bend) return peak;
  return std::max(peak, sign * values[middle] - 0.5 * slope * slope / bend);
}

std::vector<double> instantsOf(const VectorX& lengths) {
  std::vector<double> times{0.0};
  for (Eigen::Index k = 0; k < lengths.size(); ++k) times.push_back(times.back() + lengths[k]);
  return times;
}

/// The share of the limits that each segment uses, as the factor of time that brings it to the bound.
class UseOfSegments {
 public:
  UseOfSegments(const ShapeBuilder& build, const MatrixX& positions, const Limits& limits)
      : build_(build), positions_(positions), limits_(limits) {}

  /// Of the motion with these lengths; the return value is its shortest duration.
  double measure(const VectorX& lengths, VectorX& use) {
    ++motions;
    const std::vector<double> times = instantsOf(lengths);
    const PiecewisePolynomial motion = build_(positions_, times);
    use = VectorX::Zero(lengths.size());
    std::size_t segment = 0;
    for (std::size_t k = 0; k < motion.segments(); ++k) {
      const double stretch = stretchOf(motion, k);
      const double begin = motion.breaks[k] + 0.01 * motion.length(k);
      const double end = motion.breaks[k + 1] - 0.01 * motion.length(k);
      while (segment + 2 < times.size() && begin >= times[segment + 1]) ++segment;
      // A piece of a spline may belong to two segments.
      const bool two = segment + 2 < times.size() && end > times[segment + 1];
      for (std::size_t s = segment; s <= segment + (two ? 1 : 0); ++s) {
        double& here = use[static_cast<Eigen::Index>(s)];
        here = std::max(here, stretch);
      }
    }
    return lengths.sum() * use.maxCoeff();
  }

  long motions = 0;

 private:
  static int heldOrders(const PiecewisePolynomial& motion) {
    const bool moving = !motion.starts_at_rest && !motion.ends_at_rest;
    return 1 + std::min(2, moving ? motion.continuity : std::min(motion.continuity, motion.rest_continuity));
  }

  double stretchOf(const PiecewisePolynomial& motion, std::size_t k) const {
    const int places = motion.degree == 3 ? 3 : 9;
    const int orders = heldOrders(motion);
    const double rate = 1.0 / motion.length(k);
    double stretch = 0.0;
    for (int j = 0; j < motion.joints; ++j) {
      Polynomial p = motion.piece(k, j);
      double scale = 1.0;
      for (int order = 1; order <= orders; ++order) {
        p = p.derivative();
        scale *= rate;
        const double ratio = nearPeak(p, places) * scale / limits_.bound(j, order);
        stretch = std::max(stretch, order == 1 ? ratio : order == 2 ? std::sqrt(ratio) : std::cbrt(ratio));
      }
    }
    return stretch;
  }

  const ShapeBuilder& build_;
  const MatrixX& positions_;
  const Limits& limits_;
};

/// Each length by its own factor, given as a logarithm; of the longest 1.
VectorX shifted(const VectorX& lengths, const VectorX& logarithms) {
  const VectorX moved = lengths.array() * logarithms.array().exp();
  return (moved / moved.maxCoeff()).cwiseMax(kNarrowest);
}

class SegmentSearch {
 public:
  SegmentSearch(const ShapeBuilder& build, const MatrixX& positions, const Limits& limits, VectorX lengths)
      : use_(build, positions, limits), lengths_(std::move(lengths)), targets_(VectorX::Ones(lengths_.size())) {
    const long work = static_cast<long>(positions.rows()) * lengths_.size();
    VectorX use;
    best_ = use_.measure(lengths_, use);
    const int degree = build(positions, instantsOf(lengths_)).degree;
    most_ = std::min(kMostMotions, kMostWork / (work * (2 * degree - 5)));
  }

  const VectorX& run() {
    if (!(best_ > 0.0)) return lengths_;  // Nothing is limited.
    balance(lengths_, targets_, kFirstRounds);
    for (const double step : {0.3, 0.1, 0.03}) sweep([&](Eigen::Index k) { return leaveRoom(k, step); });
    for (const double step : {0.1, 0.03, 0.01}) sweep([&](Eigen::Index k) { return lengthen(k, step); });
    return lengths_;
  }

 private:
  bool exhausted() const { return use_.motions >= most_; }

  /// Lengths so that segment k uses targets[k] of the limits, from the given ones. Keeps the best on the way.
  bool balance(VectorX lengths, const VectorX& targets, int rounds) {
    constexpr double kWorse = 1.02;  // The step before was too long: splines of high degree answer far away.
    double damping = kDamping;
    double before = std::numeric_limits<double>::infinity();
    bool gained = false;
    VectorX use;
    VectorX last;
    VectorX off;
    for (int round = 0; round < rounds && !exhausted(); ++round) {
      const double duration = use_.measure(lengths, use);
      if (!(duration > 0.0) || !std::isfinite(duration)) break;
      if (duration < best_ * (1.0 - kGain)) {
        best_ = duration;
        lengths_ = lengths;
        gained = true;
      }
      if (duration > before) damping = std::max(0.03, 0.6 * damping);
      if (duration > kWorse * before) {
        lengths = shifted(last, damping * off);
        continue;
      }
      before = duration;
      last = lengths;
      off = (use.array() / use.maxCoeff() / targets.array()).max(0.3).log();
      if (off.cwiseAbs().maxCoeff() < kBalanced) break;
      lengths = shifted(lengths, damping * off);
    }
    return gained;
  }

  template <typename Step>
  void sweep(const Step& step) {
    constexpr int kSweeps = 3;
    bool gained = true;
    for (int i = 0; i < kSweeps && gained; ++i) {
      gained = false;
      for (Eigen::Index k = 0; k < lengths_.size() && !exhausted(); ++k) gained = step(k) || gained;
    }
  }

  bool leaveRoom(Eigen::Index k, double step) {
    for (const double factor : {1.0 - step, 1.0 / (1.0 - step)}) {
      VectorX targets = targets_;
      targets[k] = std::min(1.0, targets[k] * factor);
      if (targets[k] == targets_[k] || !balance(lengths_, targets, kRounds)) continue;
      targets_ = targets;
      return true;
    }
    return false;
  }

  bool lengthen(Eigen::Index k, double step) {
    for (const double factor : {1.0 + step, 1.0 / (1.0 + step)}) {
      VectorX lengths = lengths_;
      lengths[k] *= factor;
      if (balance(lengths, targets_, 1)) return true;
    }
    return false;
  }

  UseOfSegments use_;
  VectorX lengths_;
  VectorX targets_;
  double best_ = 0.0;
  long most_ = 0;
};

/// Whether the columns read backwards come first: one of the two directions is searched for both.
bool comesBackwards(const MatrixX& positions) {
  const MatrixX backwards = positions.rowwise().reverse();
  return std::lexicographical_compare(backwards.data(), backwards.data() + backwards.size(), positions.data(),
                                      positions.data() + positions.size());
}

}  // namespace

std::vector<double> shortestRatios(const ShapeBuilder& build, const MatrixX& positions, const Limits& limits,
                                   const std::vector<double>& weights) {
  if (weights.size() < 2) return weights;
  const bool backwards = comesBackwards(positions);
  VectorX lengths = Eigen::Map<const VectorX>(weights.data(), static_cast<Eigen::Index>(weights.size()));
  if (backwards) lengths.reverseInPlace();
  const MatrixX way = backwards ? MatrixX(positions.rowwise().reverse()) : positions;
  VectorX found = SegmentSearch(build, way, limits, lengths).run();
  if (backwards) found.reverseInPlace();
  return {found.data(), found.data() + found.size()};
}

std::vector<double> balancedOnce(const ShapeBuilder& build, const MatrixX& positions, const Limits& limits,
                                 const std::vector<double>& lengths) {
  const VectorX before = Eigen::Map<const VectorX>(lengths.data(), static_cast<Eigen::Index>(lengths.size()));
  VectorX use;
  const double duration = UseOfSegments(build, positions, limits).measure(before, use);
  if (!(duration > 0.0) || !std::isfinite(duration)) return lengths;
  const VectorX after = shifted(before, kDamping * (use.array() / use.maxCoeff()).max(0.3).log().matrix());
  return {after.data(), after.data() + after.size()};
}

}  // namespace screwline

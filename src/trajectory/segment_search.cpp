#include "segment_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace screwline {
namespace {

constexpr double kGain = 1e-6;       ///< What a step has to gain: less is not worth its place.
constexpr double kNarrowest = 1e-3;  ///< Of the longest segment.
constexpr double kBalanced = 1e-7;   ///< Of the use of limits.
constexpr long kMostMotions = 600;   ///< Looked at in one search.
constexpr long kMostWork = 1200000;  ///< Pieces times joints, in units of a cubic.
constexpr int kTailMotions = 6;      ///< The same for a tail that is scaled to its limits, for each motion.
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

/// The share of the limits that each segment uses, as the factor of time that brings it to the bound.
class UseOfSegments {
 public:
  UseOfSegments(const ShapeBuilder& build, const MatrixX& positions, const Limits& limits)
      : build_(build), positions_(positions), limits_(limits) {}

  void measure(const std::vector<double>& times, VectorX& use) {
    ++motions;
    const PiecewisePolynomial motion = build_(positions_, times);
    use = VectorX::Zero(positions_.cols() - 1);
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

std::vector<double> listOf(const VectorX& values) {
  return {values.data(), values.data() + values.size()};
}

class SegmentSearch {
 public:
  SegmentSearch(const ShapeBuilder& build, const MatrixX& positions, const Limits& limits, const TimeFrame& frame,
                bool homogeneous, VectorX lengths)
      : use_(build, positions, limits),
        frame_(frame),
        homogeneous_(homogeneous && frame.allOpen()),
        lengths_(std::move(lengths)),
        targets_(VectorX::Ones(lengths_.size())) {
    const long work = static_cast<long>(positions.rows()) * lengths_.size();
    const int degree = build(positions, frame.instants(listOf(lengths_))).degree;
    const long each = frame.openEnd() && !homogeneous_ ? kTailMotions : 1;
    most_ = std::min(kMostMotions * each, kMostWork / (work * (2 * degree - 5)));
    VectorX use;
    best_ = cost(lengths_, use);
  }

  const VectorX& run() {
    if (!(best_ > 0.0)) return lengths_;  // Nothing is limited.
    startLessUnequal();
    balance(lengths_, targets_, kFirstRounds);
    for (const double step : {0.3, 0.1, 0.03}) sweep([&](Eigen::Index k) { return leaveRoom(k, step); });
    for (const double step : {0.1, 0.03, 0.01}) sweep([&](Eigen::Index k) { return lengthen(k, step); });
    return lengths_;
  }

 private:
  bool exhausted() const { return use_.motions >= most_; }

  /// The duration, or, where that is given, the factor of time that would bring the motion to its limits.
  double cost(VectorX& lengths, VectorX& use) {
    if (frame_.openEnd() && !homogeneous_) return durationOf(lengths, use);
    use_.measure(frame_.instants(listOf(lengths)), use);
    return (frame_.openEnd() ? lengths.sum() : 1.0) * use.maxCoeff();
  }

  /// The same with a tail that does not scale with the rest: brought to its limits by a few steps. What passes the
  /// limits elsewhere counts as a duration beyond all others.
  double durationOf(VectorX& lengths, VectorX& use) {
    constexpr double kNear = 1e-6;
    constexpr double kBeyond = 1e6;
    auto tail = lengths.tail(lengths.size() - static_cast<Eigen::Index>(frame_.tail()));
    for (int round = 0;; ++round) {
      use_.measure(frame_.instants(listOf(lengths)), use);
      const double most = use.tail(tail.size()).maxCoeff();
      if (std::abs(most - 1.0) < kNear || round == kTailMotions || !(most > 0.0) || !std::isfinite(most)) break;
      tail *= most;
    }
    const double excess = use.maxCoeff();
    return (frame_.tailStart() + tail.sum()) * (excess > 1.0 + kNear ? kBeyond * excess : 1.0);
  }

  /// Splines of high degree swing where a long segment follows a short one: of the weights as they are, less unequal
  /// ones (their powers), and equal ones the best is where the search starts.
  void startLessUnequal() {
    const VectorX given = lengths_;
    for (const double share : {0.25, 0.5, 1.0})
      balance(shifted(given, -share * given.array().log().matrix()), targets_, 1);
  }

  /// For each group of segments that share their time.
  template <typename Visit>
  void eachGroup(const Visit& visit) const {
    for (std::size_t k = 0; k < static_cast<std::size_t>(lengths_.size());) {
      const auto [begin, end] = frame_.groupOf(k);
      visit(static_cast<Eigen::Index>(begin), static_cast<Eigen::Index>(end - begin));
      k = end;
    }
  }

  /// Each length by its own factor, given as a logarithm; groups keep their sums, and none of it is lost.
  VectorX shifted(const VectorX& lengths, const VectorX& logarithms) const {
    VectorX moved = lengths.array() * logarithms.array().exp();
    eachGroup([&](Eigen::Index begin, Eigen::Index count) {
      auto group = moved.segment(begin, count);
      group = group.cwiseMax(kNarrowest * group.maxCoeff());
      group *= lengths.segment(begin, count).sum() / group.sum();
    });
    return moved;
  }

  /// How far each segment is from its target share of what the tightest of its group uses, as logarithms.
  VectorX imbalance(const VectorX& use, const VectorX& targets) const {
    VectorX off = use.array() / targets.array();
    eachGroup([&](Eigen::Index begin, Eigen::Index count) {
      const double most = use.segment(begin, count).maxCoeff();
      if (most > 0.0) off.segment(begin, count) /= most;
    });
    return off.cwiseMax(0.3).array().log();
  }

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
      const double value = cost(lengths, use);
      if (!(value > 0.0) || !std::isfinite(value)) break;
      if (value < best_ * (1.0 - kGain)) {
        best_ = value;
        lengths_ = lengths;
        gained = true;
      }
      if (value > before) damping = std::max(0.03, 0.6 * damping);
      if (value > kWorse * before) {
        lengths = shifted(last, damping * off);
        continue;
      }
      before = value;
      last = lengths;
      off = imbalance(use, targets);
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
  const TimeFrame& frame_;
  bool homogeneous_;
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

TimeFrame::TimeFrame(std::vector<double> given) : given_(std::move(given)) {
  for (std::size_t k = 1; k < given_.size(); ++k) known_ = given_[k] > 0.0 ? k : known_;
}

bool TimeFrame::allGiven() const {
  return std::all_of(given_.begin() + 1, given_.end(), [](double t) { return t > 0.0; });
}

std::pair<std::size_t, std::size_t> TimeFrame::groupOf(std::size_t segment) const {
  std::size_t begin = segment;
  while (begin > 0 && given_[begin] == 0.0) --begin;
  std::size_t end = segment + 1;
  while (end + 1 < given_.size() && given_[end] == 0.0) ++end;
  return {begin, end};
}

std::vector<double> TimeFrame::instants(const std::vector<double>& weights, double scale) const {
  std::vector<double> times(given_.size(), 0.0);
  for (std::size_t begin = 0; begin < known_;) {
    const std::size_t end = groupOf(begin).second;
    const auto first = weights.begin() + static_cast<std::ptrdiff_t>(begin);
    const double total = std::accumulate(first, weights.begin() + static_cast<std::ptrdiff_t>(end), 0.0);
    double passed = 0.0;
    for (std::size_t k = begin + 1; k <= end; ++k) {
      passed += weights[k - 1];
      // Repeated waypoints weigh nothing where they may take no time: those at the end of a run coincide with its end.
      times[k] =
          k == end || passed >= total ? given_[end] : given_[begin] + (given_[end] - given_[begin]) * passed / total;
    }
    begin = end;
  }
  for (std::size_t k = known_ + 1; k < times.size(); ++k) times[k] = times[k - 1] + scale * weights[k - 1];
  return times;
}

std::vector<double> searchedWeights(const ShapeBuilder& build, const MatrixX& positions, const Limits& limits,
                                    const TimeFrame& frame, bool homogeneous, const std::vector<double>& weights) {
  const bool backwards = frame.allOpen() && homogeneous && comesBackwards(positions);
  VectorX lengths = Eigen::Map<const VectorX>(weights.data(), static_cast<Eigen::Index>(weights.size()));
  if (backwards) lengths.reverseInPlace();
  const MatrixX way = backwards ? MatrixX(positions.rowwise().reverse()) : positions;
  VectorX found = SegmentSearch(build, way, limits, frame, homogeneous, lengths).run();
  if (backwards) found.reverseInPlace();
  return listOf(found);
}

}  // namespace screwline

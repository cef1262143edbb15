#include "along_path.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "long_polynomial.h"

namespace screwline {
namespace {

constexpr double kFar = 0.1;     // Of a segment of the path: shorter ways do not make coefficients cancel.
constexpr double kSame = 1e-12;  // Of the whole: closer breaks are one.

/// Degree 7 between two ends that are given with three derivatives. Source: Biagiotti & Melchiorri, section 2.1.
Polynomial septicBetween(const ScalingSample& first, const ScalingSample& last, double h) {
  const double c1 = h * first.ds, c2 = 0.5 * h * h * first.dds, c3 = h * h * h * first.ddds / 6.0;
  const double d0 = last.s - (first.s + c1 + c2 + c3);
  const double d1 = h * last.ds - (c1 + 2.0 * c2 + 3.0 * c3);
  const double d2 = h * h * last.dds - (2.0 * c2 + 6.0 * c3);
  const double d3 = h * h * h * last.ddds - 6.0 * c3;
  return {{first.s, c1, c2, c3, 35.0 * d0 - 15.0 * d1 + 2.5 * d2 - d3 / 6.0,
           -84.0 * d0 + 39.0 * d1 - 7.0 * d2 + 0.5 * d3, 70.0 * d0 - 34.0 * d1 + 6.5 * d2 - 0.5 * d3,
           -20.0 * d0 + 10.0 * d1 - 2.0 * d2 + d3 / 6.0}};
}

PiecewisePolynomial polynomialPieces(const TimeLaw& scaling) {
  if (!scaling.isCycloidal()) return scaling.pieces();
  constexpr int kPieces = 32;
  std::vector<double> breaks;
  for (int k = 0; k <= kPieces; ++k) breaks.push_back(static_cast<double>(k) / kPieces);
  PiecewisePolynomial pieces(1, 7, breaks, 3);
  pieces.rest_continuity = 2;
  for (std::size_t k = 0; k < pieces.segments(); ++k) {
    pieces.setPiece(k, 0, septicBetween(scaling.at(breaks[k]), scaling.at(breaks[k + 1]), pieces.length(k)));
  }
  return pieces;
}

/// Where a polynomial that does not decrease over [0, 1] reaches a value between its ends.
double placeOf(const Polynomial& p, double value) {
  double low = 0.0;
  double high = 1.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (p(middle) < value ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// p(from + (to - from) w).
Polynomial partOf(const Polynomial& p, double from, double to) {
  Polynomial part = p;
  for (std::size_t i = 0; i < part.c.size(); ++i) {
    for (std::size_t k = part.c.size() - 1; k > i; --k) part.c[k - 1] += from * part.c[k];
  }
  double scale = 1.0;
  for (double& c : part.c) {
    c *= scale;
    scale *= to - from;
  }
  return part;
}

/// Where to cut one piece of the scaling, in its own [0, 1]. Pieces of high degree that go far are cut up even where
/// the path has no break: the coefficients of a composition of high degree cancel over a long way.
std::vector<double> cutsOf(const JointPath& path, const Polynomial& s, int degree) {
  std::vector<double> cuts{0.0};
  const auto& breaks = path.breaks();
  auto next = std::upper_bound(breaks.begin() + 1, breaks.end() - 1, (s(0.0) + kSame) * path.length());
  for (; next < breaks.end() - 1 && *next < (s(1.0) - kSame) * path.length(); ++next) {
    cuts.push_back(placeOf(s, *next / path.length()));
  }
  const double inverse = path.inverseLength(path.segmentAt(path.length() * s(0.5)));
  const bool far = (s(1.0) - s(0.0)) * path.length() * inverse > kFar;
  const int parts = far && degree * path.curve().degree > 12 ? 16 : 1;
  for (int k = 1; k < parts; ++k) cuts.push_back(static_cast<double>(k) / parts);
  cuts.push_back(1.0);
  std::sort(cuts.begin(), cuts.end());
  const auto same = [](double a, double b) { return b - a < kSame; };
  cuts.erase(std::unique(cuts.begin(), cuts.end(), same), cuts.end());
  cuts.back() = 1.0;
  return cuts;
}

struct Ends {
  double velocity = 0.0;
  double acceleration = 0.0;
};

/// Gathers the figures of one joint, piece by piece.
class Gatherer {
 public:
  Gatherer(const JointPath& path, int joint, int promised) : promised_(promised) {
    const JointExtrema way = path.curve().extrema(joint);
    figures_.position = way.position;
    figures_.travel = way.travel;
  }

  void add(const LongPolynomial& position, double length, bool first, const PiecewisePolynomial& scaling) {
    const double r = 1.0 / length;
    const LongPolynomial velocity = derivative(position, r);
    const LongPolynomial acceleration = derivative(velocity, r);
    const LongPolynomial jerk = derivative(acceleration, r);
    figures_.velocity = largestMagnitude(velocity, figures_.velocity);
    figures_.acceleration = largestMagnitude(acceleration, figures_.acceleration);
    figures_.jerk = largestMagnitude(jerk, figures_.jerk);
    figures_.squared_acceleration += integralOfSquare(acceleration) * length;
    figures_.squared_jerk += integralOfSquare(jerk) * length;
    const Ends start{velocity.c[0], acceleration.c[0]};
    if (!first) {
      step(last_, start, promised_);
    } else if (scaling.starts_at_rest) {
      step({}, start, scaling.rest_continuity);
    }
    last_ = {valueAtOne(velocity), valueAtOne(acceleration)};
  }

  JointExtrema finish(const PiecewisePolynomial& scaling) {
    if (scaling.ends_at_rest) step(last_, {}, scaling.rest_continuity);
    return figures_;
  }

 private:
  /// What is promised not to step shows no rounding in the figures.
  void step(const Ends& before, const Ends& after, int promised) {
    if (promised < 1)
      figures_.velocity_step = std::max(figures_.velocity_step, std::abs(after.velocity - before.velocity));
    if (promised < 2) {
      figures_.acceleration_step =
          std::max(figures_.acceleration_step, std::abs(after.acceleration - before.acceleration));
    }
  }

  JointExtrema figures_;
  Ends last_;
  int promised_;
};

}  // namespace

PiecewisePolynomial scalingAlongPath(const JointPath& path, const TimeLaw& scaling) {
  const PiecewisePolynomial whole = polynomialPieces(scaling);
  std::vector<double> breaks{0.0};
  std::vector<Polynomial> parts;
  for (std::size_t k = 0; k < whole.segments(); ++k) {
    const Polynomial s = whole.piece(k, 0);
    const std::vector<double> cuts = cutsOf(path, s, whole.degree);
    for (std::size_t i = 1; i < cuts.size(); ++i) {
      const bool last = i + 1 == cuts.size();
      parts.push_back(cuts.size() == 2 ? s : partOf(s, cuts[i - 1], cuts[i]));
      breaks.push_back(last ? whole.breaks[k + 1] : whole.breaks[k] + cuts[i] * whole.length(k));
    }
  }
  PiecewisePolynomial result(1, whole.degree, std::move(breaks), whole.continuity);
  result.rest_continuity = whole.rest_continuity;
  result.starts_at_rest = whole.starts_at_rest;
  result.ends_at_rest = whole.ends_at_rest;
  for (std::size_t k = 0; k < parts.size(); ++k) result.setPiece(k, 0, parts[k]);
  return result;
}

std::vector<JointExtrema> extremaAlongPath(const JointPath& path, const PiecewisePolynomial& scaling, double duration) {
  const std::size_t n = static_cast<std::size_t>(path.joints());
  std::vector<Gatherer> joints;
  for (int j = 0; j < path.joints(); ++j)
    joints.emplace_back(path, j, std::min(scaling.continuity, path.curve().continuity));
  for (std::size_t k = 0; k < scaling.segments(); ++k) {
    Polynomial x = scaling.piece(k, 0);
    const std::size_t segment = path.segmentAt(path.length() * x(0.5));
    for (double& c : x.c) c *= path.length() * path.inverseLength(segment);
    x.c[0] -= path.breaks()[segment] * path.inverseLength(segment);
    const double length = scaling.length(k) * duration;
    if (!(length > kNoTime)) continue;
    for (std::size_t j = 0; j < n; ++j) {
      const LongPolynomial position = compose(path.segment(segment), static_cast<int>(j), x, scaling.degree);
      joints[j].add(position, length, k == 0, scaling);
    }
  }
  std::vector<JointExtrema> figures;
  for (auto& joint : joints) figures.push_back(joint.finish(scaling));
  return figures;
}

}  // namespace screwline

#include "screwline/trajectory/piecewise_polynomial.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace screwline {
namespace {

/// 1 / h^order; a segment that takes no time holds, so all its derivatives are zero.
double rate(double length, int order) {
  if (order == 0) return 1.0;
  return length > kNoTime ? std::pow(length, -order) : 0.0;
}

/// p(1 - u), by repeated synthetic division: exact for the small integers and stable for the rest.
Polynomial mirrored(const Polynomial& polynomial) {
  Polynomial shifted = polynomial;  // p(u + 1), then u -> -u.
  for (std::size_t i = 0; i < shifted.c.size(); ++i) {
    for (std::size_t k = shifted.c.size() - 1; k > i; --k) shifted.c[k - 1] += shifted.c[k];
  }
  for (std::size_t k = 1; k < shifted.c.size(); k += 2) shifted.c[k] = -shifted.c[k];
  return shifted;
}

}  // namespace

double JointExtrema::peak(int order) const {
  // A step below rounding of what it steps in is none: pieces meet to a few units in the last place.
  const bool velocity_steps = velocity_step > 1e-9 * velocity;
  const bool acceleration_steps = velocity_steps || acceleration_step > 1e-9 * acceleration;
  const double infinity = std::numeric_limits<double>::infinity();
  if (order == 1) return velocity;
  if (order == 2) return velocity_steps ? infinity : acceleration;
  return acceleration_steps ? infinity : jerk;
}

PiecewisePolynomial::PiecewisePolynomial(int joint_count, int piece_degree, std::vector<double> segment_breaks,
                                         int continuity_class)
    : joints(joint_count),
      degree(piece_degree),
      breaks(std::move(segment_breaks)),
      continuity(continuity_class),
      rest_continuity(continuity_class) {
  coefficients.assign(segments() * static_cast<std::size_t>(degree + 1) * static_cast<std::size_t>(joints), 0.0);
}

Polynomial PiecewisePolynomial::piece(std::size_t segment, int joint) const {
  Polynomial polynomial;
  for (int k = 0; k <= degree; ++k) polynomial.c[static_cast<std::size_t>(k)] = at(segment, k, joint);
  return polynomial;
}

void PiecewisePolynomial::setPiece(std::size_t segment, int joint, const Polynomial& polynomial) {
  for (int k = 0; k <= degree; ++k) at(segment, k, joint) = polynomial.c[static_cast<std::size_t>(k)];
}

std::size_t PiecewisePolynomial::segmentAt(double t) const {
  const auto after = std::upper_bound(breaks.begin() + 1, breaks.end() - 1, t);
  return static_cast<std::size_t>(after - breaks.begin()) - 1;
}

double PiecewisePolynomial::valueAt(double t, int joint) const {
  const std::size_t k = segmentAt(t);
  const double x = length(k) > 0.0 ? std::min(std::max((t - breaks[k]) / length(k), 0.0), 1.0) : 0.0;
  return piece(k, joint)(x);
}

double PiecewisePolynomial::atEnd(std::size_t segment, int joint, int order, bool upper_end) const {
  Polynomial polynomial = piece(segment, joint);
  for (int i = 0; i < order; ++i) polynomial = polynomial.derivative();
  return polynomial(upper_end ? 1.0 : 0.0) * rate(length(segment), order);
}

double stepInside(const PiecewisePolynomial& motion, int joint, int order) {
  double largest = 0.0;
  for (std::size_t k = 1; k < motion.segments(); ++k) {
    largest =
        std::max(largest, std::abs(motion.atEnd(k, joint, order, false) - motion.atEnd(k - 1, joint, order, true)));
  }
  return largest;
}

double stepFromRest(const PiecewisePolynomial& motion, int joint, int order) {
  if (order == 0 || motion.segments() == 0) return 0.0;
  const double start = motion.starts_at_rest ? std::abs(motion.atEnd(0, joint, order, false)) : 0.0;
  const double end = motion.ends_at_rest ? std::abs(motion.atEnd(motion.segments() - 1, joint, order, true)) : 0.0;
  return std::max(start, end);
}

JointExtrema PiecewisePolynomial::extrema(int joint) const {
  JointExtrema result;
  for (std::size_t k = 0; k < segments(); ++k) {
    const double h = length(k);
    const Polynomial position = piece(k, joint);
    const Polynomial velocity = position.derivative();
    const Polynomial acceleration = velocity.derivative();
    const Polynomial jerk = acceleration.derivative();
    const Range range = rangeOverUnitInterval(position);
    result.position.lower = k == 0 ? range.lower : std::min(result.position.lower, range.lower);
    result.position.upper = k == 0 ? range.upper : std::max(result.position.upper, range.upper);
    result.velocity = std::max(result.velocity, rangeOverUnitInterval(velocity).peak() * rate(h, 1));
    result.acceleration = std::max(result.acceleration, rangeOverUnitInterval(acceleration).peak() * rate(h, 2));
    result.jerk = std::max(result.jerk, rangeOverUnitInterval(jerk).peak() * rate(h, 3));
    result.travel += totalVariation(position);
    result.squared_acceleration += integralOfSquare(acceleration) * rate(h, 3);
    result.squared_jerk += integralOfSquare(jerk) * rate(h, 5);
  }
  // Where the builder promises continuity the remaining jumps are rounding: the verifier bounds them, no figure shows
  // them.
  const auto step = [&](int order) {
    return std::max(continuity < order ? stepInside(*this, joint, order) : 0.0,
                    rest_continuity < order ? stepFromRest(*this, joint, order) : 0.0);
  };
  result.velocity_step = step(1);
  result.acceleration_step = step(2);
  return result;
}

PiecewisePolynomial concatenate(const PiecewisePolynomial& first, const PiecewisePolynomial& second) {
  std::vector<double> breaks{0.0};
  std::vector<std::pair<const PiecewisePolynomial*, std::size_t>> sources;
  for (const auto* motion : {&first, &second}) {
    const double start = motion == &first ? 0.0 : first.duration();
    for (std::size_t k = 0; k < motion->segments(); ++k) {
      const double end = start + motion->breaks[k + 1];
      if (motion->length(k) <= 0.0 || end <= breaks.back()) continue;  // Or so short that it vanishes beside the start.
      sources.emplace_back(motion, k);
      breaks.push_back(end);
    }
  }
  if (sources.empty()) return second;
  const int degree = std::max(first.degree, second.degree);
  PiecewisePolynomial joined(first.joints, degree, std::move(breaks), std::min(first.continuity, second.continuity));
  joined.rest_continuity = std::min(first.rest_continuity, second.rest_continuity);
  joined.starts_at_rest = first.starts_at_rest;
  joined.ends_at_rest = second.ends_at_rest;
  for (std::size_t k = 0; k < joined.segments(); ++k) {
    for (int j = 0; j < joined.joints; ++j) joined.setPiece(k, j, sources[k].first->piece(sources[k].second, j));
  }
  return joined;
}

PiecewisePolynomial reversed(const PiecewisePolynomial& motion) {
  std::vector<double> breaks;
  for (auto t = motion.breaks.rbegin(); t != motion.breaks.rend(); ++t) breaks.push_back(motion.duration() - *t);
  PiecewisePolynomial result(motion.joints, motion.degree, std::move(breaks), motion.continuity);
  result.rest_continuity = motion.rest_continuity;
  result.starts_at_rest = motion.ends_at_rest;
  result.ends_at_rest = motion.starts_at_rest;
  for (std::size_t k = 0; k < result.segments(); ++k) {
    for (int j = 0; j < result.joints; ++j) result.setPiece(k, j, mirrored(motion.piece(motion.segments() - 1 - k, j)));
  }
  return result;
}

}  // namespace screwline

#include "screwline/trajectory/verify.h"

#include <algorithm>
#include <cmath>

#include "screwline/trajectory/enclosure.h"
#include "screwline/trajectory/format.h"

namespace screwline {
namespace {

/// Pieces are built from one another's end values; what remains between them is rounding of the largest value involved.
constexpr double kStepTolerance = 1e-7;
constexpr double kPositionTolerance = 1e-9;
constexpr int kMostHalvings = 44;  ///< Of one piece: below that instants are not told apart.

constexpr const char* kOrderNames[] = {"position", "velocity", "acceleration", "jerk"};

std::string joint(int index) {
  return "joint " + std::to_string(index) + ": ";
}

double valueOf(const TrajectoryPoint& point, int joint, int order) {
  const VectorX* values[] = {&point.position, &point.velocity, &point.acceleration, &point.jerk};
  return (*values[order])[joint];
}

/// Where a motion is, or may be, outside of a range.
struct Breach {
  double time = 0.0;
  double value = 0.0;
};

/// Proves that one derivative of one joint stays in a range: halves stretches until their enclosure is inside of it, or
/// a value is found that is not.
class Prover {
 public:
  Prover(const JointTrajectory& trajectory, int joint, int order, const Range& range)
      : trajectory_(trajectory), joint_(joint), order_(order), range_(range), point_(trajectory.joints()) {}

  /// Over one piece: the ends as limits from inside it.
  std::optional<Breach> over(double from, double to, int halvings = kMostHalvings) {
    const Range reached = enclosure(trajectory_, joint_, order_, from, to);
    if (reached.lower >= range_.lower && reached.upper <= range_.upper) return std::nullopt;
    const double middle = 0.5 * (from + to);
    trajectory_.sample(middle, point_);
    const double value = valueOf(point_, joint_, order_);
    if (!(value >= range_.lower && value <= range_.upper)) return Breach{middle, value};
    if (halvings == 0 || !(middle > from && middle < to)) {
      return Breach{middle, reached.lower < range_.lower ? reached.lower : reached.upper};
    }
    if (auto breach = over(from, middle, halvings - 1)) return breach;
    return over(middle, to, halvings - 1);
  }

 private:
  const JointTrajectory& trajectory_;
  int joint_;
  int order_;
  Range range_;
  TrajectoryPoint point_;
};

std::vector<double> stretchesOf(const JointTrajectory& trajectory) {
  std::vector<double> instants{0.0};
  for (double corner : trajectory.corners()) {
    if (corner > instants.back() && corner < trajectory.duration()) instants.push_back(corner);
  }
  instants.push_back(trajectory.duration());
  return instants;
}

/// Along a path the exact extrema are compared (its rates ride on their limits: no enclosure but these is tight
/// enough); samples tell about when.
std::optional<Breach> breachAlongPath(const JointTrajectory& trajectory, int index, int order, const Range& range) {
  const Range reached = enclosure(trajectory, index, order, 0.0, trajectory.duration());
  if (reached.lower >= range.lower && reached.upper <= range.upper) return std::nullopt;
  constexpr int kSamples = 1000;
  TrajectoryPoint point(trajectory.joints());
  Breach largest;
  for (int k = 0; k <= kSamples; ++k) {
    const double time = trajectory.duration() * k / kSamples;
    trajectory.sample(time, point);
    const double value = valueOf(point, index, order);
    if (std::abs(value) > std::abs(largest.value)) largest = {time, value};
  }
  const bool inside = largest.value >= range.lower && largest.value <= range.upper;
  if (inside) largest.value = reached.lower < range.lower ? reached.lower : reached.upper;
  return largest;
}

/// Over all of the motion.
std::optional<Breach> breachOf(const JointTrajectory& trajectory, const std::vector<double>& stretches, int index,
                               int order, const Range& range) {
  if (trajectory.path() != nullptr) return breachAlongPath(trajectory, index, order, range);
  Prover prover(trajectory, index, order, range);
  for (std::size_t k = 1; k < stretches.size(); ++k) {
    if (const auto breach = prover.over(stretches[k - 1], stretches[k])) return breach;
  }
  return std::nullopt;
}

/// NaN and infinity are breaches of any bound.
std::optional<std::string> checkOrder(const JointTrajectory& trajectory, const std::vector<double>& stretches,
                                      int index, int order, const Range& bound, double tolerance) {
  const double slack[] = {tolerance * std::max(1.0, std::abs(bound.lower)),
                          tolerance * std::max(1.0, std::abs(bound.upper))};
  const double relative = order > 0 ? tolerance * bound.upper : 0.0;  // Of a rate: of its limit.
  const Range range = order > 0 ? Range{bound.lower - relative, bound.upper + relative}
                                : Range{bound.lower - slack[0], bound.upper + slack[1]};
  constexpr double kAnything = 1e300;
  const Range finite{std::max(range.lower, -kAnything), std::min(range.upper, kAnything)};
  const auto breach = breachOf(trajectory, stretches, index, order, finite);
  if (!breach) return std::nullopt;
  const bool low = breach->value < finite.lower;
  const std::string side = order > 0 ? "limit" : low ? "lower limit" : "upper limit";
  return joint(index) + kOrderNames[order] + " reaches " + number(breach->value) + " at " + number(breach->time) +
         " s, its " + side + " is " + number(low ? bound.lower : bound.upper);
}

/// Orders of which the one below steps are infinite whatever the limit is: see plan.h.
std::optional<std::string> checkLimits(const JointTrajectory& trajectory, const std::vector<double>& stretches,
                                       const Limits& limits, int index) {
  const bool bounded = limits.lower.size() > 0;
  const Range positions{bounded ? limits.lower[index] : -HUGE_VAL, bounded ? limits.upper[index] : HUGE_VAL};
  if (auto broken = checkOrder(trajectory, stretches, index, 0, positions, kPositionTolerance)) return broken;
  const JointExtrema extrema = trajectory.extrema(index);
  for (int order = 1; order <= 3; ++order) {
    const bool held = std::isfinite(extrema.peak(order));
    const double bound = held ? limits.bound(index, order) : HUGE_VAL;
    if (auto broken = checkOrder(trajectory, stretches, index, order, {-bound, bound}, 2.0 * kLimitTolerance)) {
      return broken;
    }
  }
  return std::nullopt;
}

/// A step of a derivative: when, how large, and how much of that may be rounding.
struct Step {
  double time = 0.0;
  double value = 0.0;
  double rounding = 0.0;
};

/// The step that stands out most.
/// @param scale of positions: their rounding over the shorter of the pieces beside is what derivatives may step by;
/// @param next of the derivative above: the rounding of instants times that is too.
Step largestStep(const PiecewisePolynomial& motion, int index, int order, double scale, double next) {
  constexpr double kRounding = 1e-13;
  constexpr double kInstants = 1e-15;
  Step largest;
  const auto take = [&](double time, double step, double length) {
    double rounding = length > 0.0 ? kRounding * scale / std::pow(length, order) : 0.0;
    if (std::isfinite(next)) rounding += kInstants * next * time;
    if (std::abs(step) - rounding <= largest.value - largest.rounding) return;
    largest = {time, std::abs(step), rounding};
  };
  if (order <= motion.continuity) {
    for (std::size_t k = 1; k < motion.segments(); ++k) {
      take(motion.breaks[k], motion.atEnd(k, index, order, false) - motion.atEnd(k - 1, index, order, true),
           std::min(motion.length(k - 1), motion.length(k)));
    }
  }
  if (order > 0 && order <= motion.rest_continuity && motion.segments() > 0) {
    const std::size_t last = motion.segments() - 1;
    if (motion.starts_at_rest) take(0.0, motion.atEnd(0, index, order, false), motion.length(0));
    if (motion.ends_at_rest) take(motion.duration(), motion.atEnd(last, index, order, true), motion.length(last));
  }
  return largest;
}

std::optional<std::string> checkSteps(const PiecewisePolynomial& motion, const JointExtrema& e, int index) {
  const double scale[] = {std::max(1.0, e.position.peak()), e.velocity, e.acceleration, e.jerk, 0.0};
  for (int order = 0; order <= std::max(motion.continuity, motion.rest_continuity); ++order) {
    const Step step = largestStep(motion, index, order, scale[0], scale[order + 1]);
    if (step.value <= kStepTolerance * scale[order] + step.rounding) continue;
    return joint(index) + "derivative " + std::to_string(order) + " steps by " + number(step.value) + " at " +
           number(step.time) + " s, the motion promises that it does not";
  }
  return std::nullopt;
}

std::optional<std::string> checkContinuity(const JointTrajectory& trajectory) {
  for (int j = 0; trajectory.pieces() != nullptr && j < trajectory.joints(); ++j) {
    if (auto broken = checkSteps(*trajectory.pieces(), trajectory.extrema(j), j)) return broken;
  }
  const TimeLaw* scaling = trajectory.scaling();
  if (scaling == nullptr || scaling->isCycloidal()) return std::nullopt;
  if (auto broken = checkSteps(scaling->pieces(), scaling->extrema(), 0)) return "time scaling, " + *broken;
  return std::nullopt;
}

std::optional<std::string> checkWaypoint(const TrajectoryPoint& point, const Checkpoint& checkpoint) {
  const VectorX* wanted[] = {&checkpoint.position, &checkpoint.velocity, &checkpoint.acceleration};
  constexpr double kTolerance[] = {kPositionTolerance, 1e-7, 1e-6};
  for (int order = 0; order < 3; ++order) {
    for (int j = 0; j < static_cast<int>(wanted[order]->size()); ++j) {
      const double value = (*wanted[order])[j];
      const double miss = std::abs(valueOf(point, j, order) - value);
      if (miss <= kTolerance[order] * std::max(1.0, std::abs(value))) continue;
      return joint(j) + "misses its waypoint at " + number(checkpoint.time) + " s by " + number(miss) + " in " +
             kOrderNames[order];
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> verifyTrajectory(const JointTrajectory& trajectory, const Limits& limits,
                                            const std::vector<Checkpoint>& checkpoints) {
  if (limits.joints() != trajectory.joints())
    return "the motion has " + std::to_string(trajectory.joints()) + " joints";
  if (!(std::isfinite(trajectory.duration()) && trajectory.duration() >= 0.0)) return "the duration is not finite";
  const std::vector<double> stretches = stretchesOf(trajectory);
  for (int j = 0; j < trajectory.joints(); ++j) {
    if (auto broken = checkLimits(trajectory, stretches, limits, j)) return broken;
  }
  if (auto broken = checkContinuity(trajectory)) return broken;
  TrajectoryPoint point(trajectory.joints());
  double before = 0.0;
  for (const auto& checkpoint : checkpoints) {
    if (!(checkpoint.time >= before && checkpoint.time <= trajectory.duration())) {
      return "a waypoint's instant is " + number(checkpoint.time) + " s, it must be from " + number(before) + " s to " +
             number(trajectory.duration()) + " s";
    }
    before = checkpoint.time;
    trajectory.sample(checkpoint.time, point);
    if (auto broken = checkWaypoint(point, checkpoint)) return broken;
  }
  return std::nullopt;
}

}  // namespace screwline

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "screwline/exception.h"
#include "screwline/trajectory/format.h"
#include "screwline/trajectory/state_to_state.h"

namespace screwline {
namespace {

/// Appends the instants at which any joint changes its jerk, from `offset` to `end`.
void appendBreaks(const StateToStateMotion& motion, double offset, double end, std::vector<double>& breaks) {
  std::vector<double> instants;
  for (std::size_t j = 0; j < static_cast<std::size_t>(motion.joints); ++j) {
    double t = 0.0;
    for (std::size_t k = 0; k < motion.phases[j].count; ++k) instants.push_back(t += motion.phases[j].phases[k].length);
  }
  std::sort(instants.begin(), instants.end());
  for (double t : instants) {
    if (offset + t > breaks.back() && offset + t < end) breaks.push_back(offset + t);
  }
  if (end > breaks.back() || breaks.size() == 1) breaks.push_back(end);
}

void layJoint(PiecewisePolynomial& pieces, std::size_t first, double offset, int joint, const JerkPhases& phases) {
  EndState state = phases.start;
  std::size_t phase = 0;
  double begin = offset;
  for (std::size_t k = first; k < pieces.segments(); ++k) {
    const double h = pieces.length(k);
    const double middle = pieces.breaks[k] + 0.5 * h;
    while (phase < phases.count && begin + phases.phases[phase].length < middle) {
      state = advanced(state, phases.phases[phase], phases.phases[phase].length);
      begin += phases.phases[phase++].length;
    }
    const JerkPhase rest;
    const JerkPhase& current = phase < phases.count ? phases.phases[phase] : rest;
    const EndState now = advanced(state, current, pieces.breaks[k] - begin);
    pieces.setPiece(k, joint,
                    {{now.position, now.velocity * h, 0.5 * now.acceleration * h * h, current.jerk * h * h * h / 6.0}});
  }
}

bool rests(const EndState& state) {
  return state.velocity == 0.0 && state.acceleration == 0.0;
}

const char* faultName(StateFault fault) {
  switch (fault) {
    case StateFault::kVelocity:
      return "velocity";
    case StateFault::kAcceleration:
      return "acceleration";
    case StateFault::kPosition:
      return "position";
    case StateFault::kLimits:
      return "limit";
    default:
      return "value";
  }
}

std::string subject(const StateToStateMotion& motion) {
  const std::string joint = "joint " + std::to_string(motion.joint) + ": ";
  const std::string fault = faultName(motion.check.fault);
  switch (motion.status) {
    case MotionStatus::kJoints:
      return "the number of joints";
    case MotionStatus::kDuration:
      return "the least duration";
    case MotionStatus::kLimits:
      return joint + "a limit";
    case MotionStatus::kStart:
      return joint + "start " + fault;
    case MotionStatus::kGoal:
      return joint + "goal " + fault;
    default:
      return joint + "on the way " + fault;
  }
}

}  // namespace

std::string describe(const StateToStateMotion& motion) {
  if (motion.status == MotionStatus::kFound) return "a motion was found";
  const std::string text = subject(motion) + " is " + number(motion.check.value);
  if (motion.status == MotionStatus::kLimits) return text + ", it must have its sign and jerk limits must be finite";
  if (motion.check.fault == StateFault::kNotFinite && motion.status != MotionStatus::kJoints)
    return text + ", it must be finite";
  return text + ", feasible is " + number(motion.check.feasible.lower) + " to " + number(motion.check.feasible.upper);
}

void slowDown(StateToStateMotion& motion, double factor) {
  motion.duration *= factor;
  for (std::size_t j = 0; j < static_cast<std::size_t>(motion.joints); ++j) {
    JerkPhases& phases = motion.phases[j];
    phases.start.velocity /= factor;
    phases.start.acceleration /= factor * factor;
    for (std::size_t k = 0; k < phases.count; ++k) {
      phases.phases[k].length *= factor;
      phases.phases[k].jerk /= factor * factor * factor;
    }
  }
}

void appendPieces(const StateToStateMotion& motion, PiecewisePolynomial& pieces, double end) {
  if (pieces.breaks.empty()) pieces = PiecewisePolynomial(motion.joints, 3, {0.0}, 2);
  const bool begins = pieces.segments() == 0;
  const std::size_t first = pieces.segments();
  const double offset = pieces.duration();
  appendBreaks(motion, offset, end > 0.0 ? end : offset + motion.duration, pieces.breaks);
  pieces.coefficients.resize(pieces.segments() * 4 * static_cast<std::size_t>(motion.joints));
  pieces.ends_at_rest = true;
  for (int j = 0; j < motion.joints; ++j) {
    const JerkPhases& phases = motion.phases[static_cast<std::size_t>(j)];
    layJoint(pieces, first, offset, j, phases);
    if (begins) pieces.starts_at_rest = pieces.starts_at_rest && rests(phases.start);
    pieces.ends_at_rest = pieces.ends_at_rest && motion.goal_rests[static_cast<std::size_t>(j)];
  }
}

JointTrajectory trajectoryOf(const StateToStateMotion& motion) {
  PiecewisePolynomial pieces;
  appendPieces(motion, pieces);
  return JointTrajectory::piecewise(std::move(pieces));
}

JointTrajectory timeOptimalBridge(const MotionState& from, const MotionState& to, const Limits& limits) {
  const int n = limits.joints();
  validateLimits(limits, n);
  const auto question = std::make_unique<StateToState>();
  const auto motion = std::make_unique<StateToStateMotion>();
  question->joints = n;
  for (const VectorX* values :
       {&from.position, &from.velocity, &from.acceleration, &to.position, &to.velocity, &to.acceleration}) {
    if (values->size() == n && n <= kMaxJoints) continue;
    throw InputError(AnswerCode::kInvalidGoal, "a state has " + std::to_string(values->size()) +
                                                   " values, the robot has " + std::to_string(n) + " joints");
  }
  for (int j = 0; j < n; ++j) {
    const std::size_t i = static_cast<std::size_t>(j);
    question->from[i] = {from.position[j], from.velocity[j], from.acceleration[j]};
    question->to[i] = {to.position[j], to.velocity[j], to.acceleration[j]};
    question->limits[i] = axisLimits(limits, j);
  }
  moveStateToState(*question, *motion);
  if (motion->status == MotionStatus::kFound) return trajectoryOf(*motion);
  const bool infeasible = motion->status == MotionStatus::kGoal || motion->status == MotionStatus::kPosition;
  throw InputError(infeasible ? AnswerCode::kLimitsInfeasible : AnswerCode::kInvalidGoal,
                   "no motion from the current state within the limits: " + describe(*motion));
}

AxisLimits axisLimits(const Limits& limits, int joint) {
  AxisLimits axis = AxisLimits::symmetric(limits.velocity[joint], limits.acceleration[joint], limits.jerk[joint]);
  if (limits.lower.size() > 0) axis.position = {limits.lower[joint], limits.upper[joint]};
  return axis;
}

}  // namespace screwline

#include "screwline/trajectory/stop.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "screwline/exception.h"
#include "screwline/trajectory/format.h"

namespace screwline {
namespace {

/// A stretch of constant jerk that starts with the given acceleration (which may step from the phase before).
struct Phase {
  double length = 0.0;
  double acceleration = 0.0;
  double jerk = 0.0;
};

using Phases = std::array<Phase, 3>;

/// Braking of a joint that would come to rest beyond v = 0 moving forward if its acceleration were taken back at once.
/// Acceleration runs a -> -peak -> 0 at full jerk; a plateau where the peak is the limit.
Phases brakeForward(double v, double a, double most, double jerk) {
  if (std::isinf(jerk)) return {Phase{}, Phase{v / most, -most, 0.0}, Phase{}};
  const double peak = std::min(std::sqrt(std::max(0.0, jerk * v + 0.5 * a * a)), most);
  const double towards = a > -peak ? -jerk : jerk;  // An acceleration below the limit comes back up to it.
  const double ramp = std::abs(a + peak) / jerk;
  const double at_peak = v + 0.5 * (a - peak) * ramp;  // Velocity when the plateau begins.
  const double plateau = peak > 0.0 ? std::max(0.0, (at_peak - 0.5 * peak * peak / jerk) / peak) : 0.0;
  return {Phase{ramp, a, towards}, Phase{plateau, -peak, 0.0}, Phase{peak / jerk, -peak, jerk}};
}

Phases brake(double v, double a, double most, double jerk) {
  // Where the velocity ends if the acceleration is taken back at once: its sign says which way the braking goes.
  const double carried = std::isinf(jerk) ? v : v + 0.5 * a * std::abs(a) / jerk;
  if (carried >= 0.0) return brakeForward(v, a, most, jerk);
  Phases phases = brakeForward(-v, -a, most, jerk);
  for (Phase& phase : phases) {
    phase.acceleration = -phase.acceleration;
    phase.jerk = -phase.jerk;
  }
  return phases;
}

void requireVector(const VectorX& values, const Limits& limits, const std::string& field) {
  if (values.size() != limits.joints()) {
    throw InputError(AnswerCode::kInvalidGoal, field + " has " + std::to_string(values.size()) +
                                                   " values, the robot has " + std::to_string(limits.joints()) +
                                                   " joints");
  }
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i]) && std::abs(values[i]) <= 1e6) continue;
    throw InputError(AnswerCode::kInvalidGoal, indexed(field, static_cast<std::size_t>(i)) + " is " +
                                                   number(values[i]) +
                                                   ", its magnitude must be finite and at most 1000000");
  }
}

void requireBrakes(const MotionState& state, const Limits& limits) {
  for (int j = 0; j < limits.joints(); ++j) {
    if (std::isfinite(limits.acceleration[j]) || std::isfinite(limits.jerk[j])) continue;
    if (state.velocity[j] == 0.0 && state.acceleration[j] == 0.0) continue;
    throw InputError(
        AnswerCode::kInvalidGoal,
        "joint " + std::to_string(j) + " moves and has neither an acceleration nor a jerk limit: no stop is defined");
  }
}

/// Instants at which any joint changes phase, ascending from 0.
std::vector<double> mergedBreaks(const std::vector<Phases>& joints) {
  std::vector<double> breaks{0.0};
  for (const Phases& phases : joints) {
    double t = 0.0;
    for (const Phase& phase : phases) breaks.push_back(t += phase.length);
  }
  std::sort(breaks.begin(), breaks.end());
  breaks.erase(std::unique(breaks.begin(), breaks.end()), breaks.end());
  if (breaks.size() == 1) breaks.push_back(0.0);
  return breaks;
}

/// Writes one joint's phases over the common breaks, carrying position and velocity from piece to piece.
void layPhases(PiecewisePolynomial& motion, int joint, const Phases& phases, double position, double velocity) {
  std::size_t phase = 0;
  double phase_start = 0.0;
  for (std::size_t k = 0; k < motion.segments(); ++k) {
    const double t = motion.breaks[k];
    while (phase < phases.size() && t >= phase_start + phases[phase].length) phase_start += phases[phase++].length;
    const bool at_rest = phase == phases.size();
    const double h = motion.length(k);
    const double a = at_rest ? 0.0 : phases[phase].acceleration + phases[phase].jerk * (t - phase_start);
    const double j = at_rest ? 0.0 : phases[phase].jerk;
    const double v = at_rest ? 0.0 : velocity;
    motion.setPiece(k, joint, {{position, v * h, 0.5 * a * h * h, j * h * h * h / 6.0}});
    position += h * (v + h * (0.5 * a + h * j / 6.0));
    velocity = v + h * (a + 0.5 * h * j);
  }
}

}  // namespace

JointTrajectory stopTrajectory(const MotionState& state, const Limits& limits) {
  validateLimits(limits, limits.joints());
  requireVector(state.position, limits, "position");
  requireVector(state.velocity, limits, "velocity");
  requireVector(state.acceleration, limits, "acceleration");
  requireBrakes(state, limits);

  std::vector<Phases> joints;
  bool smooth = true;
  for (int j = 0; j < limits.joints(); ++j) {
    const bool still = state.velocity[j] == 0.0 && state.acceleration[j] == 0.0;
    joints.push_back(still ? Phases{}
                           : brake(state.velocity[j], state.acceleration[j], limits.acceleration[j], limits.jerk[j]));
    smooth = smooth && std::isfinite(limits.jerk[j]);
  }
  PiecewisePolynomial motion(limits.joints(), 3, mergedBreaks(joints), smooth ? 2 : 1);
  motion.starts_at_rest = state.velocity.isZero(0.0) && state.acceleration.isZero(0.0);
  for (int j = 0; j < limits.joints(); ++j) {
    layPhases(motion, j, joints[static_cast<std::size_t>(j)], state.position[j], state.velocity[j]);
  }
  return JointTrajectory::piecewise(std::move(motion));
}

}  // namespace screwline

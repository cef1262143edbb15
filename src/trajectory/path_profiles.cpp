#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "hold_jerk.h"
#include "screwline/exception.h"
#include "screwline/trajectory/format.h"
#include "screwline/trajectory/path.h"
#include "screwline/trajectory/profile.h"
#include "screwline/trajectory/retime.h"
#include "screwline/trajectory/rounded_path.h"
#include "screwline/trajectory/segment_times.h"
#include "screwline/trajectory/tool_speed.h"

namespace screwline {
namespace {

constexpr double kMostGridPoints = 200000.0;
constexpr double kTangent = 1e-6;  ///< Of a velocity: by how much it may be off the path's tangent.

int gridPointsOf(const ProfileContext& context) {
  const double count = context.parameter("grid_points", 0.0);
  if (count == std::floor(count) && count >= 0.0 && count <= kMostGridPoints) return static_cast<int>(count);
  throw InputError(AnswerCode::kInvalidGoal, "parameter 'grid_points' is " + number(count) +
                                                 ", it must be a whole number from 0 (chosen) to 200000");
}

/// What `tool_speed` allows along a path; nothing where it is not given.
RateBound toolBound(const ProfileContext& context, const JointPath& path) {
  const auto speed = context.parameter("tool_speed");
  if (!speed) return {};
  if (!(*speed > 0.0)) {
    throw InputError(AnswerCode::kInvalidGoal,
                     "parameter 'tool_speed' is " + number(*speed) + " m/s, it must be above 0");
  }
  const InverseKinematics* kinematics = context.request.kinematics;
  if (kinematics == nullptr || kinematics->chain().size() != context.joints()) {
    throw InputError(AnswerCode::kInvalidGoal, "parameter 'tool_speed' needs the kinematics of a robot of " +
                                                   std::to_string(context.joints()) + " joints");
  }
  return toolSpeedBound(kinematics->chain(), path, *speed);
}

VectorX tangentAt(const JointPath& path, double u) {
  const Eigen::Index n = path.joints();
  VectorX q(n), first(n), second(n), third(n);
  path.at(u, q.data(), first.data(), second.data(), third.data());
  return first;
}

std::string listed(const VectorX& values) {
  std::string text;
  for (Eigen::Index i = 0; i < values.size(); ++i) text += (i > 0 ? ", " : "") + number(values[i]);
  return "[" + text + "]";
}

/// The velocities that waypoints give at the ends, as rates along the path.
class MovingEnds {
 public:
  MovingEnds(const ProfileContext& context, const JointPath& path, const RetimeOptions& options)
      : context_(context), path_(path), options_(options) {}

  /// @throws InputError(kInvalidGoal) for a velocity that is not along the path.
  RetimeOptions rates() const {
    RetimeOptions asked = options_;
    asked.start_rate = rateOf(true);
    asked.end_rate = rateOf(false);
    return asked;
  }

  [[noreturn]] void refuseTooFast(bool start, double rate, double feasible) const {
    throw InputError(AnswerCode::kLimitsInfeasible, field(start) + " is " + number(rate) +
                                                        " times the path's tangent " + listed(tangent(start)) +
                                                        ", feasible is 0 to " + number(feasible) + " times");
  }

 private:
  const VectorX& velocity(bool start) const {
    return start ? context_.waypoints().front().velocity : context_.waypoints().back().velocity;
  }
  VectorX tangent(bool start) const { return tangentAt(path_, start ? 0.0 : path_.length()); }
  std::string field(bool start) const {
    return indexed("waypoints", start ? 0 : context_.waypoints().size() - 1) + ".velocity";
  }

  double rateOf(bool start) const {
    const VectorX& asked = velocity(start);
    if (asked.size() == 0 || asked.cwiseAbs().maxCoeff() == 0.0) return 0.0;
    const VectorX along = tangent(start);
    const double rate = along.squaredNorm() > 0.0 ? asked.dot(along) / along.squaredNorm() : 0.0;
    if (rate > 0.0 && (asked - rate * along).norm() <= kTangent * asked.norm()) return rate;
    throw InputError(AnswerCode::kInvalidGoal, field(start) + " is " + listed(asked) +
                                                   ", not along the path: it must be the tangent " + listed(along) +
                                                   " times 0 to " + number(fastest(start)));
  }

  /// The greatest rate at one end, the other at rest.
  double fastest(bool start) const {
    RetimeOptions question = options_;
    const VectorX along = tangent(start);
    double rate = (context_.limits.velocity.array() / along.array().abs().max(1e-300)).minCoeff();
    rate = std::min(rate, 1e6);
    (start ? question.start_rate : question.end_rate) = rate;
    const RetimeResult result = retime(path_, context_.limits, question);
    return start ? result.start_rate : result.end_rate;
  }

  const ProfileContext& context_;
  const JointPath& path_;
  RetimeOptions options_;
};

/// The instant at which a law reaches a place, by halving.
double instantOf(const RetimeResult& result, double u, double length, double duration) {
  const auto& points = result.points;
  const auto after =
      std::lower_bound(points.begin(), points.end(), u, [](const RetimedPoint& p, double at) { return p.u < at; });
  const std::vector<double>& tau = result.law.pieces().breaks;
  const std::size_t k = static_cast<std::size_t>(after - points.begin());
  if (k == 0) return 0.0;
  if (k >= points.size()) return duration;
  double low = tau[k - 1];
  double high = tau[k];
  if (after->u == u) return high * duration;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (result.law.at(middle).s * length < u ? low : high) = middle;
  }
  return high * duration;
}

/// The way that the profile takes, and u of each waypoint.
struct Way {
  JointPath path;
  std::vector<double> waypoints;
  std::vector<Corner> corners;  ///< Empty: a spline, which has none.
};

/// The natural spline, or where a blend_radius is given lines with rounded corners.
Way wayOf(const ProfileContext& context) {
  const MatrixX positions = positionsOf(context.waypoints());
  if (context.parameter("blend_radius")) {
    RoundedLines lines = roundedLines(positions, context.blendRadius());
    return {std::move(lines.path), std::move(lines.waypoints), std::move(lines.corners)};
  }
  std::vector<double> knots;
  for (Eigen::Index k = 0; k < positions.cols(); ++k)
    knots.push_back(static_cast<double>(k) / static_cast<double>(positions.cols() - 1));
  return {naturalSplinePath(knots, positions), knots, {}};
}

/// Under jerk limits narrow corners take more cells than smooth splines do.
int cornerCells(const JointPath& path) {
  constexpr std::size_t kEach = 400;
  constexpr std::size_t kMost = 4000;
  return static_cast<int>(std::min(kMost, kEach * (path.breaks().size() - 1)));
}

/// The instant of each waypoint.
std::vector<double> waypointTimes(const Way& way, const RetimeResult& result, double duration) {
  std::vector<double> times;
  for (double u : way.waypoints) times.push_back(instantOf(result, u, way.path.length(), duration));
  times.back() = duration;
  return times;
}

/// Pieces that are short beside the whole have their instants rounded to more than the limits tolerate: then once more,
/// within limits of that order that are narrower by that.
/// @param motion what results, where the status is kDone.
RetimeResult retimeExactly(const JointPath& path, const Limits& limits, const RetimeOptions& options,
                           JointTrajectory& motion) {
  constexpr int kMostRounds = 4;
  Limits held = limits;
  if (!options.hold_jerk) held.jerk.setConstant(std::numeric_limits<double>::infinity());
  Limits narrowed = held;
  RetimeResult result = retime(path, narrowed, options);
  for (int round = 1; result.status == RetimeStatus::kDone; ++round) {
    motion = JointTrajectory::alongPath(path, result.law, result.duration);
    if (round == kMostRounds) break;
    const LimitUse use = tightestUse(motion, held);
    const double excess = use.stretch - 1.0;
    if (excess <= 0.1 * kLimitTolerance) break;
    VectorX* const orders[] = {&narrowed.velocity, &narrowed.acceleration, &narrowed.jerk};
    *orders[use.order - 1] *= 1.0 - 2.0 * use.order * excess;
    RetimeResult again = retime(path, narrowed, options);
    if (again.status != RetimeStatus::kDone) break;  // An end that is given at its limit.
    result = std::move(again);
  }
  return result;
}

[[noreturn]] void refuseShort(const ProfileContext& context, const JointTrajectory& motion, double shortest) {
  const LimitUse use = tightestUse(motion, context.limits);
  if (use.value > use.bound * (1.0 + kLimitTolerance)) refuseDuration(context, use, shortest);
  throw InputError(AnswerCode::kLimitsInfeasible,
                   "profile '" + context.request.profile + "' in " + number(context.duration) +
                       " s: the tool would pass its speed; the shortest feasible duration is " + number(shortest) +
                       " s");
}

}  // namespace

bool holdsJerk(const ProfileContext& context) {
  const double flag = context.parameter("hold_jerk", 0.0);
  if (flag == 0.0 || flag == 1.0) return flag == 1.0 && !context.limits.jerk.array().isInf().all();
  throw InputError(AnswerCode::kInvalidGoal, "parameter 'hold_jerk' is " + number(flag) + ", it must be 0 or 1");
}

ProfileDraft buildPathTimeOptimal(const ProfileContext& context) {
  if (nothingMoves(context.waypoints())) return holdStill(context);
  const Way way = wayOf(context);
  RetimeOptions options;
  options.grid_points = gridPointsOf(context);
  options.rate_bound = toolBound(context, way.path);
  options.hold_jerk = holdsJerk(context);
  if (options.hold_jerk && options.grid_points == 0 && !way.corners.empty())
    options.grid_points = cornerCells(way.path);
  const MovingEnds ends(context, way.path, options);
  options = ends.rates();
  const bool moves = options.start_rate > 0.0 || options.end_rate > 0.0;
  if (moves) options.duration = context.duration;
  JointTrajectory fastest;
  const RetimeResult result = retimeExactly(way.path, context.limits, options, fastest);
  if (result.status == RetimeStatus::kStartTooFast) ends.refuseTooFast(true, options.start_rate, result.start_rate);
  if (result.status == RetimeStatus::kEndTooFast) ends.refuseTooFast(false, options.end_rate, result.end_rate);
  const double shortest = noLessThanShortest(result.duration);
  const double duration = context.duration > 0.0 ? context.duration : shortest;
  JointTrajectory motion =
      duration == result.duration ? std::move(fastest) : JointTrajectory::alongPath(way.path, result.law, duration);
  ProfileDraft draft{std::move(motion), waypointTimes(way, result, duration), {}};
  if (duration < shortest * (1.0 - kLimitTolerance)) refuseShort(context, draft.trajectory, shortest);
  draft.meets_vias =
      std::all_of(way.corners.begin(), way.corners.end(), [](const Corner& c) { return c.reach == 0.0; });
  if (!way.corners.empty()) noteCorners(way.corners, context.blendRadius(), "", draft.notes);
  return draft;
}

}  // namespace screwline

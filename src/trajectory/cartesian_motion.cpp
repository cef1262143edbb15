#include "cartesian_motion.h"
#include "hold_jerk.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>

#include "screwline/exception.h"
#include "screwline/trajectory/format.h"
#include "screwline/trajectory/hermite.h"
#include "screwline/trajectory/retime.h"
#include "screwline/trajectory/tool_speed.h"

namespace screwline {
namespace {

constexpr double kStandstill = 1e-3;  ///< Of du per arc: a law on u would need joint rates a thousand times its own.

std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g %%", 100.0 * share);
  return text;
}

/// What each singularity costs: the rate of u there beside the greatest of the motion.
void noteSlowing(const ToolPath& path, const FollowedPath& followed, const RetimeResult& timed,
                 const std::vector<PassedSingularity>& singularities, std::vector<std::string>& notes) {
  constexpr double kAround = 0.1;  // Of arc: the wrist turns beside its singularity.
  double fastest = 0.0;
  const auto rateOf = [&](const RetimedPoint& point) {
    return point.rate * std::abs(followed.rateAt(point.u).tail<1>()[0]);
  };
  for (const RetimedPoint& point : timed.points) fastest = std::max(fastest, rateOf(point));
  for (const PassedSingularity& place : singularities) {
    double slowest = fastest;
    for (const RetimedPoint& point : timed.points) {
      const bool inside = point.u > followed.lead() && point.u < followed.length() - followed.tail();
      if (inside && std::abs(point.u - place.arc) < kAround) slowest = std::min(slowest, rateOf(point));
    }
    const bool stays = place.until_u > place.u;
    notes.push_back((place.met ? (stays ? "stays in singularity '" : "passes through singularity '")
                               : "passes beside singularity '") +
                    place.name + "' at " + placeOf(path, place.u) +
                    (stays ? " to " + placeOf(path, place.until_u) : "") + ": the tool slows down there to " +
                    percent(slowest / fastest) + " of its greatest rate");
  }
}

}  // namespace

FollowedPath::FollowedPath(PiecewisePolynomial curve, double lead, double tail, std::vector<Range> turns)
    : curve_(std::move(curve)), joints_(curve_.joints - 1), lead_(lead), tail_(tail), turns_(std::move(turns)) {}

VectorX FollowedPath::at(double arc) const {
  VectorX y(joints_ + 1);
  for (int i = 0; i <= joints_; ++i) y[i] = curve_.valueAt(arc, i);
  return y;
}

VectorX FollowedPath::rateAt(double arc) const {
  const std::size_t k = curve_.segmentAt(arc);
  const double x = std::clamp((arc - curve_.breaks[k]) / curve_.length(k), 0.0, 1.0);
  VectorX rate(joints_ + 1);
  for (int i = 0; i <= joints_; ++i) rate[i] = curve_.piece(k, i).derivative()(x) / curve_.length(k);
  return rate;
}

double FollowedPath::arcAt(double u) const {
  double low = 0.0;
  double high = length();
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (curve_.valueAt(middle, joints_) < u ? low : high) = middle;
  }
  return u <= 0.0 ? 0.0 : high;
}

JointPath FollowedPath::byArc() const {
  PiecewisePolynomial path(joints_, curve_.degree, curve_.breaks, curve_.continuity);
  for (std::size_t k = 0; k < curve_.segments(); ++k) {
    for (int i = 0; i < joints_; ++i) path.setPiece(k, i, curve_.piece(k, i));
  }
  return JointPath(std::move(path));
}

/// q and its derivatives by u, from those by arc length.
FollowedPath::Knot FollowedPath::knotAt(std::size_t piece, double x) const {
  const double r = 1.0 / curve_.length(piece);
  const Polynomial u = curve_.piece(piece, joints_);
  const double du = u.derivative()(x) * r;
  const double ddu = u.derivative().derivative()(x) * r * r;
  if (!(du > kStandstill)) {
    throw InputError(
        AnswerCode::kLimitsInfeasible,
        "time_law: at " + number(u(x)) + " of the path's parameter the joints move " + number(1.0 / du) +
            " times as fast as the tip, a singularity that no law on the tip's way can pass; leave time_law "
            "empty");
  }
  Knot knot{u(x), VectorX(joints_), VectorX(joints_), VectorX(joints_)};
  for (int i = 0; i < joints_; ++i) {
    const Polynomial q = curve_.piece(piece, i);
    const Polynomial rate = q.derivative();
    knot.q[i] = q(x);
    knot.first[i] = rate(x) * r / du;
    knot.second[i] = (rate.derivative()(x) * r * r - knot.first[i] * ddu) / (du * du);
  }
  return knot;
}

JointPath FollowedPath::byU(double tolerance) const {
  constexpr int kMostHalvings = 12;
  std::vector<Polynomial> rows;
  std::vector<double> breaks{0.0};
  const auto quintics = [&](const Knot& a, const Knot& b) {
    std::vector<Polynomial> pieces;
    for (int i = 0; i < joints_; ++i) {
      pieces.push_back(quinticBetween({a.q[i], a.first[i], a.second[i]}, {b.q[i], b.first[i], b.second[i]}, b.u - a.u));
    }
    return pieces;
  };
  const std::function<void(std::size_t, double, double, int)> add = [&](std::size_t k, double from, double to,
                                                                        int halvings) {
    const Knot a = knotAt(k, from);
    const Knot b = knotAt(k, to);
    const Knot middle = knotAt(k, 0.5 * (from + to));
    const std::vector<Polynomial> pieces = quintics(a, b);
    double off = 0.0;
    for (int i = 0; i < joints_; ++i) {
      const double x = (middle.u - a.u) / (b.u - a.u);
      off = std::max(off, std::abs(pieces[static_cast<std::size_t>(i)](x) - middle.q[i]));
    }
    if (off > tolerance && halvings < kMostHalvings) {
      add(k, from, 0.5 * (from + to), halvings + 1);
      add(k, 0.5 * (from + to), to, halvings + 1);
      return;
    }
    rows.insert(rows.end(), pieces.begin(), pieces.end());
    breaks.push_back(b.u);
  };
  for (std::size_t k = 0; k < curve_.segments(); ++k) add(k, 0.0, 1.0, 0);
  PiecewisePolynomial path(joints_, 5, breaks, curve_.continuity);
  for (std::size_t k = 0; k < path.segments(); ++k) {
    for (int i = 0; i < joints_; ++i) {
      path.setPiece(k, i, rows[k * static_cast<std::size_t>(joints_) + static_cast<std::size_t>(i)]);
    }
  }
  return JointPath(std::move(path));
}

double tauAt(const TimeLaw& law, double s) {
  if (s <= 0.0) return 0.0;
  double low = 0.0;
  double high = 1.0;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (law.at(middle).s < s ? low : high) = middle;
  }
  return high;
}

TimedPath timeOptimally(const ProfileContext& context, const ToolPath& path, const FollowedPath& followed,
                        const std::vector<PassedSingularity>& singularities) {
  Limits limits = context.limits;
  RetimeOptions options;
  options.hold_jerk = holdsJerk(context);
  if (!options.hold_jerk) limits.jerk.setConstant(std::numeric_limits<double>::infinity());
  const JointPath joints = followed.byArc();
  const SerialChain& chain = context.request.kinematics->chain();
  if (const auto speed = context.parameter("tool_speed")) options.rate_bound = toolSpeedBound(chain, joints, *speed);
  const RetimeResult timed = retime(joints, limits, options);
  double shortest = timed.duration;
  TimedPath result;
  result.trajectory = JointTrajectory::alongPath(joints, timed.law, shortest);
  const LimitUse use = tightestUse(result.trajectory, limits);
  if (use.stretch > 1.0) shortest *= use.stretch;
  if (context.duration > 0.0 && context.duration < shortest * (1.0 - kLimitTolerance)) {
    throw InputError(AnswerCode::kLimitsInfeasible,
                     "profile '" + context.request.profile + "' in " + number(context.duration) +
                         " s: the shortest motion along the path takes " + number(shortest) + " s");
  }
  const double duration = context.duration > 0.0 ? std::max(context.duration, shortest) : shortest;
  if (duration != timed.duration) result.trajectory = JointTrajectory::alongPath(joints, timed.law, duration);
  for (const double u : path.waypoints()) {
    result.waypoint_times.push_back(duration * tauAt(timed.law, followed.arcAt(u) / followed.length()));
  }
  result.waypoint_times.back() = duration;
  const auto secondsAt = [&](double arc) { return duration * tauAt(timed.law, arc / followed.length()); };
  if (followed.lead() > 0.0) {
    result.notes.push_back("waypoints[0] is singular: the joints turn in place there first, for " +
                           number(secondsAt(followed.lead())) + " s, as the tip could not leave along the path else");
  }
  for (const Range& turn : followed.turns()) {
    result.notes.push_back("at " + placeOf(path, followed.at(turn.lower).tail<1>()[0]) +
                           " the path stops in a singularity and does not go on from the joint values that it arrives "
                           "in: the joints turn in place there, for " +
                           number(secondsAt(turn.upper) - secondsAt(turn.lower)) + " s");
  }
  if (followed.tail() > 0.0) {
    result.notes.push_back("the goal is singular: the joints turn in place there last, for " +
                           number(duration - secondsAt(followed.length() - followed.tail())) +
                           " s, to the values asked for");
  }
  noteSlowing(path, followed, timed, singularities, result.notes);
  return result;
}

}  // namespace screwline

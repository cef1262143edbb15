#ifndef SCREWLINE_SRC_TRAJECTORY_CARTESIAN_MOTION_H
#define SCREWLINE_SRC_TRAJECTORY_CARTESIAN_MOTION_H

#include <string>
#include <vector>

#include "screwline/trajectory/branch_following.h"
#include "screwline/trajectory/path.h"
#include "screwline/trajectory/profile.h"

namespace screwline {

/// A followed curve as a path of the joints, by its arc length or by u, with the way between the two.
class FollowedPath {
 public:
  /// @param lead, tail arc lengths in which the joints turn in place, at either end.
  /// @param turns the same between, where the path stops.
  explicit FollowedPath(PiecewisePolynomial curve, double lead = 0.0, double tail = 0.0, std::vector<Range> turns = {});

  JointPath byArc() const;
  /// By u, through points so dense that it is off by at most the tolerance [rad, m].
  /// @throws InputError(kLimitsInfeasible) where u stands still: a singularity that a law on u cannot leave.
  JointPath byU(double tolerance) const;

  double length() const { return curve_.duration(); }
  double lead() const { return lead_; }
  double tail() const { return tail_; }
  const std::vector<Range>& turns() const { return turns_; }
  VectorX at(double arc) const;      ///< (q, u)
  VectorX rateAt(double arc) const;  ///< Its derivative.
  double arcAt(double u) const;      ///< Of monotone u, by bisection.
  const PiecewisePolynomial& curve() const { return curve_; }

 private:
  struct Knot {
    double u;
    VectorX q;
    VectorX first;
    VectorX second;
  };
  Knot knotAt(std::size_t piece, double x) const;

  PiecewisePolynomial curve_;
  int joints_;
  double lead_;
  double tail_;
  std::vector<Range> turns_;
};

/// The motion along a followed path and the instant of every waypoint.
struct TimedPath {
  JointTrajectory trajectory;
  std::vector<double> waypoint_times;
  std::vector<std::string> notes;
};

/// Where a law first reaches s, by bisection: 0 for s = 0.
double tauAt(const TimeLaw& law, double s);

/// The fastest motion within velocity and acceleration limits (and tool_speed), or longer if the request has a
/// duration. Notes say where singularities slow it down.
TimedPath timeOptimally(const ProfileContext& context, const ToolPath& path, const FollowedPath& followed,
                        const std::vector<PassedSingularity>& singularities);

/// The way u by the named law, in the shortest time that keeps all orders that the law has.
TimedPath timeByLaw(const ProfileContext& context, const ToolPath& path, const FollowedPath& followed);

}  // namespace screwline

#endif  // SCREWLINE_SRC_TRAJECTORY_CARTESIAN_MOTION_H

#ifndef SCREWLINE_TRAJECTORY_SEGMENT_TIMES_H
#define SCREWLINE_TRAJECTORY_SEGMENT_TIMES_H

#include <functional>
#include <vector>

#include "screwline/trajectory/profile.h"

namespace screwline {

/// A motion for given instants of the waypoints.
using TimedBuilder = std::function<JointTrajectory(const std::vector<double>& times)>;

/// The same as pieces, through the columns of positions.
using ShapeBuilder = std::function<PiecewisePolynomial(const MatrixX& positions, const std::vector<double>& times)>;

/// The waypoints' positions as columns, n x N.
MatrixX positionsOf(const std::vector<PathPoint>& waypoints);

/// True where no waypoint differs from the first.
bool nothingMoves(const std::vector<PathPoint>& waypoints);

/// How long each segment takes beside the others: its own shortest rest-to-rest 3-4-5 motion under the limits (its
/// length where nothing is limited). A repeated waypoint counts as the shortest segment above a thousandth of the
/// longest, so that no segment has no time.
std::vector<double> segmentWeights(const std::vector<PathPoint>& waypoints, const Limits& limits);

/// The least duration found at which `stretch` (tightestUse) is at most 1; 0 where none is. Not monotone in general
/// (given end velocities), so: a scan upwards in steps of 5 %, then bisection to 1e-12.
double searchShortest(const std::function<double(double)>& stretch, double guess);

/// Chooses the instants that the request leaves open, in proportion to the weights, and builds the motion.
/// Free times altogether: scaled uniformly to the exact point where the tightest limit is met if `homogeneous` (no
/// derivative of the motion is fixed by the request), else searched; a free tail after given instants is searched;
/// nothing free: checked.
/// @throws InputError(kLimitsInfeasible) naming the shortest feasible duration.
ProfileDraft fitTimes(const ProfileContext& context, const TimedBuilder& build, const std::vector<double>& weights,
                      bool homogeneous);

/// The same, with the open times searched: for the shortest motion, or where the duration is given for the one that
/// uses the least of the limits. Never longer (or tighter) than with the weights of segmentWeights(), and a note says
/// by how much it is better. Given instants are kept exactly.
ProfileDraft fitShape(const ProfileContext& context, const ShapeBuilder& build, bool homogeneous);

/// Rest at the first waypoint for the given duration or none: what a request without any displacement gets.
ProfileDraft holdStill(const ProfileContext& context);

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_SEGMENT_TIMES_H

#include <algorithm>
#include <cmath>

#include "screwline/exception.h"
#include "screwline/spatial/rotation.h"
#include "screwline/spatial/screw.h"
#include "screwline/trajectory/format.h"
#include "screwline/trajectory/tool_path.h"

namespace screwline {
namespace {

constexpr double kSamePose = 1e-12;  ///< Of u: what differs by less is one pose.

[[noreturn]] void refuse(const std::string& message) {
  throw InputError(AnswerCode::kInvalidGoal, message);
}

Polynomial linear(double c0, double c1) {
  Polynomial p;
  p.c[0] = c0;
  p.c[1] = c1;
  return p;
}

double measure(const Vector3& way, double turn, const ToolPathOptions& options) {
  return std::hypot(way.norm() / options.length_scale, options.rotates ? turn : 0.0);
}

/// From pose to pose, derivatives by u.
struct Leg {
  Pose from;
  Pose to;
  double start = 0.0;
  double length = 0.0;
  Vector6 rate = Vector6::Zero();  ///< [dp/du in the base frame; rotation per u in the body's], or the body's screw.
  double speed = 0.0;              ///< [m] per u.
  std::size_t goal = 0;            ///< Which pose it leads to: of repeated ones the first.
};

Leg legBetween(const Pose& from, const Pose& to, double start, const ToolPathOptions& options) {
  Leg leg{from, to, start};
  const Vector3 way = to.p - from.p;
  const Vector3 turn = options.rotates ? rotationVector(from.R.transpose() * to.R) : Vector3(Vector3::Zero());
  leg.length = measure(way, turn.norm(), options);
  if (leg.length <= kSamePose) return leg;
  leg.speed = way.norm() / leg.length;
  if (options.screw) {
    Pose target = to;
    if (!options.rotates) target.R = from.R;
    leg.rate = poseLogarithm(from.inverse() * target) / leg.length;
  } else {
    leg.rate << way / leg.length, turn / leg.length;
  }
  return leg;
}

/// [dp/du; w] in the base frame where the leg ends or begins.
Vector6 directionAt(const Leg& leg, bool end, bool screw) {
  const Pose& X = end ? leg.to : leg.from;
  Vector6 direction;
  direction << (screw ? Vector3(X.R * leg.rate.head<3>()) : Vector3(leg.rate.head<3>())), X.R * leg.rate.tail<3>();
  return direction;
}

ToolPathPiece straight(const Leg& leg, double from, double to, const ToolPathOptions& options) {
  ToolPathPiece piece;
  piece.kind = options.screw ? ToolPathPiece::Kind::kScrew : ToolPathPiece::Kind::kStraight;
  piece.start = leg.start + from;
  piece.length = to - from;
  piece.anchor = leg.from;
  piece.after = leg.rate;
  piece.h = linear(from, to - from);
  return piece;
}

/// Leaves the first leg `reach` (of u) before its end and is on the second as far behind its start: the first fades as
/// the second grows.
ToolPathPiece blend(const Leg& first, const Leg& second, double reach, const ToolPathOptions& options) {
  ToolPathPiece piece;
  piece.kind = options.screw ? ToolPathPiece::Kind::kScrew : ToolPathPiece::Kind::kStraight;
  piece.start = second.start - reach;
  piece.length = 2.0 * reach;
  piece.anchor = second.from;
  piece.before = first.rate;
  piece.after = second.rate;
  piece.h = cornerRise(reach);
  // -h(1 - x), expanded.
  piece.g.c = {-reach, 2.0 * reach, 0.0, -2.0 * reach, reach};
  return piece;
}

Bend bendAt(const Leg& first, const Leg& second, const ToolPathOptions& options) {
  return bendBetween(directionAt(first, true, options.screw), directionAt(second, false, options.screw));
}

/// The legs between poses that differ, and u of each pose.
std::vector<Leg> legsThrough(const std::vector<Pose>& poses, const ToolPathOptions& options,
                             std::vector<double>& waypoints) {
  std::vector<Leg> legs;
  waypoints = {0.0};
  for (std::size_t k = 1; k < poses.size(); ++k) {
    const Pose& last = legs.empty() ? poses.front() : legs.back().to;
    Leg leg = legBetween(last, poses[k], waypoints.back(), options);
    leg.goal = k;
    if (leg.length > kSamePose) legs.push_back(leg);
    waypoints.push_back(leg.length > kSamePose ? leg.start + leg.length : leg.start);
  }
  return legs;
}

/// [u] Of each corner between the legs, and of the ends. A corner in which the tip only turns before or behind has
/// none.
std::vector<double> reachesOf(const std::vector<Leg>& legs, const ToolPathOptions& options) {
  std::vector<double> lengths;
  std::vector<double> most(legs.size() + 1, 0.0);
  for (std::size_t k = 0; k < legs.size(); ++k) {
    lengths.push_back(legs[k].length);
    if (k == 0 || bendAt(legs[k - 1], legs[k], options) != Bend::kCorner) continue;
    if (legs[k - 1].speed > 0.0 && legs[k].speed > 0.0)
      most[k] = options.blend_radius / std::max(legs[k - 1].speed, legs[k].speed);
  }
  return fairReaches(lengths, std::move(most));
}

/// [m] The farthest that a blend is from both lines: where it is as far from one as from the other.
double farthestFromLines(const Leg& first, const Leg& second, double reach) {
  const double sine = first.rate.head<3>().normalized().cross(second.rate.head<3>().normalized()).norm();
  const Polynomial rise = cornerRise(reach);
  double low = 0.0, high = 1.0;
  for (int halving = 0; halving < 53; ++halving) {
    const double x = 0.5 * (low + high);
    (rise(x) * second.speed < rise(1.0 - x) * first.speed ? low : high) = x;
  }
  return rise(low) * second.speed * sine;
}

/// The corner that a blend of the two lines passes.
Corner cornerPassedBy(const ToolPathPiece& piece, const Leg& first, const Leg& second, double reach,
                      const ToolPathOptions& options) {
  ToolPathPoint middle;
  piece.at(second.start, middle);
  Corner corner;
  corner.reach = reach * std::max(first.speed, second.speed);
  corner.deviation = (middle.pose.p - second.from.p).norm();
  if (!options.screw) corner.off_lines = farthestFromLines(first, second, reach);
  corner.shortened = corner.reach < options.blend_radius * (1.0 - 1e-9);
  return corner;
}

/// Centre, normal and angle of the circle through three points.
void circleThrough(const Vector3& start, const Vector3& via, const Vector3& goal, ToolPathPiece& piece) {
  const Vector3 a = via - start;
  const Vector3 b = goal - start;
  const Vector3 cross = a.cross(b);
  const double largest = std::max({a.norm(), b.norm(), (goal - via).norm()});
  if (largest == 0.0 || cross.norm() <= 1e-9 * largest * largest) {
    refuse("waypoints: start, via and goal lie on one line or coincide (twice the area of their triangle is " +
           number(cross.norm()) + " m^2): they define no circle");
  }
  piece.normal = cross.normalized();
  piece.centre =
      start + (b.squaredNorm() * cross.cross(a) + a.squaredNorm() * b.cross(cross)) / (2.0 * cross.squaredNorm());
  const Vector3 from = start - piece.centre;
  const Vector3 to = goal - piece.centre;
  const double angle = std::atan2(piece.normal.dot(from.cross(to)), from.dot(to));
  piece.angle = angle > 0.0 ? angle : angle + kTwoPi;
}

void circleAround(const Vector3& start, const Vector3& centre, const Vector3& goal, bool long_way,
                  ToolPathPiece& piece) {
  const Vector3 from = start - centre;
  const Vector3 to = goal - centre;
  const double radius = from.norm();
  if (radius == 0.0 || std::abs(to.norm() - radius) > 1e-6 * radius) {
    refuse("waypoints[1] is the centre: the start is " + number(radius) + " m, the goal " + number(to.norm()) +
           " m away from it; they must be equally far");
  }
  const Vector3 cross = from.cross(to);
  if (cross.norm() <= 1e-9 * radius * radius) {
    refuse("waypoints: start, centre and goal lie on one line: they define no plane for the arc");
  }
  const double angle = std::atan2(cross.norm(), from.dot(to));
  piece.normal = cross.normalized() * (long_way ? -1.0 : 1.0);
  piece.centre = centre;
  piece.angle = long_way ? kTwoPi - angle : angle;
}

/// Where on the arc, 0 to 1, the via lies.
double fractionOf(const ToolPathPiece& piece, const Vector3& via) {
  const Vector3 from = piece.anchor.p - piece.centre;
  const Vector3 to = via - piece.centre;
  const double angle = std::atan2(piece.normal.dot(from.cross(to)), from.dot(to));
  return (angle > 0.0 ? angle : angle + kTwoPi) / piece.angle;
}

}  // namespace

ToolLines linesThrough(const std::vector<Pose>& poses, const ToolPathOptions& options) {
  if (!(options.blend_radius >= 0.0))
    refuse("parameter 'blend_radius' is " + number(options.blend_radius) + ", it must not be negative");
  std::vector<double> waypoints;
  const std::vector<Leg> legs = legsThrough(poses, options, waypoints);
  const std::vector<double> reaches = reachesOf(legs, options);
  std::vector<ToolPathPiece> pieces;
  std::vector<double> stops;
  std::vector<Corner> corners(poses.size());
  for (std::size_t k = 0; k < legs.size(); ++k) {
    const double reach = reaches[k + 1];
    if (legs[k].length - reach - reaches[k] > kSamePose)
      pieces.push_back(straight(legs[k], reaches[k], legs[k].length - reach, options));
    if (k + 1 == legs.size()) break;
    Corner& corner = corners[legs[k].goal];
    if (reach > 0.0) {
      pieces.push_back(blend(legs[k], legs[k + 1], reach, options));
      corner = cornerPassedBy(pieces.back(), legs[k], legs[k + 1], reach, options);
    } else if (bendAt(legs[k], legs[k + 1], options) != Bend::kNone) {
      corner.stops = true;
      stops.push_back(legs[k + 1].start);
    }
  }
  return {ToolPath(std::move(pieces), std::move(stops), std::move(waypoints)), std::move(corners)};
}

ToolPath arcThrough(const std::vector<Pose>& poses, const ArcOptions& arc, const ToolPathOptions& options) {
  ToolPathPiece piece;
  piece.kind = ToolPathPiece::Kind::kArc;
  piece.anchor = poses[0];
  if (arc.centre) {
    circleAround(poses[0].p, poses[1].p, poses[2].p, arc.long_way, piece);
  } else {
    circleThrough(poses[0].p, poses[1].p, poses[2].p, piece);
  }
  const double via = arc.centre ? 0.5 : fractionOf(piece, poses[1].p);
  if (options.rotates) {
    const Vector3 turn = rotationVector(poses[0].R.transpose() * poses[2].R);
    piece.before.tail<3>() = turn;
    piece.g_turn = linear(0.0, 1.0);
    if (!arc.centre && arc.via_orientation) {
      const double angle = turn.norm();
      const Matrix3 slerp =
          poses[0].R * (angle > 0.0 ? rotationAbout(turn / angle, via * angle) : Matrix3(Matrix3::Identity()));
      piece.after.tail<3>() = rotationVector(slerp.transpose() * poses[1].R);
      piece.h_turn.c = {0.0, 1.0 / (via * (1.0 - via)), -1.0 / (via * (1.0 - via))};
    }
  }
  const double way = piece.angle * (poses[0].p - piece.centre).norm();
  const double turn = piece.before.tail<3>().norm() + piece.after.tail<3>().norm();
  piece.length = std::hypot(way / options.length_scale, turn);
  return ToolPath({piece}, {}, {0.0, via * piece.length, piece.length});
}

}  // namespace screwline

#include "screwline/trajectory/tool_path.h"

#include <algorithm>
#include <cmath>

#include "screwline/spatial/rotation.h"
#include "screwline/spatial/screw.h"

namespace screwline {
namespace {

/// A polynomial's value and derivatives by u.
struct Argument {
  double value;
  double first;
  double second;
};

Argument evaluate(const Polynomial& polynomial, double x, double length) {
  const Polynomial first = polynomial.derivative();
  return {polynomial(x), first(x) / length, first.derivative()(x) / (length * length)};
}

Matrix3 rotationOf(const Vector3& vector, double factor) {
  const double norm = vector.norm();
  return norm > 0.0 ? rotationAbout(vector / norm, norm * factor) : Matrix3(Matrix3::Identity());
}

Pose exponential(const Vector6& screw, double factor) {
  const double turn = screw.tail<3>().norm();
  const double size = turn > 1e-12 ? turn : screw.head<3>().norm();
  if (size == 0.0) return {};
  // A turn too small to tell from none is left out.
  Vector6 unit = screw / size;
  if (turn <= 1e-12) unit.tail<3>().setZero();
  return screwExponential(unit, size * factor);
}

/// R = anchor exp([a] g) exp([b] h).
void turn(const Matrix3& anchor, const Vector3& a, const Vector3& b, const Argument& g, const Argument& h,
          ToolPathPoint& point) {
  const Matrix3 first = rotationOf(a, g.value);
  const Vector3 second_axis = first * b;
  const Vector3 second_rate = h.first * second_axis;
  point.pose.R = anchor * first * rotationOf(b, h.value);
  point.rate.tail<3>() = anchor * (g.first * a + second_rate);
  point.change.tail<3>() = anchor * (g.second * a + h.second * second_axis + g.first * a.cross(second_rate));
}

void screw(const ToolPathPiece& piece, const Argument& g, const Argument& h, ToolPathPoint& point) {
  const Pose first = exponential(piece.before, g.value);
  const Pose local = first * exponential(piece.after, h.value);
  const Vector6 carried = adjoint(first) * piece.after;
  const Vector6 a = g.first * piece.before;
  const Vector6 b = h.first * carried;
  Vector6 bracket;  // Of the two twists: how the second's axis is carried along by the first.
  bracket << a.tail<3>().cross(b.head<3>()) + a.head<3>().cross(b.tail<3>()), a.tail<3>().cross(b.tail<3>());
  const Vector6 twist = a + b;
  const Vector6 twist_rate = g.second * piece.before + h.second * carried + bracket;
  const Vector3 velocity = twist.head<3>() + twist.tail<3>().cross(local.p);
  const Vector3 acceleration =
      twist_rate.head<3>() + twist_rate.tail<3>().cross(local.p) + twist.tail<3>().cross(velocity);
  const Matrix3& R = piece.anchor.R;
  point.pose = piece.anchor * local;
  point.rate << R * velocity, R * twist.tail<3>();
  point.change << R * acceleration, R * twist_rate.tail<3>();
}

}  // namespace

void ToolPathPiece::at(double u, ToolPathPoint& point) const {
  const double x = (u - start) / length;
  const Argument along = evaluate(g, x, length);
  const Argument across = evaluate(h, x, length);
  if (kind == Kind::kScrew) {
    screw(*this, along, across, point);
    return;
  }
  if (kind == Kind::kArc) {
    const double rate = angle / length;
    const Vector3 spoke = rotationAbout(normal, angle * x) * (anchor.p - centre);
    point.pose.p = centre + spoke;
    point.rate.head<3>() = rate * normal.cross(spoke);
    point.change.head<3>() = -rate * rate * spoke;
    turn(anchor.R, before.tail<3>(), after.tail<3>(), evaluate(g_turn, x, length), evaluate(h_turn, x, length), point);
    return;
  }
  point.pose.p = anchor.p + along.value * before.head<3>() + across.value * after.head<3>();
  point.rate.head<3>() = along.first * before.head<3>() + across.first * after.head<3>();
  point.change.head<3>() = along.second * before.head<3>() + across.second * after.head<3>();
  turn(anchor.R, before.tail<3>(), after.tail<3>(), along, across, point);
}

ToolPath::ToolPath(std::vector<ToolPathPiece> pieces, std::vector<double> stops, std::vector<double> waypoints)
    : pieces_(std::move(pieces)), waypoints_(std::move(waypoints)) {
  length_ = pieces_.empty() ? 0.0 : pieces_.back().start + pieces_.back().length;
  for (double stop : stops) {
    if (stop > 0.0 && stop < length_) part_ends_.push_back(stop);
  }
  part_ends_.push_back(length_);
  std::size_t piece = 0;
  for (std::size_t part = 0; part < part_ends_.size(); ++part) {
    while (piece < pieces_.size() && pieces_[piece].start < partStart(part)) ++piece;
    first_piece_.push_back(piece);
  }
  first_piece_.push_back(pieces_.size());
}

void ToolPath::at(std::size_t part, double u, ToolPathPoint& point) const {
  std::size_t piece = first_piece_[part];
  while (piece + 1 < first_piece_[part + 1] && u >= pieces_[piece + 1].start) ++piece;
  pieces_[piece].at(u, point);
}

Pose ToolPath::pose(double u) const {
  std::size_t part = 0;
  while (part + 1 < parts() && u >= partEnd(part)) ++part;
  ToolPathPoint point;
  at(part, u, point);
  return point.pose;
}

double ToolPath::metres(double u) const {
  constexpr int kSteps = 32;
  double total = 0.0;
  ToolPathPoint point;
  for (const ToolPathPiece& piece : pieces_) {
    const double span = std::clamp(u - piece.start, 0.0, piece.length);
    if (span == 0.0) break;
    for (int i = 0; i <= kSteps; ++i) {  // Simpson's rule.
      piece.at(piece.start + span * i / kSteps, point);
      const double weight = i == 0 || i == kSteps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
      total += weight * span / (3.0 * kSteps) * point.rate.head<3>().norm();
    }
  }
  return total;
}

}  // namespace screwline

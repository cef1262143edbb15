#include "screwline/ik/closed_form/orientation_problem.h"

#include <algorithm>
#include <cmath>

#include "screwline/ik/closed_form/roots.h"
#include "screwline/model/structure.h"
#include "screwline/spatial/rotation.h"

namespace screwline {
namespace {

/// What an arm near its own singularities may make of kInLine.
constexpr double kMostInLine = 1e-11;

/// Cosine below which neighbours count as at right angles: what rounding leaves of it.
constexpr double kAcross = 1e-15;

/// Where both factors are small together (axes coming into line) their product is exact and is kept; where one passes
/// zero alone, two solutions meet there.
double rootOfProduct(double a, double b) {
  return squareRootOrNone(a * b, std::abs(a) + std::abs(b));
}

double angleBetween(const Vector3& a, const Vector3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Half of an angle in [0, pi].
Turn halfOf(double cosine, double sine) {
  const double length = std::sqrt(cosine * cosine + sine * sine);
  return cosine >= 0.0 ? normalized({length + cosine, sine}) : normalized({sine, length - cosine});
}

/// The same angle half a turn on, in [-pi, pi].
double oppositeOf(double angle) {
  return angle > 0.0 ? angle - kPi : angle + kPi;
}

}  // namespace

std::optional<OrientationProblem> OrientationProblem::compile(const std::array<Axis, 3>& axes) {
  for (const Axis& axis : axes) {
    if (axis.prismatic) return std::nullopt;
  }
  const Vector3& h1 = axes[0].direction;
  const Vector3& h2 = axes[1].direction;
  const Vector3& h3 = axes[2].direction;
  const double first = angleBetween(h1, h2);
  const double second = angleBetween(h2, h3);
  if (std::sin(first) <= kStructureAngleTolerance || std::sin(second) <= kStructureAngleTolerance) return std::nullopt;
  OrientationProblem problem;
  problem.across_ = std::abs(h1.dot(h2)) <= kAcross && std::abs(h2.dot(h3)) <= kAcross;
  problem.first_ = problem.across_ ? Turn{0.0, 1.0} : turnBy(first);
  problem.second_ = problem.across_ ? Turn{0.0, 1.0} : turnBy(second);
  problem.half_sum_ = turnBy(0.5 * (first + second));
  problem.half_difference_ = turnBy(0.5 * (first - second));
  // Both frames have axis 2 in their xz plane, at `first` and `second` from z, when axis 3 is nearest to axis 1.
  const Vector3 x1 = (h2 - h1 * h1.dot(h2)).normalized();
  problem.near_ << x1, h1.cross(x1), h1;
  const Vector3 x3 = (h2 - h3 * h3.dot(h2)).normalized();
  problem.far_ << x3, h3.cross(x3), h3;
  // h1 . R2(q) h3 = constant + amplitude cos(q - nearest)
  const Vector3 across = h3 - h2 * h2.dot(h3);
  problem.nearest_ = normalized({h1.dot(across), h1.dot(h2.cross(across))});
  return problem;
}

/// From cos(between) = cos(first) cos(second) + sin(first) sin(second) cos(u). Half-angle products keep the digits of a
/// small or almost straight middle angle, which the cosine loses.
OrientationProblem::Middle OrientationProblem::middleOf(double cosine, double sine) const {
  Middle middle;
  const Turn half = halfOf(cosine, sine);
  const double half_sine =
      rootOfProduct((half * half_difference_).s, half.s * half_difference_.c - half.c * half_difference_.s);
  const double half_cosine = rootOfProduct((half_sum_ * half).s, (half_sum_ * half.inverse()).s);
  middle.reached = half_sine >= 0.0 && half_cosine >= 0.0;
  middle.is_double = half_sine == 0.0 || half_cosine == 0.0;
  const Turn half_middle = normalized({half_cosine, half_sine});
  middle.turn = half_middle * half_middle;
  return middle;
}

OrientationTurns OrientationProblem::turnsInFrames(const Matrix3& M, double error, double preferred,
                                                   TurnBatch& batch) const {
  OrientationTurns turns;
  const double in_line = kInLine + std::min(error, kMostInLine);
  turns.place = batch.count();
  const double sine = std::sqrt(M(0, 2) * M(0, 2) + M(1, 2) * M(1, 2));
  if (across_ && sine > in_line) {
    addAcross(M, sine, batch);
    turns.count = 2;
    turns.half_turned = true;
    return turns;
  }
  const Middle middle = middleOf(M(2, 2), sine);
  if (!middle.reached) return turns;
  turns.free = sine <= in_line;
  turns.is_double = turns.free || middle.is_double;
  turns.count = turns.is_double ? 1 : 2;
  for (int i = 0; i < turns.count; ++i) {
    const Turn u = i == 0 ? middle.turn : middle.turn.inverse();
    // Axis 3, and y of the frame on it, before axis 1 turns.
    const double image_x = first_.s * second_.c - first_.c * second_.s * u.c;
    const double image_y = -second_.s * u.s;
    const Turn first = turns.free ? turnBy(preferred) : turnBetween(image_x, image_y, M(0, 2), M(1, 2));
    const Turn y = first * Turn{-first_.c * u.s, u.c};
    const double y_z = first_.s * u.s;
    batch.add(first);
    batch.add(u * nearest_);
    batch.add({y.c * M(0, 1) + y.s * M(1, 1) + y_z * M(2, 1), y.c * M(0, 0) + y.s * M(1, 0) + y_z * M(2, 0)});
  }
  return turns;
}

/// Neighbours at right angles, not in line: Euler angles z, y', z'', the second solution half a turn on in the first
/// and the third.
void OrientationProblem::addAcross(const Matrix3& M, double sine, TurnBatch& batch) const {
  const double scale = 1.0 / sine;
  const Turn first = {-scale * M(1, 2), scale * M(0, 2)};
  const Turn middle = {M(2, 2), sine};
  // y of the frame on axis 3, before axis 1 turns: (0, cos u, sin u).
  const Turn y = first * Turn{0.0, middle.c};
  batch.add(first);
  batch.add(middle * nearest_);
  batch.add({y.c * M(0, 1) + y.s * M(1, 1) + middle.s * M(2, 1), y.c * M(0, 0) + y.s * M(1, 0) + middle.s * M(2, 0)});
  batch.add(middle.inverse() * nearest_);
}

void OrientationProblem::takeFrom(const TurnBatch& batch, const OrientationTurns& turns, double preferred,
                                  OrientationSolutions& solutions) {
  const std::size_t k = turns.place;
  solutions.count = turns.count;
  OrientationSolution& first = solutions.solutions[0];
  OrientationSolution& second = solutions.solutions[1];
  if (turns.count > 0) first = {{turns.free ? preferred : batch[k], batch[k + 1], batch[k + 2]}, turns.free, 1};
  if (turns.is_double) first.sign = 0;
  if (turns.half_turned) {
    second = {{oppositeOf(batch[k]), batch[k + 3], oppositeOf(batch[k + 2])}, false, -1};
  } else if (turns.count == 2) {
    second = {{batch[k + 3], batch[k + 4], batch[k + 5]}, false, -1};
  }
}

}  // namespace screwline

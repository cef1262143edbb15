#include "screwline/ik/closed_form/orientation_problem.h"

#include <cmath>

#include "screwline/ik/closed_form/roots.h"
#include "screwline/model/structure.h"
#include "screwline/spatial/rotation.h"

namespace screwline {
namespace {

/// Sine below which axis 3 counts as in line with axis 1.
constexpr double kInLine = 1e-14;

/// Where both factors are small together (axes coming into line) their product is exact and is kept; where one passes
/// zero alone, two solutions meet there.
double rootOfProduct(double a, double b) {
  return squareRootOrNone(a * b, std::abs(a) + std::abs(b));
}

double angleBetween(const Vector3& a, const Vector3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace

std::optional<OrientationProblem> OrientationProblem::compile(const std::array<Axis, 3>& axes) {
  OrientationProblem problem;
  for (std::size_t i = 0; i < 3; ++i) {
    if (axes[i].prismatic) return std::nullopt;
    problem.axis_[i] = axes[i].direction;
  }
  const auto& [h1, h2, h3] = problem.axis_;
  problem.first_angle_ = angleBetween(h1, h2);
  problem.second_angle_ = angleBetween(h2, h3);
  if (std::sin(problem.first_angle_) <= kStructureAngleTolerance ||
      std::sin(problem.second_angle_) <= kStructureAngleTolerance) {
    return std::nullopt;
  }
  // h1 . R2(q) h3 = constant + amplitude cos(q - nearest)
  const Vector3 across = h3 - h2 * h2.dot(h3);
  problem.nearest_ = std::atan2(h1.dot(h2.cross(across)), h1.dot(across));
  problem.x1_ = anyPerpendicular(h1);
  problem.y1_ = h1.cross(problem.x1_);
  problem.x3_ = anyPerpendicular(h3);
  problem.y3_ = h3.cross(problem.x3_);
  return problem;
}

void OrientationProblem::solve(const Matrix3& Q, double preferred, OrientationSolutions& solutions) const {
  solutions.count = 0;
  const Vector3 image = Q * axis_[2];
  const double image_x = x1_.dot(image);
  const double image_y = y1_.dot(image);
  const double image_sine = std::hypot(image_x, image_y);
  const double between = std::atan2(image_sine, axis_[0].dot(image));
  // cos(between) = cos(first) cos(second) + sin(first) sin(second) cos(middle). Half-angle products keep the digits of
  // a small or almost straight middle angle, which the cosine loses.
  const double sum = first_angle_ + second_angle_;
  const double difference = first_angle_ - second_angle_;
  const double half_sine =
      rootOfProduct(std::sin(0.5 * (between + difference)), std::sin(0.5 * (between - difference)));
  const double half_cosine = rootOfProduct(std::sin(0.5 * (sum + between)), std::sin(0.5 * (sum - between)));
  if (half_sine < 0.0 || half_cosine < 0.0) return;
  const bool in_line = image_sine <= kInLine;
  const double middle = 2.0 * std::atan2(half_sine, half_cosine);
  const bool one = in_line || half_sine == 0.0 || half_cosine == 0.0;
  for (int sign : {1, -1}) {
    if (one && sign < 0) break;
    OrientationSolution solution;
    solution.sign = one ? 0 : sign;
    solution.free = in_line;
    solution.q[1] = nearest_ + sign * middle;
    const Matrix3 R2 = rotationAbout(axis_[1], solution.q[1]);
    const Vector3 turned = R2 * axis_[2];
    solution.q[0] = in_line ? preferred : std::atan2(image_y, image_x) - std::atan2(y1_.dot(turned), x1_.dot(turned));
    const Vector3 x3 = R2.transpose() * (rotationAbout(axis_[0], -solution.q[0]) * (Q * x3_));
    solution.q[2] = std::atan2(y3_.dot(x3), x3_.dot(x3));
    solutions.solutions[static_cast<std::size_t>(solutions.count++)] = solution;
  }
}

}  // namespace screwline

#include "screwline/symbolic/right_angles.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "../kinematics/sampling.h"
#include "screwline/kinematics/forward.h"
#include "screwline/symbolic/symbolic_chain.h"

namespace screwline {
namespace {

constexpr int kComparisons = 100;

/// The signed coordinate axis within `tolerance` of a unit vector, else the vector itself.
Vector3 squared(const Vector3& direction, double tolerance) {
  Eigen::Index largest = 0;
  direction.cwiseAbs().maxCoeff(&largest);
  Vector3 axis = Vector3::Zero();
  axis[largest] = direction[largest] < 0.0 ? -1.0 : 1.0;
  return (direction - axis).norm() <= tolerance ? axis : direction;
}

/// Coordinates closer than `tolerance` get the value of the smallest in size among them, zero where that is one.
void merge(std::vector<double*>& coordinates, double tolerance) {
  std::sort(coordinates.begin(), coordinates.end(), [](const double* a, const double* b) { return *a < *b; });
  for (std::size_t first = 0; first < coordinates.size();) {
    std::size_t end = first + 1;
    while (end < coordinates.size() && *coordinates[end] - *coordinates[end - 1] <= tolerance) ++end;
    double common = *coordinates[first];
    for (std::size_t k = first; k < end; ++k) {
      if (std::abs(*coordinates[k]) < std::abs(common)) common = *coordinates[k];
    }
    if (std::abs(common) <= tolerance) common = 0.0;
    for (std::size_t k = first; k < end; ++k) *coordinates[k] = common;
    first = end;
  }
}

}  // namespace

std::optional<SquaredChain> withRightAngles(const SerialChain& chain, double tolerance) {
  ChainDescription description = chain.description();
  double turn = 0.0;
  for (Axis& axis : description.axes) {
    const Vector3 direction = squared(axis.direction, tolerance);
    turn = std::max(turn, (direction - axis.direction).norm());
    axis.direction = direction;
    axis.point -= axis.point.dot(direction) * direction;  // The place along the axis says nothing.
  }
  Matrix3 R;
  for (int k = 0; k < 3; ++k) R.col(k) = squared(chain.home().R.col(k), tolerance);
  if (std::abs(R.determinant() - 1.0) <= kExactAngle) {
    turn = std::max(turn, (R - chain.home().R).colwise().norm().maxCoeff());
    description.home.R = R;
  }
  if (turn <= kExactAngle) return std::nullopt;
  for (Eigen::Index k = 0; k < 3; ++k) {
    std::vector<double*> coordinates = {&description.home.p[k]};
    for (Axis& axis : description.axes) coordinates.push_back(&axis.point[k]);
    merge(coordinates, tolerance * chain.characteristicLength());
  }
  for (Link& link : description.links) {
    if (link.name == description.tip_link) link.home = description.home;
  }
  SquaredChain result{SerialChain(std::move(description)), turn, 0.0, 0.0};
  for (int k = 0; k < kComparisons; ++k) {
    const VectorX q = sampleConfiguration(chain, k);
    const Pose given = forwardByExponentials(chain, q);
    const Pose now = forwardByExponentials(result.chain, q);
    result.position_error = std::max(result.position_error, (given.p - now.p).norm());
    const Matrix3 between = given.R.transpose() * now.R;
    const Vector3 twice_sine(between(2, 1) - between(1, 2), between(0, 2) - between(2, 0),
                             between(1, 0) - between(0, 1));
    result.rotation_error = std::max(result.rotation_error, std::atan2(twice_sine.norm(), between.trace() - 1.0));
  }
  return result;
}

}  // namespace screwline

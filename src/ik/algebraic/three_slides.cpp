#include "three_slides.h"

#include <cmath>

#include <Eigen/LU>

#include "screwline/kinematics/forward.h"
#include "screwline/kinematics/kernel_sweep.h"

namespace screwline {
namespace {

constexpr double kFlat = 1e-9;  ///< Volume that three slides span, below which their values are not determined.

}  // namespace

std::optional<ThreeSlides> ThreeSlides::compile(const SerialChain& chain) {
  std::array<Axis, 3> axes;
  std::array<int, 3> turns{};
  std::size_t count = 0;
  for (int i = 0; i < chain.size(); ++i) {
    const Axis& axis = chain.axes()[static_cast<std::size_t>(i)];
    if (axis.prismatic) continue;
    if (count == 3) return std::nullopt;
    axes[count] = axis;
    turns[count++] = i;
  }
  if (count != 3) return std::nullopt;
  const std::optional<OrientationProblem> orientation = OrientationProblem::compile(axes);
  if (!orientation) return std::nullopt;
  ThreeSlides result(*orientation);
  result.home_turned_back_ = chain.home().R.transpose();
  result.turns_ = turns;
  VectorX q = VectorX::Constant(6, 0.7);
  Vector6 found = q;
  if (!result.setSlides(chain, forwardKinematics(chain, q), found)) return std::nullopt;
  return result;
}

bool ThreeSlides::setSlides(const SerialChain& chain, const Pose& target, Vector6& q) const {
  std::array<int, 3> slides{};
  Matrix3 directions;
  int count = 0;
  int joint = 0;
  for (int i = 0; i < 6; ++i) {
    if (chain.axes()[static_cast<std::size_t>(i)].prismatic) q[i] = 0.0;
  }
  const Pose X = sweepKernel(chain.kernel(), q.data(), [&](const AxisKernel& axis, const Vector3& z, const Vector3&) {
    if (axis.prismatic) {
      directions.col(count) = axis.multiplier * z;
      slides[static_cast<std::size_t>(count++)] = joint;
    }
    ++joint;
  });
  if (std::abs(directions.determinant()) < kFlat) return false;
  const Vector3 values = directions.inverse() * (target.p - X.p);
  for (int i = 0; i < 3; ++i) q[slides[static_cast<std::size_t>(i)]] = values[i];
  return true;
}

bool ThreeSlides::solve(const SerialChain& chain, const Pose& target, RootRefiner& refiner) const {
  OrientationSolutions solutions;
  orientation_.solve(target.R * home_turned_back_, 0.0, solutions);
  bool isolated = true;
  for (const OrientationSolution& solution : solutions) {
    Vector6 q = Vector6::Zero();
    for (std::size_t i = 0; i < 3; ++i) {
      q[turns_[i]] = solution.q[i] / chain.axes()[static_cast<std::size_t>(turns_[i])].multiplier;
    }
    isolated = isolated && !solution.free && setSlides(chain, target, q);
    refiner.add(q);
  }
  return isolated;
}

}  // namespace screwline

#include <cmath>
#include <vector>

#include "jacobian_methods.h"

namespace screwline {
namespace {

constexpr double kStep = 1e-3;  ///< rad, m: balances h^4/30 of the extrapolated difference against rounding over h.

/// A transform's derivative with respect to one axis' displacement.
struct PoseSlope {
  Matrix3 R;
  Vector3 p;
};

/// An axis' frame, displaced, in the frame of the axis before.
Pose displaced(const AxisKernel& axis, double displacement) {
  const double angle = axis.prismatic ? axis.offset : axis.offset + displacement;
  const double s = std::sin(angle);
  const double c = std::cos(angle);
  Pose X;
  X.R << c, -s, 0.0, s * axis.cos_alpha, c * axis.cos_alpha, -axis.sin_alpha, s * axis.sin_alpha, c * axis.sin_alpha,
      axis.cos_alpha;
  X.p = axis.p;
  if (axis.prismatic) X.p += displacement * X.R.col(2);
  return X;
}

/// By a central difference of half-width h.
PoseSlope centralDifference(const AxisKernel& axis, double displacement, double h) {
  const double above = displacement + h;
  const double below = displacement - h;
  const Pose X_above = displaced(axis, above);
  const Pose X_below = displaced(axis, below);
  return {(X_above.R - X_below.R) / (above - below), (X_above.p - X_below.p) / (above - below)};
}

/// Richardson: two widths cancel the error of order h^2.
PoseSlope slopeOf(const AxisKernel& axis, double displacement) {
  const PoseSlope fine = centralDifference(axis, displacement, kStep);
  const PoseSlope coarse = centralDifference(axis, displacement, 2.0 * kStep);
  return {(4.0 * fine.R - coarse.R) / 3.0, (4.0 * fine.p - coarse.p) / 3.0};
}

}  // namespace

/// The tip's transform is a product in which an axis moves one factor: before * axis * after.
Matrix6X numericalJacobian(const SerialChain& chain, const ConstVectorRef& q) {
  const std::vector<AxisKernel>& axes = chain.kernel().axes;
  std::vector<double> displacement(axes.size());
  std::vector<Pose> after(axes.size(), chain.kernel().tool);
  for (std::size_t i = axes.size(); i-- > 0;) {
    displacement[i] = axes[i].multiplier * q[axes[i].source];
    if (i > 0) after[i - 1] = displaced(axes[i], displacement[i]) * after[i];
  }
  Matrix6X J = Matrix6X::Zero(6, chain.size());
  Pose before = chain.kernel().base;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const PoseSlope slope = slopeOf(axes[i], displacement[i]);
    const Pose X = displaced(axes[i], displacement[i]);
    const Matrix3 spin = before.R * (slope.R * X.R.transpose()) * before.R.transpose();
    auto column = J.col(axes[i].source);
    column.head<3>() += axes[i].multiplier * (before.R * (slope.R * after[i].p + slope.p));
    column.tail<3>() +=
        0.5 * axes[i].multiplier * Vector3(spin(2, 1) - spin(1, 2), spin(0, 2) - spin(2, 0), spin(1, 0) - spin(0, 1));
    before = before * X;
  }
  return J;
}

}  // namespace screwline

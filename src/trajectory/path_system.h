#ifndef SCREWLINE_SRC_TRAJECTORY_PATH_SYSTEM_H
#define SCREWLINE_SRC_TRAJECTORY_PATH_SYSTEM_H

#include <Eigen/QR>

#include "screwline/ik/task_error.h"
#include "screwline/kinematics/jacobian.h"
#include "screwline/trajectory/tool_path.h"

namespace screwline {

/// The joints along a smooth part of a tool path as one curve y = (q, u): the task error of q to the path at u is zero.
/// As a curve of n + 1 unknowns it is regular where q(u) is not, as at the edge of the workspace. Lengths are measured
/// in units: rad, and the characteristic length for slides and positions. Not for many threads at once.
class PathSystem {
 public:
  /// Keeps references to all three.
  PathSystem(const SerialChain& chain, const Task& task, const ToolPath& path);

  void choosePart(std::size_t part) { part_ = part; }

  /// Everything below is about the last y that was evaluated.
  void evaluate(const VectorX& y);

  /// Errors over the task [m, rad] and the larger one in units.
  const TaskError& error() const { return error_; }
  double residual() const;

  /// The shortest step towards the curve: Newton's.
  VectorX step() const;
  /// The curve's direction, of unit length: that of growing u where `previous` is empty, else the one that goes on.
  /// A redundant chain: the shortest joint motion per u, and away from limits that are near.
  VectorX direction(const VectorX& previous) const;
  /// Second derivative by arc length, for a direction from direction(). Evaluates elsewhere: take the rest first.
  VectorX bend(const VectorX& y, const VectorX& direction);

  /// 0 where two curves cross (an exactly met singularity), of the order of 1 far from there.
  double gap() const { return gap_; }
  bool redundant() const { return chain_.size() > task_.size(); }
  double lengthOf(const VectorX& step) const { return step.cwiseQuotient(units_).norm(); }

  /// Newton steps onto the curve. @return whether the error vanishes (to rounding).
  bool correct(VectorX& y);
  /// The same at fixed u, by the joints alone: least norm, rank revealing.
  bool correctJoints(VectorX& y);

 private:
  using Transposed = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMaxJoints + 1, 6>;

  Vector6 rowOf(int i) const;
  VectorX inUnits(const Vector6& twist) const;
  VectorX shortest(const Vector6& twist) const;
  VectorX awayFromLimits(const VectorX& y) const;
  VectorX exactBend(const VectorX& direction) const;

  const SerialChain& chain_;
  const Task& task_;
  const ToolPath& path_;
  std::size_t part_ = 0;
  int n_ = 0;
  VectorX units_;
  VectorX y_;
  ToolPathPoint target_;
  TaskError error_;
  Matrix6X J_;
  Matrix3 R_BT_;
  Transposed rows_;  ///< (n + 1) x m: derivatives of the error's rows, in units.
  Eigen::ColPivHouseholderQR<Transposed> factor_;
  int rank_ = 0;
  double gap_ = 0.0;
};

}  // namespace screwline

#endif  // SCREWLINE_SRC_TRAJECTORY_PATH_SYSTEM_H

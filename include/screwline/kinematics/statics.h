#ifndef SCREWLINE_KINEMATICS_STATICS_H
#define SCREWLINE_KINEMATICS_STATICS_H

#include "screwline/kinematics/jacobian.h"

namespace screwline {

/// Joint efforts tau = J^T F that hold a wrench F = [f; n] (base frame), exerted by the tool on the environment about
/// the tip's origin.
VectorX effortOf(const SerialChain& chain, const ConstVectorRef& q, const Vector6& wrench);

/// A wrench that given efforts hold.
struct WrenchSolution {
  Vector6 wrench;      ///< Base frame, about the tip's origin; zero outside the task rows; least norm where not unique.
  bool exact = false;  ///< residual < 1e-9 (1 + norm of the efforts).
  double residual = 0.0;  ///< Norm of efforts - J^T wrench.
};

/// Least-squares solution of J^T F = effort with F confined to the task's rows.
WrenchSolution wrenchOf(const SerialChain& chain, const ConstVectorRef& q, const ConstVectorRef& effort,
                        const Task& task);

/// Orthonormal wrenches (k x 6 rows, base frame, tip origin) that the structure carries without any effort: the null
/// space of J^T, k = 6 - rank of the 6 x n Jacobian.
MatrixX supportedWrenches(const SerialChain& chain, const ConstVectorRef& q);

}  // namespace screwline

#endif  // SCREWLINE_KINEMATICS_STATICS_H

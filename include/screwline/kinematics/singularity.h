#ifndef SCREWLINE_KINEMATICS_SINGULARITY_H
#define SCREWLINE_KINEMATICS_SINGULARITY_H

#include <string>
#include <vector>

#include "screwline/kinematics/jacobian.h"
#include "screwline/kinematics/singularity_factors.h"

namespace screwline {

/// Singular values at or below this share of the largest do not count to the rank.
constexpr double kRankTolerance = 1e-9;

/// A named way for the task to become singular. See SingularityCondition.msg.
struct SingularCondition {
  std::string name;        ///< "elbow", "shoulder", "wrist", ...
  std::string expression;  ///< "sin(theta3) = 0"
  std::string latex;
  double value = 0.0;   ///< Of the expression's left side, at q.
  bool active = false;  ///< Whether it holds at q, by the same tolerance as the rank.
  std::string meaning;  ///< What is lost, in a line.
};

/// The task Jacobian's decomposition at one configuration.
struct TaskRank {
  int rank = 0;
  VectorX singular_values;  ///< min(m, n), descending; mixed SI units.
  MatrixX lost_directions;  ///< k x m, orthonormal rows in task order, base frame: twists that no joint rates give. k =
                            ///< m - rank.
  MatrixX self_motions;     ///< k x n, orthonormal rows: joint rates that move no task row. k = n - rank.
};

/// How many of the descending singular values count: those above kRankTolerance of the largest and above `noise`.
int rankOf(const VectorX& singular_values, double noise = 0.0);

/// What rounding can leave in a task Jacobian whose rows should be zero: a share of the norm of the whole 6 x n one.
/// With it a wrist whose tip is the centre has rank 0 in x y z, whatever the last bits say.
double jacobianNoise(const Matrix6X& J);

/// Decomposition of a task Jacobian (m x n). Allocates.
TaskRank taskRank(const MatrixX& task_jacobian, double noise = 0.0);

/// Singular values alone, min(m, n) of them, descending: a fraction of taskRank()'s time.
VectorX singularValues(const MatrixX& task_jacobian);

/// Product of the singular values: sqrt(det(J J^T)) (Yoshikawa 1985).
double manipulability(const MatrixX& task_jacobian);

struct SingularityAnalysis {
  bool singular = false;  ///< rank < min(m, n).
  TaskRank rank;
  double manipulability = 0.0;
  double condition_number = 0.0;  ///< Largest over smallest singular value; kMaxCondition where singular.
  double determinant = 0.0;       ///< NaN where the task Jacobian is not square.
  std::vector<SingularCondition> conditions;
  VectorX nearest;  ///< n; a singular configuration nearest to q, within limits where there is one; empty: none found.
  double distance = 0.0;  ///< Norm of nearest - q (rad and m mixed); infinite where none was found.
  bool nearest_within_limits = false;
  std::string nearest_note;  ///< How it was found, and how far it can be trusted.
};

constexpr double kMaxCondition = 1e16;

/// Everything about the task at q. Deterministic; allocates; well under a millisecond for 6 joints, some 2 ms where
/// there are more joints than rows.
SingularityAnalysis analyzeSingularity(const SerialChain& chain, const ConstVectorRef& q, const Task& task);

/// The same with factorsOf(chain, task) at hand, which do not depend on q: the quick way for many configurations.
SingularityAnalysis analyzeSingularity(const SerialChain& chain, const ConstVectorRef& q, const Task& task,
                                       const std::vector<SingularityFactor>& factors);

}  // namespace screwline

#endif  // SCREWLINE_KINEMATICS_SINGULARITY_H

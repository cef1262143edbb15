#include "screwline/kinematics/singularity.h"

#include <algorithm>
#include <cmath>

#include "nearest_singularity.h"
#include "screwline/spatial/svd.h"

namespace screwline {
namespace {

constexpr double kNoiseShare = 1e-13;
/// A factor's share of its typical size below which it may be what makes a singular configuration so.
constexpr double kActiveShare = 1e-7;

double valueOf(const SingularityFactor& factor, const ConstVectorRef& q, const TaskDeterminant& determinant) {
  return factor.isExplicit() ? factor.value(q) : determinant(q);
}

/// Conditions at q. Whether any is active is the rank's decision; which one, the factors'.
std::vector<SingularCondition> conditionsAt(const std::vector<SingularityFactor>& factors, const ConstVectorRef& q,
                                            const TaskDeterminant& determinant, bool singular) {
  std::vector<SingularCondition> conditions;
  std::size_t smallest = 0;
  double smallest_share = std::numeric_limits<double>::infinity();
  for (const SingularityFactor& factor : factors) {
    const double value = valueOf(factor, q, determinant);
    const double share = std::abs(value) / factor.scale;
    conditions.push_back(
        {factor.name, factor.expression, factor.latex, value, singular && share <= kActiveShare, factor.meaning});
    if (share < smallest_share) {
      smallest_share = share;
      smallest = conditions.size() - 1;
    }
  }
  if (singular && !conditions.empty()) conditions[smallest].active = true;
  return conditions;
}

}  // namespace

int rankOf(const VectorX& singular_values, double noise) {
  const double floor = singular_values.size() == 0 ? 0.0 : std::max(kRankTolerance * singular_values[0], noise);
  return static_cast<int>((singular_values.array() > floor).count());
}

double jacobianNoise(const Matrix6X& J) {
  return kNoiseShare * J.norm();
}

TaskRank taskRank(const MatrixX& task_jacobian, double noise) {
  const Svd svd(task_jacobian, Eigen::ComputeFullU | Eigen::ComputeFullV);
  TaskRank result;
  result.singular_values = svd.singularValues();
  result.rank = rankOf(result.singular_values, noise);
  result.lost_directions = svd.matrixU().rightCols(task_jacobian.rows() - result.rank).transpose();
  result.self_motions = svd.matrixV().rightCols(task_jacobian.cols() - result.rank).transpose();
  return result;
}

VectorX singularValues(const MatrixX& task_jacobian) {
  return Svd(task_jacobian).singularValues();
}

double manipulability(const MatrixX& task_jacobian) {
  return singularValues(task_jacobian).prod();
}

SingularityAnalysis analyzeSingularity(const SerialChain& chain, const ConstVectorRef& q, const Task& task) {
  return analyzeSingularity(chain, q, task, factorsOf(chain, task));
}

SingularityAnalysis analyzeSingularity(const SerialChain& chain, const ConstVectorRef& q, const Task& task,
                                       const std::vector<SingularityFactor>& factors) {
  Matrix6X J;
  const Matrix3 R_BT = geometricJacobian(chain, q, J).R;
  const MatrixX J_task = taskJacobian(task, J, R_BT);
  const TaskDeterminant determinant(chain, task);

  SingularityAnalysis analysis;
  analysis.rank = taskRank(J_task, jacobianNoise(J));
  const VectorX& sigma = analysis.rank.singular_values;
  const Eigen::Index full = sigma.size();
  analysis.singular = analysis.rank.rank < full;
  analysis.manipulability = sigma.prod();
  analysis.condition_number = analysis.singular ? kMaxCondition : std::min(kMaxCondition, sigma[0] / sigma[full - 1]);
  analysis.determinant = determinantOrNan(J_task);
  analysis.conditions = conditionsAt(factors, q, determinant, analysis.singular);

  const NearestSingularity nearest = nearestSingularity(determinant, q, factors, analysis.singular);
  analysis.nearest = nearest.q;
  analysis.distance = nearest.distance;
  analysis.nearest_within_limits = nearest.within_limits;
  analysis.nearest_note = nearest.note;
  return analysis;
}

}  // namespace screwline

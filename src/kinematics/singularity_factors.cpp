#include "screwline/kinematics/singularity_factors.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "factor_names.h"
#include "factor_search.h"
#include "sampling.h"
#include "screwline/kinematics/jacobian.h"

namespace screwline {
namespace {

constexpr int kBaseTries = 12;        ///< Samples of which the largest determinant is the base of all comparisons.
constexpr int kFirstSample = 3;       ///< In the fixed sequence: after those that the search probes with.
constexpr double kZeroShare = 1e-12;  ///< Of Hadamard's bound: a determinant below it everywhere is zero.

bool isPeriodic(const SerialChain& chain) {
  return std::all_of(chain.axes().begin(), chain.axes().end(), [&chain](const Axis& axis) {
    return axis.prismatic == !chain.joint(axis.source).isRevolute() &&
           (axis.prismatic || std::abs(axis.multiplier) == 1.0);
  });
}

SingularityFactor wholeDeterminant(const TaskDeterminant& determinant, double scale) {
  SingularityFactor factor;
  factor.name = "determinant";
  factor.expression = "det(J_task) = 0";
  factor.latex = "\\det J = 0";
  if (!determinant.isSquare()) {
    const bool wide = determinant.task().size() < determinant.chain().size();
    factor.expression = wide ? "det(J_task * J_task^T) = 0" : "det(J_task^T * J_task) = 0";
    factor.latex = wide ? "\\det(J J^T) = 0" : "\\det(J^T J) = 0";
  }
  factor.meaning = "the joints together lose at least one direction of the task";
  for (int i = 0; i < determinant.chain().size(); ++i) factor.joints.push_back(i);
  factor.scale = scale;
  return factor;
}

}  // namespace

double SingularityFactor::value(const ConstVectorRef& q) const {
  return valueOf(terms, joints, q);
}

TaskDeterminant::TaskDeterminant(const SerialChain& chain, const Task& task) : chain_(chain), task_(task) {}

bool TaskDeterminant::isSquare() const {
  return task_.size() == chain_.size();
}

double TaskDeterminant::operator()(const ConstVectorRef& q) const {
  using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 6, kMaxJoints>;
  const Matrix3 R_BT = geometricJacobian(chain_, q, J_).R;
  Small A(task_.size(), chain_.size());
  task_.selectInto(J_, R_BT, A);
  using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 6, 6>;
  if (isSquare()) return Square(A).determinant();
  if (A.rows() < A.cols()) return Square(A * A.transpose()).determinant();
  return Square(A.transpose() * A).determinant();
}

double TaskDeterminant::bound(const ConstVectorRef& q) const {
  geometricJacobian(chain_, q, J_);
  double product = 1.0;
  for (Eigen::Index i = 0; i < J_.cols(); ++i) product *= J_.col(i).norm();
  return product;
}

std::vector<SingularityFactor> factorsOf(const SerialChain& chain, const Task& task) {
  const TaskDeterminant determinant(chain, task);
  VectorX base;
  double largest = -1.0;
  double bound = 0.0;
  for (int k = 0; k < kBaseTries; ++k) {
    const VectorX q = sampleConfiguration(chain, kFirstSample + k);
    const double size = std::abs(determinant(q));
    bound = std::max(bound, determinant.bound(q));
    if (size <= largest) continue;
    largest = size;
    base = q;
  }
  if (!determinant.isSquare()) return {wholeDeterminant(determinant, largest > 0.0 ? largest : 1.0)};
  if (largest <= kZeroShare * bound) {
    std::vector<SingularityFactor> always = {wholeDeterminant(determinant, 1.0)};
    always.front().name = "always";
    always.front().meaning = "the chain cannot give all rows of the task at any configuration";
    return always;
  }
  if (!isPeriodic(chain)) return {wholeDeterminant(determinant, largest)};
  FactorSearch search(chain, base);
  std::vector<int> joints(static_cast<std::size_t>(chain.size()));
  for (int i = 0; i < chain.size(); ++i) joints[static_cast<std::size_t>(i)] = i;
  search.split([&determinant](const VectorX& q) { return determinant(q); }, joints);
  std::vector<SingularityFactor> factors = search.factors();
  nameFactors(chain, factors);
  for (SingularityFactor& factor : factors) {
    factor.scale = 0.0;
    for (int k = 0; k < kBaseTries; ++k) {
      factor.scale = std::max(factor.scale, std::abs(factor.value(sampleConfiguration(chain, k))));
    }
  }
  if (!search.isComplete()) factors.push_back(wholeDeterminant(determinant, largest));
  return factors;
}

}  // namespace screwline

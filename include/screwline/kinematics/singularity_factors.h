#ifndef SCREWLINE_KINEMATICS_SINGULARITY_FACTORS_H
#define SCREWLINE_KINEMATICS_SINGULARITY_FACTORS_H

#include <string>
#include <vector>

#include "screwline/model/serial_chain.h"
#include "screwline/model/task.h"

namespace screwline {

/// coefficient * f(sum turns[i] q[joints[i]] + phase) * product q[joints[i]]^powers[i], with f = 1, sin or cos.
struct FactorTerm {
  enum class Function { kOne, kSine, kCosine };

  double coefficient = 1.0;
  Function function = Function::kOne;
  std::vector<double> turns;  ///< One per joint of the factor; 0 for slides.
  double phase = 0.0;         ///< [rad]
  std::vector<int> powers;    ///< One per joint of the factor; 0 for revolute joints.
};

/// A factor of the task determinant in few joints: where it is zero, the task is singular. Without terms (isExplicit()
/// false) it stands for the determinant itself, of which no factors are known.
struct SingularityFactor {
  std::string name;        ///< "elbow", "shoulder", "wrist", "extension", ..., "determinant"
  std::string expression;  ///< "sin(theta3) = 0"
  std::string latex;
  std::string meaning;
  std::vector<int> joints;  ///< That it depends on, ascending.
  std::vector<FactorTerm> terms;
  double scale = 1.0;  ///< Its typical magnitude.
  /// Where it depends on one joint: all its zeros, for a revolute joint in (-pi, pi].
  std::vector<double> roots;

  bool isExplicit() const { return !terms.empty(); }
  /// Sum of the terms. @pre isExplicit().
  double value(const ConstVectorRef& q) const;
};

/// The determinant of the task's rows as one function of q: det(J) where J is square, else of J J^T or J^T J, whichever
/// is smaller.
class TaskDeterminant {
 public:
  /// Keeps a reference to the chain.
  TaskDeterminant(const SerialChain& chain, const Task& task);
  double operator()(const ConstVectorRef& q) const;
  bool isSquare() const;
  const SerialChain& chain() const { return chain_; }
  const Task& task() const { return task_; }
  /// Bound on its magnitude at q (Hadamard's: the product of the columns' norms). @pre isSquare().
  double bound(const ConstVectorRef& q) const;

 private:
  const SerialChain& chain_;
  Task task_;
  mutable Matrix6X J_;
};

/// Factors of the task determinant, found numerically and named from the chain's geometry: joints that do not matter
/// and sets of joints that separate are found by sampling; zeros common to all values of the other joints are split
/// off; what remains is fitted exactly as a trigonometric polynomial (slides: polynomial) and checked at other points.
/// Where the rest is too rich for that, one factor "determinant" stands for it. Empty: the task is never singular.
/// Deterministic; allocates; about 0.2 ms for 6 joints.
std::vector<SingularityFactor> factorsOf(const SerialChain& chain, const Task& task);

}  // namespace screwline

#endif  // SCREWLINE_KINEMATICS_SINGULARITY_FACTORS_H

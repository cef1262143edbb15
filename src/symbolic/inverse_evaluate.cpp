#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "../kinematics/sampling.h"
#include "inverse_roots.h"
#include "screwline/kinematics/forward.h"
#include "screwline/kinematics/jacobian.h"
#include "screwline/kinematics/singularity.h"
#include "screwline/spatial/rotation.h"
#include "screwline/symbolic/inverse_formulas.h"

namespace screwline {
namespace {

constexpr double kSame = 1e-6;     ///< [rad, m] between joint values of solutions that are one.
constexpr double kDouble = 1e-14;  ///< Share of a radicand's terms below which it is zero: two solutions meet.
constexpr double kBeyond = 1e-12;  ///< The same below zero.
constexpr double kFree = 1e-12;    ///< Of the chain's length: what is this near to zero leaves a joint free.
constexpr double kClear = 1e-3;    ///< Smallest over largest singular value of poses at which solutions are compared.

double difference(const InverseFormulas& formulas, const VectorX& a, const VectorX& b) {
  double worst = 0.0;
  for (int i = 0; i < formulas.joints; ++i) {
    const double d = a[i] - b[i];
    worst = std::max(worst, std::abs(formulas.revolute[static_cast<std::size_t>(i)] ? wrapAngle(d) : d));
  }
  return worst;
}

/// Works off the lines, one branch at a time.
class Branches {
 public:
  Branches(const InverseFormulas& formulas, const Pose& target, const VectorX& preferred)
      : formulas_(formulas), preferred_(preferred) {
    for (int id = 0; id < formulas.symbols.size(); ++id) values_.push_back(formulas.symbols[id].value);
    for (int i = 0; i < 3; ++i) set(formulas.target[static_cast<std::size_t>(i)], target.p[i]);
    for (int i = 0; i < 9; ++i) set(formulas.target[static_cast<std::size_t>(i) + 3], target.R(i / 3, i % 3));
    if (formulas.given >= 0) set(formulas.given, preferred[formulas.given]);
  }

  std::vector<InverseSolution> all() {
    follow(0, 0);
    return std::move(found_);
  }

 private:
  void set(int symbol, double value) { values_[static_cast<std::size_t>(symbol)] = value; }

  void follow(std::size_t line, unsigned free) {
    if (line == formulas_.steps.size()) return keep(free);
    const InverseStep& step = formulas_.steps[line];
    if (step.sign >= 0) return branch(step, line, free);
    const bool is_joint = step.symbol < formulas_.joints;
    const bool is_free = is_joint && !step.free_if.empty() &&
                         std::all_of(step.free_if.begin(), step.free_if.end(), [&](const Formula& formula) {
                           return std::abs(formula.evaluate(values_)) <= kFree * std::max(1.0, formulas_.length);
                         });
    if (!step.equation.empty() && !is_free) return followRoots(step, line, free);
    set(step.symbol, is_free ? preferred_[step.symbol] : step.value.evaluate(values_));
    follow(line + 1, is_free ? free | 1U << step.symbol : free);
  }

  void branch(const InverseStep& step, std::size_t line, unsigned free) {
    double scale = 0.0;
    const bool is_sum = step.radicand.kind() == Formula::Kind::kSum;
    const std::vector<Formula> terms = is_sum ? step.radicand.parts() : std::vector<Formula>{step.radicand};
    double radicand = 0.0;
    for (const Formula& term : terms) {
      const double value = term.evaluate(values_);
      radicand += value;
      scale += std::abs(value);
    }
    const double tiny = kFree * std::max(1.0, formulas_.length);
    if (!(radicand >= -kBeyond * scale - tiny * tiny)) return;
    const double root = radicand <= kDouble * scale + tiny * tiny ? 0.0 : std::sqrt(radicand);
    for (const double sign : {1.0, -1.0}) {
      if (root == 0.0 && sign < 0.0) break;
      set(step.symbol, sign * root);
      follow(line + 1, free);
    }
  }

  void followRoots(const InverseStep& step, std::size_t line, unsigned free) {
    std::array<double, 5> coefficients{};
    for (std::size_t i = 0; i < 5; ++i) coefficients[i] = step.equation[i].evaluate(values_);
    for (const double root : step.tangent >= 0 ? zeroAngles(coefficients) : realRoots(coefficients)) {
      set(step.symbol, root);
      follow(line + 1, free);
    }
  }

  void keep(unsigned free) {
    if (formulas_.open_joint >= 0) free |= 1U << formulas_.open_joint;
    InverseSolution solution{VectorX(formulas_.joints), free};
    for (int i = 0; i < formulas_.joints; ++i) {
      const double value = i == formulas_.open_joint ? preferred_[i] : values_[static_cast<std::size_t>(i)];
      const bool turns = formulas_.revolute[static_cast<std::size_t>(i)] && (free >> i & 1U) == 0U;
      solution.q[i] = turns ? wrapAngle(value) : value;
    }
    const bool known = std::any_of(found_.begin(), found_.end(), [&](const InverseSolution& other) {
      return difference(formulas_, other.q, solution.q) <= kSame;
    });
    if (!known) found_.push_back(solution);
  }

  const InverseFormulas& formulas_;
  const VectorX& preferred_;
  std::vector<double> values_;
  std::vector<InverseSolution> found_;
};

/// Difference of the task's rows: rotation as a vector, lengths over the chain's.
double taskDeviation(const SerialChain& chain, const Task& task, const Pose& target, const VectorX& q) {
  const Pose X = forwardKinematics(chain, q);
  Vector6 error;
  error.head<3>() = (X.p - target.p) / std::max(chain.characteristicLength(), target.p.norm());
  const Eigen::AngleAxisd turn(Matrix3(X.R * target.R.transpose()));
  error.tail<3>() = turn.angle() * turn.axis();
  double worst = 0.0;
  for (int row = 0; row < 6; ++row) {
    if (task.contains(row)) worst = std::max(worst, std::abs(error[row]));
  }
  const int pointing = task.pointingAxis();
  if (pointing >= 0) worst = std::max(worst, X.R.col(pointing).cross(target.R.col(pointing)).norm());
  return worst;
}

bool isClear(const SerialChain& chain, const Task& task, int given, const VectorX& q) {
  Matrix6X J(6, chain.size());
  const Matrix3 R = geometricJacobian(chain, q, J).R;
  J.topRows<3>() /= chain.characteristicLength();
  MatrixX J_task = task.select(J, R);
  if (given >= 0) {  // The others alone.
    const Eigen::Index behind = J_task.cols() - 1 - given;
    J_task.middleCols(given, behind) = J_task.rightCols(behind).eval();
    J_task.conservativeResize(Eigen::NoChange, J_task.cols() - 1);
  }
  const VectorX values = singularValues(J_task);
  return values.minCoeff() > kClear * values.maxCoeff();
}

}  // namespace

std::vector<InverseSolution> evaluate(const InverseFormulas& formulas, const Pose& target, const VectorX& preferred) {
  return Branches(formulas, target, preferred).all();
}

InverseCheck checkInverse(const InverseFormulas& formulas, const SerialChain& chain, const Task& task,
                          const InverseSolver& solver, int poses) {
  InverseCheck check;
  for (int k = 0; check.poses < poses && k < 20 * poses; ++k) {
    const VectorX q = sampleConfiguration(chain, k);
    if (!isClear(chain, task, formulas.given, q)) continue;
    const Pose target = forwardKinematics(chain, q);
    const std::vector<VectorX> expected = solver(target, q);
    VectorX preferred = q;
    const int open = formulas.open_joint;
    if (open >= 0 && !expected.empty()) preferred[open] = expected.front()[open];
    const std::vector<InverseSolution> found = evaluate(formulas, target, preferred);
    ++check.poses;
    check.solutions += static_cast<int>(expected.size());
    for (const VectorX& solution : expected) {
      double nearest = std::numeric_limits<double>::infinity();
      for (const InverseSolution& other : found) nearest = std::min(nearest, difference(formulas, solution, other.q));
      if (nearest > kSame) {
        ++check.missing;
      } else {
        check.worst_joint = std::max(check.worst_joint, nearest);
      }
    }
    for (const InverseSolution& solution : found) {
      const bool known = std::any_of(expected.begin(), expected.end(), [&](const VectorX& other) {
        return difference(formulas, solution.q, other) <= kSame;
      });
      if (!known) ++check.extra;
      check.worst_task = std::max(check.worst_task, taskDeviation(chain, task, target, solution.q));
    }
  }
  return check;
}

}  // namespace screwline

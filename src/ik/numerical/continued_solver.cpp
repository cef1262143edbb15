#include "screwline/ik/numerical/continued_solver.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "descent.h"
#include "screwline/kinematics/forward.h"
#include "screwline/spatial/rotation.h"
#include "solution_set.h"
#include "valley.h"

namespace screwline {
namespace {

constexpr int kSamples = 100;        ///< Configurations at which the chains are compared.
constexpr double kStencil = 1.5;     ///< Of the largest difference: how far beside the target to look.
constexpr double kSamePlace = 0.15;  ///< Scaled; starts closer to one that was followed lead to the same solutions.
constexpr double kWeight = 0.5;      ///< Of rotation, in units of length, as in search().
constexpr double kSingular = 2.0;    ///< Singular values below this many square roots of the difference.
constexpr double kDepth = 40.0;      ///< Differences that solutions are looked for in along a valley.
constexpr double kScatter[] = {-1.2, -0.4, -0.12, 0.12, 0.4, 1.2};  ///< Scaled; along directions about to be lost.
constexpr int kMaxIterations = 60;

/// Work on one target.
class Continuation {
 public:
  Continuation(const SerialChain& chain, const Task& task, const Pose& target, double deviation, const Watch& watch)
      : chain_(chain),
        task_(task),
        target_(target),
        watch_(watch),
        residual_(chain, task, target, kWeight * lengthUnit(chain)),
        descent_(chain, task, target, options(chain), watch_),
        valley_(residual_, descent_.box(), kDepth * deviation),
        singular_(kSingular * std::sqrt(deviation * lengthUnit(chain))) {}

  const JointBox& box() const { return descent_.box(); }
  const std::vector<VectorX>& solutions() const { return solutions_; }
  bool complete() const { return complete_; }
  /// Index of the solution that the descent from there ended at, or -1.
  int follow(const VectorX& start);
  bool wasFollowed(const VectorX& start) const;
  TaskError errorOf(const VectorX& q) const { return taskError(task_, target_, forwardKinematics(chain_, q)); }

 private:
  static DescentOptions options(const SerialChain& chain) {
    DescentOptions result;
    result.honour_limits = false;
    result.rotation_weight = kWeight * lengthUnit(chain);
    result.max_iterations = kMaxIterations;
    return result;
  }

  int descend(const VectorX& start);
  int admit(VectorX q);
  void traceFrom(const VectorX& start);
  void scatterFrom(const VectorX& start);
  MatrixX weakDirections(const VectorX& q);
  double weakest(const ConstVectorRef& q);

  const SerialChain& chain_;
  const Task& task_;
  const Pose& target_;
  const Watch& watch_;
  TaskResidual residual_;
  Descent descent_;
  Valley valley_;
  double singular_;
  TaskPoint point_;
  std::vector<VectorX> solutions_;
  std::vector<VectorX> followed_;
  bool complete_ = true;
};

int Continuation::admit(VectorX q) {
  TaskError error = errorOf(q);
  if (error.norm() > 1e-13) error = polish(chain_, task_, target_, q);
  if (!isAccepted(error)) return -1;
  box().wrapUnbounded(q);
  const int known = indexOfKnown(chain_, task_, box(), solutions_, q, error);
  if (known >= 0) return known;
  solutions_.push_back(q);
  return static_cast<int>(solutions_.size()) - 1;
}

int Continuation::descend(const VectorX& start) {
  descent_.run(start, DescentGoal::kSolution);
  return isAccepted(descent_.point().error) ? admit(descent_.point().q) : -1;
}

double Continuation::weakest(const ConstVectorRef& q) {
  point_.q = q;
  residual_.evaluate(point_);
  for (int i = 0; i < chain_.size(); ++i) point_.J.col(i) *= box().unit(i);
  return Eigen::JacobiSVD<TaskMatrix>(point_.J).singularValues().minCoeff();
}

MatrixX Continuation::weakDirections(const VectorX& q) {
  weakest(q);
  const Eigen::JacobiSVD<MatrixX> svd(MatrixX(point_.J), Eigen::ComputeFullV);
  Eigen::Index strong = 0;
  while (strong < svd.singularValues().size() && svd.singularValues()[strong] > singular_) ++strong;
  MatrixX directions = svd.matrixV().rightCols(chain_.size() - strong);
  for (int i = 0; i < chain_.size(); ++i) directions.row(i) *= box().unit(i);
  return directions;
}

void Continuation::scatterFrom(const VectorX& start) {
  const MatrixX directions = weakDirections(start);
  for (Eigen::Index k = 0; k < directions.cols() && !watch_.expired(); ++k) {
    for (double length : kScatter) {
      const VectorX moved = start + length * directions.col(k);
      descend(moved);
      for (Eigen::Index l = 0; l < k; ++l) {
        for (double other : kScatter) descend(moved + other * directions.col(l));
      }
    }
  }
}

void Continuation::traceFrom(const VectorX& start) {
  if (valley_.passes(start)) return;
  const std::size_t before = valley_.roots().size();
  const bool whole = valley_.trace(start);
  for (std::size_t i = before; i < valley_.roots().size(); ++i) admit(valley_.roots()[i]);
  if (whole) return;
  scatterFrom(start);
  complete_ = false;
}

int Continuation::follow(const VectorX& start) {
  followed_.push_back(start);
  const int found = descend(start);
  const bool singular = weakest(start) < singular_ || (found >= 0 && weakest(descent_.point().q) < singular_);
  if (found >= 0 && !singular) return found;
  if (chain_.size() == task_.size()) {
    traceFrom(start);
  } else {
    complete_ = false;
    scatterFrom(start);
  }
  return found;
}

bool Continuation::wasFollowed(const VectorX& start) const {
  const auto near = [&](const VectorX& other) { return box().distance(other, start) < kSamePlace; };
  return std::any_of(followed_.begin(), followed_.end(), near) ||
         std::any_of(solutions_.begin(), solutions_.end(), near) || valley_.passes(start);
}

/// Poses beside the target, along and about every axis of the base that the task has a row of.
std::vector<Pose> stencil(const Task& task, const Pose& target, double length, double angle) {
  std::vector<Pose> poses;
  for (int i = 0; i < task.size(); ++i) {
    const int row = task.row(i);
    for (double side : {1.0, -1.0}) {
      Pose pose = target;
      if (row < 3) {
        pose.p[row] += side * length;
      } else {
        pose.R = rotationAbout(Vector3::Unit(row - 3), side * angle) * target.R;
      }
      poses.push_back(pose);
    }
  }
  return poses;
}

std::string branchAt(const IdealSolver& solver, const SerialChain& ideal, const JointBox& box, const VectorX& q) {
  std::string branch;
  double least = std::numeric_limits<double>::infinity();
  for (const IdealSolution& solution : solver(forwardKinematics(ideal, q), q)) {
    const double distance = box.distance(solution.q, q);
    if (distance >= least) continue;
    least = distance;
    branch = solution.branch;
  }
  return branch;
}

}  // namespace

ContinuedSolver::ContinuedSolver(const SerialChain& chain, const SerialChain& ideal, const Task& task,
                                 IdealSolver solver)
    : chain_(chain), ideal_(ideal), task_(task), solver_(std::move(solver)) {
  const JointBox box(chain, false, lengthUnit(chain));
  for (int k = 1; k <= kSamples; ++k) {
    const VectorX q = box.restart(k);
    const TaskError error = taskError(task_, forwardKinematics(chain_, q), forwardKinematics(ideal_, q));
    position_deviation_ = std::max(position_deviation_, error.position);
    rotation_deviation_ = std::max(rotation_deviation_, error.orientation);
  }
}

ContinuedSolutions ContinuedSolver::solve(const Pose& target, const VectorX& preferred, double timeout) const {
  const std::function<bool()> never;
  const Watch watch(timeout, never);
  const double deviation = std::hypot(position_deviation_, kWeight * lengthUnit(chain_) * rotation_deviation_);
  Continuation continuation(chain_, task_, target, deviation, watch);
  ContinuedSolutions result;
  std::vector<bool> claimed;
  int unclaimed = 0;
  for (const IdealSolution& ideal : solver_(target, preferred)) {
    const int found = continuation.follow(ideal.q);
    if (!ideal.free.empty()) continue;
    ++result.ideal;
    claimed.resize(continuation.solutions().size(), false);
    const bool is_new = found >= 0 && !claimed[static_cast<std::size_t>(found)];
    if (is_new) claimed[static_cast<std::size_t>(found)] = true;
    if (!is_new) ++unclaimed;
  }
  for (const Pose& beside : stencil(task_, target, kStencil * position_deviation_, kStencil * rotation_deviation_)) {
    if (watch.expired()) break;
    for (const IdealSolution& ideal : solver_(beside, preferred)) {
      if (!continuation.wasFollowed(ideal.q)) continuation.follow(ideal.q);
    }
  }
  for (const VectorX& q : continuation.solutions())
    result.solutions.push_back({q, branchAt(solver_, ideal_, continuation.box(), q), continuation.errorOf(q)});
  const auto count = static_cast<int>(result.solutions.size());
  const int others = count - (result.ideal - unclaimed);
  result.vanished = std::max(0, unclaimed - others);
  result.appeared = std::max(0, others - unclaimed);
  result.timed_out = watch.expired();
  result.complete = continuation.complete() && !result.timed_out;
  return result;
}

}  // namespace screwline

#ifndef SCREWLINE_IK_NUMERICAL_DESCENT_H
#define SCREWLINE_IK_NUMERICAL_DESCENT_H

#include <chrono>
#include <functional>

#include "active_set.h"
#include "screwline/ik/numerical/numerical_solver.h"

namespace screwline {

/// When to give up: a deadline and a caller's wish, both asked every few iterations.
class Watch {
 public:
  Watch() = default;
  /// `cancelled` must outlive the watch; it may be empty.
  Watch(double timeout, const std::function<bool()>& cancelled);

  bool expired() const;

 private:
  std::chrono::steady_clock::time_point deadline_ = std::chrono::steady_clock::time_point::max();
  const std::function<bool()>* cancelled_ = nullptr;
};

/// How far a descent is worth going.
enum class DescentGoal {
  kSolution,  ///< Give up as soon as it is seen to end above the tolerance.
  kMinimum,   ///< To the local minimum, by second-order steps where the first-order ones are slow.
};

/// Descents towards one target, with their workspace; reused from start to start. First-order steps do not allocate.
class Descent {
 public:
  Descent(const SerialChain& chain, const Task& task, const Pose& target, const DescentOptions& options,
          const Watch& watch);
  Descent(const Descent&) = delete;
  Descent& operator=(const Descent&) = delete;

  /// One descent. point() is where it ends.
  void run(const ConstVectorRef& start, DescentGoal goal);

  const TaskPoint& point() const { return *current_; }
  const JointBox& box() const { return box_; }
  bool converged() const;
  DescentResult result() const;

 private:
  enum class Outcome { kSolved, kStationary, kSlow, kStopped };

  Outcome levenbergMarquardt();
  bool newtonAhead();
  double damping(double mu) const;
  bool isSlow(double cost_before);
  void refine();

  Outcome secondOrder();
  bool newtonStep(const MatrixX& vectors, const VectorX& values);
  bool escape(const MatrixX& vectors, const VectorX& values);
  MatrixX hessian();
  bool tryAlong(const VectorX& direction, double length);
  bool tryStep(const JointVector& step);
  double scaledLength(const JointVector& step) const;
  bool exhausted() const;

  TaskResidual residual_;
  JointBox box_;
  ActiveSet active_;
  DescentOptions options_;
  Watch watch_;
  TaskPoint points_[2];
  TaskPoint* current_ = &points_[0];
  TaskPoint* trial_ = &points_[1];
  int iterations_ = 0;
  int slow_steps_ = 0;
};

}  // namespace screwline

#endif  // SCREWLINE_IK_NUMERICAL_DESCENT_H

#include "screwline/ik/numerical/continued_solver.h"

#include <algorithm>
#include <cmath>

#include "descent.h"
#include "screwline/kinematics/forward.h"
#include "screwline/kinematics/singularity.h"
#include "screwline/spatial/rotation.h"
#include "screwline/spatial/svd.h"
#include "screwline/spatial/weak_directions.h"
#include "solution_set.h"
#include "valley.h"

namespace screwline {
namespace {

constexpr int kSamples = 100;              ///< Configurations at which the chains are compared.
constexpr double kStencil[] = {3.0, 0.3};  ///< Of the largest difference: how far beside the target to look.
constexpr double kSamePlace = 0.15;      ///< Scaled; starts closer to one that was followed lead to the same solutions.
constexpr double kWeight = 0.5;          ///< Of rotation, in units of length, as in search().
constexpr double kSingular = 2.0;        ///< Singular values below this many square roots of the difference.
constexpr double kAlmostSingular = 0.1;  ///< Of that.
constexpr double kShortWay = 0.2;
constexpr double kDepth = 10.0;  ///< Differences that solutions are looked for in along a valley.
constexpr double kScatter[] = {-1.2, -0.4, -0.12, 0.12, 0.4, 1.2};  ///< Scaled; along directions about to be lost.
constexpr double kScatterAgain = 0.5;  ///< Scaled; closer to where it was done before, it is not.
constexpr int kRestarts = 64;          ///< Where solutions are about to meet: for what starts beside the pose miss.
constexpr int kMaxIterations = 60;
constexpr double kGoodEnough = 1e-13;  ///< [m, rad] errors that Newton steps would not lessen.
constexpr double kExact = 1e-12;       ///< [m, rad] errors that make a solution however singular it is.
constexpr double kUncertain = 1e-3;    ///< Scaled; solutions known no better are none.
constexpr double kBeside = 1e-5;       ///< [m, rad] errors beside a solution.
constexpr double kNoValue = 1e-8;      ///< Singular values, in units of length, of what may be part of a continuum.

/// Work on one target.
class Continuation {
 public:
  Continuation(const SerialChain& chain, const Task& task, const Pose& target, const VectorX& preferred,
               double deviation, const Watch& watch)
      : chain_(chain),
        task_(task),
        target_(target),
        preferred_(preferred),
        watch_(watch),
        residual_(chain, task, target, kWeight * lengthUnit(chain)),
        descent_(chain, task, target, options(chain), watch_),
        valley_(residual_, descent_.box(), kDepth * deviation),
        singular_(kSingular * std::sqrt(deviation * lengthUnit(chain))) {}

  const JointBox& box() const { return descent_.box(); }
  const std::vector<VectorX>& solutions() const { return solutions_; }
  int freeJoint(std::size_t solution) const { return free_[solution]; }
  bool complete() const { return complete_; }
  /// Index of the solution that the descent from there ended at, or -1.
  int follow(const VectorX& start);
  bool wasFollowed(const VectorX& start) const;
  /// Whether nothing was met but solutions that are clear of each other.
  bool isPlain() const { return plain_ && !solutions_.empty(); }
  /// Descents from all over the joint space.
  void restart(int count);
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
  void probe(const VectorX& start);
  int admit(VectorX q, bool is_member = false);
  int indexOf(const VectorX& q, const TaskError& error);
  int traceFrom(const VectorX& start, bool again = false);
  void scatterFrom(const VectorX& start);
  MatrixX weakDirections(const VectorX& q);
  double weakest(const ConstVectorRef& q);
  bool isPlain(const VectorX& start, const ConstVectorRef& end);

  /// A continuum: its solution, and points along it.
  struct Ring {
    int solution;
    std::vector<JointVector> path;
  };

  const SerialChain& chain_;
  const Task& task_;
  const Pose& target_;
  const VectorX& preferred_;
  const Watch& watch_;
  TaskResidual residual_;
  Descent descent_;
  Valley valley_;
  double singular_;
  TaskPoint point_;
  std::vector<VectorX> solutions_;
  std::vector<int> free_;  ///< Of each solution; -1: isolated.
  std::vector<Ring> continua_;
  std::vector<VectorX> followed_;
  std::vector<VectorX> scattered_;
  bool complete_ = true;
  bool plain_ = true;
  bool probing_ = false;
};

int Continuation::indexOf(const VectorX& q, const TaskError& error) {
  const int known = indexOfKnown(chain_, task_, box(), solutions_, q, error);
  if (known >= 0 || continua_.empty() || weakest(q) > kNoValue * lengthUnit(chain_)) return known;
  for (const Ring& ring : continua_) {
    if (Valley::isNearAny(box(), ring.path, q)) return ring.solution;
  }
  return -1;
}

int Continuation::admit(VectorX q, bool is_member) {
  TaskError error = errorOf(q);
  if (error.norm() > kGoodEnough) error = polish(chain_, task_, target_, q);
  // Beside a singular solution much is almost one.
  if (!isAccepted(error) || (!is_member && error.norm() > kExact && error.norm() > kUncertain * weakest(q))) return -1;
  box().wrapUnbounded(q);
  const int known = indexOf(q, error);
  if (known >= 0) return known;
  solutions_.push_back(q);
  free_.push_back(-1);
  return static_cast<int>(solutions_.size()) - 1;
}

int Continuation::descend(const VectorX& start) {
  descent_.run(start, DescentGoal::kSolution);
  return isAccepted(descent_.point().error) ? admit(descent_.point().q) : -1;
}

/// A descent that may end anywhere on a continuum: of that, the one member is wanted.
void Continuation::probe(const VectorX& start) {
  descent_.run(start, DescentGoal::kSolution);
  const VectorX end = descent_.point().q;
  if (!isAccepted(descent_.point().error)) return;
  if (chain_.size() != task_.size() || weakest(end) > kNoValue * lengthUnit(chain_)) {
    admit(end);
  } else if (!probing_) {
    probing_ = true;
    traceFrom(end);
    probing_ = false;
  }
}

double Continuation::weakest(const ConstVectorRef& q) {
  point_.q = q;
  residual_.evaluate(point_);
  for (int i = 0; i < chain_.size(); ++i) point_.J.col(i) *= box().unit(i);
  if (point_.J.rows() != point_.J.cols()) return singularValues(point_.J).minCoeff();
  const SmallMatrix J = point_.J;
  const WeakDirections weak = weakDirectionsOf(J, J.norm());
  return weak.sigma[weak.sigma.size() - 1];
}

MatrixX Continuation::weakDirections(const VectorX& q) {
  weakest(q);
  const Svd svd(MatrixX(point_.J), Eigen::ComputeFullV);
  Eigen::Index strong = 0;
  while (strong < svd.singularValues().size() && svd.singularValues()[strong] > singular_) ++strong;
  MatrixX directions = svd.matrixV().rightCols(chain_.size() - strong);
  for (int i = 0; i < chain_.size(); ++i) directions.row(i) *= box().unit(i);
  return directions;
}

void Continuation::scatterFrom(const VectorX& start) {
  const bool done = std::any_of(scattered_.begin(), scattered_.end(),
                                [&](const VectorX& other) { return box().distance(other, start) < kScatterAgain; });
  if (done) return;
  scattered_.push_back(start);
  const MatrixX directions = weakDirections(start);
  for (Eigen::Index k = 0; k < directions.cols() && !watch_.expired(); ++k) {
    for (double length : kScatter) {
      const VectorX moved = start + length * directions.col(k);
      probe(moved);
      for (Eigen::Index l = 0; l < k; ++l) {
        for (double other : kScatter) probe(moved + other * directions.col(l));
      }
    }
  }
}

/// The solution of a continuum that was found, or -1.
int Continuation::traceFrom(const VectorX& start, bool again) {
  if (!again && valley_.passes(start)) return -1;
  plain_ = false;
  const std::size_t before = valley_.roots().size();
  const bool whole = valley_.trace(start);
  if (valley_.isContinuum()) {
    const int found = admit(valley_.memberNear(preferred_), true);
    if (found < 0) return -1;
    free_[static_cast<std::size_t>(found)] = valley_.freeJoint();
    continua_.push_back({found, valley_.lastPath()});
    return found;
  }
  for (std::size_t i = before; i < valley_.roots().size(); ++i) admit(valley_.roots()[i]);
  if (!whole) {
    complete_ = false;
    if (!probing_) scatterFrom(start);
  }
  return -1;
}

/// Whether the way to the solution leaves no doubt which one it is (Newton-Kantorovich: the way is short against the
/// least singular value over the second derivative).
bool Continuation::isPlain(const VectorX& start, const ConstVectorRef& end) {
  const double least = std::min(weakest(start), weakest(end));
  if (least >= singular_) return true;
  return least > kAlmostSingular * singular_ && box().distance(start, end) < kShortWay * least / lengthUnit(chain_);
}

int Continuation::follow(const VectorX& start) {
  followed_.push_back(start);
  const bool square = chain_.size() == task_.size();
  const bool first_trace = square && weakest(start) < kAlmostSingular * singular_;
  if (first_trace) {
    const int continuum = traceFrom(start);
    if (continuum >= 0) return continuum;
  }
  const int found = descend(start);
  if (found >= 0 && isPlain(start, descent_.point().q)) return found;
  if (!square) {
    complete_ = false;
    scatterFrom(start);
  } else if (!first_trace) {
    // A descent that ends beside a solution has come to the bottom of its valley.
    const bool arrived = found >= 0 || descent_.point().error.norm() < kBeside;
    const int continuum = traceFrom(arrived ? VectorX(descent_.point().q) : start, arrived && found < 0);
    if (found < 0 && continuum < 0 && arrived) complete_ = false;
    if (found < 0) return continuum;
  }
  return found;
}

void Continuation::restart(int count) {
  for (int k = 1; k <= count && !watch_.expired(); ++k) probe(box().restart(k));
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
        pose.R = rotationAbout(task.axisOf(i, target.R), side * angle) * target.R;
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
  Continuation continuation(chain_, task_, target, preferred, deviation, watch);
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
  for (double share : kStencil) {
    for (const Pose& beside : stencil(task_, target, share * position_deviation_, share * rotation_deviation_)) {
      if (watch.expired()) break;
      for (const IdealSolution& ideal : solver_(beside, preferred)) {
        if (!continuation.wasFollowed(ideal.q)) continuation.follow(ideal.q);
      }
    }
  }
  if (!continuation.isPlain()) continuation.restart(kRestarts);
  for (std::size_t i = 0; i < continuation.solutions().size(); ++i) {
    const VectorX& q = continuation.solutions()[i];
    result.solutions.push_back(
        {q, branchAt(solver_, ideal_, continuation.box(), q), continuation.freeJoint(i), continuation.errorOf(q)});
  }
  const auto count = static_cast<int>(result.solutions.size());
  const int others = count - (result.ideal - unclaimed);
  result.vanished = std::max(0, unclaimed - others);
  result.appeared = std::max(0, others - unclaimed);
  result.timed_out = watch.expired();
  // A continuum stands where ideal solutions were: those that left it may have been taken for its members.
  const bool stands_for_others =
      result.vanished > 0 && std::any_of(result.solutions.begin(), result.solutions.end(),
                                         [](const ContinuedSolution& s) { return s.free >= 0; });
  result.complete = continuation.complete() && !result.timed_out && !stands_for_others;
  return result;
}

}  // namespace screwline

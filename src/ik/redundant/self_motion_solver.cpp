#include "screwline/ik/redundant/self_motion_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "arm_curves.h"
#include "component_finder.h"
#include "curve_cut.h"
#include "curve_optimum.h"
#include "curve_tracer.h"
#include "question_seed.h"
#include "reach_margin.h"
#include "screwline/ik/numerical/numerical_solver.h"
#include "screwline/kinematics/singularity.h"
#include "usual_rank.h"

namespace screwline {
namespace {

constexpr int kStarts = 96;        // Descents where there are no slices.
constexpr int kFewStarts = 24;     // Beside slices, for curves that no margin of reach tells of.
constexpr int kRescueStarts = 64;  // Descents where slices found nothing within limits.
constexpr double kNear = 1e-6;     // [rad, lengths] A search's result is this near to the solution set at most.

std::vector<VectorX> searched(const SerialChain& chain, const SelfMotionQuestion& question, int restarts, int count,
                              bool honour_limits) {
  SearchOptions options;
  options.restarts = restarts;
  options.max_solutions = count;
  options.timeout = question.timeout;
  options.descent.honour_limits = honour_limits;
  return search(chain, Task(), question.target, {seedOf(chain, question)}, options).solutions;
}

/// Names each arc by the branch that its slice half-way has.
void nameArcs(PoseCurve& pose, const RedundantSolver& solver, const Pose& target, SelfMotionCurve& curve) {
  RedundantSolutions solutions;
  for (SelfMotionArc& arc : curve.arcs) {
    const int middle = (arc.first + arc.last) / 2;
    SelfMotionNode node;
    if (!pose.between(nodeAt(curve, middle), nodeAt(curve, middle + 1), 0.5, node)) continue;
    solver.solveAt(target, node.q[solver.parameterJoint()], node.q, solutions);
    double least = std::numeric_limits<double>::infinity();
    for (const RedundantSolution& solution : solutions) {
      const double off = pose.norm(pose.difference(solution.q, node.q));
      if (off >= least) continue;
      least = off;
      arc.branch = solver.branchName(solution);
    }
  }
}

/// Both ends of a curve along slides that are parallel, or could be.
bool isUnbounded(const SerialChain& chain, const SelfMotionCurve& curve) {
  const auto isFar = [&chain](const SelfMotionNode& node) {
    for (int i = 0; i < kRedundantJoints; ++i) {
      const double far = kFarthestSlide * chain.characteristicLength();
      if (!chain.joint(i).isRevolute() && std::abs(node.q[i]) > far) return true;
    }
    return false;
  };
  return isFar(curve.nodes.front()) && isFar(curve.nodes.back());
}

void conclude(const SerialChain& chain, bool has_slices, SelfMotionSet& set) {
  const bool broken = std::any_of(set.curves.begin(), set.curves.end(), [&](const SelfMotionCurve& curve) {
    return !curve.closed && !isUnbounded(chain, curve);
  });
  const bool crossing = std::any_of(set.curves.begin(), set.curves.end(),
                                    [](const SelfMotionCurve& curve) { return !curve.crossings.empty(); });
  if (!has_slices) {
    set.note = "curves that no start of the numerical search met are missing";
  } else if (!set.complete) {
    if (set.note.empty()) set.note = "a slice has solutions that no curve explains";
  } else if (broken) {
    set.note = "a curve could not be followed to its end";
  } else if (crossing) {
    set.note = "curves cross: each is told as it goes straight on";
  }
  set.complete = set.complete && !broken;
}

/// The curve that has the node nearest to the seed.
void putFirst(const PoseCurve& pose, const Vector7& seed, std::vector<SelfMotionCurve>& curves) {
  auto best = curves.begin();
  double least = std::numeric_limits<double>::infinity();
  for (auto curve = curves.begin(); curve != curves.end(); ++curve) {
    for (const SelfMotionNode& node : curve->nodes) {
      const double off = pose.norm(pose.difference(node.q, seed));
      if (off >= least) continue;
      least = off;
      best = curve;
    }
  }
  if (best != curves.end()) std::rotate(curves.begin(), best, best + 1);
}

bool hasInterval(const SelfMotionSet& set) {
  return std::any_of(set.curves.begin(), set.curves.end(),
                     [](const SelfMotionCurve& curve) { return !curve.intervals.empty(); });
}

}  // namespace

SelfMotionNode nodeAt(const SelfMotionCurve& curve, int index) {
  const int count = static_cast<int>(curve.nodes.size()) - 1;
  if (!curve.closed || index <= count) return curve.nodes[static_cast<std::size_t>(index)];
  const int rounds = index / count;
  SelfMotionNode node = curve.nodes[static_cast<std::size_t>(index % count)];
  node.q += rounds * (curve.nodes.back().q - curve.nodes.front().q);
  node.arc += rounds * (curve.nodes.back().arc - curve.nodes.front().arc);
  return node;
}

SelfMotionSolver::SelfMotionSolver(const SerialChain& chain)
    : chain_(chain), one_given_(RedundantSolver::compile(chain)) {
  if (one_given_) {
    const std::optional<ReachMargin> margin = ReachMargin::compile(chain, one_given_->parameterJoint());
    if (margin) margin_ = std::make_shared<const ReachMargin>(*margin);
  }
  if (const std::optional<ArmCircle> arm = ArmCircle::compile(chain)) arm_ = std::make_shared<const ArmCircle>(*arm);
  method_ = one_given_ ? one_given_->method() +
                             (arm_ ? ", self-motions by the arm angle" : ", self-motions followed along the null space")
                       : "numerical search for starts, self-motions followed along the null space";
}

std::optional<SelfMotionSolver> SelfMotionSolver::compile(const SerialChain& chain) {
  if (chain.size() != kRedundantJoints || chain.hasMimic() || usualRank(chain) < 6) return std::nullopt;
  return SelfMotionSolver(chain);
}

SelfMotionSet SelfMotionSolver::trace(const SelfMotionQuestion& question) const {
  PoseCurve pose = poseCurve(question.target);
  SelfMotionSet set;
  if (pose.arm() != nullptr) {
    set.complete = true;
    addArmCurves(pose, pose.arm(), set);
    if (question.seed.size() > 0) putFirst(pose, question.seed, set.curves);
    finish(question, pose, 0, set.curves);
    nameSheets(question.target, set.sheets);
  } else {
    follow(question, pose, set);
  }
  conclude(chain_, one_given_.has_value(), set);
  return set;
}

PoseCurve SelfMotionSolver::poseCurve(const Pose& target) const {
  if (arm_ == nullptr) return PoseCurve(chain_, target);
  const auto arm = std::make_shared<const ArmPose>(arm_, target);
  return PoseCurve(chain_, target, arm->isRegular() ? arm : nullptr);
}

/// Fills what nodes tell, of curves from one on.
void SelfMotionSolver::finish(const SelfMotionQuestion& question, PoseCurve& pose, std::size_t from,
                              std::vector<SelfMotionCurve>& curves) const {
  for (std::size_t i = from; i < curves.size(); ++i) {
    splitAtExtrema(pose, curves[i]);
    question.ignore_limits ? keepWhole(curves[i]) : cutByLimits(pose, curves[i]);
    splitAtFolds(curves[i], parameterJoint());
    if (one_given_) nameArcs(pose, *one_given_, question.target, curves[i]);
  }
}

void SelfMotionSolver::nameSheets(const Pose& target, std::vector<SelfMotionSheet>& sheets) const {
  if (!one_given_) return;
  RedundantSolutions solutions;
  for (SelfMotionSheet& sheet : sheets) {
    const Vector7& q = sheet.member;
    one_given_->solveAt(target, q[parameterJoint()], q, solutions);
    double least = std::numeric_limits<double>::infinity();
    for (const RedundantSolution& solution : solutions) {
      const double off = (0.5 * (solution.q - q)).array().sin().matrix().norm();
      if (off >= least) continue;
      least = off;
      sheet.branch = one_given_->branchName(solution);
    }
  }
}

/// Curves along the null space, from slices or from starts that are searched.
void SelfMotionSolver::follow(const SelfMotionQuestion& question, PoseCurve& pose, SelfMotionSet& set) const {
  const RedundantSolver* solver = one_given_ ? &*one_given_ : nullptr;
  ComponentFinder finder(pose, solver, question.target);
  if (question.seed.size() > 0) finder.addStart(question.seed, kNear);
  if (solver != nullptr) {
    finder.addGrid();
    finder.addChosenValues();
    if (margin_) finder.addExtrema(*margin_);
    finder.finishSheets();
    if (!margin_) {
      for (const VectorX& q : searched(chain_, question, kFewStarts, 0, false)) finder.addStart(q, kNear);
    }
  } else {
    for (const VectorX& q : searched(chain_, question, kStarts, 0, false)) finder.addStart(q, kNear);
  }
  finish(question, pose, 0, finder.curves());
  set.curves = finder.curves();
  set.sheets = finder.sheets();
  const bool found = question.ignore_limits ? !set.curves.empty() : hasInterval(set);
  if (!found && set.sheets.empty()) {
    // A curve too small for the slices, it may be.
    const std::size_t before = finder.curves().size();
    for (const VectorX& q : searched(chain_, question, kRescueStarts, 1, !question.ignore_limits)) {
      if (finder.addStart(q, kNear) || solver == nullptr) continue;
      finder.addValue(q[solver->parameterJoint()]);
      finder.finishSheets();
    }
    finish(question, pose, before, finder.curves());
    set.curves = finder.curves();
    set.sheets = finder.sheets();
  }
  set.complete = solver != nullptr && finder.unexplained() == 0;
}

VectorX SelfMotionSolver::bestMember(const SelfMotionQuestion& question, const SelfMotionCurve& curve,
                                     const SelfMotionInterval& interval, SelfMotionGoal goal) const {
  PoseCurve pose = poseCurve(question.target);
  const Vector7 seed = seedOf(chain_, question);
  if (goal == SelfMotionGoal::kNearestToSeed) {
    const SelfMotionNode node = nearestNode(pose, curve, interval, seed, question.counts, question.ignore_limits);
    return turnedTo(chain_, node.q, seed, question.ignore_limits);
  }
  Matrix6X J(6, kRedundantJoints);
  const auto limits = [&](const Vector7& q) {
    const Vector7 turned = turnedTo(chain_, q, seed, false);
    double least = 1.0;
    for (int i = 0; i < kRedundantJoints; ++i) {
      const JointLimits& limit = chain_.joint(i).limits;
      const double half = 0.5 * (limit.upper - limit.lower);
      if (std::isfinite(half) && half > 0.0)
        least = std::min(least, std::min(turned[i] - limit.lower, limit.upper - turned[i]) / half);
    }
    return least;
  };
  const auto singular = [&](const Vector7& q) {
    geometricJacobian(chain_, q, J);
    const VectorX values = singularValues(J);
    return goal == SelfMotionGoal::kMostManipulable ? values.prod() : values.minCoeff();
  };
  const SelfMotionNode node = goal == SelfMotionGoal::kFarthestFromLimits
                                  ? largestNode(pose, curve, interval, limits)
                                  : largestNode(pose, curve, interval, singular);
  return turnedTo(chain_, node.q, seed, question.ignore_limits);
}

}  // namespace screwline

#include <algorithm>
#include <bitset>
#include <cmath>
#include <limits>

#include "component_finder.h"
#include "screwline/ik/numerical/numerical_solver.h"

namespace screwline {
namespace {

constexpr double kRegular = 1e-6;        // Gain of a node from which a curve can be followed.
constexpr double kBlurredGain = 1e-11;   // Below it curves are known to 1e-3 rad at best.
constexpr std::size_t kMostPoints = 16;  // Solutions without a curve that are told.
constexpr double kSameSolution = 4e-6;   // [rad] Solutions this near to each other have one answer.

bool sameBranch(const RedundantSolution& a, const RedundantSolution& b) {
  return a.free == b.free && a.sign == b.sign && a.rank == b.rank;
}

/// Free joints but the parameter joint, as bits.
unsigned freeOf(const SelfMotionSheet& sheet) {
  unsigned mask = 0;
  for (std::size_t i = sheet.parameter_moves ? 1 : 0; i < sheet.free.size(); ++i) mask |= 1U << sheet.free[i];
  return mask;
}

bool covers(const SelfMotionSheet& sheet, unsigned free) {
  return (free & ~freeOf(sheet)) == 0U;
}

}  // namespace

void ComponentFinder::addSheet(const RedundantSolution& told, bool parameter_moves) {
  const int parameter = solver_->parameterJoint();
  const RedundantSolution member = parameter_moves ? told : refined(told);
  SelfMotionSheet sheet;
  sheet.member = member.q;
  sheet.parameter_moves = parameter_moves;
  if (parameter_moves) sheet.free.push_back(parameter);
  for (int i = 0; i < kRedundantJoints; ++i) {
    if ((member.free >> i & 1U) != 0U) sheet.free.push_back(i);
  }
  sheet.branch = solver_->branchName(member);
  const bool known = std::any_of(sheets_.begin(), sheets_.end(), [&](const SelfMotionSheet& other) {
    if (other.free == sheet.free && !parameter_moves)
      return pose_.norm(pose_.difference(other.member, sheet.member)) <= kSamePoint;
    // One value of the parameter on a sheet that covers all values.
    return !parameter_moves && other.parameter_moves && covers(other, member.free);
  });
  if (known) return;
  if (!parameter_moves && !isAlone(sheet)) ++unexplained_;
  sheet.member_at = membersOf(member, parameter_moves);
  sheets_.push_back(sheet);
}

/// By the closed form, at the parameter's wished value or the member's own.
std::function<bool(const VectorX&, VectorX&)> ComponentFinder::membersOf(const RedundantSolution& member,
                                                                         bool parameter_moves) {
  if (held_ == nullptr) held_ = std::make_shared<const RedundantSolver>(*solver_);
  return [solver = held_, target = target_, member, parameter_moves](const VectorX& wished, VectorX& q) {
    const int parameter = solver->parameterJoint();
    RedundantSolutions solutions;
    solver->solveAt(target, parameter_moves ? wished[parameter] : member.q[parameter], wished, solutions);
    double least = std::numeric_limits<double>::infinity();
    for (const RedundantSolution& solution : solutions) {
      if (!sameBranch(solution, member)) continue;
      double off = 0.0;
      for (int i = 0; i < kRedundantJoints; ++i) off += std::abs(std::sin(0.5 * (solution.q[i] - wished[i])));
      if (off >= least) continue;
      least = off;
      q = solution.q;
    }
    return std::isfinite(least);
  };
}

/// A solution at which no curve can be followed: too near to a singularity.
void ComponentFinder::addPoint(const RedundantSolution& solution) {
  if (sheets_.size() < kMostPoints) addSheet(solution, false);
}

/// Whether nothing but the sheet itself solves the pose beside a member of it, to second order: across it the error has
/// a definite form. A definite form beside a point leaves an ellipse, of a size that the gain tells.
bool ComponentFinder::isAlone(const SelfMotionSheet& sheet) {
  if (sheet.free.size() > 1) return true;
  const PoseCurve::SecondOrder form = pose_.secondOrder(sheet.member);
  if (sheet.free.size() == 1) return std::abs(form.values[1]) > kLeastForm;
  return form.values[0] * form.values[1] > 0.0 && std::abs(form.values[0]) > kLeastForm &&
         form.gain <= kSameSolution * std::abs(form.values[0]);
}

/// The value of the parameter at which a continuum exists, and a member there, to rounding: Newton's method of least
/// norm moves the parameter as well.
RedundantSolution ComponentFinder::refined(const RedundantSolution& member) const {
  VectorX q = member.q;
  polish(pose_.chain(), Task(), target_, q);
  RedundantSolutions solutions;
  solver_->solveAt(target_, q[solver_->parameterJoint()], member.q, solutions);
  for (const RedundantSolution& solution : solutions) {
    if (sameBranch(solution, member) && pose_.norm(pose_.difference(solution.q, member.q)) < kSliceReach)
      return solution;
  }
  return member;
}

/// A continuum at one value of the parameter: a curve like others, if the Jacobian sees it.
void ComponentFinder::addFree(const Free& free) {
  const int joint = [&] {
    int i = 0;
    while ((free.solution.free >> i & 1U) == 0U) ++i;
    return i;
  }();
  RedundantSolutions members;
  bool found = false;
  bool blurred = false;
  for (double value : {0.3, 1.9, -1.2, 2.6, -2.8, 1.1, -0.4, -1.9}) {
    Vector7 wished = Vector7::Zero();
    wished[joint] = value;
    solver_->solveAt(target_, free.solution.q[solver_->parameterJoint()], wished, members);
    for (const RedundantSolution& member : members) {
      if (!sameBranch(member, free.solution)) continue;
      // Where the error has no second order either, a surface solves the pose within rounding, and curves to rounding
      // are anywhere on it: several starts are tried, and no number of them is enough where rounding blurs the curves.
      const PoseCurve::SecondOrder form = pose_.secondOrder(member.q);
      const bool surface = form.is_known && std::abs(form.values[1]) <= kLeastForm;
      const double reach = surface ? kPi : kSliceReach;
      SelfMotionNode node;
      if (!pose_.correct(member.q, reach, node) || !(surface || node.gain > kRegular)) continue;
      if (!addStart(node.q, reach)) continue;
      if (!surface) return;
      found = true;
      blurred = blurred || node.gain < kBlurredGain;
    }
  }
  if (blurred) ++unexplained_;
  if (!found) addSheet(free.solution, false);
}

void ComponentFinder::finishSheets() {
  // The more joints are free, the earlier: where rounding decides between them, the larger continuum holds the others.
  std::stable_sort(free_.begin(), free_.end(), [](const Free& a, const Free& b) {
    return std::bitset<32>(a.solution.free).count() > std::bitset<32>(b.solution.free).count();
  });
  std::vector<bool> done(free_.size(), false);
  for (std::size_t i = 0; i < free_.size(); ++i) {
    if (done[i]) continue;
    const unsigned mask = free_[i].solution.free;
    const bool held = std::any_of(sheets_.begin(), sheets_.end(), [&](const SelfMotionSheet& sheet) {
      return sheet.parameter_moves && mask != freeOf(sheet) && covers(sheet, mask);
    });
    if (held) continue;
    // Slices of the grid on the same branch are one sheet.
    bool parameter_moves = false;
    for (std::size_t k = i + 1; k < free_.size() && free_[i].slice >= 0; ++k) {
      if (free_[k].slice < 0 || free_[k].slice == free_[i].slice || !sameBranch(free_[k].solution, free_[i].solution))
        continue;
      done[k] = true;
      parameter_moves = true;
    }
    if (parameter_moves) {
      addSheet(free_[i].solution, true);
    } else {
      addFree(free_[i]);
    }
  }
  free_.clear();
}

}  // namespace screwline

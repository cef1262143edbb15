#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <limits>

#include "component_finder.h"
#include "screwline/ik/numerical/numerical_solver.h"
#include "screwline/spatial/rotation.h"
#include "screwline/spatial/screw.h"

namespace screwline {
namespace {

constexpr double kRegular = 1e-6;        // Gain of a node from which a curve can be followed.
constexpr double kMostError = 1e-10;     // Of a surface's members.
constexpr int kSurfaceSamples = 6;       // Of each turn.
constexpr int kSteps = 2;                // Of Newton's method: from a tangent plane.
constexpr double kOnSurface = 1e-6;      // [rad]
constexpr double kWeak = 1e-6;           // Of the strongest direction: not stepped along.
constexpr std::size_t kMostPoints = 16;  // Solutions without a curve that are told.
constexpr double kSameSolution = 4e-6;   // [rad] Solutions this near to each other have one answer.

/// A surface along which the pose is met to rounding or little more: all members with wished values of two joints.
class Surface {
 public:
  /// `plane` is tangent to it at `base`. The two joints are those that turn most along it.
  Surface(const SerialChain& chain, const Pose& target, const Vector7& base,
          const Eigen::Matrix<double, kRedundantJoints, 2>& plane)
      : chain_(chain), target_(target), base_(base) {
    double most = 0.0;
    for (int i = 0; i < kRedundantJoints; ++i) {
      for (int k = i + 1; k < kRedundantJoints; ++k) {
        Eigen::Matrix2d rows;
        rows << plane.row(i), plane.row(k);
        if (std::abs(rows.determinant()) <= most) continue;
        most = std::abs(rows.determinant());
        free_ = {i, k};
        along_ = plane * rows.inverse();
      }
    }
  }

  const std::array<int, 2>& free() const { return free_; }

  /// From the tangent plane by Newton steps of the five other joints. False where an error is left.
  bool at(const Vector7& wished, Vector7& q) const {
    q = base_ + along_ * Eigen::Vector2d(wished[free_[0]] - base_[free_[0]], wished[free_[1]] - base_[free_[1]]);
    Matrix6X J(6, kRedundantJoints);
    for (int i = 0;; ++i) {
      Vector6 error = poseDifference(target_, geometricJacobian(chain_, q, J));
      error.head<3>() /= chain_.characteristicLength();
      if (i == kSteps) return error.norm() <= kMostError;
      J.topRows<3>() /= chain_.characteristicLength();
      for (int joint : free_) J.col(joint).setZero();
      Eigen::ColPivHouseholderQR<Matrix6X> qr;
      qr.setThreshold(kWeak);
      q += qr.compute(J).solve(error);
    }
  }

  /// Whether it comes round in both turns.
  bool isWhole() const {
    Vector7 wished = base_;
    Vector7 q;
    for (int i = 0; i < kSurfaceSamples * kSurfaceSamples; ++i) {
      wished[free_[0]] = base_[free_[0]] + kTwoPi * (i % kSurfaceSamples) / kSurfaceSamples;
      wished[free_[1]] = base_[free_[1]] + kTwoPi * (i / kSurfaceSamples) / kSurfaceSamples;
      if (!at(wished, q)) return false;
    }
    return true;
  }

 private:
  SerialChain chain_;
  Pose target_;
  Vector7 base_;
  std::array<int, 2> free_{0, 1};
  Eigen::Matrix<double, kRedundantJoints, 2> along_;  ///< Rates of all joints by the two.
};

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
  if (sheet.free.size() == 1) return std::abs(form.values[1]) > PoseCurve::kLeastForm;
  return form.values[0] * form.values[1] > 0.0 && std::abs(form.values[0]) > PoseCurve::kLeastForm &&
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

/// Where a surface solves the pose within rounding, curves to rounding are anywhere on it: it is told as a surface, if
/// it goes on as it starts.
bool ComponentFinder::addSurface(const Vector7& q) {
  const auto holds = [&](const SelfMotionSheet& sheet) {
    VectorX member;
    return sheet.free.size() == 2 && !sheet.parameter_moves && sheet.member_at(q, member) &&
           pose_.norm(pose_.difference(member, q)) <= kOnSurface;
  };
  if (std::any_of(sheets_.begin(), sheets_.end(), holds)) return true;
  const PoseCurve::SecondOrder form = pose_.secondOrder(q);
  if (!form.isSurface()) return false;
  const Surface surface(pose_.chain(), target_, q, form.plane);
  if (!surface.isWhole()) return false;
  SelfMotionSheet sheet;
  sheet.member = q;
  sheet.free = {surface.free()[0], surface.free()[1]};
  sheet.member_at = [surface](const VectorX& wished, VectorX& member) {
    Vector7 found;
    if (!surface.at(wished, found)) return false;
    member = found;
    return true;
  };
  sheets_.push_back(sheet);
  return true;
}

/// A continuum at one value of the parameter: a curve like others, if the Jacobian sees it; or a surface.
void ComponentFinder::addFree(const Free& free) {
  int joint = 0;
  while ((free.solution.free >> joint & 1U) == 0U) ++joint;
  const auto follow = [this](const RedundantSolution& member) {
    SelfMotionNode node;
    if (addSurface(member.q)) return true;
    return pose_.correct(member.q, kSliceReach, node) && node.gain > kRegular && addStart(node.q, kSliceReach);
  };
  if (follow(free.solution)) return;
  RedundantSolutions members;
  for (double value : {0.3, 1.9, -1.2, 2.6}) {
    Vector7 wished = Vector7::Zero();
    wished[joint] = value;
    solver_->solveAt(target_, free.solution.q[solver_->parameterJoint()], wished, members);
    for (const RedundantSolution& member : members) {
      if (sameBranch(member, free.solution) && follow(member)) return;
    }
  }
  addSheet(free.solution, false);
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

#include "component_finder.h"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <limits>

#include "curve_tracer.h"
#include "screwline/ik/numerical/numerical_solver.h"

namespace screwline {
namespace {

constexpr int kSlices = 256;
constexpr int kFewSlices = 64;           // Of a slide, and where each one compiles a closed form.
constexpr double kShift = 0.0137;        // Slices avoid the values that people choose.
constexpr double kSamePoint = 1e-6;      // [rad] A configuration this near to a curve is on it.
constexpr double kRounding = 1e-13;      // Of residuals; over the gain, of solutions.
constexpr double kCubicError = 2e-3;     // [rad] of the uncorrected curve between nodes, many times over.
constexpr double kSliceReach = 1e-3;     // [rad] A slice's solution is this near to the curve at most.
constexpr double kSameSolution = 4e-6;   // [rad] Solutions this near to each other have one answer.
constexpr double kLeastForm = 1e-4;      // Of second derivatives over the chain's length: below it they are none.
constexpr double kBlurredGain = 1e-11;   // Below it curves are known to 1e-3 rad at best.
constexpr double kRegular = 1e-6;        // Gain of a node from which a curve can be followed.
constexpr std::size_t kMostPoints = 16;  // Solutions without a curve that are told.
constexpr std::size_t kMostCrossings = 32;
constexpr double kSameCrossing = 1e-3;  // [rad]
constexpr int kCrossingWays = 12;       // Directions in the plane of a crossing's tangents, half a turn of them.
constexpr double kCrossingStep = 0.02;  // [rad] from the crossing, where its branches are apart.
constexpr double kFarthestSlide = 4.0;  // [lengths] Where a slide has no limits.

/// Share at which the cubic's coordinate has a value between those of its ends.
double shareAt(const SelfMotionNode& a, const SelfMotionNode& b, int joint, double value) {
  const double h = b.arc - a.arc;
  const auto coordinate = [&](double s) {
    const double r = 1.0 - s;
    return r * r * (1.0 + 2.0 * s) * a.q[joint] + s * s * (1.0 + 2.0 * r) * b.q[joint] +
           h * s * r * (r * a.tangent[joint] - s * b.tangent[joint]);
  };
  double low = 0.0;
  double high = 1.0;
  for (int i = 0; i < 30; ++i) {
    const double middle = 0.5 * (low + high);
    ((coordinate(middle) < value) == (a.q[joint] < b.q[joint]) ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

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

double distanceToCurve(PoseCurve& pose, const SelfMotionCurve& curve, const Vector7& q, double reach) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < curve.nodes.size(); ++i) {
    const SelfMotionNode& a = curve.nodes[i];
    const SelfMotionNode& b = curve.nodes[i + 1];
    const double h = b.arc - a.arc;
    const Vector7 from = pose.difference(a.q, q);
    if (h <= 0.0 || pose.norm(from) > 1.1 * h + reach) continue;
    double share = std::clamp(pose.dot(from, a.tangent) / h, 0.0, 1.0);
    SelfMotionNode node = a;
    for (int k = 0; k < 6; ++k) {
      if (!pose.between(a, b, share, node)) break;
      const double step = pose.dot(pose.difference(node.q, q), node.tangent) / h;
      const double next = std::clamp(share + step, 0.0, 1.0);
      if (std::abs(next - share) < 1e-14) break;
      share = next;
    }
    least = std::min(least, pose.norm(pose.difference(node.q, q)));
  }
  return least <= reach ? least : std::numeric_limits<double>::infinity();
}

ComponentFinder::ComponentFinder(PoseCurve& pose, const RedundantSolver* solver, const Pose& target)
    : pose_(pose), solver_(solver), target_(target) {
  if (solver == nullptr) return;
  const int joint = solver->parameterJoint();
  slices_ = solver->compiledOnce() && pose.isRevolute(joint) ? kSlices : kFewSlices;
  if (pose.isRevolute(joint)) {
    step_ = kTwoPi / slices_;
    first_ = -kPi + kShift;
    return;
  }
  const JointLimits& limits = pose.chain().joint(joint).limits;
  const double far = kFarthestSlide * pose.chain().characteristicLength() + target.p.norm();
  first_ = std::max(limits.lower, -far);
  const double last = std::max(first_, std::min(limits.upper, far));
  step_ = std::max((last - first_) / slices_, 1e-9);
  first_ += 0.5 * step_;
}

void ComponentFinder::addGrid() {
  grid_.resize(static_cast<std::size_t>(slices_));
  covered_.assign(static_cast<std::size_t>(slices_), 0U);
  for (int slice = 0; slice < slices_; ++slice)
    solver_->solveAt(target_, first_ + slice * step_, Vector7::Zero(), grid_[static_cast<std::size_t>(slice)]);
  for (int slice = 0; slice < slices_; ++slice) {
    const auto i = static_cast<std::size_t>(slice);
    for (int k = 0; k < grid_[i].count; ++k) {
      const RedundantSolution& solution = grid_[i].solutions[static_cast<std::size_t>(k)];
      if (solution.free != 0U) {
        free_.push_back({slice, solution});
      } else if ((covered_[i] >> k & 1U) == 0U && !addStart(solution.q, kSliceReach)) {
        addPoint(solution);
      }
    }
  }
}

void ComponentFinder::addExtrema(const ReachMargin& margin) {
  for (double value : margin.maxima(target_, first_, first_ + slices_ * step_, slices_)) addValue(value);
}

void ComponentFinder::addValue(double value) {
  RedundantSolutions solutions;
  solver_->solveAt(target_, value, Vector7::Zero(), solutions);
  for (const RedundantSolution& solution : solutions) {
    if (solution.free != 0U) {
      free_.push_back({-1, solution});
    } else if (!addStart(solution.q, kSliceReach)) {
      addPoint(solution);
    }
  }
}

bool ComponentFinder::addStart(const Vector7& q, double reach) {
  SelfMotionNode node;
  if (!pose_.correct(q, reach, node)) return false;
  // Near a singularity rounding leaves open where across the curve a solution lies.
  const double same = std::clamp(kRounding / node.gain, kSamePoint, kSliceReach);
  for (const SelfMotionCurve& curve : curves_) {
    if (distanceToCurve(pose_, curve, node.q, 0.05) <= same) return true;
  }
  SelfMotionCurve curve;
  if (!traceCurve(pose_, node.q, curve)) return false;
  coverGrid(curve);
  const std::vector<Vector7> crossings = curve.crossings;
  curves_.push_back(std::move(curve));
  for (const Vector7& crossing : crossings) branchOut(crossing);
  return true;
}

/// Where curves cross, the Jacobian has one dimension less: tangents of all of them lie in the plane that it
/// annihilates. A curve along which the parameter stands still is met by no slice, but crosses another.
void ComponentFinder::branchOut(const Vector7& crossing) {
  const bool known = std::any_of(crossings_.begin(), crossings_.end(), [&](const Vector7& other) {
    return pose_.norm(pose_.difference(other, crossing)) <= kSameCrossing;
  });
  if (known || crossings_.size() >= kMostCrossings) return;
  crossings_.push_back(crossing);
  const PoseCurve::SecondOrder form = pose_.secondOrder(crossing);
  const double size = std::abs(form.values[0]);
  if (form.is_known && size > kLeastForm) {
    // Two curves cross where the form is zero.
    if (form.values[0] * form.values[1] > 0.0) return;
    const double share = std::sqrt(size / (size + std::abs(form.values[1])));
    for (double sign : {1.0, -1.0}) {
      const Vector7 way = std::sqrt(1.0 - share * share) * form.vectors.col(0) + sign * share * form.vectors.col(1);
      for (double step : {kCrossingStep, -kCrossingStep}) addStart(crossing + step * way, kCrossingStep);
    }
    return;
  }
  // A surface within rounding has curves everywhere.
  if (form.is_known && std::abs(form.values[1]) <= kLeastForm) return;
  const Eigen::Matrix<double, kRedundantJoints, 2> plane = pose_.weakestPlane(crossing);
  for (int k = 0; k < 2 * kCrossingWays; ++k) {
    const double angle = kPi * k / kCrossingWays;
    const Vector7 way = std::cos(angle) * plane.col(0) + std::sin(angle) * plane.col(1);
    addStart(crossing + kCrossingStep * way, kCrossingStep);
  }
}

void ComponentFinder::coverGrid(const SelfMotionCurve& curve) {
  if (grid_.empty()) return;
  const int joint = solver_->parameterJoint();
  const bool turns = pose_.isRevolute(joint);
  for (std::size_t i = 0; i + 1 < curve.nodes.size(); ++i) {
    const SelfMotionNode& a = curve.nodes[i];
    const SelfMotionNode& b = curve.nodes[i + 1];
    const double low = std::min(a.q[joint], b.q[joint]);
    const double high = std::max(a.q[joint], b.q[joint]);
    for (double k = std::ceil((low - first_) / step_); first_ + k * step_ <= high; k += 1.0) {
      if (!turns && (k < 0.0 || k >= slices_)) continue;
      const auto slice = static_cast<std::size_t>(k - slices_ * std::floor(k / slices_));
      const Vector7 q = cubicBetween(a, b, shareAt(a, b, joint, first_ + k * step_));
      double least = kCubicError;
      int nearest = -1;
      for (int n = 0; n < grid_[slice].count; ++n) {
        const double off = pose_.norm(pose_.difference(grid_[slice].solutions[static_cast<std::size_t>(n)].q, q));
        if (off >= least) continue;
        least = off;
        nearest = n;
      }
      if (nearest >= 0) covered_[slice] |= 1U << nearest;
    }
  }
}

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

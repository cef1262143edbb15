#include "component_finder.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "curve_tracer.h"
#include "local_conic.h"

namespace screwline {
namespace {

constexpr int kSlices = 256;
constexpr int kFewSlices = 64;        // Where each one compiles a closed form.
constexpr double kShift = 0.0137;     // Slices avoid the values that people choose.
constexpr double kRounding = 1e-13;   // Of residuals; over the gain, of solutions.
constexpr double kCubicError = 2e-3;  // [rad] of the uncorrected curve between nodes, many times over.
constexpr std::size_t kMostCrossings = 32;
constexpr std::size_t kMostNodes = 5000;  // Of all curves: bounds the time where rounding leaves their course open.
constexpr double kSmallLoop = 0.01;       // [rad] of arc.
constexpr double kFirmGain = 1e-3;        // Of the third weakest direction.
constexpr double kSameCrossing = 1e-3;    // [rad]
constexpr int kCrossingWays = 12;         // Directions in the plane of a crossing's tangents, half a turn of them.
constexpr double kCrossingStep = 0.02;    // [rad] from the crossing, where its branches are apart.
constexpr double kUsualSlide = 4.0;       // [lengths] Where a slide has no limits.

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

using Range = std::pair<double, double>;

/// Values of a slide at an end of the chain between which the six others can reach the target, if they are turns: the
/// point of the axis next to it (or of the first axis, where the slide is the last) stays within the sum of the lengths
/// between the axes. Elsewhere a range that is wide enough for usual arms.
Range rangeOfSlide(const SerialChain& chain, int joint, const Pose& target) {
  const double far = kUsualSlide * chain.characteristicLength() + target.p.norm();
  const bool first = joint == 0;
  if (!first && joint != kRedundantJoints - 1) return {-far, far};
  const auto axis = [&](int i) { return chain.axes()[static_cast<std::size_t>(first ? i + 1 : i)]; };
  for (int i = 0; i + 1 < kRedundantJoints; ++i) {
    if (axis(i).prismatic) return {-far, far};
  }
  double reach = 0.0;
  for (int i = 0; i + 1 < kRedundantJoints - 1; ++i) reach += (axis(i + 1).point - axis(i).point).norm();
  // Where the slide has to bring one point for another to be met.
  const Vector3 tip = chain.home().p;
  const Vector3 last = axis(kRedundantJoints - 2).point;
  reach += (tip - last).norm();
  const Vector3& slide = chain.axes()[static_cast<std::size_t>(joint)].direction;
  const Vector3 direction = first ? slide : Vector3(target.R * (chain.home().R.transpose() * slide));
  const Vector3 gap = target.p - axis(0).point;
  const double middle = gap.dot(direction);
  const double half = std::sqrt(std::max(0.0, reach * reach - (gap - middle * direction).squaredNorm()));
  return {middle - half, middle + half};
}

}  // namespace

double distanceToCurve(PoseCurve& pose, const SelfMotionCurve& curve, const Vector7& q, double reach) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < curve.nodes.size(); ++i) {
    const SelfMotionNode& a = curve.nodes[i];
    const SelfMotionNode& b = curve.nodes[i + 1];
    const double h = b.arc - a.arc;
    const Vector7 from = pose.difference(a.q, q);
    const double away = pose.norm(from);
    if (h <= 0.0 || away > 1.1 * h + reach) {
      // Nor is what ends before the curve can have come so far.
      while (i + 2 < curve.nodes.size() && 1.1 * (curve.nodes[i + 2].arc - a.arc) < away - reach) ++i;
      continue;
    }
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
  slices_ = solver->compiledOnce() ? kSlices : kFewSlices;
  if (pose.isRevolute(joint)) {
    step_ = kTwoPi / slices_;
    first_ = -kPi + kShift;
    return;
  }
  const JointLimits& limits = pose.chain().joint(joint).limits;
  const Range range = rangeOfSlide(pose.chain(), joint, target);
  first_ = std::max(limits.lower, range.first);
  const double last = std::max(first_, std::min(limits.upper, range.second));
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

/// A curve along which the parameter stands still does so at a value that people choose: what is at right angles, or
/// meant to be as the target says.
void ComponentFinder::addChosenValues() {
  const bool turns = pose_.isRevolute(solver_->parameterJoint());
  for (double value : {0.0, 0.5 * kPi, kPi, -0.5 * kPi}) {
    if (turns || value == 0.0) addValue(value);
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
  if (node.gain <= kSurfaceGain && addSurface(node.q)) return true;
  // Near a singularity rounding leaves open where across the curve a solution lies.
  const double same = std::clamp(kRounding / node.gain, kSamePoint, kSliceReach);
  for (const SelfMotionCurve& curve : curves_) {
    if (distanceToCurve(pose_, curve, node.q, 0.05) <= same) return true;
  }
  if (nodes_ > kMostNodes) {
    ++unexplained_;
    return true;
  }
  SelfMotionCurve curve;
  if (!traceCurve(pose_, node.q, curve)) return false;
  nodes_ += curve.nodes.size();
  // A small loop is almost a point; where a third direction is weak, another may lie between the same slices.
  const bool small = curve.nodes.back().arc < kSmallLoop;
  if (small && pose_.secondOrder(curve.nodes.front().q).next_gain < kFirmGain) ++unexplained_;
  coverGrid(curve);
  std::vector<Vector7> crossings = curve.crossings;
  for (const Vector7& near : nearCrossings(pose_, curve)) crossings.push_back(near);
  curves_.push_back(std::move(curve));
  for (const Vector7& crossing : crossings) branchOut(crossing);
  return true;
}

/// Where curves cross, or almost do, the Jacobian has one dimension less: tangents of all of them lie in the plane that
/// it annihilates. A curve along which the parameter stands still is met by no slice, but crosses another.
void ComponentFinder::branchOut(const Vector7& crossing) {
  const bool known = std::any_of(crossings_.begin(), crossings_.end(), [&](const Vector7& other) {
    return pose_.norm(pose_.difference(other, crossing)) <= kSameCrossing;
  });
  if (known || crossings_.size() >= kMostCrossings) return;
  crossings_.push_back(crossing);
  const PoseCurve::SecondOrder form = pose_.secondOrder(crossing);
  const double size = std::abs(form.values[0]);
  if (form.is_known && size > PoseCurve::kLeastForm) {
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
  if (form.isSurface()) return;
  for (int k = 0; k < 2 * kCrossingWays; ++k) {
    const double angle = kPi * k / kCrossingWays;
    const Vector7 way = std::cos(angle) * form.plane.col(0) + std::sin(angle) * form.plane.col(1);
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

}  // namespace screwline

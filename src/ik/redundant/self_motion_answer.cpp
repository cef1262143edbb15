#include <algorithm>
#include <cmath>
#include <limits>

#include "../continuum.h"
#include "curve_cut.h"
#include "curve_optimum.h"
#include "question_seed.h"
#include "screwline/ik/numerical/numerical_solver.h"
#include "screwline/ik/redundant/self_motion_solver.h"

namespace screwline {
namespace {

constexpr double kMoves = 1e-7;         // Of a tangent, or of a range: a joint that moves less does not move.
constexpr double kBand = 1e-9;          // [rad, m] within which limits are decided.
constexpr double kExact = 1e-12;        // [m, rad] errors that need no polish.
constexpr double kTolerated = 1e-10;    // [m, rad] errors where nothing better can be had.
constexpr double kSingularGain = 1e-9;  // Of the Jacobian's pivots.
constexpr double kAside = 0.3;          // [rad] from a place of a surface where it may have no member.

bool isWithinAll(const SerialChain& chain, const Vector7& q) {
  for (int i = 0; i < kRedundantJoints; ++i) {
    const JointLimits& limits = chain.joint(i).limits;
    if (q[i] < limits.lower - kBand || q[i] > limits.upper + kBand) return false;
  }
  return true;
}

/// Ranges of the joints over an interval, in the turns of the answer.
void describeRange(const SerialChain& chain, const SelfMotionCurve& curve, const SelfMotionInterval& interval,
                   const Vector7& shift, bool ignore_limits, SelfMotionAnswer& answer) {
  Vector7 lower = answer.q;
  Vector7 upper = answer.q;
  Vector7 tangent = Vector7::Zero();
  for (int i = interval.first; i <= interval.last; ++i) {
    const SelfMotionNode node = nodeAt(curve, i);
    lower = lower.cwiseMin(node.q + shift);
    upper = upper.cwiseMax(node.q + shift);
    tangent = tangent.cwiseMax(node.tangent.cwiseAbs());
  }
  std::vector<double> low;
  std::vector<double> high;
  for (int i = 0; i < kRedundantJoints; ++i) {
    if (tangent[i] <= kMoves) continue;
    const JointLimits& limits = chain.joint(i).limits;
    answer.free_joints.push_back(i);
    low.push_back(ignore_limits ? lower[i] : std::max(lower[i], limits.lower));
    high.push_back(ignore_limits ? upper[i] : std::min(upper[i], limits.upper));
  }
  answer.lower = Eigen::Map<VectorX>(low.data(), static_cast<Eigen::Index>(low.size()));
  answer.upper = Eigen::Map<VectorX>(high.data(), static_cast<Eigen::Index>(high.size()));
}

/// Parts of the arcs that the interval covers, and the branch of the node at an index.
void describeArcs(const SelfMotionCurve& curve, const SelfMotionInterval& interval, int parameter, double shift,
                  double arc_at, SelfMotionAnswer& answer) {
  const int count = static_cast<int>(curve.nodes.size()) - 1;
  for (int round = curve.closed ? -1 : 0; round <= (curve.closed ? 1 : 0); ++round) {
    for (const SelfMotionArc& arc : curve.arcs) {
      const int first = std::max(interval.first, arc.first + round * count);
      const int last = std::min(interval.last, arc.last + round * count);
      if (first > last || (first == last && interval.first != interval.last)) continue;
      const SelfMotionNode a = nodeAt(curve, first);
      const SelfMotionNode b = nodeAt(curve, last);
      if (answer.branch.empty() || (arc_at > a.arc && arc_at <= b.arc)) answer.branch = arc.branch;
      if (parameter >= 0) answer.parameter.push_back({arc.branch, a.q[parameter] + shift, b.q[parameter] + shift});
    }
  }
}

SelfMotionAnswer answerOf(PoseCurve& pose, const SelfMotionCurve& curve, const SelfMotionInterval& interval,
                          const SelfMotionQuestion& question, const Vector7& seed, int parameter) {
  const SerialChain& chain = pose.chain();
  const bool ignore_limits = question.ignore_limits;
  const SelfMotionNode node = nearestNode(pose, curve, interval, seed, question.counts, ignore_limits);
  SelfMotionAnswer answer;
  answer.traced = true;
  const Vector7 q = turnedTo(chain, node.q, seed, ignore_limits);
  answer.q = q;
  answer.distance = question.counts.cwiseProduct(q - seed).norm();
  answer.within_limits = isWithinAll(chain, q);
  answer.singular = node.gain <= kSingularGain;
  answer.self_motion = node.tangent.normalized().transpose();
  const Vector7 shift = q - node.q;
  describeRange(chain, curve, interval, shift, ignore_limits, answer);
  describeArcs(curve, interval, parameter, parameter >= 0 ? shift[parameter] : 0.0, node.arc, answer);
  return answer;
}

/// As continua inside of a plan are described. Where a sum of angles is given, the member with the seed's other values
/// is in its best turn; or one beside it, where there is none.
Candidate candidateOf(const SelfMotionSheet& sheet, const Vector7& seed) {
  Candidate candidate;
  candidate.q = sheet.member;
  for (double aside : {0.0, kAside}) {
    VectorX wished = seed;
    for (int joint : sheet.free) wished[joint] += aside;
    if (sheet.free.size() > 1 && sheet.member_at(wished, candidate.q)) break;
  }
  candidate.branch = sheet.branch;
  candidate.free = sheet.free;
  candidate.member = sheet.member_at;
  return candidate;
}

/// The closed form joins what rounding cannot tell from a double root: its members are off by the root of that at most.
void refine(const SerialChain& chain, const Pose& target, bool ignore_limits, VectorX& q) {
  const auto errorOf = [&] { return taskError(Task(), target, forwardKinematics(chain, q)).norm(); };
  if (errorOf() <= kExact || polish(chain, Task(), target, q).norm() <= kExact) return;
  DescentOptions options;
  options.honour_limits = !ignore_limits;
  options.tolerance = kTolerated;
  const DescentResult descent = descend(chain, Task(), target, q, options);
  if (descent.error.norm() < errorOf()) q = descent.q;
}

SelfMotionAnswer answerOf(const SerialChain& chain, const Pose& target, const Candidate& candidate, const Vector7& seed,
                          bool ignore_limits) {
  SelfMotionAnswer answer;
  answer.self_motion.resize(0, kRedundantJoints);
  if (candidate.free.empty()) {
    answer.q = turnedTo(chain, candidate.q, seed, ignore_limits);
  } else {
    const Continuum continuum = describeContinuum(chain, candidate, seed, ignore_limits);
    answer.q = continuum.nearest;
    answer.self_motion = continuum.directions;
    answer.free_joints = continuum.free_joints;
    answer.lower = continuum.lower;
    answer.upper = continuum.upper;
  }
  refine(chain, target, ignore_limits, answer.q);
  answer.branch = candidate.branch;
  answer.distance = (answer.q - seed).norm();
  answer.within_limits = isWithinAll(chain, answer.q);
  answer.singular = true;
  return answer;
}

void sortAnswers(SelfMotionAnswers& result) {
  std::stable_sort(result.answers.begin(), result.answers.end(),
                   [](const SelfMotionAnswer& a, const SelfMotionAnswer& b) { return a.distance < b.distance; });
}

}  // namespace

SelfMotionAnswers SelfMotionSolver::answer(const SelfMotionQuestion& question) const {
  const SelfMotionSet set = trace(question);
  const Vector7 seed = seedOf(chain_, question);
  PoseCurve pose = poseCurve(question.target);
  SelfMotionAnswers result;
  result.complete = set.complete;
  result.note = set.note;
  for (const SelfMotionCurve& curve : set.curves) {
    if (curve.intervals.empty()) ++result.outside_limits;
    for (const SelfMotionInterval& interval : curve.intervals)
      result.answers.push_back(answerOf(pose, curve, interval, question, seed, parameterJoint()));
  }
  for (const SelfMotionSheet& sheet : set.sheets) {
    const SelfMotionAnswer answer =
        answerOf(chain_, question.target, candidateOf(sheet, seed), seed, question.ignore_limits);
    if (answer.within_limits || question.ignore_limits) {
      result.answers.push_back(answer);
    } else {
      ++result.outside_limits;
    }
  }
  sortAnswers(result);
  return result;
}

SelfMotionAnswers SelfMotionSolver::answerAt(const SelfMotionQuestion& question, double value) const {
  const Vector7 seed = seedOf(chain_, question);
  RedundantSolutions solutions;
  one_given_->solveAt(question.target, value, seed, solutions);
  PoseCurve pose = poseCurve(question.target);
  SelfMotionAnswers result;
  result.complete = solutions.complete;
  for (const RedundantSolution& solution : solutions) {
    SelfMotionAnswer answer;
    SelfMotionNode node;
    // Newton steps may leave the value by rounding only.
    const bool polished = solution.free == 0U && pose.correct(solution.q, 1e-7, node);
    Vector7 q = polished ? node.q : solution.q;
    q[parameterJoint()] = value;
    q = turnedTo(chain_, q, seed, question.ignore_limits);
    q[parameterJoint()] = value;
    answer.q = q;
    answer.branch = one_given_->branchName(solution);
    answer.distance = (q - seed).norm();
    answer.within_limits = isWithinAll(chain_, q);
    answer.singular = one_given_->isDouble(solution) || solution.free != 0U;
    answer.self_motion.resize(0, kRedundantJoints);
    if (!answer.within_limits && !question.ignore_limits) {
      ++result.outside_limits;
    } else {
      result.answers.push_back(answer);
    }
  }
  sortAnswers(result);
  return result;
}

std::optional<VectorX> SelfMotionSolver::anyWithinLimits(const SelfMotionQuestion& question) const {
  const Vector7 seed = seedOf(chain_, question);
  if (one_given_) {
    constexpr int kTries = 32;  // To each side of the seed.
    const int joint = parameterJoint();
    const JointLimits& limits = chain_.joint(joint).limits;
    const bool turns = chain_.joint(joint).isRevolute();
    const double step = turns ? kPi / kTries : 0.1 * chain_.characteristicLength();
    RedundantSolutions solutions;
    for (int k = 0; k <= 2 * kTries; ++k) {
      const double value = seed[joint] + step * ((k + 1) / 2) * (k % 2 == 0 ? 1.0 : -1.0);
      if (!isWithin(chain_.joint(joint), value, 0.0) && !(turns && limits.upper - limits.lower >= kTwoPi)) continue;
      one_given_->solveAt(question.target, value, seed, solutions);
      for (const RedundantSolution& solution : solutions) {
        const Vector7 q = turnedTo(chain_, solution.q, seed, false);
        if (isWithinAll(chain_, q)) return VectorX(chain_.clamped(q));
      }
    }
  }
  SelfMotionQuestion within = question;
  within.ignore_limits = false;
  const SelfMotionAnswers all = answer(within);
  if (all.answers.empty()) return std::nullopt;
  return all.answers.front().q;
}

}  // namespace screwline

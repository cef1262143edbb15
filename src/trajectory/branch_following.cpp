#include "screwline/trajectory/branch_following.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "curve_tracer.h"
#include "screwline/trajectory/format.h"
#include "singularity_names.h"
#include "turn_in_place.h"

namespace screwline {
namespace {

constexpr double kCrossing = 1e-5;      ///< Of the gap: the first pose is (nearly) singular.
constexpr double kStandstill = 1e-4;    ///< Of du along a curve: it only turns the joints, on a self-motion or a fold.
constexpr double kInside = 0.03;        ///< Of u, or a tenth of the part: where such a path's branches are told apart.
constexpr double kLookAhead = 1e-3;     ///< Of u, or a hundredth of the part: behind a fold.
constexpr double kSameSolution = 1e-5;  ///< [rad, m]
constexpr double kBand = 1e-9;          ///< [rad, m] within which limits are decided.

std::string limitReason(const Joint& joint, double limit, const std::string& place) {
  return "joint '" + joint.name + "' reaches its limit " + number(limit) + " at " + place;
}

class Follower {
 public:
  Follower(const InverseKinematics& solver, const ToolPath& path, const FollowRequest& request)
      : solver_(solver),
        chain_(solver.chain()),
        path_(path),
        request_(request),
        system_(chain_, solver.task(), path),
        tracer_(system_, chain_, request.tolerance),
        names_(chain_, solver.task()) {}

  FollowResult run();

 private:
  IkResult solve(double u, const VectorX& seed) const;
  bool beginsRegular(const std::vector<IkAnswer>& answers);
  void begin(FollowResult& result);
  void beginInside(FollowResult& result);
  void carryOn(FollowedBranch& branch);
  bool turnAtStop(std::size_t part, VectorX& y, FollowedBranch& branch);
  void explain(FollowedBranch& branch, const TracedCurve& last, double goal);
  void turn(FollowedBranch& branch) const;
  void name(FollowedBranch& branch) const;
  VectorX joined(const VectorX& q, double u) const;

  const InverseKinematics& solver_;
  const SerialChain& chain_;
  const ToolPath& path_;
  const FollowRequest& request_;
  PathSystem system_;
  CurveTracer tracer_;
  SingularityNames names_;
};

IkResult Follower::solve(double u, const VectorX& seed) const {
  IkRequest question;
  question.target = path_.pose(u);
  question.seed = seed;
  question.ignore_limits = chain_.size() <= solver_.task().size();
  question.timeout = request_.timeout;
  question.find_closest = false;
  return solver_.solve(question);
}

VectorX Follower::joined(const VectorX& q, double u) const {
  VectorX y(q.size() + 1);
  y << q, u;
  return y;
}

bool Follower::beginsRegular(const std::vector<IkAnswer>& answers) {
  return std::all_of(answers.begin(), answers.end(), [&](const IkAnswer& answer) {
    system_.evaluate(joined(answer.position, 0.0));
    const VectorX direction = system_.direction({});
    return system_.gap() >= kCrossing && direction[chain_.size()] >= kStandstill;
  });
}

/// The branches as solutions of the first pose.
void Follower::begin(FollowResult& result) {
  const IkResult first = solve(0.0, request_.seed);
  result.complete = first.complete;
  result.note = first.message;
  system_.choosePart(0);
  if (!first.solutions.empty() && !beginsRegular(first.solutions)) {
    beginInside(result);
    return;
  }
  for (const IkAnswer& answer : first.solutions) {
    FollowedBranch branch;
    branch.branch = answer.branch;
    VectorX y = joined(answer.position, 0.0);
    system_.correctJoints(y);
    branch.start = y.head(chain_.size());
    result.branches.push_back(branch);
  }
}

/// The first pose is singular: its solutions do not say which way they go on. Those a little way inside do, followed
/// back.
void Follower::beginInside(FollowResult& result) {
  const double u = std::min(kInside, 0.1 * path_.partEnd(0));
  const IkResult inside = solve(u, request_.seed);
  result.complete = inside.complete;
  for (const IkAnswer& answer : inside.solutions) {
    FollowedBranch branch;
    branch.branch = answer.branch;
    VectorX y = joined(answer.position, u);
    system_.correctJoints(y);
    TracedCurve back = tracer_.trace(y, -1.0, 0.0);
    if (back.end != TraceEnd::kGoal || back.curve.segments() == 0) continue;
    branch.curve = reversed(back.curve);
    branch.start = back.last.head(chain_.size());
    result.branches.push_back(branch);
  }
}

/// From where the branch is to the end of the path, part by part.
void Follower::carryOn(FollowedBranch& branch) {
  VectorX y = joined(branch.start, 0.0);
  if (branch.curve.segments() > 0) {
    const std::size_t last = branch.curve.segments() - 1;
    for (Eigen::Index i = 0; i < y.size(); ++i) y[i] = branch.curve.piece(last, static_cast<int>(i))(1.0);
  }
  for (std::size_t part = 0; part < path_.parts(); ++part) {
    system_.choosePart(part);
    const double goal = path_.partEnd(part);
    TracedCurve traced = tracer_.trace(y, 1.0, goal);
    if (traced.end != TraceEnd::kGoal && part > 0 && turnAtStop(part, y, branch)) traced = tracer_.trace(y, 1.0, goal);
    if (traced.curve.segments() > 0) {
      branch.curve = branch.curve.segments() > 0 ? concatenate(branch.curve, traced.curve) : traced.curve;
    }
    y = traced.last;
    branch.end_u = std::clamp(y[chain_.size()], 0.0, goal);
    if (traced.end != TraceEnd::kGoal) {
      explain(branch, traced, goal);
      return;
    }
    y[chain_.size()] = goal;
  }
  branch.end_u = path_.length();
}

/// At the stop where `part` begins, from the branch's joint values y to the nearest of those, with the same pose all
/// the way between, from which the part goes on: solutions a little way inside, followed back, know them.
/// @return whether there are any. Then y is inside, and the branch leads there.
bool Follower::turnAtStop(std::size_t part, VectorX& y, FollowedBranch& branch) {
  const int n = chain_.size();
  const double from = path_.partStart(part);
  const double u = from + std::min(kInside, 0.1 * (path_.partEnd(part) - from));
  const VectorX here = y.head(n);
  const double tolerance = 1e-6 * std::max(1.0, chain_.characteristicLength());
  double nearest = std::numeric_limits<double>::infinity();
  PiecewisePolynomial onward;
  for (const IkAnswer& answer : solve(u, here).solutions) {
    VectorX inside = joined(answer.position, u);
    system_.correctJoints(inside);
    TracedCurve back = tracer_.trace(inside, -1.0, from);
    if (back.end != TraceEnd::kGoal || back.curve.segments() == 0) continue;
    for (int i = 0; i < n && !system_.redundant(); ++i) {
      if (!chain_.joint(i).isRevolute()) continue;
      const double shift = kTwoPi * std::round((here[i] - back.last[i]) / kTwoPi);
      back.last[i] += shift;
      inside[i] += shift;
      for (std::size_t k = 0; k < back.curve.segments(); ++k) back.curve.at(k, 0, i) += shift;
    }
    const VectorX start = back.last.head(n);
    const double way = (start - here).norm();
    if (way < kSameSolution || way >= nearest || !keepsPose(chain_, solver_.task(), here, start, tolerance)) continue;
    nearest = way;
    onward = reversed(back.curve);
    y = inside;
  }
  if (!std::isfinite(nearest)) return false;
  VectorX start(n);
  for (int i = 0; i < n; ++i) start[i] = onward.valueAt(0.0, i);
  const PiecewisePolynomial turn = turnInPlace(here, start, from);
  branch.turns.push_back({branch.curve.duration(), branch.curve.duration() + turn.duration()});
  branch.curve = concatenate(concatenate(branch.curve, turn), onward);
  return true;
}

void Follower::explain(FollowedBranch& branch, const TracedCurve& last, double goal) {
  const VectorX q = last.last.head(chain_.size());
  const std::string place = placeOf(path_, branch.end_u);
  if (last.end == TraceEnd::kLimit) {
    const JointLimits& limits = chain_.joint(last.joint).limits;
    branch.end = BranchEnd::kJointLimit;
    branch.joint = last.joint;
    branch.limit =
        std::abs(q[last.joint] - limits.lower) < std::abs(q[last.joint] - limits.upper) ? limits.lower : limits.upper;
    branch.reason = limitReason(chain_.joint(last.joint), branch.limit, place);
    return;
  }
  const double ahead = std::min(kLookAhead, 0.01 * goal);
  const IkResult behind = solve(std::min(goal, branch.end_u + ahead), q);
  const std::string singularity = names_.nearest(q);
  if (behind.solutions.empty() && behind.outside_limits == 0) {
    branch.end = BranchEnd::kOutOfReach;
    branch.reason = "out of reach behind " + place + " (" + (behind.complete ? "proved; " : "no solution was found; ") +
                    "singularity '" + singularity + "')";
  } else if (last.end == TraceEnd::kFold || system_.gap() < 1e-3) {
    branch.end = BranchEnd::kSingular;
    branch.reason = "turns back in singularity '" + singularity + "' at " + place;
  } else {
    branch.end = BranchEnd::kLost;
    branch.reason = "could not be followed behind " + place;
  }
}

/// Where a joint's way first leaves its limits in the turn given by `shift`: the arc, and which limit.
struct Leaving {
  double arc = std::numeric_limits<double>::infinity();
  double limit = 0.0;
};

Leaving firstLeaving(const PiecewisePolynomial& curve, int joint, const JointLimits& limits, double shift) {
  for (std::size_t k = 0; k < curve.segments(); ++k) {
    const Polynomial piece = curve.piece(k, joint);
    const Range range = rangeOverUnitInterval(piece);
    Leaving leaving;
    for (const double limit : {limits.lower - kBand - shift, limits.upper + kBand - shift}) {
      const bool low = limit < 0.5 * (limits.lower + limits.upper) - shift;
      if (low ? range.lower >= limit : range.upper <= limit) continue;
      Polynomial above = piece;
      above.c[0] -= limit;
      const bool outside = low ? above(0.0) < 0.0 : above(0.0) > 0.0;
      const Roots roots = rootsInUnitInterval(above);
      const double x = outside || roots.count == 0 ? 0.0 : *roots.begin();
      const double arc = curve.breaks[k] + x * curve.length(k);
      if (arc < leaving.arc) leaving = {arc, low ? limits.lower : limits.upper};
    }
    if (std::isfinite(leaving.arc)) return leaving;
  }
  return {};
}

/// The turn of one joint, nearest to the present one, in which its whole way keeps the limits, else the one that keeps
/// them longest.
double bestShift(const PiecewisePolynomial& curve, int joint, const JointLimits& limits, Leaving& leaving) {
  const Range range = curve.extrema(joint).position;
  const double least = std::ceil((limits.lower - kBand - range.lower) / kTwoPi);
  const double most = std::floor((limits.upper + kBand - range.upper) / kTwoPi);
  leaving = {};
  if (least <= most) return kTwoPi * std::clamp(0.0, least, most);
  double best = 0.0;
  leaving.arc = -1.0;
  for (double turns = most; turns <= least; ++turns) {
    const Leaving here = firstLeaving(curve, joint, limits, kTwoPi * turns);
    if (here.arc <= leaving.arc) continue;
    leaving = here;
    best = kTwoPi * turns;
  }
  return best;
}

/// Puts every joint into its best turn, and ends the branch where a joint leaves its limits even so.
void Follower::turn(FollowedBranch& branch) const {
  double earliest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < chain_.size() && branch.curve.segments() > 0; ++i) {
    const Joint& joint = chain_.joint(i);
    Leaving leaving = firstLeaving(branch.curve, i, joint.limits, 0.0);
    if (!std::isfinite(leaving.arc)) continue;
    if (joint.isRevolute() && !request_.from_seed && !system_.redundant()) {
      const double shift = bestShift(branch.curve, i, joint.limits, leaving);
      branch.start[i] += shift;
      for (std::size_t k = 0; k < branch.curve.segments(); ++k) branch.curve.at(k, 0, i) += shift;
    }
    if (leaving.arc >= earliest) continue;
    earliest = leaving.arc;
    branch.end = BranchEnd::kJointLimit;
    branch.joint = i;
    branch.limit = leaving.limit;
  }
  if (!std::isfinite(earliest)) return;
  branch.end_u = std::clamp(branch.curve.valueAt(earliest, chain_.size()), 0.0, path_.length());
  branch.reason = limitReason(chain_.joint(branch.joint), branch.limit, placeOf(path_, branch.end_u));
}

/// The name at the goal: that of the solution there.
void Follower::name(FollowedBranch& branch) const {
  if (branch.end != BranchEnd::kGoal || branch.branch.empty()) return;
  VectorX goal(chain_.size());
  for (int i = 0; i < chain_.size(); ++i) goal[i] = branch.curve.valueAt(branch.curve.duration(), i);
  for (const IkAnswer& answer : solve(path_.length(), goal).solutions) {
    if ((answer.position - goal).cwiseAbs().maxCoeff() > kSameSolution) continue;
    branch.goal_branch = answer.branch;
    return;
  }
}

FollowResult Follower::run() {
  FollowResult result;
  begin(result);
  for (FollowedBranch& branch : result.branches) {
    carryOn(branch);
    turn(branch);
    name(branch);
    branch.distance = (branch.start - request_.seed).norm();
  }
  std::stable_sort(result.branches.begin(), result.branches.end(),
                   [](const FollowedBranch& a, const FollowedBranch& b) { return a.distance < b.distance; });
  return result;
}

}  // namespace

FollowResult followPath(const InverseKinematics& solver, const ToolPath& path, const FollowRequest& request) {
  return Follower(solver, path, request).run();
}

std::string placeOf(const ToolPath& path, double u) {
  char text[64];
  std::snprintf(text, sizeof text, "%.4g m (%.3g %%)", path.metres(u), 100.0 * u / path.length());
  return text;
}

}  // namespace screwline

#include "descent.h"

#include <algorithm>
#include <cmath>

namespace screwline {
namespace {

// Found by trial on PUMA 560, UR5, Panda, iiwa and a general 6R: fewest iterations per solved pose.
constexpr double kFirstDamping = 0.1;
constexpr double kDampingGrowth = 4.0;
constexpr double kDampingDecay = 0.3;
constexpr double kGoodStep = 0.25;  ///< A step that leaves less of the cost lowers the damping.
constexpr double kSlowStep = 0.85;  ///< One that leaves more of it is slow, ...
constexpr int kMaxSlowSteps = 4;    ///< ... and so many in a row tell of a minimum above zero.
constexpr double kNear = 1e-3;      ///< Below this error slow steps are those of a singular solution: go on.

constexpr double kDampingFloor = 1e-15;  ///< Of the mean squared column: what rounding makes of J J^T anyway.
constexpr double kNoStep = 1e-10;        ///< Scaled; shorter steps change a solution by less than is asked for.
constexpr int kMaxRejected = 8;
constexpr int kMaxRefinements = 24;  ///< Steps halve the way to a double root: from 1e-6 to rounding, and to spare.
constexpr int kMaxRounds = 6;
constexpr double kAhead = 1e-2;        ///< Below this error the cost may rise for ...
constexpr int kStepsAhead = 4;         ///< ... so many Newton steps ...
constexpr double kLongestAhead = 0.3;  ///< ... of this scaled length at most.
constexpr int kWatchPeriod = 4;

}  // namespace

Watch::Watch(double timeout, const std::function<bool()>& cancelled) : cancelled_(&cancelled) {
  // An hour is for ever; much more would overflow the clock's ticks.
  if (!(timeout < 3600.0)) return;
  const std::chrono::duration<double> seconds(std::max(timeout, 0.0));
  deadline_ =
      std::chrono::steady_clock::now() + std::chrono::duration_cast<std::chrono::steady_clock::duration>(seconds);
}

bool Watch::expired() const {
  if (cancelled_ != nullptr && *cancelled_ && (*cancelled_)()) return true;
  return deadline_ != std::chrono::steady_clock::time_point::max() && std::chrono::steady_clock::now() >= deadline_;
}

Descent::Descent(const SerialChain& chain, const Task& task, const Pose& target, const DescentOptions& options,
                 const Watch& watch)
    : residual_(chain, task, target, options.rotation_weight),
      box_(chain, options.honour_limits, (target.p - chain.home().p).norm()),
      active_(box_),
      options_(options),
      watch_(watch) {}

bool Descent::converged() const {
  return current_->error.position <= options_.tolerance && current_->error.orientation <= options_.tolerance;
}

DescentResult Descent::result() const {
  return {current_->q, current_->error, converged(), iterations_};
}

bool Descent::exhausted() const {
  return iterations_ >= options_.max_iterations || (iterations_ % kWatchPeriod == 0 && watch_.expired());
}

double Descent::scaledLength(const JointVector& step) const {
  double longest = 0.0;
  for (int i = 0; i < box_.size(); ++i) longest = std::max(longest, std::abs(step[i]) / box_.unit(i));
  return longest;
}

bool Descent::tryStep(const JointVector& step) {
  trial_->q = current_->q + step;
  box_.confine(trial_->q);
  residual_.evaluate(*trial_);
  if (!(trial_->cost < current_->cost)) return false;
  std::swap(current_, trial_);
  return true;
}

bool Descent::isSlow(double cost_before) {
  const bool slow = current_->cost > kSlowStep * cost_before && current_->error.norm() > kNear;
  slow_steps_ = slow ? slow_steps_ + 1 : 0;
  return slow_steps_ >= kMaxSlowSteps;
}

double Descent::damping(double mu) const {
  // In proportion to the squared error (Sugihara 2011), but only to the error where that is more than one unit of step
  // makes up for: a far target would else never be approached.
  const double scale = active_.columnScale(*current_);
  const double squared_error = 2.0 * current_->cost;
  return mu * std::min(squared_error, std::sqrt(squared_error * scale)) + kDampingFloor * scale;
}

Descent::Outcome Descent::levenbergMarquardt() {
  double mu = kFirstDamping;
  int rejected = 0;
  slow_steps_ = 0;
  while (!converged()) {
    if (exhausted()) return Outcome::kStopped;
    ++iterations_;
    if (rejected == 0) active_.update(*current_);
    if (active_.columnScale(*current_) == 0.0) return Outcome::kStationary;
    const JointVector& step = active_.step(*current_, damping(mu));
    const double cost_before = current_->cost;
    if (tryStep(step)) {
      rejected = 0;
      if (current_->cost < kGoodStep * cost_before) mu *= kDampingDecay;
      if (isSlow(cost_before)) return Outcome::kSlow;
    } else if (++rejected == 1 && current_->error.norm() < kAhead && newtonAhead()) {
      rejected = 0;
    } else {
      mu *= kDampingGrowth;
      if (rejected >= kMaxRejected || scaledLength(step) < kNoStep) return Outcome::kStationary;
    }
  }
  return Outcome::kSolved;
}

bool Descent::newtonAhead() {
  // At a solution that is almost double the valley is narrow and bent: a Newton step along it climbs the wall, the next
  // one comes down further on. So the cost may rise for a few steps (watchdog technique, Chamberlain et al. 1982).
  const JointVector q = current_->q;
  const double cost = current_->cost;
  for (int k = 0; k < kStepsAhead; ++k) {
    if (k > 0) active_.update(*current_);
    if (active_.columnScale(*current_) == 0.0) break;
    const JointVector& step = active_.step(*current_, kDampingFloor * active_.columnScale(*current_));
    if (scaledLength(step) > kLongestAhead) break;
    ++iterations_;
    trial_->q = current_->q + step;
    box_.confine(trial_->q);
    residual_.evaluate(*trial_);
    std::swap(current_, trial_);
    if (current_->cost < kGoodStep * cost) return true;
  }
  current_->q = q;
  residual_.evaluate(*current_);
  active_.update(*current_);
  return false;
}

void Descent::refine() {
  for (int k = 0; k < kMaxRefinements; ++k) {
    active_.update(*current_);
    if (active_.columnScale(*current_) == 0.0) return;
    const JointVector& step = active_.step(*current_, damping(1.0));
    if (scaledLength(step) < kNoStep || !tryStep(step)) return;
    ++iterations_;
  }
}

void Descent::run(const ConstVectorRef& start, DescentGoal goal) {
  iterations_ = 0;
  current_->q = start;
  box_.confine(current_->q);
  residual_.evaluate(*current_);
  Outcome outcome = levenbergMarquardt();
  // A start that is stationary at once (a straight arm, the target along it) may be a saddle.
  const bool at_saddle = outcome == Outcome::kStationary && iterations_ <= kMaxRejected;
  const int rounds = goal == DescentGoal::kMinimum ? kMaxRounds : at_saddle ? 1 : 0;
  for (int round = 0; round < rounds; ++round) {
    if (outcome == Outcome::kSolved || outcome == Outcome::kStopped) break;
    if (secondOrder() == Outcome::kStationary) break;
    outcome = levenbergMarquardt();
  }
  if (outcome == Outcome::kSolved) refine();
}

DescentResult descend(const SerialChain& chain, const Task& task, const Pose& target, const VectorX& start,
                      const DescentOptions& options) {
  Descent descent(chain, task, target, options, Watch());
  descent.run(start, DescentGoal::kMinimum);
  return descent.result();
}

}  // namespace screwline

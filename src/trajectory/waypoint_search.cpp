#include "screwline/trajectory/waypoint_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace screwline {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr long kMostPlans = 200000;  ///< Of segments, in one search.

}  // namespace

WaypointSearch::WaypointSearch(int joints, const std::array<AxisLimits, kMaxJoints>& limits,
                               std::vector<ViaState> waypoints)
    : question_(std::make_unique<StateToState>()),
      motion_(std::make_unique<StateToStateMotion>()),
      waypoints_(std::move(waypoints)),
      durations_(waypoints_.size() - 1, 0.0) {
  question_->joints = joints;
  question_->limits = limits;
  planAll();
  stop_duration_ = duration();
}

double WaypointSearch::duration() const {
  return std::accumulate(durations_.begin(), durations_.end(), 0.0);
}

bool WaypointSearch::feasible(std::size_t k) {
  return std::isfinite(plan(k));
}

/// The duration, and a little of the other joints' own shortest ones: what only they gain makes room for later steps. A
/// start that would have to brake back into the limits counts as none.
double WaypointSearch::plan(std::size_t k) {
  question_->from = waypoints_[k].joints;
  question_->to = waypoints_[k + 1].joints;
  moveStateToState(*question_, *motion_);
  if (motion_->status != MotionStatus::kFound) return kInfinity;
  for (std::size_t j = 0; j < static_cast<std::size_t>(question_->joints); ++j) {
    if (motion_->braking_phases[j] > 0) return kInfinity;
  }
  double others = 0.0;
  for (std::size_t j = 0; j < static_cast<std::size_t>(question_->joints); ++j) others += motion_->shortest[j];
  return motion_->duration + others_weight_ * others / question_->joints;
}

bool WaypointSearch::planAll() {
  for (std::size_t k = 0; k < durations_.size(); ++k) durations_[k] = plan(k);
  return std::isfinite(duration());
}

bool WaypointSearch::accept(std::size_t k, const ViaState& before) {
  const double in = plan(k - 1);
  if (in < durations_[k - 1] + durations_[k]) {
    const double out = plan(k);
    if (in + out < (durations_[k - 1] + durations_[k]) * (1.0 - 1e-9)) {
      durations_[k - 1] = in;
      durations_[k] = out;
      return true;
    }
  }
  waypoints_[k] = before;
  return false;
}

bool WaypointSearch::tryStep(std::size_t k, std::size_t joint, double velocity, double acceleration) {
  const ViaState before = waypoints_[k];
  EndState& state = waypoints_[k].joints[joint];
  state.velocity += velocity;
  state.acceleration += acceleration;
  return accept(k, before);
}

bool WaypointSearch::tryScale(std::size_t k, double factor) {
  const ViaState before = waypoints_[k];
  for (std::size_t j = 0; j < static_cast<std::size_t>(question_->joints); ++j) {
    waypoints_[k].joints[j].velocity *= factor;
  }
  return accept(k, before);
}

/// Through each free waypoint at a share of the mean velocity of the stop-and-go motion around it, where the direction
/// stays.
void WaypointSearch::guess() {
  const std::vector<double> stops = durations_;
  for (std::size_t k = 1; k + 1 < waypoints_.size(); ++k) {
    if (!waypoints_[k].free || stops[k - 1] <= 0.0 || stops[k] <= 0.0) continue;
    for (std::size_t j = 0; j < static_cast<std::size_t>(question_->joints); ++j) {
      const double here = waypoints_[k].joints[j].position;
      const double in = (here - waypoints_[k - 1].joints[j].position) / stops[k - 1];
      const double out = (waypoints_[k + 1].joints[j].position - here) / stops[k];
      if (in * out > 0.0) waypoints_[k].joints[j].velocity = std::copysign(std::min(std::abs(in), std::abs(out)), in);
    }
  }
}

/// Sweeps over the free waypoints: the whole velocity longer or shorter, then each joint's velocity and acceleration up
/// and down; steps halve when a sweep gains nothing.
void WaypointSearch::improve() {
  const std::size_t n = static_cast<std::size_t>(question_->joints);
  long plans = 0;
  for (double step = 0.25; step > 1e-3;) {
    others_weight_ = step;
    planAll();
    const double before = duration();
    for (std::size_t k = 1; k + 1 < waypoints_.size(); ++k) {
      if (!waypoints_[k].free) continue;
      for (double factor : {1.0 + step, 1.0 / (1.0 + step)}) plans += tryScale(k, factor) ? 2 : 1;
      for (std::size_t j = 0; j < n; ++j) {
        const AxisLimits& l = question_->limits[j];
        const double v = std::isfinite(l.velocity.upper) ? step * l.velocity.upper : step;
        const double a = std::isfinite(l.acceleration.upper) ? step * l.acceleration.upper : step;
        if (!tryStep(k, j, v, 0.0)) tryStep(k, j, -v, 0.0);
        if (!tryStep(k, j, 0.0, a)) tryStep(k, j, 0.0, -a);
        plans += 6;
      }
      if (plans > kMostPlans) step = 0.0;
    }
    if (duration() > before * (1.0 - 1e-3)) step *= 0.5;
  }
  others_weight_ = 0.0;
  planAll();
}

bool WaypointSearch::run() {
  const std::vector<ViaState> stops = waypoints_;
  if (!std::isfinite(stop_duration_)) return false;
  guess();
  if (!planAll()) waypoints_ = stops;
  planAll();
  improve();
  const double guessed = duration();
  const std::vector<ViaState> from_guess = waypoints_;
  waypoints_ = stops;
  planAll();
  improve();
  if (duration() > guessed) waypoints_ = from_guess;
  planAll();
  if (duration() > stop_duration_) waypoints_ = stops;
  return planAll();
}

}  // namespace screwline

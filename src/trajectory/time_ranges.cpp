#include "time_ranges.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "screwline/trajectory/format.h"

namespace screwline {
namespace {

constexpr std::size_t kMostValues = 120;  ///< Waypoints times joints.
constexpr int kMostFields = 6;
constexpr int kPlaces = 12;
constexpr int kHalvings = 12;

/// One time of a request: of a waypoint, or of the whole.
class GivenTime {
 public:
  GivenTime(const PlanRequest& request, std::size_t waypoint) : request_(request), waypoint_(waypoint) {
    for (std::size_t k = 0; k < waypoint; ++k) from_ = std::max(from_, request.waypoints[k].time);
    for (std::size_t k = waypoint + 1; k < request.waypoints.size() && to_ == 0.0; ++k) to_ = request.waypoints[k].time;
    if (to_ == 0.0 && !last()) to_ = request.duration;
  }

  double value() const { return waypointTime() > 0.0 ? waypointTime() : last() ? request_.duration : 0.0; }
  std::string name() const { return waypointTime() > 0.0 ? indexed("waypoints", waypoint_) + ".time" : "duration"; }
  bool bounded() const { return to_ > 0.0; }  ///< By a later time.

  PlanRequest with(double time) const {
    PlanRequest changed = request_;
    if (waypointTime() > 0.0) changed.waypoints[waypoint_].time = time;
    if (last() && request_.duration > 0.0) changed.duration = time;
    return changed;
  }

  /// Values to try, ascending: between the times beside, or beyond the last one.
  std::vector<double> places() const {
    std::vector<double> values;
    for (int i = 1; i < kPlaces; ++i) {
      const double way = bounded() ? (to_ - from_) * i / kPlaces : (value() - from_) * std::exp2(i - 4);
      values.push_back(from_ + way);
    }
    return values;
  }

 private:
  bool last() const { return waypoint_ + 1 == request_.waypoints.size(); }
  double waypointTime() const { return request_.waypoints[waypoint_].time; }

  const PlanRequest& request_;
  std::size_t waypoint_;
  double from_ = 0.0;
  double to_ = 0.0;
};

/// The feasible one of two values, brought near to where feasibility ends.
double edgeBetween(double good, double bad, const std::function<bool(double)>& feasible) {
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (good + bad);
    (feasible(middle) ? good : bad) = middle;
  }
  return good;
}

std::optional<std::string> rangeOf(const GivenTime& time, const std::function<bool(double)>& feasible) {
  const std::vector<double> places = time.places();
  std::vector<bool> good;
  std::size_t nearest = places.size();
  for (std::size_t i = 0; i < places.size(); ++i) {
    good.push_back(feasible(places[i]));
    const bool nearer =
        nearest == places.size() || std::abs(places[i] - time.value()) < std::abs(places[nearest] - time.value());
    if (good[i] && nearer) nearest = i;
  }
  if (nearest == places.size()) return std::nullopt;
  std::size_t first = nearest;
  while (first > 0 && good[first - 1]) --first;
  std::size_t last = nearest;
  while (last + 1 < places.size() && good[last + 1]) ++last;
  const double step = places[1] - places[0];
  const double lower = edgeBetween(places[first], first > 0 ? places[first - 1] : places[0] - step, feasible);
  std::string text =
      time.name() + " is " + number(time.value()) + " s, with all else as given " + number(lower) + " s ";
  if (!time.bounded() && last + 1 == places.size()) return text + "and more are feasible";
  const double beyond = last + 1 < places.size() ? places[last + 1] : places[last] + step;
  return text + "to " + number(edgeBetween(places[last], beyond, feasible)) + " s are feasible";
}

}  // namespace

std::string feasibleTimes(const PlanRequest& request, const std::function<bool(const PlanRequest&)>& feasible) {
  const std::size_t count = request.waypoints.size();
  if (count * static_cast<std::size_t>(request.limits.joints()) > kMostValues) return {};
  std::vector<GivenTime> times;
  bool intermediate = false;
  for (std::size_t k = 1; k < count; ++k) {
    const GivenTime time(request, k);
    if (time.value() == 0.0) continue;
    intermediate = intermediate || k + 1 < count;
    times.push_back(time);
  }
  for (std::size_t i = 0; intermediate && i < times.size() && i < kMostFields; ++i) {
    const auto with = [&](double value) { return value > 0.0 && feasible(times[i].with(value)); };
    if (const auto range = rangeOf(times[i], with)) return "; " + *range;
  }
  return {};
}

}  // namespace screwline

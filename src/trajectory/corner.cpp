#include "screwline/trajectory/corner.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include "screwline/trajectory/format.h"

namespace screwline {
namespace {

constexpr double kSameDirection = 1e-12;  // Of unit vectors: what differs by less goes straight on.
constexpr double kReversed = 1e-6;        // The same: a blend between such lines would be a needle.

/// The level of all reaches at which the two corners of a line fill it, those that may have no more left behind.
double fillLevel(double length, double one, double other) {
  if (one + other <= length) return std::numeric_limits<double>::infinity();
  return std::max(0.5 * length, length - std::min(one, other));
}

std::string several(std::size_t count, std::size_t first) {
  return count == 1 ? indexed("waypoints", first)
                    : std::to_string(count) + " waypoints, the first of them " + indexed("waypoints", first) + ",";
}

}  // namespace

Bend bendBetween(const VectorX& before, const VectorX& after) {
  if ((after - before).cwiseAbs().maxCoeff() <= kSameDirection) return Bend::kNone;
  return (after + before).norm() <= kReversed ? Bend::kReversal : Bend::kCorner;
}

std::vector<double> fairReaches(const std::vector<double>& lengths, std::vector<double> most) {
  using Event = std::pair<double, std::size_t>;  // Level, line.
  std::priority_queue<Event, std::vector<Event>, std::greater<>> events;
  const auto levelOf = [&](std::size_t k) { return fillLevel(lengths[k], most[k], most[k + 1]); };
  for (std::size_t k = 0; k < lengths.size(); ++k) events.emplace(levelOf(k), k);
  for (; !events.empty();) {
    const auto [level, k] = events.top();
    events.pop();
    const double now = levelOf(k);
    if (now == std::numeric_limits<double>::infinity()) continue;
    if (now > level) {  // A corner of it has been filled by the line beside since.
      events.emplace(now, k);
      continue;
    }
    most[k] = std::min(most[k], level);
    most[k + 1] = std::min(most[k + 1], level);
  }
  return most;
}

Polynomial cornerRise(double reach) {
  Polynomial rise;
  rise.c = {0.0, 0.0, 0.0, 2.0 * reach, -reach};
  return rise;
}

Corner describeCorner(double reach, double middle, const VectorX& before, const VectorX& after) {
  Corner corner;
  corner.reach = reach;
  corner.deviation = middle * (after - before).norm();
  corner.off_lines = middle * (after - after.dot(before) * before).norm();
  return corner;
}

void noteCorners(const std::vector<Corner>& corners, double radius, const std::string& unit,
                 std::vector<std::string>& notes) {
  if (radius == 0.0) {
    notes.push_back("blend_radius is 0: the motion stops where the lines between waypoints bend");
    return;
  }
  double deviation = 0.0;
  double off_lines = 0.0;
  double least = radius;
  std::size_t stops = 0, first_stop = 0, shortened = 0, narrowest = 0;
  for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
    const Corner& corner = corners[k];
    deviation = std::max(deviation, corner.deviation);
    off_lines = std::max(off_lines, corner.off_lines);
    if (corner.stops && stops++ == 0) first_stop = k;
    if (!corner.shortened) continue;
    ++shortened;
    if (corner.reach >= least) continue;
    least = corner.reach;
    narrowest = k;
  }
  const auto distance = [&](double value) { return number(value) + unit; };
  notes.push_back("corners are blended within blend_radius " + distance(radius) +
                  (unit.empty() ? " (norm of joint differences)" : "") +
                  "; the way passes its waypoints at a distance of up to " + distance(deviation) +
                  (off_lines > 0.0 ? ", the lines between them at up to " + distance(off_lines) : ""));
  if (stops > 0)
    notes.push_back("at " + several(stops, first_stop) +
                    " the way turns straight back or in place, or lines are too short: it stops there");
  if (shortened == 0) return;
  notes.push_back("at " + std::to_string(shortened) +
                  " waypoints the lines beside are too short for blend_radius and shared with the next corners: " +
                  distance(least) + " at " + indexed("waypoints", narrowest));
}

}  // namespace screwline

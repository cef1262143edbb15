#include "completed_chain.h"

#include <cmath>
#include <optional>

#include "screwline/model/structure.h"
#include "screwline/spatial/rotation.h"

namespace screwline {
namespace {

constexpr int kMostLocked = 2;

/// A locked joint's tilt from the axis that it meets. Not a right angle: at one it could come into line with the axis
/// before that, which would make a continuum of an isolated solution.
constexpr double kTilt = 0.25 * kPi;

Axis revoluteAxis(const Vector3& direction, const Vector3& point) {
  Axis axis;
  axis.direction = direction.normalized();
  axis.point = point;
  return axis;
}

Vector3 footOf(const Axis& axis, const Vector3& point) {
  return axis.point + axis.direction * axis.direction.dot(point - axis.point);
}

Axis tilted(const Axis& axis, const Vector3& point) {
  const Vector3 across = anyPerpendicular(axis.direction);
  return revoluteAxis(std::cos(kTilt) * axis.direction + std::sin(kTilt) * across, point);
}

/// Nowhere near any relation to the chain's axes.
Axis skewed(const SerialChain& chain, int number) {
  const Vector3 direction = rotationAbout(Vector3(0.6, 0.0, 0.8), 1.0 + number) * Vector3(0.48, 0.6, 0.64);
  return revoluteAxis(direction, chain.home().p + 0.4 * chain.characteristicLength() * Vector3(0.5, -0.3, 0.7));
}

/// Sets of locked axes behind axes `before`, in front of `turn` where that is added.
std::vector<std::vector<Axis>> lockedAxes(const SerialChain& chain, int count, const std::optional<Axis>& turn) {
  if (count == 0) return {{}};
  const Axis& last = chain.axes().back();
  const Vector3 foot = last.prismatic ? chain.home().p : footOf(last, chain.home().p);
  std::vector<std::vector<Axis>> sets;
  if (count == 1) {
    // With two neighbours that meet, a spherical wrist.
    const Axis& neighbour = turn ? last : chain.axes()[chain.axes().size() - 2];
    const Axis& other = turn ? *turn : last;
    const AxisRelation relation = relate(neighbour, other, chain.characteristicLength());
    if (relation.intersecting) {
      const Vector3 across = neighbour.direction.cross(other.direction);
      const Vector3& point = relation.meeting_point;
      sets.push_back({turn ? revoluteAxis(across, point) : tilted(other, point)});
    }
    sets.push_back({tilted(last, foot)});
    sets.push_back({skewed(chain, 0)});
    return sets;
  }
  const Vector3 x = anyPerpendicular(last.direction);
  sets.push_back({revoluteAxis(x, foot), revoluteAxis(last.direction.cross(x), foot)});
  sets.push_back({skewed(chain, 0), skewed(chain, 1)});
  return sets;
}

/// The chain's own joint that turns the tool about `axis` and does nothing else: behind it there are slides along the
/// axis at most. -1: none. Where no position is asked for, a parallel axis does.
int ownTurn(const SerialChain& chain, const Axis& axis, bool anywhere) {
  for (int i = chain.size() - 1; i >= 0; --i) {
    const Axis& own = chain.axes()[static_cast<std::size_t>(i)];
    const AxisRelation relation = relate(own, axis, chain.characteristicLength());
    if (!relation.parallel) return -1;
    if (!own.prismatic) return relation.coincident || anywhere ? i : -1;
  }
  return -1;
}

void append(ChainDescription& description, const Axis& axis, const std::string& name) {
  description.axes.push_back(axis);
  description.axes.back().source = static_cast<int>(description.joints.size());
  Joint joint;
  joint.name = name;
  joint.type = JointType::kContinuous;
  description.joints.push_back(joint);
}

CompletedChain completed(const SerialChain& chain, const std::vector<Axis>& locked, const std::optional<Axis>& turn) {
  ChainDescription description = chain.description();
  for (std::size_t i = 0; i < locked.size(); ++i)
    append(description, locked[i], "a locked joint " + std::to_string(i + 1));
  if (turn) append(description, *turn, "the tool's turn");
  description.links = {{description.tip_link, static_cast<int>(description.axes.size()), description.home}};
  const int last = static_cast<int>(description.joints.size()) - 1;
  return {SerialChain(description), chain.size(), static_cast<int>(locked.size()), turn ? last : -1};
}

}  // namespace

Task wholeRowsOf(const Task& task) {
  std::vector<int> rows;
  for (int row = 0; row < 3; ++row) {
    if (task.contains(row)) rows.push_back(row);
  }
  rows.insert(rows.end(), {3, 4, 5});
  return Task::fromRows(rows);
}

std::vector<CompletedChain> completions(const SerialChain& chain, const Task& task) {
  const int pointing = task.pointingAxis();
  const bool whole = task.rotationCount() == 3;
  const int translations = task.translationCount();
  if (chain.hasMimic() || !(whole || pointing >= 0) || !(translations == 0 || translations == 3)) return {};
  std::optional<Axis> turn;
  int own_turn = -1;
  if (pointing >= 0) {
    const Axis axis = revoluteAxis(chain.home().R.col(pointing), chain.home().p);
    own_turn = ownTurn(chain, axis, translations == 0);
    if (own_turn < 0) turn = axis;
  }
  const int locked = translations + 3 - chain.size() - (turn ? 1 : 0);
  if (locked < 0 || (whole && locked == 0)) return {};
  std::vector<CompletedChain> result;
  if (locked > 0 && pointing >= 0) result.push_back(completed(chain, {}, turn));
  if (locked <= kMostLocked && (locked == 0 || (translations == 3 && chain.size() >= 3))) {
    for (const std::vector<Axis>& axes : lockedAxes(chain, locked, turn))
      result.push_back(completed(chain, axes, turn));
  }
  for (CompletedChain& one : result) {
    if (own_turn >= 0) one.turn = own_turn;
  }
  return result;
}

}  // namespace screwline

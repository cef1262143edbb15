#include "completed_chain.h"

#include <cmath>
#include <optional>

#include "screwline/model/structure.h"
#include "screwline/spatial/rotation.h"

namespace screwline {
namespace {

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
  const Matrix3 turn = rotationAbout(Vector3(0.6, 0.0, 0.8), 1.0 + number);
  const Vector3 offset = 0.4 * chain.characteristicLength() * (turn * turn * Vector3(0.5, -0.3, 0.7));
  return revoluteAxis(turn * Vector3(0.48, 0.6, 0.64), chain.home().p + offset);
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
  if (count == 2) {
    const Vector3 x = anyPerpendicular(last.direction);
    sets.push_back({revoluteAxis(x, foot), revoluteAxis(last.direction.cross(x), foot)});
  }
  std::vector<Axis> apart;
  for (int i = 0; i < count; ++i) apart.push_back(skewed(chain, i));
  sets.push_back(apart);
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

/// A joint that may take any value.
Joint freeJoint(const Axis& axis, const std::string& name) {
  Joint joint;
  joint.name = name;
  joint.type = axis.prismatic ? JointType::kPrismatic : JointType::kContinuous;
  return joint;
}

/// What the task leaves open of the base's rows, as axes in front of the chain; nothing where it is no whole pose with
/// them. A turn about a base axis moves positions along the others.
std::optional<std::vector<Axis>> openAxes(const Task& task) {
  std::vector<Axis> axes;
  const bool has_positions = task.translationCount() > 0;
  int turned = -1;
  if (task.rotationCount() == 2 && task.pointingAxis() < 0) {
    for (int row = 3; row < 6; ++row) turned = task.contains(row) ? turned : row - 3;
    axes.push_back(revoluteAxis(Vector3::Unit(turned), Vector3::Zero()));
  }
  for (int row = 0; row < 3; ++row) {
    if (task.contains(row)) {
      if (turned >= 0 && row != turned) return std::nullopt;
    } else if (has_positions) {
      Axis slide;
      slide.prismatic = true;
      slide.direction = Vector3::Unit(row);
      axes.push_back(slide);
    }
  }
  return axes;
}

/// What is added to a chain.
struct Addition {
  Task rows;  ///< That the completed chain has joints for.
  std::vector<Axis> open;
  std::vector<Axis> locked;
  std::optional<Axis> turn;
  int own_turn = -1;  ///< The chain's own joint that turns the tool about its pointing axis; then none is added.

  int freeCount() const { return static_cast<int>(open.size()) + (turn ? 1 : 0); }
};

/// The name of the row that an axis along one of the base's moves.
std::string rowAlong(const Axis& axis) {
  int row = 0;
  axis.direction.cwiseAbs().maxCoeff(&row);
  return Task::fromRows({axis.prismatic ? row : 3 + row}).names().front();
}

CompletedChain completed(const SerialChain& chain, const Addition& added) {
  ChainDescription description = chain.description();
  description.axes.clear();
  description.joints.clear();
  const auto append = [&description](Axis axis, const Joint& joint) {
    axis.source = static_cast<int>(description.joints.size());
    description.axes.push_back(axis);
    description.joints.push_back(joint);
  };
  for (const Axis& axis : added.open) append(axis, freeJoint(axis, "the open " + rowAlong(axis)));
  for (int i = 0; i < chain.size(); ++i) append(chain.axes()[static_cast<std::size_t>(i)], chain.joint(i));
  for (const Axis& axis : added.locked)
    append(axis, freeJoint(axis, "a locked joint " + std::to_string(description.joints.size())));
  if (added.turn) append(*added.turn, freeJoint(*added.turn, "the tool's turn"));
  description.links = {{description.tip_link, static_cast<int>(description.axes.size()), description.home}};
  const int first = static_cast<int>(added.open.size());
  const int last = static_cast<int>(description.joints.size()) - 1;
  const int locked = static_cast<int>(added.locked.size());
  return {
      SerialChain(description), added.rows, first, chain.size(), locked, added.turn ? last - first : added.own_turn};
}

/// The joints that may take any value. Empty where the task with them is no whole pose, nor a whole orientation.
std::optional<Addition> openingOf(const SerialChain& chain, const Task& task) {
  const std::optional<std::vector<Axis>> open = openAxes(task);
  if (chain.hasMimic() || task.rotationCount() < 2 || !open) return std::nullopt;
  const bool is_orientation = task.translationCount() == 0;
  Addition added;
  added.rows = is_orientation ? Task::fromRows({3, 4, 5}) : Task();
  added.open = *open;
  const int pointing = task.pointingAxis();
  if (pointing < 0) return added;
  const Axis axis = revoluteAxis(chain.home().R.col(pointing), chain.home().p);
  added.own_turn = ownTurn(chain, axis, is_orientation);
  if (added.own_turn < 0) added.turn = axis;
  return added;
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
  std::optional<Addition> added = openingOf(chain, task);
  if (!added) return {};
  const int locked = added->rows.size() - chain.size() - added->freeCount();
  if (locked < 0 || (added->freeCount() == 0 && added->own_turn < 0 && locked == 0)) return {};
  const bool is_orientation = task.translationCount() == 0;
  std::vector<CompletedChain> result;
  if (locked > 0 && task.pointingAxis() >= 0) result.push_back(completed(chain, *added));
  if (locked > 0 && is_orientation) return result;
  for (const std::vector<Axis>& axes : lockedAxes(chain, locked, added->turn)) {
    added->locked = axes;
    result.push_back(completed(chain, *added));
  }
  return result;
}

std::optional<CompletedChain> completionWithOneToSpare(const SerialChain& chain, const Task& task) {
  const std::optional<Addition> added = openingOf(chain, task);
  if (!added || added->own_turn >= 0 || task.translationCount() == 0 || added->freeCount() == 0) return std::nullopt;
  if (chain.size() + added->freeCount() != added->rows.size() + 1) return std::nullopt;
  return completed(chain, *added);
}

}  // namespace screwline

#include "screwline/model/structure.h"

#include <cmath>

namespace screwline {
namespace {

bool sameLine(const Axis& first, const Axis& second, double length) {
  const Vector3 offset = second.point - first.point;
  return offset.cross(first.direction).norm() <= kStructureLengthTolerance * length;
}

/// Points of closest approach of two lines that are not parallel: the middle between them, and the distance.
std::pair<Vector3, double> closestApproach(const Axis& first, const Axis& second) {
  const double b = first.direction.dot(second.direction);
  const Vector3 r = first.point - second.point;
  const double d = first.direction.dot(r);
  const double e = second.direction.dot(r);
  const double denominator = 1.0 - b * b;
  const Vector3 on_first = first.point + (b * e - d) / denominator * first.direction;
  const Vector3 on_second = second.point + (e - b * d) / denominator * second.direction;
  return {0.5 * (on_first + on_second), (on_first - on_second).norm()};
}

double distanceToLine(const Axis& axis, const Vector3& point) {
  return (point - axis.point).cross(axis.direction).norm();
}

std::vector<ConcurrentGroup> sphericalGroups(const SerialChain& chain, const std::vector<AxisRelation>& neighbours) {
  std::vector<ConcurrentGroup> groups;
  const int count = static_cast<int>(chain.axes().size());
  const double tolerance = kStructureLengthTolerance * chain.characteristicLength();
  for (int first = 0; first + 2 < count;) {
    const AxisRelation& relation = neighbours[static_cast<std::size_t>(first)];
    int last = first + 1;
    if (relation.intersecting) {
      while (last + 1 < count && !chain.axes()[static_cast<std::size_t>(last) + 1].prismatic &&
             neighbours[static_cast<std::size_t>(last)].intersecting &&
             distanceToLine(chain.axes()[static_cast<std::size_t>(last) + 1], relation.meeting_point) <= tolerance) {
        ++last;
      }
    }
    if (last - first >= 2) groups.push_back({first, last - first + 1, relation.meeting_point});
    first = last - first >= 2 ? last : first + 1;
  }
  return groups;
}

std::vector<ParallelGroup> parallelGroups(const SerialChain& chain) {
  std::vector<ParallelGroup> groups;
  ParallelGroup current;
  const auto close = [&] {
    if (current.axes.size() > 1) groups.push_back(current);
    current = {};
  };
  for (std::size_t i = 0; i < chain.axes().size(); ++i) {
    const Axis& axis = chain.axes()[i];
    if (axis.prismatic) continue;
    if (!current.axes.empty() && axis.direction.cross(current.direction).norm() > kStructureAngleTolerance) close();
    if (current.axes.empty()) current.direction = axis.direction;
    current.axes.push_back(static_cast<int>(i));
  }
  close();
  return groups;
}

std::string namesOf(const SerialChain& chain, int first, int count) {
  std::string names;
  for (int i = first; i < first + count; ++i) {
    const Axis& axis = chain.axes()[static_cast<std::size_t>(i)];
    names += (names.empty() ? "" : ", ") + chain.joint(axis.source).name;
  }
  return names;
}

}  // namespace

AxisRelation relate(const Axis& first, const Axis& second, double length) {
  AxisRelation relation;
  const double sine = first.direction.cross(second.direction).norm();
  const double cosine = std::abs(first.direction.dot(second.direction));
  relation.angle = std::atan2(sine, cosine);
  relation.parallel = sine <= kStructureAngleTolerance;
  relation.orthogonal = cosine <= kStructureAngleTolerance;
  if (first.prismatic || second.prismatic) return relation;
  if (relation.parallel) {
    relation.coincident = sameLine(first, second, length);
    relation.distance = distanceToLine(first, second.point);
    return relation;
  }
  const auto [point, distance] = closestApproach(first, second);
  relation.distance = distance;
  relation.intersecting = distance <= kStructureLengthTolerance * length;
  relation.meeting_point = point;
  return relation;
}

Structure structureOf(const SerialChain& chain) {
  Structure structure;
  const std::vector<Axis>& axes = chain.axes();
  for (std::size_t i = 0; i + 1 < axes.size(); ++i) {
    structure.neighbours.push_back(relate(axes[i], axes[i + 1], chain.characteristicLength()));
  }
  structure.spherical = sphericalGroups(chain, structure.neighbours);
  structure.parallel = parallelGroups(chain);
  std::size_t revolute_count = 0;
  for (const Axis& axis : axes) {
    if (axis.prismatic) continue;
    if (revolute_count == 0) structure.common_direction = axis.direction;
    ++revolute_count;
  }
  structure.all_revolute_parallel = revolute_count == 1 || (structure.parallel.size() == 1 &&
                                                            structure.parallel.front().axes.size() == revolute_count);
  return structure;
}

std::vector<std::string> describeStructure(const SerialChain& chain, const Structure& structure) {
  std::vector<std::string> lines;
  for (const ConcurrentGroup& group : structure.spherical) {
    lines.push_back("axes " + namesOf(chain, group.first, group.count) + " meet in one point (spherical joint)");
  }
  for (const ParallelGroup& group : structure.parallel) {
    std::string names;
    for (int i : group.axes) names += (names.empty() ? "" : ", ") + namesOf(chain, i, 1);
    lines.push_back("axes " + names + " are parallel");
  }
  for (std::size_t i = 0; i < structure.neighbours.size(); ++i) {
    const AxisRelation& relation = structure.neighbours[i];
    const std::string names = "axes " + namesOf(chain, static_cast<int>(i), 2);
    if (relation.coincident) lines.push_back(names + " are the same line");
    if (relation.intersecting)
      lines.push_back(names + std::string(" meet") + (relation.orthogonal ? " at a right angle" : ""));
  }
  return lines;
}

}  // namespace screwline

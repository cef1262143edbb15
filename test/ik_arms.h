#ifndef SCREWLINE_TEST_IK_ARMS_H
#define SCREWLINE_TEST_IK_ARMS_H

#include <random>
#include <string>
#include <vector>

#include "screwline/model/serial_chain.h"
#include "screwline/model/task.h"
#include "screwline/spatial/rotation.h"

namespace screwline {
namespace test {

/// Random arms of the structures that the closed form knows, with other lengths, places, tools and joint orders than
/// any shipped robot.
class ArmMaker {
 public:
  explicit ArmMaker(unsigned seed) : random_(seed) {}

  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  int index(int count) { return static_cast<int>(std::uniform_int_distribution<int>(0, count - 1)(random_)); }
  Vector3 vector(double size) { return size * Vector3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)); }
  Vector3 direction() {
    const Vector3 v = vector(1.0);
    return v.norm() > 0.1 ? Vector3(v.normalized()) : direction();
  }
  Pose pose() { return {rotationAbout(direction(), uniform(-3, 3)), vector(0.5)}; }

  static Axis turn(const Vector3& direction, const Vector3& point) {
    Axis axis;
    axis.direction = direction.normalized();
    axis.point = point;
    return axis;
  }
  static Axis slide(const Vector3& direction) {
    Axis axis;
    axis.prismatic = true;
    axis.direction = direction.normalized();
    return axis;
  }

  /// Axes placed by X (base orientation and position), the tip by `home` in their frame.
  static SerialChain chain(std::vector<Axis> axes, const Pose& home, const Pose& X) {
    ChainDescription description;
    description.name = "arm";
    description.base_link = "base_link";
    description.tip_link = "tool0";
    for (std::size_t i = 0; i < axes.size(); ++i) {
      axes[i].direction = X.R * axes[i].direction;
      axes[i].point = X * axes[i].point;
      axes[i].source = static_cast<int>(i);
      Joint joint;
      joint.name = "joint" + std::to_string(i + 1);
      joint.type = axes[i].prismatic ? JointType::kPrismatic : JointType::kContinuous;
      description.joints.push_back(joint);
    }
    description.axes = axes;
    description.home = X * home;
    description.links = {{"tool0", static_cast<int>(axes.size()), description.home}};
    return SerialChain(description);
  }

  double length() { return uniform(0.2, 1.0); }
  double sign() { return index(2) == 0 ? 1.0 : -1.0; }

  struct Arm {
    std::string structure;
    SerialChain chain;
    Task task;
  };

  static constexpr int kStructures = 14;

  Arm make(int structure) {
    if (structure < 4) return makePlanar(structure);
    return structure < 10 ? makeSmall(structure) : makeLarge(structure);
  }

 private:
  Arm makePlanar(int structure) {
    const Vector3 z = Vector3::UnitZ();
    const double a = length();
    const double b = length();
    if (structure == 1)
      return planar("planar RR", {turn(sign() * z, vector(0.2)), turn(sign() * z, {a, 0, 0})}, false, false);
    std::vector<Axis> axes = {turn(sign() * z, {0, 0, 0}), turn(sign() * z, {a, 0, 0.1})};
    if (structure == 3) {
      axes.insert(axes.begin() + index(3), slide(Vector3(uniform(-1, 1), uniform(-1, 1), 0)));
      return planar("planar with a slide in the plane", axes, false);
    }
    axes.push_back(turn(sign() * z, {a + b, 0, 0}));
    if (structure == 0) return planar("planar RRR", axes, false);
    axes.insert(axes.begin() + index(4), slide(sign() * z));
    return planar("SCARA, slide anywhere", axes, true);
  }

  Arm makeSmall(int structure) {
    const Vector3 x = Vector3::UnitX();
    const Vector3 y = Vector3::UnitY();
    const Vector3 z = Vector3::UnitZ();
    const Pose tool{rotationAbout(direction(), uniform(-3, 3)), vector(0.4)};
    const double a = length();
    const double b = length();
    const Task position = Task::fromRows({0, 1, 2});
    std::vector<Axis> axes = {turn(z, {0, 0, 0}), turn(sign() * y, {0, 0, a}), slide(x)};
    switch (structure) {
      case 4:
        return {"RRP, axes meet", chain(axes, {tool.R, {b, 0, a}}, pose()), position};
      case 5:
        return {"RRP, shoulder offset", chain(axes, {tool.R, {b, 0.3 * a, a}}, pose()), position};
      case 6:
        axes[2] = turn(sign() * y, {b, 0, a});
        return {"RRR articulated", chain(axes, {tool.R, {b + length(), index(2) * 0.2, a}}, pose()), position};
      case 7:
        axes = {turn(z, {0, 0, 0}), turn(y, {0, 0, 0}), turn(z, {0, a, 0})};
        return {"RRR orthogonal", chain(axes, {tool.R, {b, a, 0}}, pose()), position};
      case 8:
        axes = {turn(z, {0, 0, 0}), slide(z), slide(x)};
        if (index(2) == 0) std::swap(axes[0], axes[1]);
        return {"cylindrical", chain(axes, {tool.R, {a, 0.1 * index(2), b}}, pose()), position};
      default:
        axes = {turn(direction(), vector(1)), turn(direction(), vector(1)), turn(direction(), vector(1))};
        return {"orienting 3R", chain(axes, tool, pose()), Task::fromRows({3, 4, 5})};
    }
  }

  Arm makeLarge(int structure) {
    const Vector3 y = Vector3::UnitY();
    const Vector3 z = Vector3::UnitZ();
    const Pose tool{rotationAbout(direction(), uniform(-3, 3)), vector(0.4)};
    const double a = length();
    const double b = length();
    std::vector<Axis> axes;
    switch (structure) {
      case 10:
        axes = {turn(z, {0, 0, 0}), turn(z, {a, 0, 0}), slide(z)};
        return wristed("SCARA-type arm, wrist", axes, {a + b, 0, 0}, tool);
      case 11:
        axes = {turn(z, {0, 0, 0}), turn(y, {0, 0, a}), turn(y, {b, 0, a})};
        return wristed("articulated arm, wrist", axes, {b + length(), 0.1 * index(2), a}, tool);
      case 12:
        axes = {slide(direction()), turn(direction(), vector(0.4)), turn(direction(), vector(0.4))};
        if (index(2) == 0) std::swap(axes[0], axes[static_cast<std::size_t>(index(2)) + 1]);
        return wristed("a slide and two turns in general, wrist", axes, vector(0.6), tool);
      default:
        axes = {slide(Vector3::UnitX() + 0.2 * vector(1)), index(2) == 0 ? slide(y) : turn(z, vector(0.3)),
                slide(z + 0.3 * y)};
        return {"three slides or a turn between two", chain(axes, tool, pose()), Task::fromRows({0, 1, 2})};
    }
  }

  Arm planar(const std::string& name, const std::vector<Axis>& axes, bool with_height, bool with_heading = true) {
    // The plane's normal is any base axis: rows are those of the plane.
    const int normal = index(3);
    Matrix3 R;
    R.col(2) = Vector3::Unit(normal);
    R.col(0) = Vector3::Unit((normal + 1) % 3);
    R.col(1) = Vector3::Unit((normal + 2) % 3);
    const Pose X{R * rotationAbout(Vector3::UnitZ(), uniform(-3, 3)), vector(0.5)};
    std::vector<int> rows;
    for (int row = 0; row < 3; ++row) {
      if (row != normal || with_height) rows.push_back(row);
    }
    if (with_heading) rows.push_back(3 + normal);
    const Pose home{rotationAbout(direction(), uniform(-3, 3)), Vector3(uniform(1, 2), uniform(-0.5, 0.5), 0.1)};
    return {name, chain(axes, home, X), Task::fromRows(rows)};
  }

  Arm wristed(const std::string& name, std::vector<Axis> axes, const Vector3& center, const Pose& tool) {
    const Vector3 first = direction();
    Vector3 second = direction();
    Vector3 third = direction();
    if (index(2) == 0) {
      second = anyPerpendicular(first);
      third = first;
    }
    axes.push_back(turn(first, center));
    axes.push_back(turn(second, center));
    axes.push_back(turn(third, center));
    return {name, chain(axes, {tool.R, center + tool.p}, pose()), Task()};
  }

  std::mt19937 random_;
};

}  // namespace test
}  // namespace screwline

#endif  // SCREWLINE_TEST_IK_ARMS_H

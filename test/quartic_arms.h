#ifndef SCREWLINE_TEST_QUARTIC_ARMS_H
#define SCREWLINE_TEST_QUARTIC_ARMS_H

#include <string>
#include <vector>

#include "ik_arms.h"

namespace screwline {
namespace test {

/// Random arms of which the third joint takes a quartic, twists at right angles or any.
class QuarticArmMaker {
 public:
  explicit QuarticArmMaker(unsigned seed) : maker_(seed) {}

  static constexpr int kStructures = 8;

  ArmMaker::Arm make(int structure) {
    const Vector3 x = Vector3::UnitX();
    const Vector3 y = Vector3::UnitY();
    const Vector3 z = Vector3::UnitZ();
    const double a = maker_.length();
    const double b = maker_.length();
    const Pose tool{rotationAbout(maker_.direction(), maker_.uniform(-3, 3)), {a + b + maker_.length(), 0.3, 0.2}};
    const std::vector<Axis> right = {turn(z, Vector3::Zero()), turn(y, {a, 0, 0.1}), turn(x, {a + 0.2, b, 0.3})};
    const std::vector<Axis> slid = {turn(z, Vector3::Zero()), turn(y, {a, 0, 0.1}), ArmMaker::slide(x + 0.2 * z)};
    const std::vector<Axis> between = {turn(z, Vector3::Zero()), ArmMaker::slide(z + x), turn(x + y, {a, b, 0.2})};
    const std::vector<Axis> any = {turn(z, Vector3::Zero()), turn(maker_.direction(), maker_.vector(0.5)),
                                   turn(maker_.direction(), maker_.vector(0.5))};
    switch (structure) {
      case 0:
        return position("three turns at right angles", right, tool);
      case 1:
        return position("two turns and a slide", slid, tool);
      case 2:
        return position("a slide askew between turns", between, tool);
      case 3:
        return position("three turns of any directions", any, tool);
      case 4:
        return wristed("three turns at right angles, wrist", right, tool);
      case 5:
        return wristed("two turns and a slide, wrist", slid, tool);
      case 6:
        return wristed("three turns of any directions, wrist", any, tool);
      default:
        return shouldered("shoulder, three turns at right angles", right, tool);
    }
  }

 private:
  static Axis turn(const Vector3& direction, const Vector3& point) { return ArmMaker::turn(direction, point); }

  ArmMaker::Arm position(const std::string& name, const std::vector<Axis>& axes, const Pose& tool) {
    return {name, ArmMaker::chain(axes, tool, Pose()), Task::fromRows({0, 1, 2})};
  }

  ArmMaker::Arm wristed(const std::string& name, std::vector<Axis> axes, const Pose& tool) {
    for (const Vector3& direction : {Vector3(Vector3::UnitX()), Vector3(Vector3::UnitY()), Vector3(Vector3::UnitX())})
      axes.push_back(turn(direction, tool.p));
    return {name, ArmMaker::chain(axes, {tool.R, tool.p + 0.1 * Vector3::UnitX()}, Pose()), Task()};
  }

  /// From the tip it is an arm with a spherical wrist.
  ArmMaker::Arm shouldered(const std::string& name, const std::vector<Axis>& arm, const Pose& tool) {
    std::vector<Axis> axes;
    for (const Vector3& direction : {Vector3(Vector3::UnitZ()), Vector3(Vector3::UnitY()), Vector3(Vector3::UnitZ())})
      axes.push_back(turn(direction, {-0.7, 0.2, 0.4}));
    axes.insert(axes.end(), arm.begin(), arm.end());
    return {name, ArmMaker::chain(axes, tool, Pose()), Task()};
  }

  ArmMaker maker_;
};

}  // namespace test
}  // namespace screwline

#endif  // SCREWLINE_TEST_QUARTIC_ARMS_H

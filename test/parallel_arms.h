#ifndef SCREWLINE_TEST_PARALLEL_ARMS_H
#define SCREWLINE_TEST_PARALLEL_ARMS_H

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "ik_arms.h"

namespace screwline {
namespace test {

/// Random arms of six turns with three parallel axes: where these stand, and which neighbours of the others meet.
/// Even numbers are the same with right angles everywhere, as real arms have them.
class ParallelArmMaker {
 public:
  static constexpr int kStructures = 12;

  explicit ParallelArmMaker(unsigned seed) : maker_(seed) {}

  ArmMaker& maker() { return maker_; }

  static std::string name(int structure) {
    static const char* const kNames[] = {"parallel axes second", "parallel axes first, the last two meet",
                                         "parallel axes first, the two behind them meet"};
    return std::string(kNames[structure / 4]) + (structure % 4 >= 2 ? ", from the tip" : "") +
           (structure % 2 == 0 ? ", right angles" : "");
  }

  SerialChain make(int structure) {
    right_ = structure % 2 == 0;
    std::vector<Axis> axes = axesOf(structure / 4);
    if (structure % 4 >= 2) std::reverse(axes.begin(), axes.end());
    return ArmMaker::chain(axes, maker_.pose(), maker_.pose());
  }

 private:
  Vector3 across(const Vector3& axis) { return right_ ? anyPerpendicular(axis) : maker_.direction(); }
  Vector3 offset() { return maker_.vector(0.4); }

  std::vector<Axis> axesOf(int kind) {
    const Vector3 h = right_ ? Vector3::UnitY() : maker_.direction();
    const Vector3 meeting = Vector3(1.0, 0.1, 0.2) + offset();
    const Vector3 fourth = across(h);
    const Vector3 fifth = right_ ? h : maker_.direction();
    std::vector<Axis> three;
    Vector3 at = offset();
    for (int i = 0; i < 3; ++i) {
      three.push_back(ArmMaker::turn(maker_.sign() * h, at));
      at += maker_.length() * anyPerpendicular(h) + 0.3 * maker_.vector(1.0);
    }
    const Vector3 elsewhere = offset();
    std::vector<Axis> others;
    if (kind == 1) {
      others = {ArmMaker::turn(across(h), elsewhere), ArmMaker::turn(right_ ? h.cross(fourth) : fourth, meeting),
                ArmMaker::turn(fifth, meeting)};
    } else {
      others = {ArmMaker::turn(fourth, meeting), ArmMaker::turn(fifth, meeting),
                ArmMaker::turn(across(fifth), elsewhere)};
    }
    if (kind == 0) {
      std::vector<Axis> axes = {ArmMaker::turn(across(h), elsewhere)};
      axes.insert(axes.end(), three.begin(), three.end());
      axes.insert(axes.end(), others.begin(), others.begin() + 2);
      return axes;
    }
    three.insert(three.end(), others.begin(), others.end());
    return three;
  }

  ArmMaker maker_;
  bool right_ = true;
};

}  // namespace test
}  // namespace screwline

#endif  // SCREWLINE_TEST_PARALLEL_ARMS_H

#ifndef SCREWLINE_TEST_UNIT_ROS_ARM_H
#define SCREWLINE_TEST_UNIT_ROS_ARM_H

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>

#include "screwline/exception.h"
#include "screwline/model/urdf_reader.h"

namespace screwline {
namespace ros_bridge {

/// A planar arm of three joints a, b, c; `camera` is fixed to its last link, `table` to its base.
inline std::string armUrdf() {
  const auto joint = [](const std::string& name, const std::string& parent, const std::string& child) {
    return "<link name='" + child + "'/><joint name='" + name + "' type='revolute'><parent link='" + parent +
           "'/><child link='" + child +
           "'/><origin xyz='0.5 0 0'/><axis xyz='0 0 1'/><limit lower='-3' upper='3' effort='1' velocity='2'/></joint>";
  };
  const auto fixed = [](const std::string& parent, const std::string& child) {
    return "<link name='" + child + "'/><joint name='to_" + child + "' type='fixed'><parent link='" + parent +
           "'/><child link='" + child + "'/><origin xyz='0 0 1'/></joint>";
  };
  return "<robot name='arm'><link name='base'/>" + joint("a", "base", "l1") + joint("b", "l1", "l2") +
         joint("c", "l2", "l3") + fixed("l3", "camera") + fixed("base", "table") + "</robot>";
}

inline std::shared_ptr<const SerialChain> arm() {
  return std::make_shared<const SerialChain>(readUrdf(armUrdf(), {"base", "l3"}));
}

/// The call throws InputError with this code, and its message holds `words`.
inline void expectRefused(const std::function<void()>& call, AnswerCode code, const std::string& words) {
  try {
    call();
    ADD_FAILURE() << "not refused: " << words;
  } catch (const InputError& error) {
    EXPECT_EQ(static_cast<int>(error.code()), static_cast<int>(code)) << error.what();
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
  }
}

/// The same for ModelError.
inline void expectModelError(const std::function<void()>& call, const std::string& words) {
  try {
    call();
    ADD_FAILURE() << "not refused: " << words;
  } catch (const ModelError& error) {
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
  }
}

}  // namespace ros_bridge
}  // namespace screwline

#endif  // SCREWLINE_TEST_UNIT_ROS_ARM_H

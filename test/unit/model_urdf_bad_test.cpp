// Every file of test/data/urdf_bad is refused with a message that names what is wrong.

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "screwline/exception.h"
#include "screwline/model/urdf_reader.h"

namespace screwline {
namespace {

const std::string kFolder = std::string(SCREWLINE_TEST_DATA) + "/urdf_bad/";

/// What the message of each file must have in it: the thing, and its value.
const std::map<std::string, std::vector<std::string>> kExpected = {
    {"all_in_loop", {"loop", "'base'"}},
    {"axis_nan", {"j1", "axis", "nan"}},
    {"axis_tiny", {"'j1'", "axis", "1e-09"}},
    {"axis_too_large", {"'j1'", "axis", "10000000", "1000000"}},
    {"axis_two_numbers", {"j1", "axis", "0 1"}},
    {"axis_zero", {"'j1'", "axis (0, 0, 0)"}},
    {"blank", {"empty"}},
    {"cut_off", {"XML", "malformed", "line"}},
    {"empty", {"empty"}},
    {"floating", {"'j1'", "floating"}},
    {"joint_twice", {"joint", "'j1'", "twice"}},
    {"joint_without_name", {"<joint>", "no name", "line 4"}},
    {"limit_infinite", {"j1", "lower", "-inf"}},
    {"limit_nan", {"j1", "lower", "nan"}},
    {"limit_not_number", {"j1", "lower", "-pi"}},
    {"limit_too_large", {"'j1'", "upper limit", "2000000", "1000000"}},
    {"limits_swapped", {"'j1'", "lower limit 1.5", "upper limit -0.5"}},
    {"link_twice", {"link", "'tool'", "twice"}},
    {"link_without_name", {"<link>", "no name", "line 4"}},
    {"loop", {"loop", "'mid'"}},
    {"mimic_apart", {"'j2'", "'j1'", "mimics", "-6 to -4", "-1 to 1"}},
    {"mimic_itself", {"'j2'", "mimics itself"}},
    {"mimic_multiplier_too_large", {"'j2'", "mimic multiplier", "100000000"}},
    {"mimic_of_fixed", {"'j2'", "'f'", "does not move"}},
    {"mimic_outside", {"several chains", "'base'", "'tool'", "'finger'", "tip_link"}},
    {"mimic_ring", {"mimics itself", "'j2'", "'j3'"}},
    {"mimic_unknown", {"'j1'", "'ghost'", "not in the chain"}},
    {"mimic_without_joint", {"j1", "no mimic joint specified"}},
    {"no_child", {"'j1'", "no child link"}},
    {"no_joints", {"no moving joint", "'base'"}},
    {"no_limit", {"j1", "limits"}},
    {"no_links", {"'bad'", "no link"}},
    {"no_moving_joint", {"no moving joint", "'base'"}},
    {"no_parent", {"'j1'", "no parent link"}},
    {"no_range", {"'j1'", "revolute", "lower and upper are missing"}},
    {"no_robot", {"<model>", "<robot>"}},
    {"no_type", {"'j1'", "no type"}},
    {"not_xml", {"XML", "malformed", "line 1"}},
    {"origin_comma", {"j1", "origin", "0,5"}},
    {"origin_overflow", {"j1", "origin", "1e999"}},
    {"origin_rpy_infinite", {"j1", "origin", "inf"}},
    {"origin_too_large", {"'j1'", "origin", "-3000000", "1000000"}},
    {"own_parent", {"loop", "'mid'"}},
    {"planar", {"'j2'", "planar"}},
    {"prismatic_no_range", {"'j1'", "prismatic", "lower and upper are missing"}},
    {"robot_without_name", {"<robot>", "no name"}},
    {"several_roots", {"several root links", "'base'", "'mid'"}},
    {"several_tips", {"several chains", "'base'", "'mid'", "'tool'", "tip_link"}},
    {"several_tools", {"several chains", "'flange'", "'tool0'", "tip_link"}},
    {"too_many_joints", {"'bad'", "65 joints", "64"}},
    {"two_parents", {"'tool'", "two joints", "'j2'", "'j3'"}},
    {"two_robots", {"second root element", "<robot>"}},
    {"unclosed_element", {"XML", "malformed", "line 3"}},
    {"unknown_child", {"'j1'", "child link 'nowhere'"}},
    {"unknown_parent", {"'j1'", "parent link 'nowhere'"}},
    {"unknown_type", {"j1", "hinge"}},
    {"velocity_negative", {"'j1'", "velocity limit", "-2.5"}},
    {"velocity_too_large", {"'j1'", "velocity limit", "10000000"}},
    {"version_two", {"version", "1.0"}},
};

class BadUrdf : public testing::TestWithParam<std::string> {};

TEST_P(BadUrdf, IsRefusedAndTheMessageSaysWhy) {
  const std::string path = kFolder + GetParam() + ".urdf";
  try {
    readUrdfFile(path);
    FAIL() << path << " was read";
  } catch (const ModelError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find(path), std::string::npos) << message;
    for (const std::string& part : kExpected.at(GetParam())) {
      EXPECT_NE(message.find(part), std::string::npos) << "no \"" << part << "\" in: " << message;
    }
    EXPECT_EQ(message.find('\n'), std::string::npos) << "more than one line: " << message;
  }
}

std::vector<std::string> names() {
  std::vector<std::string> result;
  for (const auto& [name, parts] : kExpected) result.push_back(name);
  return result;
}

INSTANTIATE_TEST_SUITE_P(All, BadUrdf, testing::ValuesIn(names()),
                         [](const testing::TestParamInfo<std::string>& file) { return file.param; });

TEST(BadUrdfFiles, AreAllExpected) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kFolder)) {
    EXPECT_EQ(kExpected.count(entry.path().stem().string()), 1U) << entry.path();
    ++count;
  }
  EXPECT_EQ(count, kExpected.size());
}

TEST(BadUrdfFiles, MissingFileAndFolderAreRefused) {
  for (const std::string& path : {kFolder + "not_there.urdf", kFolder}) {
    try {
      readUrdfFile(path);
      FAIL() << path << " was read";
    } catch (const ModelError& error) {
      EXPECT_NE(std::string(error.what()).find("'" + path + "' cannot be read"), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace screwline

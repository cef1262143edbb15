#include "../../src/ros/bag_recorder.h"

#include <gtest/gtest.h>
#include <rosbag/view.h>
#include <std_msgs/Int32.h>
#include <std_msgs/String.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <string>
#include <thread>
#include <vector>

namespace screwline {
namespace ros_bridge {
namespace {

namespace fs = std::filesystem;

class BagRecording : public ::testing::Test {
 protected:
  BagRecording() : folder_(fs::temp_directory_path() / ("screwline_recorder_" + std::to_string(::getpid()))) {
    fs::create_directories(folder_);
  }
  ~BagRecording() override { fs::remove_all(folder_); }
  std::string path() const { return (folder_ / "test.bag").string(); }

  const fs::path folder_;
};

/// A message as a subscriber of any type gets it.
template <typename M>
BagRecorder::Message received(const M& message, const ros::Time& time, bool latched, const std::string& publisher) {
  namespace traits = ros::message_traits;
  const auto shape = boost::make_shared<topic_tools::ShapeShifter>();
  shape->morph(traits::md5sum<M>(), traits::datatype<M>(), traits::definition<M>(), latched ? "1" : "0");
  std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream out(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(out, message);
  ros::serialization::IStream in(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  shape->read(in);
  const auto connection = boost::make_shared<ros::M_string>();
  (*connection)["type"] = traits::datatype<M>();
  (*connection)["md5sum"] = traits::md5sum<M>();
  (*connection)["message_definition"] = traits::definition<M>();
  (*connection)["callerid"] = publisher;
  (*connection)["latching"] = latched ? "1" : "0";
  return BagRecorder::Message(shape, connection, time, false, ros::DefaultMessageCreator<topic_tools::ShapeShifter>());
}

BagRecorder::Message numbered(int number, const std::string& publisher = "/publisher") {
  std_msgs::Int32 message;
  message.data = number;
  return received(message, ros::Time(1000.0 + 1e-3 * number), false, publisher);
}

BagRecorder::Message text(std::size_t length) {
  std_msgs::String message;
  message.data.assign(length, 'x');
  return received(message, ros::Time(1000.0), false, "/publisher");
}

std::string failureOf(BagRecorder& recorder) {
  try {
    recorder.close();
  } catch (const RecordingError& error) {
    return error.what();
  }
  return "";
}

std::string refusalOf(const std::string& path) {
  try {
    BagRecorder recorder(path);
  } catch (const RecordingError& error) {
    return error.what();
  }
  return "";
}

TEST_F(BagRecording, HoldsEveryMessageOfEachThread) {
  constexpr int kEach = 20000;
  BagRecorder recorder(path());
  std::vector<std::thread> threads;
  for (const std::string topic : {"/a", "/b", "/c"}) {
    threads.emplace_back([&recorder, topic] {
      for (int i = 0; i < kEach; ++i) recorder.take(topic, numbered(i));
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_TRUE(fs::exists(path() + ".active"));
  EXPECT_EQ(recorder.close(), 3u * kEach);
  EXPECT_FALSE(fs::exists(path() + ".active"));

  const rosbag::Bag bag(path());
  std::map<std::string, int> next;
  for (const rosbag::MessageInstance& instance : rosbag::View(bag)) {
    const int number = next[instance.getTopic()]++;
    ASSERT_EQ(instance.instantiate<std_msgs::Int32>()->data, number);
    ASSERT_EQ(instance.getTime(), ros::Time(1000.0 + 1e-3 * number));
  }
  EXPECT_EQ(next, (std::map<std::string, int>{{"/a", kEach}, {"/b", kEach}, {"/c", kEach}}));
}

TEST_F(BagRecording, KeepsWhichPublisherIsLatched) {
  {
    BagRecorder recorder(path());
    recorder.take("/fact", received(std_msgs::String(), ros::Time(1.0), true, "/one"));
    recorder.take("/fact", received(std_msgs::String(), ros::Time(2.0), false, "/other"));
    // Before any clock has come, simulated time is zero, which a bag does not take.
    recorder.take("/fact", received(std_msgs::String(), ros::Time(0, 0), true, "/one"));
  }  // closed
  const rosbag::Bag bag(path());
  rosbag::View view(bag);
  EXPECT_EQ(view.size(), 3u);
  std::map<std::string, std::string> latching;
  for (const rosbag::ConnectionInfo* connection : view.getConnections())
    latching[connection->header->at("callerid")] = connection->header->at("latching");
  EXPECT_EQ(latching, (std::map<std::string, std::string>{{"/one", "1"}, {"/other", "0"}}));
}

TEST_F(BagRecording, RefusesWhatCannotBeWritten) {
  EXPECT_NE(refusalOf((folder_ / "missing" / "test.bag").string()).find("No such file or directory"),
            std::string::npos);
  std::ofstream(path()) << "precious";
  EXPECT_NE(refusalOf(path()).find("exists already"), std::string::npos);
  EXPECT_NE(refusalOf(path() + "/test.bag").find("Not a directory"), std::string::npos);
  EXPECT_EQ(fs::file_size(path()), 8u);
}

TEST_F(BagRecording, EndsWithAGoodBagBeforeTheDiskIsFull) {
  RecorderBounds bounds;
  bounds.reserve = std::numeric_limits<std::uint64_t>::max();
  BagRecorder recorder(path(), bounds);
  recorder.take("/a", numbered(0));
  EXPECT_NE(failureOf(recorder).find("the disk is full"), std::string::npos);
  EXPECT_TRUE(recorder.failed());
  EXPECT_EQ(rosbag::View(rosbag::Bag(path())).size(), 0u);
}

TEST_F(BagRecording, TellsAnErrorOfTheDisk) {
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{1 << 20, before.rlim_max};
  std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);
  BagRecorder recorder(path());
  for (int i = 0; i < 30; ++i) recorder.take("/a", text(100000));
  const std::string failure = failureOf(recorder);
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_NE(failure.find("File too large"), std::string::npos) << failure;
  EXPECT_NE(failure.find("reindexed"), std::string::npos) << failure;
  EXPECT_TRUE(fs::exists(path() + ".active"));
  EXPECT_FALSE(fs::exists(path()));

  fs::create_symlink("/dev/full", folder_ / "full.bag.active");
  std::string full = refusalOf((folder_ / "full.bag").string());
  if (full.empty()) {
    BagRecorder onto_full((folder_ / "full.bag").string());
    full = failureOf(onto_full);
  }
  EXPECT_NE(full.find("No space left on device"), std::string::npos) << full;
}

TEST_F(BagRecording, EndsWhereTheDiskCannotFollow) {
  RecorderBounds bounds;
  bounds.most_waiting = 1000;
  BagRecorder recorder(path(), bounds);
  recorder.take("/a", numbered(0));
  recorder.take("/a", text(2000));
  recorder.take("/a", numbered(1));
  EXPECT_TRUE(recorder.failed());
  const std::string failure = failureOf(recorder);
  EXPECT_NE(failure.find("too slow"), std::string::npos);
  EXPECT_NE(failure.find("after 1 messages"), std::string::npos) << failure;
  EXPECT_EQ(rosbag::View(rosbag::Bag(path())).size(), 1u);
}

TEST_F(BagRecording, ClosesOnce) {
  BagRecorder recorder(path());
  recorder.take("/a", numbered(0));
  EXPECT_EQ(recorder.close(), 1u);
  recorder.take("/a", numbered(1));
  EXPECT_EQ(recorder.close(), 1u);
}

}  // namespace
}  // namespace ros_bridge
}  // namespace screwline

#include "screwline/ros/trajectory_generator.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "screwline/kinematics/forward.h"
#include "screwline/ros/conversions.h"
#include "screwline/ros/trajectory_conversions.h"
#include "unit/ros_arm.h"
#include "unit/ros_trajectory_support.h"

namespace screwline {
namespace ros_bridge {
namespace {

using XmlRpc::XmlRpcValue;

Waypoint at(const std::vector<double>& position) {
  Waypoint waypoint;
  waypoint.position = position;
  return waypoint;
}

PlanTrajectory::Request question(const std::string& profile, double duration = 0.0) {
  PlanTrajectory::Request request;
  request.profile = profile;
  request.waypoints = {at({0.0, 0.0, 0.0}), at({0.5, -0.4, 0.3})};
  request.duration = duration;
  return request;
}

/// The generator without a master: what it says is kept, its clock is turned by hand.
struct Bench {
  FakeClock clock;
  std::vector<trajectory_msgs::JointTrajectory> trajectories;
  std::vector<TrajectoryMetrics> metrics;
  std::vector<sensor_msgs::JointState> states;
  std::vector<TimeScaling> scalings;
  std::vector<geometry_msgs::PoseStamped> poses;
  std::vector<geometry_msgs::TwistStamped> twists;
  std::vector<diagnostic_msgs::DiagnosticArray> diagnostics;
  TrajectoryGenerator generator;

  template <typename Message>
  static std::function<void(const Message&)> into(std::vector<Message>& list) {
    return [&list](const Message& message) { list.push_back(message); };
  }

  explicit Bench(const TrajectoryParams& params = {})
      : generator({arm(), Task::parse({"x", "y", "rz"}), {}}, params,
                  [](const std::string& frame) -> std::optional<Pose> {
                    if (frame != "cell") return std::nullopt;
                    return Pose{Matrix3::Identity(), Vector3(0.1, 0.2, 0.0)};
                  },
                  clock.clock(),
                  {into(trajectories), into(metrics), into(states), into(scalings), into(poses), into(twists),
                   into(diagnostics)}) {}

  PlanTrajectory::Response plan(const PlanTrajectory::Request& request) {
    PlanTrajectory::Response response;
    EXPECT_TRUE(serve("plan", response, [&] { return generator.plan(request, response); }));
    return response;
  }
  Outcome execute(const ExecuteTrajectory::Request& request = {}) {
    ExecuteTrajectory::Response response;
    return generator.execute(request, response);
  }
  void run(int steps) {
    for (int i = 0; i < steps; ++i) ASSERT_TRUE(generator.executor().step());
  }
};

TEST(TrajectoryGenerator, StreamsWhatItPlanned) {
  Bench bench;
  bench.run(3);
  const auto planned = bench.plan(question("polynomial_345", 1.0));
  ASSERT_TRUE(planned.success) << planned.message;
  EXPECT_EQ(bench.execute().message, "");
  ASSERT_EQ(bench.trajectories.size(), 1U);
  ASSERT_EQ(bench.metrics.size(), 1U);
  bench.run(110);
  const ros::Time first = bench.trajectories[0].header.stamp;
  std::size_t point = 0;
  for (std::size_t i = 0; i < bench.states.size(); ++i) {
    EXPECT_EQ(bench.states[i].header.stamp, bench.poses[i].header.stamp);
    EXPECT_EQ(bench.states[i].header.stamp, bench.twists[i].header.stamp);
    EXPECT_EQ(bench.states[i].header.stamp, bench.scalings[i].header.stamp);
    if (bench.states[i].header.stamp < first || point >= planned.trajectory.points.size()) continue;
    for (std::size_t j = 0; j < 3; ++j) {
      EXPECT_NEAR(bench.states[i].position[j], planned.trajectory.points[point].positions[j], 1e-12);
      EXPECT_NEAR(bench.states[i].velocity[j], planned.trajectory.points[point].velocities[j], 1e-9);
    }
    ASSERT_EQ(bench.scalings[i].s.size(), 1U);
    EXPECT_NEAR(bench.scalings[i].s[0], planned.time_scaling.s[point], 1e-12);
    ++point;
  }
  EXPECT_EQ(point, 101U);
}

TEST(TrajectoryGenerator, InfinityIsAllowedWhereItIsDocumented) {
  Bench bench;
  for (const std::string profile : {"rectangular", "cubic"}) {
    const auto answer = bench.plan(question(profile));
    ASSERT_TRUE(answer.success) << answer.message;
    EXPECT_TRUE(std::isinf(answer.metrics.peak_jerk[0]));
    EXPECT_EQ(std::isinf(answer.metrics.peak_acceleration[0]), profile == "rectangular");
  }
  PlanTrajectory::Response wrong;
  wrong.metrics.peak_velocity = {HUGE_VAL};
  EXPECT_FALSE(isSound(wrong));
  wrong.metrics.peak_velocity = {1.0};
  wrong.metrics.peak_jerk = {std::nan("")};
  EXPECT_FALSE(isSound(wrong));
}

TEST(TrajectoryGenerator, PosesInFramesOfTheChainAndOfTf) {
  Bench bench;
  const auto chain = arm();
  const VectorX q = (VectorX(3) << 0.4, 0.6, -0.3).finished();
  Pose target = forwardKinematics(*chain, q);
  for (const std::string frame : {"", "base", "table", "cell"}) {
    Pose X_BF;
    if (frame == "cell") X_BF.p = {0.1, 0.2, 0.0};
    if (frame == "table") X_BF = chain->findLink("table")->home;
    PlanTrajectory::Request request = question("cubic");
    request.waypoints[1] = Waypoint();
    request.waypoints[1].pose.header.frame_id = frame;
    request.waypoints[1].pose.pose = toPose(X_BF.inverse() * target);
    const auto answer = bench.plan(request);
    ASSERT_TRUE(answer.success) << frame << ": " << answer.message;
    const auto& end = answer.trajectory.points.back().positions;
    const Pose met = forwardKinematics(*chain, Eigen::Map<const VectorX>(end.data(), 3));
    EXPECT_LT((met.p - target.p).head<2>().norm(), 1e-8) << frame;
  }
  PlanTrajectory::Request request = question("cubic");
  request.waypoints[1] = Waypoint();
  request.waypoints[1].pose.header.frame_id = "nowhere";
  request.waypoints[1].pose.pose = toPose(target);
  EXPECT_EQ(bench.plan(request).error_code, static_cast<int>(AnswerCode::kFrameTransformFailure));
}

TEST(TrajectoryGenerator, ARefusedExecutionLeavesTheMotion) {
  Bench bench;
  bench.run(3);
  ASSERT_TRUE(bench.plan(question("polynomial_345", 1.0)).success);
  bench.execute();
  bench.run(40);
  ExecuteTrajectory::Request bad;
  bad.trajectory.points.resize(1);
  bad.trajectory.points[0].positions = {9.0, 0.0, 0.0};
  expectRefused([&] { bench.execute(bad); }, AnswerCode::kLimitsInfeasible, "'a'");
  bench.run(100);
  EXPECT_NEAR(bench.states.back().position[0], 0.5, 1e-12);
  EXPECT_EQ(bench.trajectories.size(), 1U);
}

TEST(TrajectoryGenerator, StopsAndSaysSo) {
  Bench bench;
  bench.run(3);
  EXPECT_EQ(bench.generator.stop().message, "the robot is at rest");
  ASSERT_TRUE(bench.plan(question("polynomial_345", 2.0)).success);
  bench.execute();
  bench.run(100);
  EXPECT_NE(bench.generator.stop().message.find("at rest in"), std::string::npos);
  bench.run(200);
  EXPECT_EQ(bench.states.back().velocity, std::vector<double>(3, 0.0));
  EXPECT_LT(bench.states.back().position[0], 0.45);
}

std::string valueOf(const diagnostic_msgs::DiagnosticStatus& status, const std::string& key) {
  for (const auto& entry : status.values) {
    if (entry.key == key) return entry.value;
  }
  return "";
}

TEST(TrajectoryGenerator, TellsHowItKeepsItsDeadlines) {
  Bench bench;
  int sleeps = 0;
  bench.clock.lateness = [&sleeps] { return ++sleeps % 50 == 0 ? 25000000 : 80000; };
  bench.run(3);
  ASSERT_TRUE(bench.plan(question("polynomial_345", 3.0)).success);
  bench.execute();
  bench.run(400);
  ASSERT_GE(bench.diagnostics.size(), 4U);  // Each second, and at the end.
  const auto& last = bench.diagnostics[bench.diagnostics.size() - 1];
  const auto whole = std::find_if(bench.diagnostics.begin(), bench.diagnostics.end(),
                                  [](const auto& d) { return valueOf(d.status.back(), "samples") == "301"; });
  ASSERT_NE(whole, bench.diagnostics.end()) << "at the end, of the motion with its first and last sample";
  const auto& motion = whole->status[1];
  EXPECT_EQ(motion.name, "trajectory_generator: motion");
  EXPECT_NEAR(std::stod(valueOf(motion, "achieved rate [Hz]")), 100.0, 1.0);
  EXPECT_NEAR(std::stod(valueOf(motion, "jitter p50 [us]")), 80.0, 4.0);
  EXPECT_NEAR(std::stod(valueOf(motion, "jitter max [us]")), 25000.0, 0.1);
  EXPECT_GE(std::stoi(valueOf(motion, "missed deadlines")), 4);
  EXPECT_EQ(motion.level, diagnostic_msgs::DiagnosticStatus::WARN);
  EXPECT_EQ(last.status[0].name, "trajectory_generator: stream");
}

TEST(TrajectoryGenerator, TellsHowWellARobotFollows) {
  Bench bench;
  bench.run(3);
  ASSERT_TRUE(bench.plan(question("polynomial_345", 1.0)).success);
  bench.execute();
  double squares = 0.0;
  const int before = static_cast<int>(bench.states.size());
  for (int i = 0; i < 100; ++i) {
    bench.run(1);
    sensor_msgs::JointState measured = bench.states.back();
    const double off = 0.01 * std::sin(0.3 * i);
    measured.position[1] += off;
    std::swap(measured.name[0], measured.name[2]);
    std::swap(measured.position[0], measured.position[2]);
    bench.generator.track(measured);
    if (i > 0) squares += off * off;
  }
  EXPECT_EQ(bench.metrics.size(), 1U);
  bench.run(10);
  ASSERT_EQ(bench.metrics.size(), 2U) << before;
  const TrajectoryMetrics& metrics = bench.metrics.back();
  EXPECT_NEAR(metrics.tracking_error_max[1], 0.01, 1e-4);
  EXPECT_NEAR(metrics.tracking_error_rms[1], std::sqrt(squares / 99.0), 2e-4);
  EXPECT_NEAR(metrics.tracking_error_max[0], 0.0, 1e-8);
  sensor_msgs::JointState bad = bench.states.back();
  bad.position[0] = std::nan("");
  EXPECT_NO_THROW(bench.generator.track(bad)) << "nothing runs: nothing is compared";
  bench.execute();
  bench.run(20);
  bad.header.stamp = bench.states.back().header.stamp;
  EXPECT_THROW(bench.generator.track(bad), InputError);
}

TEST(TrajectoryGenerator, PausesAndTellsWhen) {
  Bench bench;
  bench.run(3);
  EXPECT_EQ(bench.generator.resume().message, "nothing is paused");
  ASSERT_TRUE(bench.plan(question("polynomial_345", 2.0)).success);
  bench.execute();
  bench.run(80);
  EXPECT_NE(bench.generator.pause().message.find("at rest on its path in"), std::string::npos);
  EXPECT_EQ(bench.generator.pause().message, "paused already");
  bench.run(100);
  EXPECT_EQ(bench.states.back().velocity, std::vector<double>(3, 0.0));
  EXPECT_NE(bench.generator.resume().message.find("at its speed in"), std::string::npos);
  bench.run(300);
  EXPECT_NEAR(bench.states.back().position[0], 0.5, 1e-12);
  for (const double wrong : {-0.5, 1.5, std::nan("")}) {
    expectRefused([&] { bench.generator.setSpeed(wrong); }, AnswerCode::kInvalidGoal, "speed_override");
  }
  bench.generator.setSpeed(0.25);
  EXPECT_NE(bench.execute().message.find("at 0.25 of its speed"), std::string::npos);
}

TEST(TrajectoryGenerator, PointsWithALeadFollowIt) {
  const auto chain = arm();
  const VectorX zero = VectorX::Zero(3);
  const VectorX far = VectorX::Constant(3, 0.5);
  const JointTrajectory main = JointTrajectory::scaled(far, -far, TimeLaw::cubic(), 1.0);
  const Motion motion = startFrom({zero, zero, zero}, main, limitsOf(*chain));
  const auto all = withLead(*chain, motion, sampled(*chain, main, 0.1).message);
  for (std::size_t i = 1; i < all.points.size(); ++i) {
    EXPECT_GT(all.points[i].time_from_start, all.points[i - 1].time_from_start);
  }
  EXPECT_NEAR(all.points.back().time_from_start.toSec(), motion.duration(), 1e-8);
  EXPECT_EQ(all.points.front().positions, std::vector<double>(3, 0.0));
}

TEST(TrajectoryPlanner, ContinuousJointsTakeTheShortWayAndSaySo) {
  const auto chain =
      std::make_shared<const SerialChain>(readUrdfFile(std::string(SCREWLINE_SOURCE_DIR) + "/urdf/rrr_planar.urdf"));
  ASSERT_EQ(chain->joint(2).type, JointType::kContinuous);
  const TrajectoryPlanner planner({chain, Task::parse({"x", "y", "rz"}), {}}, 0.1,
                                  [](const std::string&) { return std::optional<Pose>(); });
  PlanTrajectory::Request request = question("polynomial_345");
  request.waypoints = {at({0.0, 0.0, 0.0}), at({0.5, 0.5, 5.0})};
  PlanTrajectory::Response response;
  PlannedMotion planned;
  const Outcome outcome = planner.plan(request, VectorX::Zero(3), response, planned);
  EXPECT_NEAR(response.trajectory.points.back().positions[2], 5.0 - kTwoPi, 1e-12);
  EXPECT_EQ(response.metrics.goal_error, 0.0);
  EXPECT_NE(outcome.message.find("takes the short way"), std::string::npos) << outcome.message;
  request.parameter_names = {"keep_turns"};
  request.parameter_values = {1.0};
  planner.plan(request, VectorX::Zero(3), response, planned);
  EXPECT_NEAR(response.trajectory.points.back().positions[2], 5.0, 1e-12);
}

TEST(TrajectoryParams, EveryKeyAndItsBounds) {
  EXPECT_EQ(readTrajectoryParams(XmlRpcValue()).rate, 100.0);
  XmlRpcValue values;
  values["rate"] = 250;
  values["initial_position"][0] = 1;
  values["initial_position"][1] = 0.5;
  const TrajectoryParams params = readTrajectoryParams(values);
  EXPECT_EQ(params.rate, 250.0);
  EXPECT_EQ(params.initial_position, (std::vector<double>{1.0, 0.5}));
  values["rate"] = 1000.5;
  expectModelError([&] { readTrajectoryParams(values); }, "~rate");
  values["rate"] = 0.5;
  expectModelError([&] { readTrajectoryParams(values); }, "~rate");
  XmlRpcValue unknown;
  unknown["speed"] = 1;
  expectModelError([&] { readTrajectoryParams(unknown); }, "~speed");
}

}  // namespace
}  // namespace ros_bridge
}  // namespace screwline

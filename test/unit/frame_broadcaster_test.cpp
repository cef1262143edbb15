#include "screwline/ros/frame_broadcaster.h"

#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <map>
#include <set>
#include <sstream>

#include "screwline/exception.h"
#include "screwline/kinematics/jacobian.h"
#include "screwline/ros/conversions.h"
#include "screwline/ros/markers.h"

namespace screwline {
namespace ros_bridge {
namespace {

using visualization_msgs::Marker;

const char* const kRobots[] = {"prrr_arm",       "rrp_spherical",   "rr_planar", "rrr_planar",  "rrr_articulated",
                               "rrp_offset",     "rpp_cylindrical", "scara",     "prrr_column", "spherical_wrist",
                               "rrr_orthogonal", "orienting_3r",    "planar_3r", "rrprrr"};

std::string urdfOf(const std::string& robot) {
  std::ifstream file(std::string(SCREWLINE_SOURCE_DIR) + "/urdf/" + robot + ".urdf");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

ServedRobot load(const std::string& robot) {
  return makeRobot({urdfOf(robot), "robot_description", {}}, {});
}

/// Joint values that no geometry is special at.
VectorX someConfiguration(int n, int k = 0) {
  VectorX q(n);
  for (int i = 0; i < n; ++i) q[i] = 0.31 + 0.17 * i - 0.23 * k;
  return q;
}

/// What a broadcaster sends, kept.
struct Record {
  std::vector<geometry_msgs::TransformStamped> constant;
  std::vector<std::vector<geometry_msgs::TransformStamped>> transforms;
  std::vector<visualization_msgs::MarkerArray> markers;

  BroadcasterSinks sinks() {
    return {[this](const auto& transform) { constant.push_back(transform); },
            [this](const auto& array) { transforms.push_back(array); },
            [this](const auto& array) { markers.push_back(array); }};
  }
};

sensor_msgs::JointState stateOf(const SerialChain& chain, const VectorX& q, double time) {
  sensor_msgs::JointState state;
  state.header.stamp = ros::Time(time);
  state.name = chain.jointNames();
  state.position = arrayOf(q);
  return state;
}

Pose poseOf(const geometry_msgs::TransformStamped& transform) {
  const auto& p = transform.transform.translation;
  const auto& q = transform.transform.rotation;
  return {Quaternion(q.w, q.x, q.y, q.z).toRotationMatrix(), {p.x, p.y, p.z}};
}

/// Pose of every frame in the base link, as tf2 composes them.
std::map<std::string, Pose> composed(const Record& record, const std::string& base) {
  std::map<std::string, Pose> poses{{base, Pose()}};
  std::vector<geometry_msgs::TransformStamped> all = record.constant;
  all.insert(all.end(), record.transforms.back().begin(), record.transforms.back().end());
  for (const auto& transform : all) {
    poses[transform.child_frame_id] = poses.at(transform.header.frame_id) * poseOf(transform);
  }
  return poses;
}

Vector3 vectorOf(const geometry_msgs::Point& point) {
  return {point.x, point.y, point.z};
}

std::vector<Marker> addedIn(const std::vector<Marker>& markers, const std::string& space) {
  std::vector<Marker> result;
  for (const Marker& marker : markers)
    if (marker.ns == space && marker.action == Marker::ADD) result.push_back(marker);
  return result;
}

TEST(AnalysisFrames, ToolIsForwardKinematicsAndDhFramesLeadToIt) {
  for (const char* name : kRobots) {
    const ServedRobot robot = load(name);
    Record record;
    FrameBroadcaster broadcaster(robot, {}, {}, record.sinks());
    broadcaster.start(ros::Time(1.0));
    const VectorX q = someConfiguration(robot.chain->size());
    broadcaster.onJointState(stateOf(*robot.chain, q, 2.0), ros::Time(9.0));
    const auto poses = composed(record, robot.chain->baseLink());
    const Pose tip = forwardByExponentials(*robot.chain, q);
    EXPECT_TRUE(isApprox(poses.at("screwline/tool"), tip, 1e-12)) << name;
    const std::string last = "screwline/dh_" + std::to_string(robot.chain->size());
    EXPECT_TRUE(isApprox(poses.at(last) * robot.chain->modifiedDh().tool_transform, tip, 1e-12)) << name;
    EXPECT_EQ(record.transforms.back().front().header.stamp, ros::Time(2.0)) << name;
  }
}

TEST(AnalysisFrames, AxisOfEachDhFrameIsTheJointsAxis) {
  const ServedRobot robot = load("rrprrr");
  Record record;
  FrameBroadcaster broadcaster(robot, {}, {}, record.sinks());
  broadcaster.start(ros::Time(1.0));
  const VectorX q = someConfiguration(6);
  broadcaster.onJointState(stateOf(*robot.chain, q, 2.0), ros::Time());
  const auto poses = composed(record, robot.chain->baseLink());
  Matrix6X J;
  geometricJacobian(*robot.chain, q, J);
  for (int i = 0; i < 6; ++i) {
    const Vector3 z = poses.at("screwline/dh_" + std::to_string(i + 1)).R.col(2);
    const Vector3 axis = robot.chain->joint(i).isRevolute() ? J.col(i).tail<3>() : J.col(i).head<3>();
    EXPECT_NEAR((z - axis).norm(), 0.0, 1e-12) << i;
  }
}

TEST(AnalysisFrames, NamesThatTheDescriptionHasAreRefused) {
  const ServedRobot robot = load("rr_planar");
  try {
    AnalysisFrames frames(robot.chain, "screwline/", {"base_link", "screwline/dh_2"});
    FAIL();
  } catch (const ModelError& error) {
    EXPECT_NE(std::string(error.what()).find("'screwline/dh_2'"), std::string::npos) << error.what();
  }
  EXPECT_THROW(AnalysisFrames(robot.chain, "", {"tool"}), ModelError);
  EXPECT_NO_THROW(AnalysisFrames(robot.chain, "", linkNames(urdfOf("rr_planar"))));
}

TEST(JointStates, NamesInAnyOrderOthersBesidesAndSeveralPublishers) {
  const ServedRobot robot = load("rr_planar");
  JointStateTracker tracker(robot.chain);
  sensor_msgs::JointState state;
  state.name = {"gripper", "theta2"};
  state.position = {std::numeric_limits<double>::quiet_NaN(), 0.5};
  EXPECT_FALSE(tracker.update(state));
  state.name = {"theta1"};
  state.position = {0.25};
  EXPECT_TRUE(tracker.update(state));
  EXPECT_EQ(tracker.positions(), Eigen::Vector2d(0.25, 0.5));
  state.name = {"gripper"};
  EXPECT_FALSE(tracker.update(state));
  state.position.clear();
  EXPECT_FALSE(tracker.update(state));
}

TEST(JointStates, BadOnesAreRefusedAndChangeNothing) {
  const ServedRobot robot = load("rr_planar");
  JointStateTracker tracker(robot.chain);
  ASSERT_TRUE(tracker.update(stateOf(*robot.chain, Eigen::Vector2d(0.1, 0.2), 1.0)));
  EXPECT_THROW(tracker.update(stateOf(*robot.chain, Eigen::Vector2d(0.3, std::nan("")), 1.0)), InputError);
  sensor_msgs::JointState state;
  state.name = {"theta1"};
  state.position = {0.0, 0.0};
  EXPECT_THROW(tracker.update(state), InputError);
  EXPECT_EQ(tracker.positions(), Eigen::Vector2d(0.1, 0.2));
}

TEST(Broadcaster, StampsAdvanceAndAJumpBackStartsAnew) {
  const ServedRobot robot = load("rr_planar");
  Record record;
  FrameBroadcaster broadcaster(robot, {}, {}, record.sinks());
  const auto send = [&](double time, double angle) {
    broadcaster.onJointState(stateOf(*robot.chain, Eigen::Vector2d(angle, 0.0), time), ros::Time(50.0));
    return record.transforms.size();
  };
  EXPECT_EQ(send(10.0, 0.0), 1U);
  EXPECT_EQ(send(10.0, 0.1), 1U);
  EXPECT_EQ(send(9.8, 0.1), 1U);
  EXPECT_EQ(send(10.1, 0.5), 2U);
  EXPECT_EQ(addedIn(record.markers.back().markers, kToolPathMarkers).front().points.size(), 2U);
  EXPECT_EQ(send(5.0, 0.0), 3U);
  EXPECT_TRUE(addedIn(record.markers.back().markers, kToolPathMarkers).empty());
  EXPECT_EQ(send(0.0, 0.0), 4U);
  EXPECT_EQ(record.transforms.back().front().header.stamp, ros::Time(50.0)) << "no stamp: now";
}

TEST(Broadcaster, MarkersKeepTheirRateWhateverTheJitter) {
  const ServedRobot robot = load("rr_planar");
  Record record;
  FrameBroadcaster broadcaster(robot, {}, {}, record.sinks());
  for (int i = 0; i <= 1000; ++i) {
    const double time = 10.0 + 0.01 * i + (i % 3) * 1e-4;
    broadcaster.onJointState(stateOf(*robot.chain, Eigen::Vector2d(0.01 * i, 0.0), time), ros::Time());
  }
  EXPECT_EQ(record.transforms.size(), 1001U);
  EXPECT_NEAR(static_cast<double>(record.markers.size()), 201.0, 1.0);
}

TEST(Broadcaster, PathIsBounded) {
  const ServedRobot robot = load("rr_planar");
  Record record;
  BroadcasterParams params;
  params.markers.path_points = 20;
  FrameBroadcaster broadcaster(robot, {}, params, record.sinks());
  for (int i = 0; i <= 100; ++i) {
    broadcaster.onJointState(stateOf(*robot.chain, Eigen::Vector2d(0.05 * i, 0.0), 10.0 + 0.1 * i), ros::Time());
  }
  const Marker path = addedIn(record.markers.back().markers, kToolPathMarkers).front();
  EXPECT_EQ(path.points.size(), 20U);
  const Vector3 tool = forwardKinematics(*robot.chain, Eigen::Vector2d(5.0, 0.0)).p;
  EXPECT_NEAR((vectorOf(path.points.back()) - tool).norm(), 0.0, 1e-12);
}

TEST(Broadcaster, TargetIsTheTrajectorysEndOrTheOneGiven) {
  const ServedRobot robot = load("planar_3r");
  Record record;
  FrameBroadcaster broadcaster(robot, {}, {}, record.sinks());
  broadcaster.start(ros::Time(1.0));
  const auto targetAt = [&](double time) {
    broadcaster.onJointState(stateOf(*robot.chain, VectorX::Zero(3), time), ros::Time());
    return composed(record, robot.chain->baseLink());
  };
  EXPECT_EQ(targetAt(1.0).count("screwline/target"), 0U);

  trajectory_msgs::JointTrajectory trajectory;
  trajectory.joint_names = {"theta3", "theta1", "theta2"};
  trajectory.points.resize(2);
  trajectory.points.back().positions = {0.3, 0.1, 0.2};
  broadcaster.onTrajectory(trajectory);
  const Pose end = forwardKinematics(*robot.chain, Vector3(0.1, 0.2, 0.3));
  EXPECT_TRUE(isApprox(targetAt(2.0).at("screwline/target"), end, 1e-12));

  geometry_msgs::PoseStamped given;
  given.header.frame_id = "screwline/dh_1";
  given.pose = toPose(end);
  broadcaster.onTarget(given);
  const auto poses = targetAt(3.0);
  EXPECT_TRUE(isApprox(poses.at("screwline/target"), poses.at("screwline/dh_1") * end, 1e-12));

  broadcaster.onTrajectory(trajectory_msgs::JointTrajectory());
  EXPECT_EQ(targetAt(4.0).count("screwline/target"), 0U);
}

TEST(Broadcaster, BadTargetsAreRefused) {
  const ServedRobot robot = load("planar_3r");
  Record record;
  FrameBroadcaster broadcaster(robot, {}, {}, record.sinks());
  geometry_msgs::PoseStamped target;
  EXPECT_THROW(broadcaster.onTarget(target), InputError) << "the quaternion is zero";
  target.pose.orientation.w = 1.0;
  target.header.frame_id = "screwline/target";
  EXPECT_THROW(broadcaster.onTarget(target), InputError);
  target.header.frame_id = "/base_link";
  EXPECT_THROW(broadcaster.onTarget(target), InputError);
  trajectory_msgs::JointTrajectory trajectory;
  trajectory.joint_names = {"theta1"};
  trajectory.points.resize(1);
  EXPECT_THROW(broadcaster.onTrajectory(trajectory), InputError);
}

TEST(Markers, IdsAreUniqueNumbersFiniteAndAlwaysTheSameSet) {
  for (const char* name : kRobots) {
    const ServedRobot robot = load(name);
    std::set<std::pair<std::string, int>> expected;
    for (int k = 0; k < 4; ++k) {
      const VectorX q =
          k == 0 ? VectorX(VectorX::Zero(robot.chain->size())) : someConfiguration(robot.chain->size(), k);
      std::set<std::pair<std::string, int>> ids;
      for (const Marker& marker : configurationMarkers(*robot.chain, robot.task, q, {})) {
        EXPECT_TRUE(ids.insert({marker.ns, marker.id}).second) << name << " " << marker.ns << " " << marker.id;
        EXPECT_TRUE(std::isfinite(marker.pose.orientation.x + marker.scale.x + marker.scale.y + marker.scale.z));
        EXPECT_GT(marker.scale.x, 0.0);
        const auto& o = marker.pose.orientation;
        EXPECT_NEAR(o.x * o.x + o.y * o.y + o.z * o.z + o.w * o.w, 1.0, 1e-12);
        for (const auto& point : marker.points) EXPECT_TRUE(vectorOf(point).allFinite());
      }
      if (k == 0) expected = ids;
      EXPECT_EQ(ids, expected) << name;
    }
  }
}

TEST(Markers, AxisArrowsLieOnTheJointAxes) {
  for (const char* name : kRobots) {
    const ServedRobot robot = load(name);
    const VectorX q = someConfiguration(robot.chain->size());
    Matrix6X J;
    const Vector3 tool = geometricJacobian(*robot.chain, q, J).p;
    const std::vector<Marker> markers = screwAxisMarkers(*robot.chain, q);
    ASSERT_EQ(markers.size(), 2U * robot.chain->axes().size());
    for (int i = 0; i < robot.chain->size(); ++i) {
      const Marker& arrow = markers[2U * static_cast<std::size_t>(i)];
      const Vector3 direction = (vectorOf(arrow.points[1]) - vectorOf(arrow.points[0])).normalized();
      const bool revolute = robot.chain->joint(i).isRevolute();
      const Vector3 axis = revolute ? J.col(i).tail<3>() : J.col(i).head<3>();
      EXPECT_NEAR((direction - axis).norm(), 0.0, 1e-12) << name << " " << i;
      if (!revolute) continue;
      const Vector3 speed = axis.cross(tool - vectorOf(arrow.points[0]));
      EXPECT_NEAR((speed - J.col(i).head<3>()).norm(), 0.0, 1e-12) << name << " " << i;
    }
  }
}

TEST(Markers, EllipsoidHoldsTheSpeedsOfUnitRates) {
  const ServedRobot robot = load("rrr_articulated");
  const VectorX q = someConfiguration(3);
  Matrix6X J;
  const Vector3 tool = geometricJacobian(*robot.chain, q, J).p;
  const double scale = 0.3;
  const Marker marker = manipulabilityMarker(J, tool, scale, 1e-6);
  const auto& o = marker.pose.orientation;
  const Matrix3 R = Quaternion(o.w, o.x, o.y, o.z).toRotationMatrix();
  const Vector3 radii = Vector3(marker.scale.x, marker.scale.y, marker.scale.z) / 2.0;
  // J J^T = U S^2 U^T.
  const Matrix3 shape = R * radii.cwiseAbs2().asDiagonal() * R.transpose();
  EXPECT_NEAR((shape - scale * scale * J.topRows(3) * J.topRows(3).transpose()).norm(), 0.0, 1e-12);
}

TEST(Markers, EllipsoidOfALostAxisIsThin) {
  const ServedRobot robot = load("planar_3r");
  Matrix6X J;
  const Vector3 tool = geometricJacobian(*robot.chain, VectorX::Zero(3), J).p;
  const Marker marker = manipulabilityMarker(J, tool, 1.0, 0.01);
  EXPECT_DOUBLE_EQ(marker.scale.y, 0.02);
  EXPECT_DOUBLE_EQ(marker.scale.z, 0.02);
  EXPECT_GT(marker.scale.x, 1.0);
}

TEST(Markers, LostDirectionOfAStretchedArmIsAlongIt) {
  const ServedRobot robot = load("rr_planar");
  const auto lostAt = [&](double elbow) {
    const std::vector<Marker> markers = configurationMarkers(*robot.chain, robot.task, Eigen::Vector2d(0.7, elbow), {});
    return addedIn(markers, kLostDirectionMarkers);
  };
  EXPECT_TRUE(lostAt(1.2).empty());
  const std::vector<Marker> lost = lostAt(0.0);
  ASSERT_EQ(lost.size(), 2U);
  const Vector3 along = (vectorOf(lost[0].points[1]) - vectorOf(lost[0].points[0])).normalized();
  EXPECT_NEAR(std::abs(along.dot(Vector3(std::cos(0.7), std::sin(0.7), 0.0))), 1.0, 1e-9);
  const std::vector<Marker> near = lostAt(0.02);
  ASSERT_EQ(near.size(), 2U);
  EXPECT_LT(near[0].color.a, lost[0].color.a);
}

TEST(Markers, LostRotationOfAnAlignedWrist) {
  const ServedRobot robot = load("spherical_wrist");
  const std::vector<Marker> markers = configurationMarkers(*robot.chain, robot.task, Vector3(0.4, 0.0, 0.1), {});
  const std::vector<Marker> lost = addedIn(markers, kLostDirectionMarkers);
  ASSERT_EQ(lost.size(), 2U);
  const Vector3 along = (vectorOf(lost[0].points[1]) - vectorOf(lost[0].points[0])).normalized();
  EXPECT_NEAR(std::abs(along.dot(Vector3(std::cos(0.4), std::sin(0.4), 0.0))), 1.0, 1e-9);
}

TEST(Parameters, DefaultsBoundsAndUnknownKeys) {
  EXPECT_EQ(readBroadcasterParams({}).frame_prefix, "screwline/");
  const auto refused = [](const std::string& key, const XmlRpc::XmlRpcValue& value) {
    XmlRpc::XmlRpcValue values;
    values[key] = value;
    try {
      readBroadcasterParams(values);
    } catch (const ModelError& error) {
      return std::string(error.what()).find("~" + key) == 0;
    }
    return false;
  };
  EXPECT_TRUE(refused("frame_prefix", "/screwline/"));
  EXPECT_TRUE(refused("frame_prefix", 3));
  EXPECT_TRUE(refused("marker_rate", 0.0));
  EXPECT_TRUE(refused("marker_rate", std::nan("")));
  EXPECT_TRUE(refused("near_singular", 1.5));
  EXPECT_TRUE(refused("path_points", 1));
  EXPECT_TRUE(refused("markerrate", 10.0));
  EXPECT_TRUE(refused("task", 1));
}

}  // namespace
}  // namespace ros_bridge
}  // namespace screwline

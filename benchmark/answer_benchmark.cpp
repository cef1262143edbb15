// What kinematics_server does for a request besides the transport: the service's body, its check and the answer's
// serialisation, in this process and without a master. KDL's forward kinematics of six joints in the same run.
#include <benchmark/benchmark.h>
#include <ros/serialization.h>

#include <fstream>
#include <sstream>

#include "kdl_unit.h"
#include "robots.h"
#include "screwline/ros/kinematics_server.h"
#include "screwline/ros/service_adapter.h"

namespace screwline {
namespace benchmark_support {
namespace {

using ros_bridge::KinematicsServer;
using ros_bridge::Outcome;

KinematicsServer serverOf(const Robot& robot) {
  std::ostringstream text;
  text << std::ifstream(robot.path).rdbuf();
  ros_bridge::RobotSource source;
  source.name = "robot_description";
  source.description = text.str();
  ros_bridge::KinematicsParams params;
  params.robot.task = robot.task.names();
  return KinematicsServer(ros_bridge::makeRobot(source, params.robot), params, nullptr);
}

template <typename Request, typename Response>
void answer(benchmark::State& state, const KinematicsServer& server, Request& request,
            Outcome (KinematicsServer::*method)(const Request&, Response&) const) {
  for (auto _ : state) {
    Response response;
    ros_bridge::serve("benchmark", response, [&] { return (server.*method)(request, response); });
    if (!response.success) state.SkipWithError(response.message.c_str());
    benchmark::DoNotOptimize(ros::serialization::serializeServiceResponse(true, response));
  }
}

sensor_msgs::JointState stateOf(const Robot& robot) {
  sensor_msgs::JointState state;
  state.position.assign(static_cast<std::size_t>(robot.chain.size()), 0.4);
  return state;
}

void fk(benchmark::State& state, const std::string& name) {
  const Robot robot(name);
  ComputeFK::Request request;
  request.joint_state = stateOf(robot);
  answer(state, serverOf(robot), request, &KinematicsServer::computeFk);
}

void jacobian(benchmark::State& state, const std::string& name) {
  const Robot robot(name);
  ComputeJacobian::Request request;
  request.joint_state = stateOf(robot);
  answer(state, serverOf(robot), request, &KinematicsServer::computeJacobian);
}

void ik(benchmark::State& state, const std::string& name) {
  const Robot robot(name);
  const KinematicsServer server = serverOf(robot);
  ComputeFK::Request where;
  where.joint_state = stateOf(robot);
  ComputeFK::Response there;
  server.computeFk(where, there);
  ComputeIK::Request request;
  request.pose = there.poses.front();
  answer(state, server, request, &KinematicsServer::computeIk);
}

BENCHMARK_CAPTURE(forwardKdl, rrprrr, "rrprrr");
BENCHMARK_CAPTURE(fk, rrprrr, "rrprrr");
BENCHMARK_CAPTURE(jacobian, rrprrr, "rrprrr");
BENCHMARK_CAPTURE(ik, rrprrr, "rrprrr");

}  // namespace
}  // namespace benchmark_support
}  // namespace screwline

BENCHMARK_MAIN();

/// A client of screwline in C++: every way to reach a pose, the best of them explained, and a motion there.
///
///     roslaunch screwline bringup.launch robot:=planar_3r     # in one terminal
///     rosrun screwline example_client                         # in another
///
/// Works with every robot. Without trajectory_generator nothing moves.
#include <ros/ros.h>
#include <screwline/AnalyzeSingularity.h>
#include <screwline/ComputeFK.h>
#include <screwline/ComputeIK.h>
#include <screwline/Describe.h>
#include <screwline/ExecuteTrajectory.h>
#include <screwline/PlanTrajectory.h>
#include <sensor_msgs/JointState.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

const ros::Duration kLongestWait(20.0);

/// Calls a service. An answer without success says in its message which input broke which bound.
template <typename Service>
typename Service::Response ask(const std::string& name, const typename Service::Request& request) {
  typename Service::Response answer;
  if (!ros::service::call(name, request, answer)) throw std::runtime_error(name + ": nobody answers");
  if (!answer.success) throw std::runtime_error(name + ": " + answer.message);
  return answer;
}

void print(const std::vector<double>& values) {
  for (const double value : values) std::printf(" %8.4f", value);
}

/// Joint values inside the limits, and away from where most arms are singular.
std::vector<double> someConfiguration(const screwline::Describe::Response& robot) {
  std::vector<double> values;
  for (std::size_t i = 0; i < robot.joint_names.size(); ++i) {
    values.push_back(std::min(std::max(0.5 + 0.2 * static_cast<double>(i), robot.lower[i]), robot.upper[i]));
  }
  return values;
}

/// All solutions for a pose of the tip, of which the one with the greatest manipulability is the best.
screwline::IkSolution bestSolution(const geometry_msgs::PoseStamped& pose) {
  screwline::ComputeIK::Request request;
  request.pose = pose;
  const auto answer = ask<screwline::ComputeIK>("kinematics_server/compute_ik", request);
  std::printf("%s, %s:\n", answer.message.c_str(), answer.complete ? "complete" : "there may be more");
  for (const auto& solution : answer.solutions) {
    print(solution.position);
    std::printf("  %s\n", solution.branch.c_str());
  }
  return *std::max_element(answer.solutions.begin(), answer.solutions.end(),
                           [](const auto& a, const auto& b) { return a.manipulability < b.manipulability; });
}

void explain(const sensor_msgs::JointState& joints) {
  screwline::AnalyzeSingularity::Request request;
  request.joint_state = joints;
  const auto analysis = ask<screwline::AnalyzeSingularity>("kinematics_server/analyze_singularity", request);
  std::printf("manipulability %.4f, %.4f from the nearest singularity\n", analysis.manipulability,
              analysis.distance_to_singularity);
  for (const auto& condition : analysis.conditions) {
    std::printf("  %s: %s, here %.4f\n", condition.name.c_str(), condition.expression.c_str(), condition.value);
  }
}

/// Joint values in the chain's order; a JointState may have any order, and other joints too.
std::vector<double> presentPosition(const std::vector<std::string>& joint_names) {
  const auto state = ros::topic::waitForMessage<sensor_msgs::JointState>("joint_states", kLongestWait);
  if (!state) throw std::runtime_error("joint_states: nobody publishes them");
  std::vector<double> position;
  for (const std::string& name : joint_names) {
    const auto found = std::find(state->name.begin(), state->name.end(), name);
    if (found == state->name.end()) throw std::runtime_error("joint_states: no joint " + name);
    position.push_back(state->position.at(static_cast<std::size_t>(found - state->name.begin())));
  }
  return position;
}

double largestDifference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b.at(i)));
  return largest;
}

/// Plans a motion to the pose on the given branch, in the shortest time at half the speed limits; does it.
void moveTo(const geometry_msgs::PoseStamped& pose, const std::string& branch,
            const std::vector<std::string>& joint_names) {
  screwline::PlanTrajectory::Request request;
  request.profile = "minimum_jerk";
  request.velocity_scaling = 0.5;
  request.waypoints.resize(2);
  request.waypoints[0].position = presentPosition(joint_names);
  request.waypoints[1].pose = pose;
  request.waypoints[1].branch = branch;
  const auto plan = ask<screwline::PlanTrajectory>("trajectory_generator/plan", request);
  std::printf("planned: %.3f s, tool path %.3f m, peak speed %.3f m/s\n", plan.duration, plan.metrics.path_length,
              plan.metrics.peak_speed);
  ask<screwline::ExecuteTrajectory>("trajectory_generator/execute", {});
  const std::vector<double>& goal = plan.trajectory.points.back().positions;
  const ros::Time deadline = ros::Time::now() + ros::Duration(plan.duration) + kLongestWait;
  while (largestDifference(goal, presentPosition(joint_names)) > 1e-6) {
    if (ros::Time::now() > deadline) throw std::runtime_error("the motion did not arrive");
  }
  std::printf("arrived at");
  print(goal);
  std::printf("\n");
}

void run() {
  if (!ros::service::waitForService("kinematics_server/describe", kLongestWait)) {
    throw std::runtime_error("kinematics_server/describe: nobody offers it");
  }
  const auto robot = ask<screwline::Describe>("kinematics_server/describe", {});
  std::printf("%s to %s, %s\n", robot.base_link.c_str(), robot.tip_link.c_str(), robot.ik_method.c_str());

  screwline::ComputeFK::Request forward;
  forward.joint_state.name = robot.joint_names;
  forward.joint_state.position = someConfiguration(robot);
  const auto pose = ask<screwline::ComputeFK>("kinematics_server/compute_fk", forward).poses.front();
  const screwline::IkSolution best = bestSolution(pose);
  sensor_msgs::JointState joints;
  joints.name = robot.joint_names;
  joints.position = best.position;
  explain(joints);

  if (ros::service::exists("trajectory_generator/plan", false)) moveTo(pose, best.branch, robot.joint_names);
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "screwline_client", ros::init_options::AnonymousName);
  ros::NodeHandle node;
  try {
    run();
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "example_client: %s\n", error.what());
    return 1;
  }
}

// Round trips over persistent connections: the server's services against an empty one, and against ones that send the
// same answers without having to find them, in turn in the same run. Needs a roscore and a kinematics_server named
// /kinematics_server; benchmark/run starts both.
#include <ros/ros.h>
#include <screwline/ComputeFK.h>
#include <screwline/ComputeIK.h>
#include <screwline/ComputeJacobian.h>
#include <screwline/Describe.h>
#include <std_srvs/Empty.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <vector>

namespace {

constexpr int kRounds = 40;
constexpr int kCallsPerRound = 100;

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

template <typename Service>
double secondsPerCall(ros::ServiceClient& client, Service& service) {
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < kCallsPerRound; ++i) {
    if (!client.call(service)) ROS_FATAL("%s does not answer", client.getService().c_str());
  }
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / kCallsPerRound;
}

/// Offers the answer of a kinematics_server's service without its mathematics: asked of it once, then repeated.
template <typename Service>
ros::ServiceServer offerCanned(ros::NodeHandle& node, const std::string& name, typename Service::Response& stored,
                               bool& known) {
  const boost::function<bool(typename Service::Request&, typename Service::Response&)> answer =
      [name, &stored, &known](typename Service::Request& request, typename Service::Response& response) {
        if (!known) known = ros::service::call("/kinematics_server/" + name, request, stored);
        response = stored;
        return known;
      };
  return node.advertiseService("/canned/" + name, answer);
}

template <typename Service>
struct Canned {
  Canned(ros::NodeHandle& node, const std::string& name) : server(offerCanned<Service>(node, name, stored, known)) {}
  typename Service::Response stored;
  bool known = false;
  ros::ServiceServer server;
};

/// Rounds of three, empty, canned and asked service in turn, so that a drifting machine does not decide.
template <typename Service>
void compare(const char* name, ros::ServiceClient& empty, Service service) {
  ros::NodeHandle node;
  ros::ServiceClient asked = node.serviceClient<Service>(std::string("/kinematics_server/") + name, true);
  ros::ServiceClient canned = node.serviceClient<Service>(std::string("/canned/") + name, true);
  asked.waitForExistence();
  canned.waitForExistence();
  std_srvs::Empty nothing;
  std::vector<double> ratios;
  std::vector<double> to_canned;
  std::vector<double> times;
  for (int round = 0; round < kRounds; ++round) {
    const double reference = secondsPerCall(empty, nothing);
    const double transport = secondsPerCall(canned, service);
    const double time = secondsPerCall(asked, service);
    times.push_back(time * 1e6);
    ratios.push_back(time / reference);
    to_canned.push_back(time / transport);
  }
  std::printf("%-20s median %7.1f us, ratio to the empty service %.3f, to the same answer without mathematics %.3f\n",
              name, median(times), median(ratios), median(to_canned));
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "service_benchmark");
  ros::NodeHandle node;
  // The empty service is served by another process, as the kinematics are: started with --serve.
  if (argc > 1 && std::string(argv[1]) == "--serve") {
    const boost::function<bool(std_srvs::Empty::Request&, std_srvs::Empty::Response&)> answer =
        [](std_srvs::Empty::Request&, std_srvs::Empty::Response&) { return true; };
    const ros::ServiceServer server = node.advertiseService("/empty_service", answer);
    const Canned<screwline::ComputeFK> fk(node, "compute_fk");
    const Canned<screwline::ComputeJacobian> jacobian(node, "compute_jacobian");
    const Canned<screwline::ComputeIK> ik(node, "compute_ik");
    ros::AsyncSpinner spinner(0);
    spinner.start();
    ros::waitForShutdown();
    return 0;
  }
  ros::service::waitForService("/empty_service");
  ros::ServiceClient empty = node.serviceClient<std_srvs::Empty>("/empty_service", true);
  screwline::Describe describe;
  ros::service::waitForService("/kinematics_server/describe");
  ros::service::call("/kinematics_server/describe", describe);
  screwline::ComputeFK fk;
  fk.request.joint_state.position.assign(describe.response.joint_names.size(), 0.4);
  compare("compute_fk", empty, fk);
  screwline::ComputeJacobian jacobian;
  jacobian.request.joint_state = fk.request.joint_state;
  compare("compute_jacobian", empty, jacobian);
  ros::service::call("/kinematics_server/compute_fk", fk);
  screwline::ComputeIK ik;
  ik.request.pose = fk.response.poses.front();
  compare("compute_ik", empty, ik);
  return 0;
}

#include "screwline/ros/trajectory_generator.h"

#include <ros/console.h>
#include <std_msgs/Float64.h>

#include <boost/function.hpp>

#include "screwline/ros/checks.h"
#include "screwline/ros/trajectory_conversions.h"

namespace screwline {
namespace ros_bridge {
namespace {

/// Offers one method of the generator as a service.
template <typename Service, typename Body>
ros::ServiceServer offer(ros::NodeHandle& node, const std::string& name, const Body& body) {
  using Request = typename Service::Request;
  using Response = typename Service::Response;
  const boost::function<bool(Request&, Response&)> callback = [name, body](Request& request, Response& response) {
    return serve(name, response, [&] { return body(request, response); });
  };
  return node.advertiseService<Request, Response>(name, callback);
}

/// std_srvs/Trigger has no error_code.
ros::ServiceServer offerTrigger(ros::NodeHandle& node, const std::string& name, const std::function<Outcome()>& body) {
  using Request = std_srvs::Trigger::Request;
  using Response = std_srvs::Trigger::Response;
  const boost::function<bool(Request&, Response&)> callback = [name, body](Request&, Response& response) {
    const Outcome outcome = detail::run(response, body);
    detail::logOutcome(name, outcome);
    response.success = outcome.code == AnswerCode::kSuccess;
    response.message = outcome.message;
    return true;
  };
  return node.advertiseService<Request, Response>(name, callback);
}

/// Takes messages of a topic; one that is refused is warned of.
template <typename Message>
ros::Subscriber listen(ros::NodeHandle& node, const std::string& topic,
                       const std::function<void(const Message&)>& take) {
  const boost::function<void(const boost::shared_ptr<const Message>&)> callback =
      [topic, take](const boost::shared_ptr<const Message>& message) {
        try {
          take(*message);
        } catch (const std::exception& error) {
          ROS_WARN_STREAM_THROTTLE(1.0, "topic " << topic << " is refused: " << error.what());
        }
      };
  return node.subscribe<Message>(topic, 100, callback, ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
}

VectorX initialPosition(const SerialChain& chain, const std::vector<double>& given) {
  if (given.empty()) return chain.clamped(VectorX::Zero(chain.size()));
  if (given.size() != static_cast<std::size_t>(chain.size())) {
    throw ModelError("~initial_position has " + std::to_string(given.size()) + " values, chain " +
                     quoted(chain.name()) + " has " + std::to_string(chain.size()) + " joints");
  }
  const VectorX position = Eigen::Map<const VectorX>(given.data(), chain.size());
  for (int j = 0; j < chain.size(); ++j) {
    const JointLimits& limits = chain.joint(j).limits;
    if (position[j] >= limits.lower && position[j] <= limits.upper) continue;
    throw ModelError("~initial_position has " + numberText(position[j]) + " for joint " + quoted(chain.joint(j).name) +
                     ", its limits are " + numberText(limits.lower) + " to " + numberText(limits.upper));
  }
  return position;
}

}  // namespace

TrajectoryGenerator::TrajectoryGenerator(ServedRobot robot, const TrajectoryParams& params, FrameLookup lookup,
                                         MotionClock clock, const GeneratorSinks& sinks)
    : robot_(std::move(robot)),
      limits_(limitsOf(*robot_.chain)),
      sinks_(sinks),
      planner_(robot_, params.ik_timeout, std::move(lookup)),
      streams_(robot_.chain, sinks),
      reporter_(robot_.chain, params.rate, sinks.diagnostics),
      tracked_topic_(params.tracked_joint_states),
      executor_(initialPosition(*robot_.chain, params.initial_position), params.rate, limits_, std::move(clock),
                [this](const StreamSample& sample) { stream(sample); }) {}

void TrajectoryGenerator::advertise(ros::NodeHandle& private_node, ros::NodeHandle& node) {
  speed_ =
      listen<std_msgs::Float64>(node, kSpeedTopic, [this](const std_msgs::Float64& speed) { setSpeed(speed.data); });
  if (!tracked_topic_.empty()) {
    tracked_ = listen<sensor_msgs::JointState>(node, tracked_topic_,
                                               [this](const sensor_msgs::JointState& state) { track(state); });
  }
  services_ = {
      offer<PlanTrajectory>(private_node, kPlanService,
                            [this](const auto& request, auto& response) { return plan(request, response); }),
      offer<ExecuteTrajectory>(private_node, kExecuteService,
                               [this](const auto& request, auto& response) { return execute(request, response); }),
      offer<ListProfiles>(private_node, kListProfilesService,
                          [this](const auto& request, auto& response) { return listProfiles(request, response); }),
      offerTrigger(private_node, kStopService, [this] { return stop(); }),
      offerTrigger(private_node, kPauseService, [this] { return pause(); }),
      offerTrigger(private_node, kResumeService, [this] { return resume(); }),
  };
}

Outcome TrajectoryGenerator::plan(const PlanTrajectory::Request& request, PlanTrajectory::Response& response) {
  const auto planned = std::make_shared<PlannedMotion>();
  const Outcome outcome = planner_.plan(request, executor_.state().position, response, *planned);
  const std::lock_guard<std::mutex> lock(planned_mutex_);
  planned_ = planned;
  return outcome;
}

Outcome TrajectoryGenerator::listProfiles(const ListProfiles::Request&, ListProfiles::Response& response) const {
  for (const ProfileSummary& profile : screwline::listProfiles()) {
    ProfileInfo detail;
    detail.name = profile.name;
    detail.meaning = profile.meaning;
    for (const ParameterInfo& parameter : profile.parameters) {
      detail.parameter_names.push_back(parameter.name);
      detail.parameter_meanings.push_back(parameter.meaning);
    }
    response.profiles.push_back(profile.name);
    response.details.push_back(detail);
  }
  return {};
}

}  // namespace ros_bridge
}  // namespace screwline

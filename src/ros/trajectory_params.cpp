#include "screwline/ros/trajectory_params.h"

#include <cmath>

#include "screwline/exception.h"
#include "screwline/ros/checks.h"
#include "screwline/ros/node_constants.h"

namespace screwline {
namespace ros_bridge {
namespace {

constexpr char kRateParam[] = "rate";
constexpr char kTrackedStatesParam[] = "tracked_joint_states";
constexpr char kInitialPositionParam[] = "initial_position";
constexpr double kLowestRate = 1.0;         // Hz
constexpr double kHighestRate = 1000.0;     // Hz
constexpr double kLongestTimeout = 3600.0;  // s
constexpr int kMostThreads = 1024;

double readRate(ParamReader& reader, double otherwise) {
  const double rate = reader.number(kRateParam, otherwise, 0.0, kHighestRate);
  if (rate >= kLowestRate) return rate;
  throw ModelError(reader.nameOf(kRateParam) + " is " + numberText(rate) + ", it must be from " +
                   numberText(kLowestRate) + " to " + numberText(kHighestRate) + " Hz");
}

std::vector<double> readPosition(ParamReader& reader, const XmlRpc::XmlRpcValue& values) {
  reader.pass(kInitialPositionParam);
  if (!reader.has(kInitialPositionParam)) return {};
  using XmlRpc::XmlRpcValue;
  XmlRpcValue list = XmlRpcValue(values)[kInitialPositionParam];
  const std::string name = reader.nameOf(kInitialPositionParam);
  if (list.getType() != XmlRpcValue::TypeArray) throw ModelError(name + " must be a list of numbers");
  std::vector<double> position;
  for (int i = 0; i < list.size(); ++i) {
    const bool whole = list[i].getType() == XmlRpcValue::TypeInt;
    const std::string entry = name + "[" + std::to_string(i) + "]";
    if (!whole && list[i].getType() != XmlRpcValue::TypeDouble) throw ModelError(entry + " must be a number");
    const double value = whole ? static_cast<int>(list[i]) : static_cast<double>(list[i]);
    if (!(std::abs(value) <= kMaxMagnitude)) {
      throw ModelError(entry + " is " + numberText(value) + ", it must be finite and within +-" +
                       numberText(kMaxMagnitude));
    }
    position.push_back(value);
  }
  return position;
}

}  // namespace

TrajectoryParams readTrajectoryParams(const XmlRpc::XmlRpcValue& private_params) {
  ParamReader reader(private_params);
  TrajectoryParams params;
  params.robot = readRobotParams(reader);
  params.rate = readRate(reader, params.rate);
  params.ik_timeout = reader.number(kIkTimeoutParam, params.ik_timeout, 0.0, kLongestTimeout);
  params.threads = reader.integer(kThreadsParam, params.threads, 0, kMostThreads);
  params.tracked_joint_states = reader.text(kTrackedStatesParam, params.tracked_joint_states);
  params.initial_position = readPosition(reader, private_params);
  reader.refuseUnknown();
  return params;
}

}  // namespace ros_bridge
}  // namespace screwline

#ifndef SCREWLINE_ROS_SERVICE_ADAPTER_H
#define SCREWLINE_ROS_SERVICE_ADAPTER_H

#include <exception>
#include <string>

#include "screwline/exception.h"
#include "screwline/ros/response_check.h"

namespace screwline {
namespace ros_bridge {

/// How a question ended: what goes into success, error_code and message.
struct Outcome {
  AnswerCode code = AnswerCode::kSuccess;
  std::string message;
};

namespace detail {

/// Says it on the console: expected refusals at debug level, internal failures as errors.
void logOutcome(const std::string& service, const Outcome& outcome);

template <typename Response, typename Body>
Outcome run(Response& response, Body&& body) {
  try {
    const Outcome outcome = body();
    if (isSound(response)) return outcome;
    response = Response();
    return {AnswerCode::kFailure, "internal check: the answer holds a number that is not finite"};
  } catch (const InputError& error) {
    response = Response();
    return {error.code(), error.what()};
  } catch (const std::exception& error) {
    response = Response();
    return {AnswerCode::kFailure, std::string("internal failure: ") + error.what()};
  } catch (...) {
    response = Response();
    return {AnswerCode::kFailure, "internal failure of an unknown kind"};
  }
}

}  // namespace detail

/// Runs the body of a service: it fills the response and returns its Outcome, or throws. Fills success, error_code and
/// message; an answer after an exception holds nothing else. No exception passes; always true, as a service callback
/// must be for its caller to read why. `service` is for the log.
template <typename Response, typename Body>
bool serve(const std::string& service, Response& response, Body&& body) {
  const Outcome outcome = detail::run(response, body);
  detail::logOutcome(service, outcome);
  response.success = outcome.code == AnswerCode::kSuccess;
  response.error_code = static_cast<int>(outcome.code);
  response.message = outcome.message;
  return true;
}

}  // namespace ros_bridge
}  // namespace screwline

#endif  // SCREWLINE_ROS_SERVICE_ADAPTER_H

#include <ros/init.h>

#include <memory>
#include <utility>

#include "screwline/ik/method_summary.h"
#include "screwline/ros/checks.h"
#include "screwline/ros/kinematics_server.h"
#include "screwline/symbolic/derivation.h"

namespace screwline {
namespace ros_bridge {

Outcome KinematicsServer::derive(const Derive::Request& request, Derive::Response& response) const {
  const SerialChain& chain = *robot_.chain;
  constexpr std::size_t kMostQuantities = 100;
  requireCount(request.quantities.size(), kMostQuantities, "quantities");
  DerivationOptions options;
  options.quantities = request.quantities;
  options.format = documentFormatOf(request.format.empty() ? "markdown" : request.format);
  options.inverse = [&](const SerialChain& described) {
    const bool is_own = &described == &chain;  // Else with its rounded right angles put in.
    return inverseMethodOf(is_own ? solverFor(linkOrTip("", "tip_link"), robot_.task)
                                  : std::make_shared<const InverseKinematics>(described, robot_.task));
  };
  options.progress.time_limit = params_.derive_timeout;
  options.progress.cancelled = [] { return ros::isShuttingDown(); };
  response.joint_names = chain.jointNames();
  response.task = robot_.task.names();
  std::string message;
  try {
    Derivation derived = deriveDocument(chain, robot_.task, options);
    response.document = std::move(derived.document);
    response.factors = std::move(derived.factors);
    response.symbols = std::move(derived.symbols);
    response.symbol_values = std::move(derived.symbol_values);
    response.worst_deviation = derived.worst_deviation;
    if (!derived.no_inverse.empty()) message = "ik: the method and its branches; " + derived.no_inverse;
  } catch (const DerivationStopped& stopped) {
    throw InputError(AnswerCode::kTimedOut, stopped.what());
  }
  return {AnswerCode::kSuccess, message};
}

}  // namespace ros_bridge
}  // namespace screwline

#include <ros/init.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "screwline/ik/inverse_outline_of.h"
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
  const auto& asked = request.quantities;
  const bool inverse = asked.empty() || std::find(asked.begin(), asked.end(), "ik") != asked.end();
  // Of the chain that the document describes: the robot's own, or with its rounded right angles put in.
  const std::optional<SquaredChain> squared = inverse ? withRightAngles(chain, options.right_angles) : std::nullopt;
  const auto solver = squared ? std::make_shared<const InverseKinematics>(squared->chain, robot_.task)
                              : solverFor(linkOrTip("", "tip_link"), robot_.task);
  if (inverse) {
    options.inverse = summaryOf(*solver);
    options.inverse_outline = inverseOutlineOf(solver->chain(), robot_.task);
    options.inverse_solver = everySolution(*solver);
  }
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

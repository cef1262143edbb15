#include "screwline/ros/derived_conditions.h"

#include <sys/resource.h>

#include <exception>
#include <optional>
#include <utility>

#include "screwline/symbolic/conditions.h"

namespace screwline {
namespace ros_bridge {
namespace {

constexpr int kNiceness = 5;  ///< Of the deriving thread beside those that answer.

}  // namespace

DerivedConditions::DerivedConditions(std::shared_ptr<const SerialChain> chain, const Task& task, double time_limit) {
  if (time_limit <= 0.0) return;
  state_ = State::kDeriving;
  thread_ = std::thread([this, chain = std::move(chain), task, time_limit] { derive(*chain, task, time_limit); });
}

DerivedConditions::~DerivedConditions() {
  cancelled_ = true;
  if (thread_.joinable()) thread_.join();
}

void DerivedConditions::derive(const SerialChain& chain, const Task& task, double time_limit) {
  // Linux keeps a niceness for each thread; elsewhere nothing is lost where the call does nothing.
  static_cast<void>(setpriority(PRIO_PROCESS, 0, kNiceness));
  State state = State::kNotFound;
  try {
    state = deriveInTime(chain, task, time_limit);
  } catch (const std::exception& error) {  // Out of memory, or the algebra system's own.
    reason_ = error.what();
  }
  if (state == State::kDerived) known_.store(&factors_, std::memory_order_release);
  state_.store(state, std::memory_order_release);
}

DerivedConditions::State DerivedConditions::deriveInTime(const SerialChain& chain, const Task& task,
                                                         double time_limit) {
  Progress progress;
  progress.time_limit = time_limit;
  progress.cancelled = [this] { return cancelled_.load(); };
  std::optional<Factors> found = derivedFactorsOf(chain, task, progress);
  if (!found) {
    reason_ = "the exact determinant has no factors to name";
    return State::kNotFound;
  }
  factors_ = std::move(*found);
  return State::kDerived;
}

std::string DerivedConditions::note() const {
  const std::string conditions = "the conditions of analyze_singularity are ";
  switch (state_.load(std::memory_order_acquire)) {
    case State::kDerived:
      return conditions + "derived exactly";
    case State::kDeriving:
      return conditions + "fitted to numbers; exact ones are being derived";
    case State::kNotFound:
      return conditions + "fitted to numbers: " + reason_;
    case State::kOff:
      break;
  }
  return conditions + "fitted to numbers";
}

}  // namespace ros_bridge
}  // namespace screwline

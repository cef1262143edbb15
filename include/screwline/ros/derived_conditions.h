#ifndef SCREWLINE_ROS_DERIVED_CONDITIONS_H
#define SCREWLINE_ROS_DERIVED_CONDITIONS_H

#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "screwline/kinematics/singularity_factors.h"

namespace screwline {
namespace ros_bridge {

/// The singular conditions of one task of a chain, derived exactly by a thread of its own while others answer.
class DerivedConditions {
 public:
  using Factors = std::vector<SingularityFactor>;

  /// Begins at once and gives up after time_limit [s]; 0: does not begin.
  DerivedConditions(std::shared_ptr<const SerialChain> chain, const Task& task, double time_limit);
  /// Cancels what is still being derived, and waits for its thread.
  ~DerivedConditions();
  DerivedConditions(const DerivedConditions&) = delete;
  DerivedConditions& operator=(const DerivedConditions&) = delete;

  /// Null until they are known, and for good where they are not found. Takes no lock; what it points to is never
  /// changed and lives as long as this.
  const Factors* find() const { return known_.load(std::memory_order_acquire); }
  /// Of which kind the conditions are now and, where they are not the derived ones, why.
  std::string note() const;

 private:
  enum class State { kOff, kDeriving, kDerived, kNotFound };

  void derive(const SerialChain& chain, const Task& task, double time_limit);
  State deriveInTime(const SerialChain& chain, const Task& task, double time_limit);

  Factors factors_;     // Written by the thread before known_ is.
  std::string reason_;  // Written by the thread before state_ is.
  std::atomic<const Factors*> known_{nullptr};
  std::atomic<State> state_{State::kOff};
  std::atomic<bool> cancelled_{false};
  std::thread thread_;
};

}  // namespace ros_bridge
}  // namespace screwline

#endif  // SCREWLINE_ROS_DERIVED_CONDITIONS_H

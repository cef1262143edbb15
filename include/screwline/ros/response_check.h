#ifndef SCREWLINE_ROS_RESPONSE_CHECK_H
#define SCREWLINE_ROS_RESPONSE_CHECK_H

#include <ros/message_traits.h>
#include <ros/serialization.h>

#include <cmath>
#include <string>
#include <type_traits>
#include <vector>

#include "screwline/ros/messages.h"

namespace screwline {
namespace ros_bridge {

/// What a field may hold besides finite numbers.
enum class Allowed { kFinite, kInfinity, kNan };

inline bool lies(const double* number, const std::vector<double>& in) {
  return !in.empty() && number >= &in.front() && number <= &in.back();
}

/// The fields whose .srv file documents infinity or NaN, by response.
template <typename Response>
Allowed allowed(const Response&, const double*) {
  return Allowed::kFinite;
}
inline Allowed allowed(const Describe::Response& response, const double* number) {
  return lies(number, response.lower) || lies(number, response.upper) ? Allowed::kInfinity : Allowed::kFinite;
}
inline Allowed allowed(const ComputeJacobian::Response& response, const double* number) {
  return number == &response.determinant ? Allowed::kNan : Allowed::kFinite;
}
inline Allowed allowed(const AnalyzeSingularity::Response& response, const double* number) {
  if (number == &response.determinant) return Allowed::kNan;
  const bool infinite = number == &response.condition_number || number == &response.distance_to_singularity;
  return infinite ? Allowed::kInfinity : Allowed::kFinite;
}
Allowed allowed(const ComputeIK::Response& response, const double* number);

/// Visits every number of a message the way ROS serialises it; stands in for its output stream.
template <typename Response>
class NumberVisitor {
 public:
  explicit NumberVisitor(const Response& response) : response_(response) {}

  bool ok() const { return ok_; }

  template <typename T>
  void next(const T& field) {
    if constexpr (std::is_same<T, double>::value) {
      check(field);
    } else if constexpr (ros::message_traits::IsMessage<T>::value) {
      ros::serialization::Serializer<T>::write(*this, field);
    }
  }
  template <typename T, typename Allocator>
  void next(const std::vector<T, Allocator>& array) {
    for (const T& entry : array) next(entry);
  }

 private:
  void check(const double& number) {
    if (std::isfinite(number)) return;
    const Allowed what = allowed(response_, &number);
    ok_ = ok_ && (what == Allowed::kNan || (what == Allowed::kInfinity && !std::isnan(number)));
  }

  const Response& response_;
  bool ok_ = true;
};

/// Whether every number of the response is finite, or what its field documents.
template <typename Response>
bool isSound(const Response& response) {
  NumberVisitor<Response> visitor(response);
  visitor.next(response);
  return visitor.ok();
}

}  // namespace ros_bridge
}  // namespace screwline

#endif  // SCREWLINE_ROS_RESPONSE_CHECK_H

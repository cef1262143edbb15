#ifndef SCREWLINE_ROS_CHECKS_H
#define SCREWLINE_ROS_CHECKS_H

#include <cmath>
#include <cstddef>
#include <string>

#include "screwline/exception.h"
#include "screwline/model/serial_chain.h"

namespace screwline {
namespace ros_bridge {

/// A number as messages show it: shortest form that tells it from its neighbours in 12 digits.
std::string numberText(double value);

/// A name given by a caller as messages show it: quoted, in one line, cut after 80 bytes (never within a character).
std::string quoted(const std::string& name);

/// @throws InputError (code) where value is not finite or beyond kMaxMagnitude; the message names field, value, bound.
void requireFinite(double value, const std::string& field, AnswerCode code = AnswerCode::kInvalidGoal);

/// Whether requireFinite() passes: asked first where the field's name would have to be put together.
inline bool isServed(double value) {
  return std::abs(value) <= kMaxMagnitude;
}

/// @throws InputError (kTooLarge) where an array has more entries than are served.
void requireCount(std::size_t count, std::size_t bound, const std::string& field);

}  // namespace ros_bridge
}  // namespace screwline

#endif  // SCREWLINE_ROS_CHECKS_H

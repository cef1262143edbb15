#include "screwline/ros/checks.h"

#include <algorithm>
#include <sstream>

namespace screwline {
namespace ros_bridge {
namespace {

constexpr std::size_t kLongestName = 80;

}  // namespace

std::string numberText(double value) {
  std::ostringstream out;
  out.precision(12);
  out << value;
  return out.str();
}

std::string quoted(const std::string& name) {
  std::size_t length = std::min(name.size(), kLongestName);
  const auto continues = [&](std::size_t i) { return (static_cast<unsigned char>(name[i]) & 0xC0U) == 0x80U; };
  while (length < name.size() && length > 0 && continues(length)) --length;
  std::string shown = name.substr(0, length);
  std::replace_if(
      shown.begin(), shown.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20U; }, '?');
  return "'" + shown + (length < name.size() ? "...'" : "'");
}

void requireFinite(double value, const std::string& field, AnswerCode code) {
  if (isServed(value)) return;
  throw InputError(
      code, field + " is " + numberText(value) + ", it must be finite and within +-" + numberText(kMaxMagnitude));
}

void requireCount(std::size_t count, std::size_t bound, const std::string& field) {
  if (count <= bound) return;
  throw InputError(AnswerCode::kTooLarge, field + " has " + std::to_string(count) + " entries, at most " +
                                              std::to_string(bound) + " are served");
}

}  // namespace ros_bridge
}  // namespace screwline

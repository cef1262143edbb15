#ifndef SCREWLINE_TRAJECTORY_FORMAT_H
#define SCREWLINE_TRAJECTORY_FORMAT_H

#include <cstdio>
#include <string>

namespace screwline {

/// A number as messages show it: ten significant digits, no trailing zeros.
inline std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.10g", value);
  return text;
}

/// "name[i]", as a request's field is named.
inline std::string indexed(const std::string& name, std::size_t i) {
  return name + "[" + std::to_string(i) + "]";
}

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_FORMAT_H

#include "screwline/trajectory/trapezoid.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "screwline/exception.h"
#include "screwline/trajectory/format.h"
#include "screwline/trajectory/limits.h"

namespace screwline {
namespace {

constexpr double kRounding = 1e-12;  // A pair on the very boundary is feasible, whatever the last bit says.

[[noreturn]] void infeasible(const std::string& what) {
  throw InputError(AnswerCode::kInvalidGoal, "trapezoid: " + what);
}

void requirePositive(const std::optional<double>& value, const char* name) {
  if (value && !(*value >= kLeastLimit && *value <= kGreatestLimit)) {
    infeasible(std::string(name) + " is " + number(*value) + ", it must be positive: " + number(kLeastLimit) + " to " +
               number(kGreatestLimit));
  }
}

std::string range(const char* name, double value, double lower, double upper) {
  return std::string(name) + " is " + number(value) + ", feasible is " + number(lower) + " to " + number(upper);
}

Trapezoid velocityAndDuration(double d, double v, double T) {
  const double lower = d / T;
  if (v < lower * (1.0 - kRounding) || v > 2.0 * lower * (1.0 + kRounding)) {
    infeasible(range("peak_velocity", v, lower, 2.0 * lower) + " with duration " + number(T));
  }
  // At the lower bound the ramp takes no time: a rectangle, whose acceleration is infinite.
  const double ta = std::min(T - d / v, 0.5 * T);
  if (ta <= kRounding * T) {
    infeasible("peak_velocity " + number(v) + " leaves no time to accelerate; feasible is above " + number(lower) +
               " to " + number(2.0 * lower) + " with duration " + number(T));
  }
  return {v, v / ta, T, ta};
}

Trapezoid velocityAndAcceleration(double d, double v, double a) {
  if (v * v > d * a * (1.0 + kRounding)) {
    infeasible("peak_velocity is " + number(v) + ", feasible is above 0 to " + number(std::sqrt(d * a)) +
               " with acceleration " + number(a));
  }
  const double ta = v / a;
  return {v, a, std::max(d / v + ta, 2.0 * ta), ta};
}

Trapezoid accelerationAndDuration(double d, double a, double T) {
  const double lowest = 4.0 * d / (T * T);
  if (a < lowest * (1.0 - kRounding)) {
    infeasible("acceleration is " + number(a) + ", feasible is " + number(lowest) + " or more with duration " +
               number(T));
  }
  // 2 (d/a) / (T + root) instead of (T - root) / 2: no cancellation for large a.
  const double root = std::sqrt(std::max(0.0, T * T - 4.0 * d / a));
  const double ta = 2.0 * d / (a * (T + root));
  return {a * ta, a, T, ta};
}

Trapezoid accelerationAndTime(double d, double a, double ta) {
  const double longest = std::sqrt(d / a);
  if (ta > longest * (1.0 + kRounding)) {
    infeasible("acceleration_time is " + number(ta) + ", feasible is above 0 to " + number(longest) +
               " with acceleration " + number(a));
  }
  return {a * ta, a, std::max(ta + d / (a * ta), 2.0 * ta), ta};
}

Trapezoid velocityAndTime(double d, double v, double ta) {
  const double longest = d / v;
  if (ta > longest * (1.0 + kRounding)) {
    infeasible("acceleration_time is " + number(ta) + ", feasible is above 0 to " + number(longest) +
               " with peak_velocity " + number(v));
  }
  return {v, v / ta, std::max(d / v + ta, 2.0 * ta), ta};
}

Trapezoid durationAndTime(double d, double T, double ta) {
  if (ta > 0.5 * T * (1.0 + kRounding)) {
    infeasible("acceleration_time is " + number(ta) + ", feasible is above 0 to " + number(0.5 * T) +
               " with duration " + number(T));
  }
  const double v = d / (T - ta);
  return {v, v / ta, T, std::min(ta, 0.5 * T)};
}

Trapezoid thirds(double d, double T) {
  return {1.5 * d / T, 4.5 * d / (T * T), T, T / 3.0};
}

}  // namespace

Trapezoid resolveTrapezoid(double distance, const TrapezoidSpec& spec) {
  const auto& [v, a, T, ta] = spec;
  requirePositive(v, "peak_velocity");
  requirePositive(a, "acceleration");
  requirePositive(T, "duration");
  requirePositive(ta, "acceleration_time");
  if (int{v.has_value()} + int{a.has_value()} + int{T.has_value()} + int{ta.has_value()} > 2) {
    infeasible("more than two of peak_velocity, acceleration, duration and acceleration_time are given");
  }
  if (distance == 0.0) return {0.0, 0.0, T.value_or(0.0), T.value_or(0.0) / 3.0};
  if (v && T) return velocityAndDuration(distance, *v, *T);
  if (v && a) return velocityAndAcceleration(distance, *v, *a);
  if (a && T) return accelerationAndDuration(distance, *a, *T);
  if (a && ta) return accelerationAndTime(distance, *a, *ta);
  if (v && ta) return velocityAndTime(distance, *v, *ta);
  if (T && ta) return durationAndTime(distance, *T, *ta);
  if (v) return thirds(distance, 1.5 * distance / *v);
  if (a) return thirds(distance, 3.0 * std::sqrt(0.5 * distance / *a));
  if (ta) return thirds(distance, 3.0 * *ta);
  return thirds(distance, T.value_or(1.0));
}

}  // namespace screwline

#ifndef SCREWLINE_SRC_KINEMATICS_DUAL_H
#define SCREWLINE_SRC_KINEMATICS_DUAL_H

#include <cmath>

namespace screwline {

/// Dual number a + b e with e^2 = 0: carries a value and its exact derivative through any formula (forward
/// differentiation).
struct Dual {
  double value = 0.0;
  double slope = 0.0;

  Dual() = default;
  Dual(double constant) : value(constant) {}  // NOLINT: constants mix with duals in formulas
  Dual(double v, double s) : value(v), slope(s) {}
};

inline Dual operator+(const Dual& a, const Dual& b) {
  return {a.value + b.value, a.slope + b.slope};
}
inline Dual operator-(const Dual& a, const Dual& b) {
  return {a.value - b.value, a.slope - b.slope};
}
inline Dual operator*(const Dual& a, const Dual& b) {
  return {a.value * b.value, a.value * b.slope + a.slope * b.value};
}
inline Dual operator*(const Dual& a, double b) {
  return {a.value * b, a.slope * b};
}
inline Dual operator*(double a, const Dual& b) {
  return b * a;
}
inline Dual sin(const Dual& a) {
  return {std::sin(a.value), std::cos(a.value) * a.slope};
}
inline Dual cos(const Dual& a) {
  return {std::cos(a.value), -std::sin(a.value) * a.slope};
}

}  // namespace screwline

#endif  // SCREWLINE_SRC_KINEMATICS_DUAL_H

#ifndef SCREWLINE_SRC_IK_ALGEBRAIC_TRIGONOMETRIC_H
#define SCREWLINE_SRC_IK_ALGEBRAIC_TRIGONOMETRIC_H

#include <array>

namespace screwline {

constexpr int kTrigonometricSamples = 32;
constexpr int kTrigonometricDegree = 12;

/// A Moebius map of the circle, tan(image / 2) = stretch tan((angle - center) / 2): it spreads what lies about
/// `center`.
struct CircleMap {
  double center = 0.0;
  double stretch = 1.0;

  double image(double angle) const;
  double angle(double image) const;
  /// Derivative of angle(); its inverse is the squared factor by which homogeneous parameters grow.
  double slope(double image) const;
};

/// Angles that are held together in one place: real roots, and where the polynomial comes closer to zero than its
/// noise.
struct TrigonometricRoots {
  struct Root {
    double angle = 0.0;
    bool touching = false;  ///< A double root, or two, or none: within noise.
  };
  std::array<Root, 48> roots{};
  int count = 0;
  bool overflow = false;
};

/// c0 + sum of c_k cos(k x) + s_k sin(k x), largest coefficient 1.
struct TrigonometricPolynomial {
  /// From values at x = 2 pi j / 32. What they have beyond degree 12 is noise, as is what lies beyond `degree`.
  explicit TrigonometricPolynomial(const std::array<double, kTrigonometricSamples>& values);

  /// Drops what lies beyond; it counts as noise.
  void truncate(int new_degree);
  /// Value and three derivatives.
  std::array<double, 4> derivatives(double x) const;
  /// All real roots in [0, 2 pi), by subdivision with a bound on the remainder of Taylor's series: none is passed over
  /// that is farther than noise from being double.
  TrigonometricRoots realRoots() const;

  std::array<double, kTrigonometricDegree + 1> c{};
  std::array<double, kTrigonometricDegree + 1> s{};
  int degree = kTrigonometricDegree;
  double scale = 0.0;  ///< What all coefficients were divided by; 0: the polynomial is zero, or not finite.
  double noise = 0.0;  ///< Largest coefficient that should be zero.
};

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_ALGEBRAIC_TRIGONOMETRIC_H

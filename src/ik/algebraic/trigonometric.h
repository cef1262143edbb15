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

/// Roots that noise does not tell apart: as many, real or not, lie in a disk of the complex plane.
struct RootCluster {
  double angle = 0.0;    ///< The disk's center; of a simple root it is the root.
  double radius = 0.0;   ///< [rad]
  int multiplicity = 0;  ///< 0: that many are not told.
};

/// Held together in one place. All real roots are in the disks.
struct TrigonometricRoots {
  std::array<RootCluster, 48> roots{};
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
  /// The roots about x: the smallest disk in which one term of Taylor's series outweighs all others and the noise, so
  /// that it holds as many roots as that term's degree (Rouche's theorem).
  RootCluster clusterAt(double x) const;
  /// Noise of a value, generously.
  double tolerance() const;

  std::array<double, kTrigonometricDegree + 1> c{};
  std::array<double, kTrigonometricDegree + 1> s{};
  int degree = kTrigonometricDegree;
  double scale = 0.0;  ///< What all coefficients were divided by; 0: the polynomial is zero, or not finite.
  double noise = 0.0;  ///< Largest coefficient that should be zero.

 private:
  using Taylor = std::array<double, 10>;  ///< For clusters of up to 8 roots, and the remainder.

  Taylor taylor(double x) const;
  int outweighing(const Taylor& terms, double radius) const;
  RootCluster smallestDisk(const Taylor& terms, double x, int degree_there) const;
};

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_ALGEBRAIC_TRIGONOMETRIC_H

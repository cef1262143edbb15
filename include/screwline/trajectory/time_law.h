#ifndef SCREWLINE_TRAJECTORY_TIME_LAW_H
#define SCREWLINE_TRAJECTORY_TIME_LAW_H

#include <utility>
#include <vector>

#include "screwline/trajectory/piecewise_polynomial.h"
#include "screwline/trajectory/scaling_table.h"

namespace screwline {

/// s and its derivatives with respect to tau (not time): d^k q/dt^k = delta * d^k s/dtau^k / T^k.
struct ScalingSample {
  double s = 0.0;
  double ds = 0.0;
  double dds = 0.0;
  double ddds = 0.0;
};

/// A time scaling s(tau), tau = t/T in [0, 1], s(0) = 0, s(1) = 1, with exact derivatives: piecewise polynomial or
/// cycloidal. An immutable value. Sources: Biagiotti & Melchiorri, Trajectory Planning for Automatic Machines and
/// Robots, ch. 2 and 3; the degree-6 via polynomial is s345(tau) + k tau^3 (1-tau)^3.
class TimeLaw {
 public:
  static TimeLaw rectangular();     ///< Constant velocity: it steps at both ends.
  static TimeLaw cubic();           ///< Acceleration steps by 6 at both ends.
  static TimeLaw polynomial345();   ///< Also the minimum-jerk motion; zero acceleration at the ends.
  static TimeLaw polynomial4567();  ///< Zero acceleration and jerk at the ends.
  static TimeLaw cycloidal();       ///< tau - sin(2 pi tau) / (2 pi).
  static TimeLaw minimumJerk() { return polynomial345(); }

  /// Parabola, line, parabola: acceleration over the fraction b of the time at each end.
  /// @param blend_fraction b in (0, 1/2]. @throws InputError outside it.
  static TimeLaw trapezoidal(double blend_fraction);

  /// Degree 6 through s = via_s at tau = via_tau, with zero velocity and acceleration at both ends.
  /// @throws InputError where via_tau is not inside (0, 1) or a value is not finite.
  static TimeLaw via6(double via_s, double via_tau = 0.5);

  /// From pieces of one joint with breaks from 0 to 1; the way in for scalings to come.
  explicit TimeLaw(PiecewisePolynomial pieces);

  /// s and derivatives at tau; outside [0, 1] those of the nearer end. At tau = 0 and 1 and at a breakpoint a stepping
  /// derivative has its value from inside (at an interior breakpoint: of the later piece). Does not allocate.
  ScalingSample at(double tau) const;

  /// Exact peaks over [0, 1] in units of tau: peak(1), peak(2), peak(3) are C_v, C_a, C_j (v = C_v |delta| / T,
  /// a = C_a |delta| / T^2, j = C_j |delta| / T^3; infinite where the order below steps), the steps, the range of s,
  /// its integrals.
  JointExtrema extrema() const { return extrema_; }

  int continuity() const { return continuity_; }  ///< See PiecewisePolynomial.
  bool isCycloidal() const { return cycloidal_; }
  bool isMonotone() const;                                        ///< True where s never turns back.
  const PiecewisePolynomial& pieces() const& { return pieces_; }  ///< Empty for the cycloidal scaling.
  PiecewisePolynomial pieces() && { return std::move(pieces_); }
  std::vector<double> breaks() const;  ///< tau of the interior breakpoints.

 private:
  TimeLaw() = default;

  PiecewisePolynomial pieces_;
  ScalingTable table_;  ///< Empty for the cycloidal scaling.
  JointExtrema extrema_;
  int continuity_ = 2;
  bool cycloidal_ = false;
};

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_TIME_LAW_H

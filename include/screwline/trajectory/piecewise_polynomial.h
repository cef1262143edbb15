#ifndef SCREWLINE_TRAJECTORY_PIECEWISE_POLYNOMIAL_H
#define SCREWLINE_TRAJECTORY_PIECEWISE_POLYNOMIAL_H

#include <cstddef>
#include <vector>

#include "screwline/trajectory/polynomial.h"

namespace screwline {

/// [s] A piece this short takes no time: cubes of its rate would leave the range of a double.
constexpr double kNoTime = 1e-60;

/// Exact figures of one joint's motion, in rad (or m) and s. `velocity`, `acceleration` and `jerk` are the largest
/// magnitudes inside the pieces; a step is the largest jump of the order below at a breakpoint or, where the motion
/// joins rest, at an end.
struct JointExtrema {
  Range position;
  double velocity = 0.0;
  double acceleration = 0.0;
  double jerk = 0.0;
  double velocity_step = 0.0;
  double acceleration_step = 0.0;
  double travel = 0.0;                ///< Integral of |velocity|.
  double squared_acceleration = 0.0;  ///< Integral over time, inside the pieces.
  double squared_jerk = 0.0;          ///< The same.

  /// The peak of order 1 (velocity), 2 or 3, infinite where the order below steps.
  double peak(int order) const;
};

/// One polynomial per joint and segment, in normalised local time u = (t - breaks[k]) / (breaks[k+1] - breaks[k]): as
/// well conditioned for 1 ms as for t = 5..7 s. Coefficients lie contiguous as [segment][power][joint], so that one
/// pass over a segment evaluates all joints. A plain value: builders fill it, JointTrajectory samples it.
struct PiecewisePolynomial {
  int joints = 0;
  int degree = 0;                    ///< Of every piece, at most Polynomial::kMaxDegree.
  std::vector<double> breaks;        ///< [s], segments() + 1 of them, not decreasing, the first 0.
  std::vector<double> coefficients;  ///< segments() * (degree + 1) * joints.
  int continuity = 0;          ///< Derivatives 0 .. continuity (at most 3) are continuous at the breakpoints inside.
  int rest_continuity = 0;     ///< Derivatives 1 .. this are zero at an end that joins rest.
  bool starts_at_rest = true;  ///< False: the motion starts in a moving state, so nothing steps at t = 0.
  bool ends_at_rest = true;

  PiecewisePolynomial() = default;
  /// Room for the segments between the given breaks, all coefficients zero; rest is joined as smoothly as pieces are.
  PiecewisePolynomial(int joint_count, int piece_degree, std::vector<double> segment_breaks, int continuity_class);

  std::size_t segments() const { return breaks.empty() ? 0 : breaks.size() - 1; }
  double length(std::size_t segment) const { return breaks[segment + 1] - breaks[segment]; }
  double duration() const { return breaks.empty() ? 0.0 : breaks.back(); }
  double& at(std::size_t segment, int power, int joint) { return coefficients[index(segment, power, joint)]; }
  double at(std::size_t segment, int power, int joint) const { return coefficients[index(segment, power, joint)]; }

  /// The piece of one joint, in u.
  Polynomial piece(std::size_t segment, int joint) const;
  void setPiece(std::size_t segment, int joint, const Polynomial& polynomial);

  /// The segment that holds t, at a breakpoint the later one; outside the range the nearer end's. @pre segments() > 0.
  std::size_t segmentAt(double t) const;
  /// Of one joint at t, which is taken to the nearer end outside the range. @pre segments() > 0.
  double valueAt(double t, int joint) const;

  /// Derivative of the given order (0..3) of one joint at an end of a segment, from inside it, with respect to time.
  double atEnd(std::size_t segment, int joint, int order, bool upper_end) const;

  /// Exact extrema, travel and integrals of one joint: closed form from the roots of the derivatives. Does not
  /// allocate.
  JointExtrema extrema(int joint) const;

 private:
  std::size_t index(std::size_t segment, int power, int joint) const {
    return (segment * static_cast<std::size_t>(degree + 1) + static_cast<std::size_t>(power)) *
               static_cast<std::size_t>(joints) +
           static_cast<std::size_t>(joint);
  }
};

/// Largest jump of a derivative (0..3) of one joint over the breakpoints inside.
double stepInside(const PiecewisePolynomial& motion, int joint, int order);

/// Its largest jump where the motion joins rest: at the ends, where they are at rest. 0 for order 0.
double stepFromRest(const PiecewisePolynomial& motion, int joint, int order);

/// The first motion, then the second, which starts where the first ends. The result's continuity is the lesser of the
/// two.
PiecewisePolynomial concatenate(const PiecewisePolynomial& first, const PiecewisePolynomial& second);

/// The same way backwards: q'(t) = q(T - t).
PiecewisePolynomial reversed(const PiecewisePolynomial& motion);

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_PIECEWISE_POLYNOMIAL_H

#ifndef SCREWLINE_TRAJECTORY_JOINT_TRAJECTORY_H
#define SCREWLINE_TRAJECTORY_JOINT_TRAJECTORY_H

#include <algorithm>
#include <cstddef>
#include <vector>

#include "screwline/spatial/pose.h"
#include "screwline/trajectory/path.h"
#include "screwline/trajectory/piecewise_polynomial.h"
#include "screwline/trajectory/time_law.h"

namespace screwline {

/// Position [rad or m], velocity, acceleration and jerk of every joint (per s, s^2, s^3) at one instant.
struct TrajectoryPoint {
  VectorX position;
  VectorX velocity;
  VectorX acceleration;
  VectorX jerk;

  TrajectoryPoint() = default;
  explicit TrajectoryPoint(int joints)
      : position(VectorX::Zero(joints)),
        velocity(VectorX::Zero(joints)),
        acceleration(VectorX::Zero(joints)),
        jerk(VectorX::Zero(joints)) {}
};

/// offset_i + amplitude_i sin(omega_i t + phase_i); rad (or m), rad/s, rad.
struct Sinusoid {
  VectorX offset;
  VectorX amplitude;
  VectorX omega;
  VectorX phase;
};

/// An immutable motion of n joints over [0, duration]. Pure: the same t gives the same answer, nothing is remembered
/// between calls. Four forms: one scaling for all joints (start + delta s(t/T)), one scaling along a path
/// (q(length s(t/T))), piecewise polynomials, sinusoids.
/// Outside the interval the ends are held with zero derivatives; at 0 and at the duration derivatives have their values
/// from inside, at an interior breakpoint those of the later piece.
class JointTrajectory {
 public:
  JointTrajectory() = default;  ///< No joints, no duration.

  /// start + delta s(t / duration). @pre equal sizes, duration >= 0 (at 0 it rests at start).
  static JointTrajectory scaled(VectorX start, VectorX delta, TimeLaw scaling, double duration);
  /// path(length s(t / duration)). @pre the scaling never turns back; duration >= 0 (at 0 it rests at the start).
  static JointTrajectory alongPath(JointPath path, const TimeLaw& scaling, double duration);
  static JointTrajectory piecewise(PiecewisePolynomial motion);
  /// @pre equal sizes, duration >= 0.
  static JointTrajectory sinusoidal(Sinusoid motion, double duration);

  int joints() const { return joints_; }
  double duration() const { return duration_; }  ///< [s]

  /// Derivatives 0 .. continuity (at most 3) are continuous; ends joined to rest count unless the motion starts or ends
  /// moving.
  int continuity() const;

  /// True where it starts in a moving state that is no step from rest: it has to be entered in motion. (A sinusoid is
  /// taken as it is: it has no start of its own.)
  bool startsMoving() const;

  /// Instants inside (0, duration) at which a derivative up to jerk may step: a sampled copy should hold each of them.
  std::vector<double> corners() const;

  /// State at t [s] into `point`. Allocates only where `point` has not n entries. O(log segments).
  void sample(double t, TrajectoryPoint& point) const {
    if (point.position.size() != joints_) resize(point);
    sample(t, point.position.data(), point.velocity.data(), point.acceleration.data(), point.jerk.data());
  }
  /// The same into arrays of n doubles. Never allocates.
  void sample(double t, double* position, double* velocity, double* acceleration, double* jerk) const {
    const bool inside = t >= 0.0 && t <= duration_;
    if (inside && line_kernel_ != nullptr) {
      line_kernel_(line_, t, position, velocity, acceleration, jerk);
    } else if (inside && !spans_.empty()) {
      samplePieces(t, {position, velocity, acceleration, jerk});
    } else {
      sampleOther(t, {position, velocity, acceleration, jerk});
    }
  }

  /// Exact figures of one joint: closed form in every form. Does not allocate.
  JointExtrema extrema(int joint) const;

  /// The common scaling s(tau), nullptr where the motion has none.
  const TimeLaw* scaling() const { return form_ == Form::kScaled || form_ == Form::kAlongPath ? &scaling_ : nullptr; }
  /// The path that the scaling moves along, nullptr in the other forms.
  const JointPath* path() const { return form_ == Form::kAlongPath ? &path_ : nullptr; }
  /// The polynomial pieces, nullptr in the other forms.
  const PiecewisePolynomial* pieces() const { return form_ == Form::kPiecewise ? &pieces_ : nullptr; }
  /// The sinusoids, nullptr in the other forms.
  const Sinusoid* sinusoid() const { return form_ == Form::kSinusoidal ? &sinusoid_ : nullptr; }
  const VectorX& start() const { return start_; }  ///< Of the scaled form: it moves from here
  const VectorX& delta() const { return delta_; }  ///< by this; empty in the other forms.

 private:
  enum class Form { kPiecewise, kScaled, kAlongPath, kSinusoidal };
  struct Span {
    double start = 0.0;
    double inverse_length = 0.0;  ///< As inverseLengthOf().
  };

  void samplePieces(double t, const SampleOutput& output) const {
    const std::size_t k = breaks_.find(t);
    const Span& span = spans_[k];
    const double x = std::min((t - span.start) * span.inverse_length, 1.0);
    piece_kernel_(pieces_.coefficients.data() + k * stride_, {joints_, pieces_.degree}, x, span.inverse_length,
                  output.position, output.velocity, output.acceleration, output.jerk);
  }
  void resize(TrajectoryPoint& point) const;
  /// Every form, and instants outside.
  void sampleOther(double t, const SampleOutput& output) const;
  void sampleScaled(double t, const SampleOutput& output) const;
  void samplePath(double t, const SampleOutput& output) const;
  void sampleSinusoid(double t, const SampleOutput& output) const;
  int pathContinuity() const;
  JointExtrema scaledExtrema(int joint) const;
  JointExtrema pathExtrema(int joint) const;
  JointExtrema sinusoidExtrema(int joint) const;

  Form form_ = Form::kPiecewise;
  int joints_ = 0;
  double duration_ = 0.0;
  double inverse_duration_ = 0.0;  ///< 0 for a motion that takes no time: it rests.
  VectorX start_;
  VectorX delta_;
  TimeLaw scaling_ = TimeLaw::rectangular();
  ScaledLine line_;                   ///< The scaled form by time; empty where nothing takes time.
  LineKernel line_kernel_ = nullptr;  ///< Null where it is empty, or has none.
  ScalingTable along_;                ///< u by time, along a path.
  JointPath path_;
  std::vector<JointExtrema> extrema_;  ///< Along a path: of each joint.
  PiecewisePolynomial pieces_;
  BreakTable breaks_;  ///< Of the pieces.
  std::vector<Span> spans_;
  std::size_t stride_ = 0;
  PieceKernel piece_kernel_ = nullptr;  ///< Null without pieces.
  Sinusoid sinusoid_;
};

/// Instants 0, period, 2 period, ... and exactly the duration last; a step shorter than 1e-6 of the period before the
/// end is left out. With corners each of them is added, so that linear or Hermite interpolation of the samples follows
/// the motion.
/// @throws InputError(kTooLarge) for more than a million samples, (kInvalidGoal) where the period is not positive and
/// finite.
std::vector<double> sampleTimes(const JointTrajectory& trajectory, double period, bool with_corners = false);

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_JOINT_TRAJECTORY_H

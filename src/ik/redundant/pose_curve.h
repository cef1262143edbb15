#ifndef SCREWLINE_SRC_IK_REDUNDANT_POSE_CURVE_H
#define SCREWLINE_SRC_IK_REDUNDANT_POSE_CURVE_H

#include <memory>

#include "arm_circle.h"
#include "screwline/ik/redundant/self_motion.h"
#include "screwline/kinematics/jacobian.h"

namespace screwline {

/// The configurations of seven joints that reach a pose, locally a curve: the corrector that brings a configuration
/// onto it, and its tangent there. Prismatic joints count by the chain's length, in arc length and everywhere else.
/// Not for several threads at once; allocates when it is made only.
class PoseCurve {
 public:
  /// `arm`: whose closed form tells nodes that have an arm angle; may be null.
  PoseCurve(const SerialChain& chain, const Pose& target, std::shared_ptr<const ArmPose> arm = nullptr);

  const SerialChain& chain() const { return chain_; }
  const std::shared_ptr<const ArmPose>& arm() const { return arm_; }

  /// Newton steps of least norm until rounding is reached. False where that fails or leads further than `reach` away;
  /// `node` is then undefined. Its tangent is oriented by the Jacobian's minors: along the curve it does not turn back,
  /// on the other side of a crossing it does.
  bool correct(const Vector7& q, double reach, SelfMotionNode& node) {
    return correctAbove(kNegligiblePivot, q, reach, node);
  }
  /// The same, directions with a smaller gain than a share of the largest left alone. What they leave of the error may
  /// be as large as 1e-12.
  bool correctAbove(double share, const Vector7& q, double reach, SelfMotionNode& node);

  /// Norm of the pose's error, lengths over the chain's.
  double errorAt(const Vector7& q);

  /// Point between two nodes at share 0..1 of the way: cubic by their tangents, then corrected; or by the arm angle.
  /// Its tangent runs the way of `a`'s.
  bool between(const SelfMotionNode& a, const SelfMotionNode& b, double share, SelfMotionNode& node);

  /// Least pivot of the Jacobian, lengths over the chain's.
  double gainAt(const Vector7& q);

  /// What the pose's error does to second order along the two directions that move the tip least, in the direction that
  /// it is moved least in: a quadratic form.
  struct SecondOrder {
    /// Whether the error is zero to second order as well: a surface solves the pose within rounding.
    bool isSurface() const { return is_known && std::abs(values[1]) <= kLeastForm; }

    Eigen::Matrix<double, kRedundantJoints, 2> plane;    ///< The two directions, of norm 1 and across each other.
    bool is_known = false;                               ///< Not where a third direction is as weak.
    double gain = 0.0;                                   ///< Least singular value of the Jacobian.
    double next_gain = 0.0;                              ///< The one above.
    Eigen::Vector2d slopes{0.0, 0.0};                    ///< Of the error in that direction, along `vectors`.
    Eigen::Vector2d values{0.0, 0.0};                    ///< Of the form, the smaller size first.
    Eigen::Matrix<double, kRedundantJoints, 2> vectors;  ///< Directions that have them, of norm 1.
  };
  SecondOrder secondOrder(const Vector7& q);

  double dot(const Vector7& a, const Vector7& b) const { return a.cwiseProduct(weight_).dot(b); }
  double norm(const Vector7& a) const { return std::sqrt(dot(a, a)); }
  /// b - a, revolute joints by the nearest full turn.
  Vector7 difference(const Vector7& a, const Vector7& b) const;
  /// Form values [second derivatives over the chain's length] below it are none.
  static constexpr double kLeastForm = 1e-4;
  /// What rounding leaves open of the error; over the gain, of a place.
  static constexpr double kErrorNoise = 1e-14;

  bool isRevolute(int joint) const { return chain_.joint(joint).isRevolute(); }

 private:
  static constexpr double kNegligiblePivot = 1e-13;
  using ScaledJacobian = Eigen::Matrix<double, 6, kRedundantJoints>;
  ScaledJacobian scaledJacobian() const;  ///< Of J_: lengths over the chain's.

  const SerialChain& chain_;
  Pose target_;
  std::shared_ptr<const ArmPose> arm_;
  Vector7 unit_;    ///< Of each joint: 1 rad, or the chain's length.
  Vector7 weight_;  ///< unit^-2
  Matrix6X J_;
};

/// Cubic that has the nodes' positions and tangents. No correction.
Vector7 cubicBetween(const SelfMotionNode& a, const SelfMotionNode& b, double share);

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_REDUNDANT_POSE_CURVE_H

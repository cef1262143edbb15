#ifndef SCREWLINE_SRC_IK_ALGEBRAIC_LOOP_H
#define SCREWLINE_SRC_IK_ALGEBRAIC_LOOP_H

#include <array>

#include "dual_quaternion.h"
#include "screwline/model/serial_chain.h"

namespace screwline {

/// The homogeneous parameter of a joint: (cos(q/2), sin(q/2)), or (1, q/2) times anything for a slide, in the loop's
/// unit of length.
using JointParameter = Eigen::Vector2d;

/// The arm as a closed loop e0 e1 e2 e3 e4 e5 X^-1 = 1 (up to a factor) of dual quaternions, each linear in its joint's
/// parameter. Lengths are divided by `length`, the origin lies amid the axes: neither is the base frame's choice.
struct Loop {
  explicit Loop(const SerialChain& chain);

  /// X of the loop for a pose of the tip: what the axes' motions amount to.
  Pose motion(const Pose& target) const;
  /// X^-1.
  DualQuaternion closure(const Pose& target) const { return conjugate(toDualQuaternion(motion(target))); }
  double displacement(int joint, const JointParameter& parameter) const;

  std::array<Axis, 6> axes;
  std::array<DualQuaternion, 6> screws;
  Vector6 multipliers = Vector6::Ones();  ///< Displacement of an axis over its joint's value.
  Vector3 origin = Vector3::Zero();
  double length = 1.0;
  Pose home_inverse;
};

/// Which joints play which part: the pair that is eliminated linearly, and the other four in the loop's order behind
/// it, of which one is hidden. Where it is the first or the last (the pair's neighbours), every root is a solution.
struct Labelling {
  int pair_first = 0;
  int hidden_place = 0;  ///< Among the four.

  int pair(int i) const { return (pair_first + i) % 6; }
  int hidden() const { return (pair_first + 2 + hidden_place) % 6; }
  /// The three unknowns beside the hidden one, in the loop's order.
  int unknown(int i) const { return (pair_first + 2 + (i < hidden_place ? i : i + 1)) % 6; }
};

/// The loop in a labelling: the pair's motions e_a e_b span four dimensions of eight, so four linear conditions say
/// that the motion of the other four joints is the inverse of one of theirs. Each is linear in all four parameters.
struct LoopSystem {
  using Coefficients = Eigen::Matrix<double, 4, 8>;  ///< Of x^i y^j z^k at column 4 i + 2 j + k.

  LoopSystem(const Loop& loop, const Labelling& labelling, const DualQuaternion& closure);

  /// The four equations in the unknowns x, y, z where the hidden joint has this parameter.
  Coefficients at(const JointParameter& hidden) const { return hidden[0] * cosine_part + hidden[1] * sine_part; }
  /// Parameters of the pair, from all the others.
  void solvePair(const JointParameter& hidden, const std::array<JointParameter, 3>& unknowns, JointParameter& first,
                 JointParameter& second) const;

  Coefficients cosine_part;
  Coefficients sine_part;
  Eigen::Matrix<double, 8, 16> products;  ///< Of the four, hidden joint first: column 8 h + 4 i + 2 j + k.
  Eigen::Matrix<double, 8, 4> pair_products;
};

/// The two factors of a 2 x 2 matrix of rank one, given by rows; each a unit vector.
void splitProduct(const Eigen::Vector4d& product, JointParameter& first, JointParameter& second);

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_ALGEBRAIC_LOOP_H

#ifndef SCREWLINE_IK_CLOSED_FORM_TURN_SEQUENCE_H
#define SCREWLINE_IK_CLOSED_FORM_TURN_SEQUENCE_H

#include <array>

#include "screwline/model/joint.h"
#include "screwline/spatial/turn.h"

namespace screwline {

/// The rotation R1 R2 R3 of three axes and a frame N that they carry, as A Rz(q1) Rx(.) Rz(q2 + .) Rx(.) Rz(q3 + .)
/// Rx(.) Rz(.) with constants folded in: each factor mixes two rows of a matrix, a third of the work of a product.
class TurnSequence {
 public:
  TurnSequence() = default;
  TurnSequence(const std::array<Axis, 3>& axes, const Matrix3& N);

  const Matrix3& base() const { return base_; }  ///< A; its z is axis 1.

  /// M becomes (R1 R2 R3 N)^T A M. A prismatic axis has the turn zero. No allocation.
  void undo(const std::array<Turn, 3>& turns, Matrix3& M) const;

 private:
  Matrix3 base_ = Matrix3::Identity();
  std::array<Turn, 3> offset_;      ///< From the common normal with the axis before to the one with the axis after.
  std::array<Turn, 3> tilt_;        ///< To the next axis, about their common normal.
  std::array<bool, 3> parallel_{};  ///< The next axis is: it has no tilt.
  Turn last_;                       ///< From the last common normal to N's x.
};

}  // namespace screwline

#endif  // SCREWLINE_IK_CLOSED_FORM_TURN_SEQUENCE_H

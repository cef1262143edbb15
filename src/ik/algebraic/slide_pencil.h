#ifndef SCREWLINE_SRC_IK_ALGEBRAIC_SLIDE_PENCIL_H
#define SCREWLINE_SRC_IK_ALGEBRAIC_SLIDE_PENCIL_H

#include "dixon.h"

namespace screwline {

/// What DixonPencil is, where two of the three unknowns are slides: their product does not occur, so that the equations
/// are a 4 x 3 matrix, linear in the turn x, times (1, y, z). It loses rank where its four minors vanish, cubics in x:
/// the 4 x 4 matrix of their coefficients is singular there. Its determinant has degree 6 at most over the hidden
/// angle.
class SlidePencil {
 public:
  static constexpr int kDegree = 6;

  /// `turn` is the place of the unknown that is not a slide.
  SlidePencil(const LoopSystem& system, int turn) : system_(&system), turn_(turn) {}

  TrigonometricPolynomial determinant(const CircleMap& map) const;
  CircleMap spread() const { return {}; }
  bool vanishes() const;
  std::array<JointParameter, 3> unknownsAt(double angle) const;
  std::array<std::array<JointParameter, 3>, 2> doubleUnknownsAt(double angle, const LoopSystem::Coefficients&) const;

 private:
  using Linear = Eigen::Matrix<double, 4, 3>;

  Eigen::Matrix4d minorsAt(double angle, Linear& constant, Linear& slope) const;

  const LoopSystem* system_;
  int turn_;
};

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_ALGEBRAIC_SLIDE_PENCIL_H

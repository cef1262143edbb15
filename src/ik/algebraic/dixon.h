#ifndef SCREWLINE_SRC_IK_ALGEBRAIC_DIXON_H
#define SCREWLINE_SRC_IK_ALGEBRAIC_DIXON_H

#include <array>
#include <optional>

#include "loop.h"
#include "trigonometric.h"

namespace screwline {

/// Dixon's matrix of four equations that are linear in each of x, y, z: rows y^b z^k at 3 b + k, columns x^i y^j at
/// 2 i + j. It is singular where they have a common root; the root's monomials are its null vectors, left and right.
/// Source: Dixon 1908; for equations of this form it has no superfluous factor (Sturmfels & Zelevinsky 1994).
using DixonMatrix = Eigen::Matrix<double, 6, 6>;

DixonMatrix dixonMatrix(const LoopSystem::Coefficients& equations);

/// Dixon's matrix over the hidden joint's angle: each entry is a trigonometric polynomial of degree two.
class DixonPencil {
 public:
  static constexpr int kDegree = 8;  ///< Of the determinant: half the number of solutions.

  explicit DixonPencil(const LoopSystem& system);

  DixonMatrix at(double cosine, double sine) const;
  /// Its determinant, of degree 12 at most, and 8 where the chain has 16 solutions: (1 + t^2)^4 of the half-angle
  /// form is constant here.
  /// Its argument is the image of the angle under `map`: as a form in the half-angle's parameters it has the same
  /// degree.
  TrigonometricPolynomial determinant(const CircleMap& map) const;
  /// The map that spreads the determinant's roots over the circle, where they are crowded: they drown in rounding
  /// there.
  CircleMap spread() const;
  /// Whether the matrix is singular at every angle, to rounding.
  bool vanishes() const;
  /// The unknowns' parameters where the matrix is singular.
  std::array<JointParameter, 3> unknownsAt(double angle) const;
  /// The same where two roots share the angle, or almost: the monomials of both lie in the plane that the matrix all
  /// but annihilates. `equations` are the system's there. Empty where the roots are clearly complex.
  std::optional<std::array<std::array<JointParameter, 3>, 2>> doubleUnknownsAt(
      double angle, const LoopSystem::Coefficients& equations) const;

 private:
  std::array<DixonMatrix, 5> harmonics_;  ///< 1, cos, sin, cos 2, sin 2.
};

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_ALGEBRAIC_DIXON_H

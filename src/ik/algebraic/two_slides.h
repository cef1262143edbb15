#ifndef SCREWLINE_SRC_IK_ALGEBRAIC_TWO_SLIDES_H
#define SCREWLINE_SRC_IK_ALGEBRAIC_TWO_SLIDES_H

#include "hidden_turn.h"

namespace screwline {

/// Solving by one of four turns, with two slides anywhere between them.
///
/// The turns alone make the orientation: with one of them at an angle the others follow, in two ways, and the position
/// is left to the slides. Their directions d1, d2 and what is missing, p, have to lie in a plane: g = det(d1, d2, p)
/// vanishes. On the curve of all angles that make the orientation, a spherical four-bar's, the turns' cosines and sines
/// have four poles for each of the two pairs of opposite turns. Each term of g, written with the turns on one side of
/// the loop or on the other, has degree one in both pairs: g has 8 poles of order one, and so 8 zeros. The product of g
/// in both ways, times 1 - c^2, is a trigonometric polynomial of degree 4 over the hidden angle with these zeros and no
/// others; c is the cosine between the axes of the first and the last of the three. Its roots are all solutions, but
/// those where the slides are parallel.
class TwoSlides : public HiddenTurn {
 public:
  /// @pre the joint `hidden` is one of the loop's four turns, and two of its axes are slides.
  TwoSlides(const Loop& loop, int hidden) : loop_(&loop), hidden_(hidden) {}

  Eliminated solve(const Pose& target, RootRefiner& refiner) const override;
  double errorAt(const Pose& target, const Vector6& q) const override;
  std::string words(const SerialChain& chain) const override;

 private:
  const Loop* loop_;
  int hidden_;
};

/// One for each turn that can be hidden.
HiddenTurns slidePairsOf(const Loop& loop);

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_ALGEBRAIC_TWO_SLIDES_H

#ifndef SCREWLINE_SRC_IK_ALGEBRAIC_ELIMINATION_H
#define SCREWLINE_SRC_IK_ALGEBRAIC_ELIMINATION_H

#include "hidden_turn.h"

namespace screwline {

/// Solving by Dixon's elimination in one labelling of the loop, of five turns at least.
class Elimination : public HiddenTurn {
 public:
  Elimination(const Loop& loop, const Labelling& labelling) : loop_(&loop), labelling_(labelling) {}

  Eliminated solve(const Pose& target, RootRefiner& refiner) const override;
  double errorAt(const Pose& target, const Vector6& q) const override;
  std::string words(const SerialChain& chain) const override;

 private:
  const Loop* loop_;
  Labelling labelling_;
};

/// Every sensible labelling: the hidden joint is a turn, next to the pair.
HiddenTurns eliminationsOf(const Loop& loop);

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_ALGEBRAIC_ELIMINATION_H

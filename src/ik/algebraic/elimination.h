#ifndef SCREWLINE_SRC_IK_ALGEBRAIC_ELIMINATION_H
#define SCREWLINE_SRC_IK_ALGEBRAIC_ELIMINATION_H

#include <vector>

#include "loop.h"
#include "root_refiner.h"

namespace screwline {

/// Solving by elimination in one labelling of the loop.
class Elimination {
 public:
  Elimination(const Loop& loop, const Labelling& labelling) : loop_(&loop), labelling_(labelling) {}

  const Labelling& labelling() const { return labelling_; }

  /// Adds what it finds; true where every root led to a solution of its own. No allocation.
  bool solve(const DualQuaternion& closure, RootRefiner& refiner) const;
  /// How well a configuration is found for its pose: an error in rad, large where the elimination breaks down.
  double errorAt(const DualQuaternion& closure, const Vector6& q) const;

 private:
  const Loop* loop_;
  Labelling labelling_;
};

/// Labellings that serve the chain, best first; tried at fixed configurations. Empty where none does.
std::vector<Elimination> chooseEliminations(const SerialChain& chain, const Loop& loop);

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_ALGEBRAIC_ELIMINATION_H

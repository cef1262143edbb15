#ifndef SCREWLINE_SRC_IK_ALGEBRAIC_ELIMINATION_H
#define SCREWLINE_SRC_IK_ALGEBRAIC_ELIMINATION_H

#include <vector>

#include "dixon.h"
#include "root_refiner.h"

namespace screwline {

enum class Eliminated {
  kAll,        ///< Every root led to a solution of its own.
  kUncertain,  ///< Rounding hides something.
  kVanishing,  ///< Every value of the hidden joint is a root: a self-motion, or this labelling breaks down here.
};

/// Solving by elimination in one labelling of the loop.
class Elimination {
 public:
  Elimination(const Loop& loop, const Labelling& labelling) : loop_(&loop), labelling_(labelling) {}

  const Labelling& labelling() const { return labelling_; }
  /// The hidden joint is a turn, and next to the pair unless slides leave no such.
  bool isSensible() const;

  /// Adds what it finds. No allocation.
  Eliminated solve(const DualQuaternion& closure, RootRefiner& refiner) const;
  /// How well a configuration is found for its pose: an error in rad, large where the elimination breaks down.
  double errorAt(const DualQuaternion& closure, const Vector6& q) const;

 private:
  /// Roots with slides at infinity are none of the arm's: of two slides, such may be real.
  bool isAtInfinity(const std::array<JointParameter, 3>& unknowns) const;
  /// Place among the unknowns of the turn beside two slides; -1 where there is one slide at most.
  int turnBesideSlides() const;
  template <class Pencil>
  Eliminated solveWith(const Pencil& pencil, const LoopSystem& system, RootRefiner& refiner) const;
  template <class Pencil>
  double errorWith(const Pencil& pencil, const LoopSystem& system, const Vector6& q) const;
  Vector6 configurationOf(const LoopSystem& system, double angle, const std::array<JointParameter, 3>& unknowns) const;

  const Loop* loop_;
  Labelling labelling_;
};

/// Labellings that serve the chain, best first; tried at fixed configurations.
struct EliminationChoice {
  std::vector<Elimination> usable;
  std::vector<Elimination> reserves;  ///< Where roots coincide, or are found badly: good for a second look only.
};

EliminationChoice chooseEliminations(const SerialChain& chain, const Loop& loop);

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_ALGEBRAIC_ELIMINATION_H

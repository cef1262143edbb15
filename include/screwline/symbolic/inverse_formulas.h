#ifndef SCREWLINE_SYMBOLIC_INVERSE_FORMULAS_H
#define SCREWLINE_SYMBOLIC_INVERSE_FORMULAS_H

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "screwline/kinematics/inverse_outline.h"
#include "screwline/model/serial_chain.h"
#include "screwline/model/task.h"
#include "screwline/symbolic/formula.h"
#include "screwline/symbolic/symbolic_chain.h"

namespace screwline {

/// One line of an inverse solution: symbol = value. A line with a sign gives two branches, value has the symbol of the
/// sign as a factor. A line with an equation gives a branch for each real root of it.
struct InverseStep {
  int symbol = 0;
  Formula value;
  int sign = -1;                 ///< Symbol that is +1 and -1 in turn; -1: the line has one value.
  Formula radicand;              ///< Of a line with a sign: value = sign sqrt(radicand). Below zero: out of reach.
  bool reach = false;            ///< The radicand can become negative.
  std::vector<Formula> free_if;  ///< Of a joint: where all of these are zero any value does.
  /// Of a joint that takes more than a square root, five: of 1, cos, sin and, of twice the angle, cos, sin; of 1, q,
  /// ... q^4 for a slide. Their sum is zero. Else empty. `value` is not used.
  std::vector<Formula> equation;
  int tangent = -1;    ///< Symbol for tan(angle/2), in which the equation of a turn is a quartic.
  std::string before;  ///< What this line and the next ones are about; may be empty.
};

/// Inverse kinematics as lines to be worked off from the first to the last, each in the target's entries, the chain's
/// lengths and what the lines before gave: sines and cosines of joints already known among that.
struct InverseFormulas {
  SymbolTable symbols;  ///< The chain's first, with the numbers of SymbolicChain; joints are 0..joints-1.
  int joints = 0;
  int given = -1;       ///< Joint whose value is given: the others are solved for; -1: none.
  int open_joint = -1;  ///< Joint that may always take any value; -1: none.
  int tool_turn = -1;   ///< Symbol for the tool's turn about the direction that the task asks for; -1: there is none.
  std::array<int, 12> target{};  ///< Symbols of px, py, pz, then r11, r12, ... r33: the tip in the base link.
  std::vector<InverseStep> steps;
  std::vector<bool> revolute;
  double length = 1.0;  ///< [m] the chain's, by which a length counts as zero.
};

/// The formulas of the plan that `outline` tells of, exact in the chain's symbols. Empty where one of its cases is not
/// written. Allocates.
/// @throws DerivationStopped
std::optional<InverseFormulas> inverseFormulasOf(const SerialChain& chain, const Task& task,
                                                 const InverseOutline& outline, const SymbolicOptions& options = {},
                                                 const Progress& progress = {});

/// One configuration that the formulas give.
struct InverseSolution {
  VectorX q;          ///< Revolute joints in (-pi, pi].
  unsigned free = 0;  ///< Bit i: joint i may take any value; it has the preferred one, and others follow from it.
};

/// Works the formulas off at a pose. Solutions that are the same within 1e-6 come once. `preferred` sets free joints,
/// and the joint whose value is given.
std::vector<InverseSolution> evaluate(const InverseFormulas& formulas, const Pose& target, const VectorX& preferred);

/// How formulas compare with a solver at random reachable poses.
struct InverseCheck {
  int poses = 0;
  int solutions = 0;         ///< Of the solver, all poses together.
  int missing = 0;           ///< Of those, not among the formulas' (farther than 1e-6 from each).
  int extra = 0;             ///< Of the formulas', not among the solver's.
  double worst_joint = 0.0;  ///< [rad, m] between solutions that correspond.
  double worst_task = 0.0;   ///< Of the task's rows by forward kinematics: rad, or lengths over the chain's.
  bool agrees() const { return missing == 0 && extra == 0; }
};

/// Compares at `poses` configurations of a fixed random sequence. Poses are skipped where the configuration is nearly
/// singular (two solutions that nearly meet can not be told apart).
InverseCheck checkInverse(const InverseFormulas& formulas, const SerialChain& chain, const Task& task,
                          const InverseSolver& solver, int poses);

/// Formulas that have passed the check, or why there are none.
struct InverseDerivation {
  std::optional<InverseFormulas> formulas;
  InverseCheck check;
  std::string reason;  ///< In a line, where there are no formulas.
};

constexpr double kInverseAgreement =
    1e-9;  ///< [rad, chain's lengths] of the task's rows: what deviates more is not shown.

/// The formulas of a chain's method, compared with it at so many poses. @throws DerivationStopped
InverseDerivation deriveInverse(const SerialChain& chain, const Task& task, const InverseMethod& method, int poses,
                                const SymbolicOptions& options = {}, const Progress& progress = {});

}  // namespace screwline

#endif  // SCREWLINE_SYMBOLIC_INVERSE_FORMULAS_H

#ifndef SCREWLINE_SRC_IK_PARALLEL_CANDIDATES_H
#define SCREWLINE_SRC_IK_PARALLEL_CANDIDATES_H

#include <optional>

#include "candidate.h"
#include "screwline/ik/algebraic/algebraic_solver.h"
#include "screwline/ik/closed_form/parallel_plan.h"

namespace screwline {

/// The closed form for three parallel axes, with elimination behind it: what rounding leaves open in a stage of the one
/// is looked up by the other.
struct ParallelMethod {
  ParallelPlan plan;
  std::optional<AlgebraicSolver> algebraic;
};

/// Empty where the chain has no such closed form, or the task is not the whole pose.
std::optional<ParallelMethod> parallelMethodFor(const SerialChain& chain, const Task& task);

struct ParallelCandidates {
  std::vector<Candidate> found;
  bool complete = false;
  bool indistinct = false;  ///< The pose may not tell some of them from others along a curve.
};

/// All solutions, each of its own branch, continua as loops. `method` and `chain` must outlive the candidates.
/// @param eliminate asks elimination as well, whether or not the closed form is in doubt.
ParallelCandidates candidatesOf(const ParallelMethod& method, const SerialChain& chain, const Pose& target,
                                const VectorX& seed, bool eliminate);

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_PARALLEL_CANDIDATES_H

#ifndef SCREWLINE_SRC_IK_SOLUTION_BUILDER_H
#define SCREWLINE_SRC_IK_SOLUTION_BUILDER_H

#include <chrono>
#include <optional>
#include <vector>

#include "candidate.h"
#include "screwline/kinematics/jacobian.h"
#include "task_conditioning.h"

namespace screwline {

/// Turns what a solver proposes into verified answers to one request.
class SolutionBuilder {
 public:
  SolutionBuilder(const SerialChain& chain, const Task& task, const IkRequest& request);

  const VectorX& seed() const { return seed_; }
  /// [s] of the request's timeout.
  double timeLeft() const;
  bool hasSeed() const { return request_.seed.size() > 0; }

  /// Refines, verifies by forward kinematics, chooses turns, describes continua. Empty where the candidate is no
  /// solution to 1e-9.
  std::optional<IkAnswer> build(Candidate candidate) const;

  /// The same numbers for a configuration that need not be a solution. `held`: a joint whose value is given, which
  /// therefore takes no part of an error; -1: none.
  IkAnswer describe(const VectorX& q, int held = -1) const;

  /// Of the task Jacobian at the position of an answer that was built, where this is nearly singular; null elsewhere.
  /// Points into the builder, until it builds again.
  const WeakDirections* weakDirectionsAt(const VectorX& position) const;

  /// Whether the seed itself meets the pose (and the limits, where they are honoured).
  bool seedSolves() const;

 private:
  TaskConditioning measure(IkAnswer& solution, bool merged) const;
  double jointError(const IkAnswer& solution, double smallest) const;
  void place(IkAnswer& solution, bool near_seed) const;
  double verify(IkAnswer& solution) const;

  const SerialChain& chain_;
  const Task& task_;
  const IkRequest& request_;
  VectorX seed_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  mutable Matrix6X jacobian_;    ///< Of the configuration verified last. A builder serves one request, in one thread.
  mutable Matrix3 orientation_;  ///< Its tip's.
  mutable std::vector<std::pair<VectorX, WeakDirections>> nearly_singular_;  ///< Isolated ones.
};

/// A redundant chain's solution lies on its self-motion; told here to first order, its range is not traced.
void describeRedundancy(const SerialChain& chain, const Task& task, IkAnswer& solution);

/// A continuum's answer, told by another of its members.
IkAnswer toldBy(IkAnswer continuum, const IkAnswer& member);

/// Candidates with those that are the same within kSameSolution joined into one, marked merged.
std::vector<Candidate> joinEqual(const SerialChain& chain, std::vector<Candidate> candidates);

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_SOLUTION_BUILDER_H

#ifndef SCREWLINE_SRC_IK_NEARLY_IDEAL_H
#define SCREWLINE_SRC_IK_NEARLY_IDEAL_H

#include <optional>
#include <vector>

#include "candidate.h"
#include "screwline/ik/numerical/continued_solver.h"

namespace screwline {

/// What stands behind elimination for an arm that has special geometry but for small errors (calibrated, or described
/// with rounded numbers). Where the ideal arm is singular for every value of one joint, as with an aligned wrist, roots
/// of the elimination crowd within its noise and are lost; the ideal arm's exact solutions lead to them.
class NearlyIdeal {
 public:
  /// Empty where no geometry is almost special, or the ideal arm has no closed form. Allocates; some milliseconds.
  static std::optional<NearlyIdeal> compile(const SerialChain& chain, const Task& task);

  /// Adds the solutions that `found` lacks. `timeout` [s] of the continuation, which is asked only where a descent from
  /// an ideal solution is singular, or does not end at one of its own in `found`. False where some may still be
  /// missing.
  bool addMissing(const Pose& target, const VectorX& seed, double timeout, std::vector<Candidate>& found) const;

 private:
  NearlyIdeal(const SerialChain& chain, const SerialChain& ideal, const Task& task, const IdealSolver& exact);

  bool confirms(const Pose& target, const VectorX& seed, const std::vector<Candidate>& found) const;

  SerialChain chain_;
  Task task_;
  IdealSolver exact_;
  ContinuedSolver continued_;
  double deviation_ = 0.0;      ///< [m, rad] Of the ideal chain's poses from the chain's.
  double near_singular_ = 0.0;  ///< Singular values below which the deviation makes solutions meet or part.
};

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_NEARLY_IDEAL_H

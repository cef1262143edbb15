#ifndef SCREWLINE_SRC_IK_CANDIDATE_H
#define SCREWLINE_SRC_IK_CANDIDATE_H

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "screwline/ik/inverse_kinematics.h"
#include "screwline/ik/task_error.h"

namespace screwline {

class AlgebraicSolver;

/// Solutions closer than this in every joint are one.
constexpr double kSameSolution = 1e-6;
/// Errors, by forward kinematics, that a solution may have: m and rad.
constexpr double kSolutionTolerance = 1e-9;

/// A member of a continuum, of a chain of eight joints at most: no memory of its own to be got and given back.
using MemberVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 8, 1>;

/// What is told of a continuum.
struct Continuum {
  VectorX nearest;     ///< Its member nearest to the seed; within limits, where they are honoured and any member is.
  MatrixX directions;  ///< k x n, orthonormal rows: tangents at `nearest`.
  std::vector<int> free_joints;  ///< That move along it.
  VectorX lower;  ///< Range of each of them, moving from `nearest` one parameter at a time until a limit is met.
  VectorX upper;
};

struct CurveImage;

/// Members of a continuum by the value of its parameter, in the turns next to `near` (which may be `member`); false
/// where there is none.
using MemberAt = std::function<bool(double value, const MemberVector& near, MemberVector& member)>;

/// A way all round a continuum of one dimension, where no joint's value leads round it: joints turn back on it, or what
/// leads is no joint of the chain.
struct WayRound {
  MemberAt at;
  double start = 0.0;  ///< A parameter's value with a member, which is not a fold.
  double period = 1.0;
};

/// A configuration that a solver proposes, on its way to becoming an IkAnswer.
struct Candidate {
  VectorX q;
  std::string branch;
  bool merged = false;    ///< Two solutions that meet here: singular by nature.
  std::vector<int> free;  ///< Joints that parametrise a continuum; empty: isolated.
  /// Member of the same branch of the continuum with the free joints at the values that `preferred` has; false where
  /// there is none.
  std::function<bool(const VectorX& preferred, VectorX& q)> member;
  /// Given where `free` is one joint whose values may not lead to all members; then `member` may be missing.
  std::optional<WayRound> round;
  /// Given where another candidate's continuum is this one's image.
  std::shared_ptr<CurveImage> image;
  /// Given where the solver knows the continuum better than by members: describes it itself.
  std::function<Continuum(const VectorX& seed, bool ignore_limits)> describe;
};

/// A candidate that has no branch and is not known to be of a continuum.
Candidate unnamed(const VectorX& q);
/// Every root of an elimination, unnamed; false in `complete` where some may be missing.
std::vector<Candidate> rootsOf(const AlgebraicSolver& solver, const Pose& target, bool& complete);

/// Brings revolute values next to `reference` by full turns; those that are, stay as they are to the bit.
void bringNear(const SerialChain& chain, const Eigen::Ref<const VectorX>& reference, Eigen::Ref<VectorX> q);
/// q with revolute values brought next to `reference`.
VectorX nearestTurns(const SerialChain& chain, VectorX q, const VectorX& reference);

/// Largest joint difference, revolute ones modulo full turns.
double largestDifference(const SerialChain& chain, const Eigen::Ref<const VectorX>& a,
                         const Eigen::Ref<const VectorX>& b);

/// Whether no joint differs by more than kSameSolution, revolute ones modulo full turns.
bool isSameConfiguration(const SerialChain& chain, const VectorX& a, const VectorX& b);

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_CANDIDATE_H

#ifndef SCREWLINE_IK_REDUNDANT_SELF_MOTION_SOLVER_H
#define SCREWLINE_IK_REDUNDANT_SELF_MOTION_SOLVER_H

#include <memory>
#include <vector>

#include "screwline/ik/redundant/self_motion.h"

namespace screwline {

/// Values of the parameter joint on one branch.
struct ParameterInterval {
  std::string branch;
  double from = 0.0;  ///< [rad or m]
  double to = 0.0;
};

/// A connected piece of the solution set within limits, as an inverse kinematics answer tells it.
struct SelfMotionAnswer {
  VectorX q;              ///< 7: its member nearest to the seed, in the turns within limits nearest to the seed.
  std::string branch;     ///< Of that member.
  double distance = 0.0;  ///< Euclidean norm of q - seed, of joints that count.
  bool within_limits = false;
  bool traced = false;           ///< A piece of a curve; else a sheet.
  bool singular = false;         ///< The Jacobian loses rank at q, or two curves cross there.
  MatrixX self_motion;           ///< k x 7, orthonormal rows: tangents at q.
  std::vector<int> free_joints;  ///< Joints that move along it.
  VectorX lower;                 ///< Range of each of them over the piece [rad or m].
  VectorX upper;
  std::vector<ParameterInterval> parameter;  ///< Arcs of the piece, in the curve's order.
};

struct SelfMotionAnswers {
  std::vector<SelfMotionAnswer> answers;  ///< Nearest to the seed first.
  int outside_limits = 0;                 ///< Curves without any part within limits.
  bool complete = false;
  std::string note;  ///< One line.
};

struct SelfMotionQuestion {
  Pose target;   ///< X_BT
  VectorX seed;  ///< 7 values, or empty: zero, clamped into the limits.
  bool ignore_limits = false;
  double timeout = 0.1;  ///< [s] for what has to be searched numerically.
  /// 1 for joints that count in distances to the seed, 0 for others.
  Vector7 counts = Vector7::Ones();
};

/// What makes a member good.
enum class SelfMotionGoal {
  kNearestToSeed,
  kFarthestFromLimits,       ///< Largest of the smallest distance to a limit over half the joint's range.
  kMostManipulable,          ///< Yoshikawa's measure.
  kFarthestFromSingularity,  ///< Largest smallest singular value, lengths in m.
};

class ArmCircle;
class PoseCurve;
class ReachMargin;

/// Self-motions of a chain of seven joints for whole poses: every connected component of the solution set as a curve
/// (Burdick 1989), cut exactly by joint limits. Where one joint given leaves a closed form, or any six others where it
/// is the first or the last, slices of all branches at 256 values of it (64 of a middle joint), and at right angles and
/// zero, find the curves, with a few searched starts where no margin of reach is known; each curve is followed by
/// predictor and corrector along the null space, so folds, where branches meet and the parameter turns back, are points
/// as any other. Else numerical search finds the starts. S-R-S arms (three axes that meet, an elbow, three that meet,
/// neighbours at right angles) need none of this: their curves are circles of the arm angle in closed form, none is
/// missed, and axes in line and a straight elbow are told with all of their dimensions, and the surfaces that rounding
/// makes of curves beside them.
///
/// Resolution. A curve may be missed where the parameter joint moves by less than 0.025 rad (0.1 of a middle joint; a
/// 256th of the range in which a slide can reach the pose) over the whole of it, between two slices. Where the point
/// that the three meeting axes share is placed by turns of which the first two meet or are parallel, the maxima of the
/// margin of reach find such curves too (an arm almost straight); with a quartic, slides or a middle joint as parameter
/// they do not, and `complete` holds to this resolution only. Between nodes joint values are monotone but for pairs of
/// extrema less than 1e-5 rad of arc length apart, so a limit may be overrun unnoticed by 1e-9 rad. Where curves come
/// near to each other, or are loops about a single configuration, they are conics to second order: whether they cross
/// or turn off is decided by the conic, to an error of 1e-14. Where even that is rounding, and members for any values
/// of two joints solve the pose to 1e-10, the surface is told as one; else `complete` is false. Immutable; all
/// functions allocate and may be called from many threads.
class SelfMotionSolver {
 public:
  /// Empty where the chain has not seven joints, or mimic joints, or moves its tip in less than six dimensions: its
  /// solutions are no curves.
  static std::optional<SelfMotionSolver> compile(const SerialChain& chain);

  /// What solves the six others where one joint is given; empty where no single joint leaves an exact method.
  const std::optional<RedundantSolver>& oneGiven() const { return one_given_; }
  const std::string& method() const { return method_; }
  /// The joint to be given; -1 where there is none.
  int parameterJoint() const { return one_given_ ? one_given_->parameterJoint() : -1; }

  /// The whole solution set. @pre target finite, R a rotation; seed of 7 finite values or empty.
  SelfMotionSet trace(const SelfMotionQuestion& question) const;

  /// One answer for each connected piece within limits.
  SelfMotionAnswers answer(const SelfMotionQuestion& question) const;

  /// All branches at one value of the parameter joint, wrapped into limits as answer() does; those outside are left out
  /// and counted unless ignored. Without self-motions; `singular` where the branch is double or a continuum, of which
  /// this is one member. @pre parameterJoint() >= 0
  SelfMotionAnswers answerAt(const SelfMotionQuestion& question, double value) const;

  /// The best member of one interval of a curve, to 1e-9 in what is optimised.
  VectorX bestMember(const SelfMotionQuestion& question, const SelfMotionCurve& curve,
                     const SelfMotionInterval& interval, SelfMotionGoal goal) const;

  /// One solution within limits, quickly: near the seed, not the nearest. Empty: none was found.
  std::optional<VectorX> anyWithinLimits(const SelfMotionQuestion& question) const;

 private:
  explicit SelfMotionSolver(const SerialChain& chain);
  PoseCurve poseCurve(const Pose& target) const;
  void follow(const SelfMotionQuestion& question, PoseCurve& pose, SelfMotionSet& set) const;
  void finish(const SelfMotionQuestion& question, PoseCurve& pose, std::size_t from,
              std::vector<SelfMotionCurve>& curves) const;
  void nameSheets(const Pose& target, std::vector<SelfMotionSheet>& sheets) const;

  SerialChain chain_;
  std::optional<RedundantSolver> one_given_;
  std::shared_ptr<const ArmCircle> arm_;       ///< Null where the chain is no S-R-S arm.
  std::shared_ptr<const ReachMargin> margin_;  ///< Null where no such margin is known.
  std::string method_;
};

}  // namespace screwline

#endif  // SCREWLINE_IK_REDUNDANT_SELF_MOTION_SOLVER_H

#ifndef SCREWLINE_SRC_IK_REDUNDANT_ARM_CIRCLE_H
#define SCREWLINE_SRC_IK_REDUNDANT_ARM_CIRCLE_H

#include <memory>
#include <optional>
#include <vector>

#include "screwline/ik/closed_form/orientation_problem.h"
#include "screwline/ik/redundant/self_motion.h"
#include "screwline/spatial/rotation.h"

namespace screwline {

/// Seven turns of which the first three and the last three meet, with neighbours at right angles (S-R-S): the elbow's
/// angle is fixed by the distance between the two points, what is left is a turn of the arm about the line through
/// them (the arm angle, Kreutz-Delgado et al. 1992; Shimizu et al. 2008). Every solution is closed form of that angle,
/// also where the Jacobian tells nothing: with a straight elbow, aligned axes, and next to these. Immutable.
class ArmCircle {
 public:
  static std::optional<ArmCircle> compile(const SerialChain& chain);

  /// One of the groups of three axes.
  struct Group {
    OrientationProblem problem;
    std::array<Vector3, 3> axis;  ///< At zero.
  };

  const Group& shoulder() const { return groups_[0]; }
  const Group& wrist() const { return groups_[1]; }
  const SerialChain& chain() const { return chain_; }
  const Vector3& shoulderCenter() const { return shoulder_center_; }
  const Vector3& wristCenter() const { return wrist_center_; }

 private:
  ArmCircle(const SerialChain& chain, const Group& shoulder, const Group& wrist);

  SerialChain chain_;
  std::array<Group, 2> groups_;
  Vector3 shoulder_center_;
  Vector3 wrist_center_;  ///< At zero.
};

/// Which of the two ways a group turns: the sign of the sine of its middle angle. 0: any.
struct ArmSigns {
  int shoulder = 1;
  int wrist = 1;
  bool operator==(const ArmSigns& other) const { return shoulder == other.shoulder && wrist == other.wrist; }
};

/// The solutions of one pose. Immutable.
class ArmPose {
 public:
  ArmPose(std::shared_ptr<const ArmCircle> arm, const Pose& target);

  /// What a group has to turn by, as a function of the arm angle, in the group's frames.
  struct Side {
    Matrix3 at(double angle) const { return before * rotationAbout(Vector3::UnitZ(), sense * angle) * behind; }
    /// The largest sine between the first and the third axis of the group, to second order.
    double tilt() const { return before.bottomLeftCorner<1, 2>().norm() + behind.topRightCorner<2, 1>().norm(); }

    Matrix3 before, behind;
    double sense = 1.0;  ///< -1 of the wrist, which turns back.
  };

  /// One value of the elbow. The arm angle is zero where axes come nearest to being in line: there joints may turn much
  /// faster than it.
  struct Elbow {
    double q = 0.0;
    bool straight = false;  ///< Or folded: rounding does not tell the two values apart that it may have.
    Side shoulder, wrist;
    Matrix3 turn;  ///< Of the elbow.
  };

  /// Tilt of a group beside a straight elbow below which its turns follow the elbow by what rounding leaves it bent.
  static constexpr double kFlat = 1e-7;

  /// None where the pose is out of reach, or the points coincide.
  const std::vector<Elbow>& elbows() const { return elbows_; }
  /// False where the wrist's point lies in the shoulder's: all directions of the arm are solutions.
  bool isRegular() const { return regular_; }

  /// Fills q, tangent, noise, angle and angle_rate. Without `signs`, the ways nearest to `near` are taken; turns are
  /// those nearest to it, and joints that turn out free have its values.
  void at(const Elbow& elbow, double angle, const ArmSigns* signs, const Vector7& near, SelfMotionNode& node) const;

  /// The configuration alone. Returns the lesser sine between first and third axes of the groups; 0 where one is free.
  double solve(const Elbow& elbow, double angle, const ArmSigns* signs, const Vector7& near, Vector7& q) const;

  /// The arm angle that three turns of a group make whose axes are almost in line at every arm angle; of q the turns
  /// about the first and the third axis count.
  double angleOf(const Elbow& elbow, bool shoulder, const Vector7& q) const;

  /// A straight elbow bent by what the distance does not tell, so that a group whose axes are then almost in line has
  /// the turns about its first and third axis that q has: any two, where that bends it little enough. Else empty.
  std::optional<Elbow> bentFor(const Elbow& straight, bool shoulder, const Vector7& q) const;

  /// Arm angles at which the first and the third axis of a group are nearest to being in line, one way and the other;
  /// any, where they are as near at all of them.
  static std::array<double, 2> extremes(const Side& side);

  /// Sine between the first and the third axis of a group.
  static double outOfLine(const Side& side, double angle);

  /// The elbow whose value a node has.
  const Elbow& elbowOf(const SelfMotionNode& node) const;

 private:
  Elbow elbowAt(double q) const;
  void joinElbows();
  static void recentre(Elbow& elbow);
  Vector7 rates(const Elbow& elbow, const Vector7& q) const;

  std::shared_ptr<const ArmCircle> arm_;
  Vector3 line_;      ///< From the shoulder's point to the wrist's, of norm 1.
  Matrix3 rotation_;  ///< Of the tip against its orientation at zero.
  bool regular_ = true;
  std::vector<Elbow> elbows_;
};

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_REDUNDANT_ARM_CIRCLE_H

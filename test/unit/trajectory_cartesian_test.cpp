#include <gtest/gtest.h>

#include "property/cartesian_support.h"
#include "screwline/trajectory/branch_following.h"
#include "screwline/trajectory/tool_path.h"

namespace screwline {
namespace trajectory_test {
namespace {

Pose moved(const Pose& X, double x, double y, double z) {
  return {X.R, X.p + Vector3(x, y, z)};
}

VectorX pumaPlace() {
  return vector({0.3, -0.7, 0.6, 0.4, 0.6, -0.9});
}

bool mentions(const std::string& text, const std::string& word) {
  return text.find(word) != std::string::npos;
}

/// Derivatives of a path by central differences.
void expectDerivatives(const ToolPath& path, double u) {
  constexpr double kStep = 1e-5;
  ToolPathPoint at, ahead, behind;
  path.at(0, u, at);
  path.at(0, u + kStep, ahead);
  path.at(0, u - kStep, behind);
  const Vector3 v = (ahead.pose.p - behind.pose.p) / (2 * kStep);
  const Vector3 w = rotationVector(ahead.pose.R * behind.pose.R.transpose()) / (2 * kStep);
  EXPECT_LT((at.rate.head<3>() - v).norm(), 1e-8) << u;
  EXPECT_LT((at.rate.tail<3>() - w).norm(), 1e-8) << u;
  EXPECT_LT((at.change - (ahead.rate - behind.rate) / (2 * kStep)).norm(), 1e-6) << u;
}

std::vector<Pose> threePoses(Random& random) {
  std::vector<Pose> poses;
  for (int i = 0; i < 3; ++i) {
    const Vector3 axis = random.vector(3, -1.0, 1.0).normalized();
    poses.push_back({rotationAbout(axis, random.uniform(-1.0, 1.0)), random.vector(3, -0.5, 0.5)});
  }
  return poses;
}

TEST(ToolPath, DerivativesOfLinesScrewsBlendsAndArcs) {
  Random random(3);
  for (int k = 0; k < 20; ++k) {
    const std::vector<Pose> poses = threePoses(random);
    ToolPathOptions options;
    options.length_scale = 0.7;
    options.blend_radius = 0.1;
    for (const bool screw : {false, true}) {
      options.screw = screw;
      const ToolPath path = linesThrough(poses, options).path;
      EXPECT_EQ(path.parts(), 1U);
      for (int i = 1; i < 40; ++i) expectDerivatives(path, path.length() * i / 40.0);
      EXPECT_TRUE(isApprox(path.pose(0.0), poses[0], 1e-12));
      EXPECT_TRUE(isApprox(path.pose(path.length()), poses[2], 1e-9));
    }
    const ToolPath arc = arcThrough(poses, {}, options);
    for (int i = 1; i < 20; ++i) expectDerivatives(arc, arc.length() * i / 20.0);
    for (int i = 0; i < 3; ++i) {
      EXPECT_TRUE(
          isApprox(arc.pose(arc.waypoints()[static_cast<std::size_t>(i)]), poses[static_cast<std::size_t>(i)], 1e-9));
    }
  }
}

TEST(ToolPath, ABlendCutsTheCornerByWhatItSays) {
  const Pose A, B = moved(A, 1.0, 0.0, 0.0), C = moved(A, 1.0, 1.0, 0.0);
  ToolPathOptions options;
  options.blend_radius = 0.2;
  const auto [path, corners] = linesThrough({A, B, C}, options);
  EXPECT_NEAR((path.pose(path.waypoints()[1]).p - B.p).norm(), 0.1875 * std::sqrt(2.0) * 0.2, 1e-12);
  EXPECT_NEAR(corners[1].deviation, 0.1875 * std::sqrt(2.0) * 0.2, 1e-12);
  options.blend_radius = 0.0;
  EXPECT_EQ(linesThrough({A, B, C}, options).path.parts(), 2U);
  EXPECT_EQ(linesThrough({A, B, B, moved(B, 1.0, 0.0, 0.0)}, options).path.parts(), 1U) << "no corner, one pose twice";
}

/// From the line through two points.
double awayFromLine(const Vector3& from, const Vector3& to, const Vector3& p) {
  return (to - from).normalized().cross(p - from).norm();
}

TEST(ToolPath, CornersTellWhatSamplesOfThePathShow) {
  trajectory_test::Random random(47);
  for (int trial = 0; trial < 40; ++trial) {
    const std::vector<Pose> poses = threePoses(random);
    ToolPathOptions options;
    options.rotates = trial % 4 != 0;
    options.length_scale = 0.7;
    options.blend_radius = random.uniform(0.01, 0.6);
    const auto [path, corners] = linesThrough(poses, options);
    double off_lines = 0.0;
    double reach = 0.0;
    for (int i = 0; i <= 4000; ++i) {
      const Vector3 p = path.pose(path.length() * i / 4000.0).p;
      const double off[] = {awayFromLine(poses[0].p, poses[1].p, p), awayFromLine(poses[1].p, poses[2].p, p)};
      off_lines = std::max(off_lines, std::min(off[0], off[1]));
      if (std::min(off[0], off[1]) > 1e-9) reach = std::max(reach, (p - poses[1].p).norm());
    }
    EXPECT_LE(off_lines, corners[1].off_lines + 1e-12) << "seed 47, trial " << trial;
    EXPECT_GE(off_lines, corners[1].off_lines - 2e-4) << "between samples; seed 47, trial " << trial;
    EXPECT_LE(corners[1].reach, options.blend_radius * (1.0 + 1e-12)) << "seed 47, trial " << trial;
    EXPECT_LE(reach, corners[1].reach + 1e-9) << "seed 47, trial " << trial;
    EXPECT_EQ(corners[1].shortened, corners[1].reach < options.blend_radius * (1.0 - 1e-9));
    EXPECT_EQ(corners[0].reach, 0.0);
  }
}

TEST(CartesianArc, StaysOnTheCircleThroughThreePoses) {
  const Arm arm("puma560");
  const Pose A = forwardKinematics(arm.chain, pumaPlace());
  const Pose B = moved(A, 0.06, 0.06, 0.0);
  const Pose C = moved(A, 0.0, 0.12, 0.02);
  const PlanResult result = plan(arm.request("cartesian_arc", {A, B, C}, pumaPlace()));
  const Vector3 normal = (B.p - A.p).cross(C.p - A.p).normalized();
  TrajectoryPoint point(6);
  // The centre is equally far from all three: an own way to find it.
  Matrix3 rows;
  rows << (B.p - A.p).transpose(), (C.p - A.p).transpose(), normal.transpose();
  const Vector3 right(0.5 * (B.p.squaredNorm() - A.p.squaredNorm()), 0.5 * (C.p.squaredNorm() - A.p.squaredNorm()),
                      normal.dot(A.p));
  const Vector3 centre = rows.inverse() * right;
  for (int k = 0; k <= 500; ++k) {
    result.trajectory.sample(result.trajectory.duration() * k / 500, point);
    const Pose X = forwardKinematics(arm.chain, point.position);
    EXPECT_NEAR((X.p - centre).norm(), (A.p - centre).norm(), 1e-6);
    EXPECT_NEAR(normal.dot(X.p - A.p), 0.0, 1e-6);
    EXPECT_LT(rotationAngle(X.R * A.R.transpose()), 1e-6);
  }
  EXPECT_LT(result.via_joint_errors.cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LE(largestUse(result.trajectory, arm.limits(), 2000), 1.0 + 1e-6);
}

TEST(CartesianLine, PassesThroughTheAlignedWrist) {
  const Arm arm("puma560");
  const VectorX middle = vector({0.3, -0.7, 0.6, 0.4, 0.0, -0.9});
  Matrix6X J(6, 6);
  const Pose M = geometricJacobian(arm.chain, middle, J);
  const Vector6 V = J * vector({0.3, 0.2, -0.4, 0.0, 0.8, 0.1});
  const auto at = [&](double s) {
    return Pose{rotationAbout(V.tail<3>().normalized(), s * V.tail<3>().norm()) * M.R, M.p + s * V.head<3>()};
  };
  const PlanResult result = plan(arm.request("cartesian_line", {at(-0.4), at(0.5)}, middle));
  EXPECT_TRUE(mentions(joined(result.notes), "passes through singularity 'wrist")) << joined(result.notes);
  EXPECT_LT(result.waypoints.front()[4] * result.waypoints.back()[4], 0.0) << "the wrist goes to its other side";
  EXPECT_LE(largestUse(result.trajectory, arm.limits(), 5000), 1.0 + 1e-6);
  EXPECT_LT(result.trajectory.duration(), 3.0);
}

TEST(CartesianLine, SlowsDownBesideTheAlignedWristAndSaysSo) {
  const Arm arm("kr6_r900");  // Its fourth joint makes a half turn within limits.
  const VectorX middle = vector({0.3, -1.0, 1.2, 0.0, 0.0, -0.2});
  const Pose M = forwardKinematics(arm.chain, middle);
  Matrix6X J(6, 6);
  geometricJacobian(arm.chain, middle, J);
  const Vector3 across = J.col(3).tail<3>().cross(J.col(4).tail<3>()).normalized();
  const auto at = [&](double turn) {
    return Pose{rotationAbout(J.col(4).tail<3>(), turn) * rotationAbout(across, 0.01) * M.R, M.p};
  };
  const PlanRequest question = arm.request("cartesian_line", {at(-0.4), at(0.4)}, middle);
  const PlanResult result = plan(question);
  EXPECT_TRUE(mentions(joined(result.notes), "passes beside singularity 'wrist")) << joined(result.notes);
  EXPECT_LE(largestUse(result.trajectory, arm.limits(), 5000), 1.0 + 1e-6);
}

TEST(CartesianLine, StartsAndEndsOnTheEdgeOfTheWorkspace) {
  const Arm arm("rrr_planar");
  const VectorX straight = vector({0.3, 0.0, 0.4});
  const VectorX bent = vector({0.3, 0.9, 0.4});
  const Pose A = forwardKinematics(arm.chain, straight);
  const Pose B = forwardKinematics(arm.chain, bent);
  for (const auto& way : {std::vector<Pose>{A, B}, std::vector<Pose>{B, A}}) {
    const PlanResult result = plan(arm.request("cartesian_line", way, bent));
    EXPECT_LE(largestUse(result.trajectory, arm.limits(), 2000), 1.0 + 1e-6);
    EXPECT_TRUE(mentions(joined(result.notes), "elbow")) << joined(result.notes);
    PlanRequest law = arm.request("cartesian_line", way, bent);
    law.time_law = "polynomial_345";
    EXPECT_EQ(errorOf(law), AnswerCode::kLimitsInfeasible);
  }
  const Pose beyond = moved(A, 0.3 * A.p.x() / A.p.norm(), 0.3 * A.p.y() / A.p.norm(), 0.0);
  const PlanRequest out = arm.request("cartesian_line", {B, beyond}, bent);
  EXPECT_EQ(errorOf(out), AnswerCode::kPathNotContinuous);
  EXPECT_TRUE(mentions(messageOf(out), "out of reach") && mentions(messageOf(out), "elbow")) << messageOf(out);
}

TEST(CartesianLine, NamesTheJointWhoseLimitEndsTheWay) {
  const Arm arm("scara_600");
  VectorX q = 0.5 * (arm.chain.lower() + arm.chain.upper());
  q[1] = 0.6;
  const Pose A = forwardKinematics(arm.chain, q);
  const double depth = arm.chain.upper()[2] - arm.chain.lower()[2];
  const PlanRequest request = arm.request("cartesian_line", {A, moved(A, 0.0, 0.0, 2.0 * depth)}, q);
  EXPECT_EQ(errorOf(request), AnswerCode::kPathNotContinuous);
  EXPECT_TRUE(mentions(messageOf(request), arm.chain.joint(2).name)) << messageOf(request);
  EXPECT_TRUE(mentions(messageOf(request), "reaches its limit")) << messageOf(request);
}

TEST(CartesianLine, ACornerIsStoppedAtOrBlended) {
  const Arm arm("puma560");
  const Pose A = forwardKinematics(arm.chain, pumaPlace());
  const std::vector<Pose> way{A, moved(A, 0.1, 0.0, 0.0), moved(A, 0.1, 0.0, 0.0), moved(A, 0.1, 0.1, 0.0)};
  PlanRequest question = arm.request("cartesian_line", way, pumaPlace());
  const PlanResult stopped = plan(question);
  TrajectoryPoint point(6);
  stopped.trajectory.sample(stopped.waypoint_times[1], point);
  EXPECT_LT(point.velocity.cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LT(stopped.via_joint_errors.cwiseAbs().maxCoeff(), 1e-6);
  question.parameters = {{"blend_radius", 0.03}};
  const PlanResult blended = plan(question);
  EXPECT_LT(blended.trajectory.duration(), stopped.trajectory.duration());
  EXPECT_GT(blended.via_joint_errors.cwiseAbs().maxCoeff(), 1e-4);
  blended.trajectory.sample(blended.waypoint_times[1], point);
  EXPECT_NEAR((forwardKinematics(arm.chain, point.position).p - way[1].p).norm(), 0.1875 * std::sqrt(2.0) * 0.03, 1e-5);
  EXPECT_LE(largestUse(blended.trajectory, arm.limits(), 4000), 1.0 + 1e-6);
}

TEST(CartesianLine, EveryTimeLawDrivesTheSameWay) {
  const Arm arm("puma560");
  const Pose A = forwardKinematics(arm.chain, pumaPlace());
  const Pose B = moved(A, 0.1, 0.05, -0.05);
  for (const char* name : {"rectangular", "cubic", "trapezoidal", "polynomial_345", "polynomial_4567", "cycloidal",
                           "minimum_jerk", "double_s"}) {
    PlanRequest question = arm.request("cartesian_line", {A, B}, pumaPlace());
    question.time_law = name;
    const PlanResult result = plan(question);
    TrajectoryPoint point(6);
    for (int k = 0; k <= 200; ++k) {
      result.trajectory.sample(result.trajectory.duration() * k / 200, point);
      const Pose X = forwardKinematics(arm.chain, point.position);
      EXPECT_LT(offLine(arm.task, A, B, X), 1e-6) << name;
    }
    const LimitUse use = tightestUse(result.trajectory, arm.limits());
    EXPECT_NEAR(use.stretch, 1.0, 1e-6) << name;
    question.duration = 0.5 * result.trajectory.duration();
    EXPECT_EQ(errorOf(question), AnswerCode::kLimitsInfeasible) << name;
    question.duration = 2.0 * result.trajectory.duration();
    EXPECT_DOUBLE_EQ(plan(question).trajectory.duration(), question.duration);
  }
  PlanRequest wrong = arm.request("cartesian_line", {A, B}, pumaPlace());
  wrong.time_law = "warp";
  EXPECT_EQ(errorOf(wrong), AnswerCode::kInvalidGoal);
}

TEST(CartesianLine, KeepsToTheToolSpeed) {
  const Arm arm("puma560");
  const Pose A = forwardKinematics(arm.chain, pumaPlace());
  PlanRequest question = arm.request("cartesian_line", {A, moved(A, 0.1, 0.05, -0.05)}, pumaPlace());
  question.parameters = {{"tool_speed", 0.05}};
  const JointTrajectory motion = plan(question).trajectory;
  TrajectoryPoint point(6);
  Matrix6X J(6, 6);
  double fastest = 0.0;
  for (int k = 0; k <= 1000; ++k) {
    motion.sample(motion.duration() * k / 1000, point);
    geometricJacobian(arm.chain, point.position, J);
    fastest = std::max(fastest, (J.topRows<3>() * point.velocity).norm());
  }
  EXPECT_LE(fastest, 0.05 * (1.0 + 1e-6));
  EXPECT_GT(fastest, 0.049);
}

TEST(CartesianLine, RefusesWhatItCannotMean) {
  const Arm arm("puma560");
  const Pose A = forwardKinematics(arm.chain, pumaPlace());
  const Pose B = moved(A, 0.1, 0.0, 0.0);
  PlanRequest far = arm.request("cartesian_line", {moved(A, 9.0, 0.0, 0.0), B}, pumaPlace());
  EXPECT_EQ(errorOf(far), AnswerCode::kNoIkSolution);
  PlanRequest branch = arm.request("cartesian_line", {A, B}, pumaPlace());
  branch.waypoints[0].branch = "elbow sideways";
  EXPECT_EQ(errorOf(branch), AnswerCode::kInvalidGoal);
  PlanRequest radius = arm.request("cartesian_line", {A, B}, pumaPlace());
  radius.parameters = {{"blend_radius", -0.1}};
  EXPECT_EQ(errorOf(radius), AnswerCode::kInvalidGoal);
  PlanRequest broken = arm.request("cartesian_line", {A, B}, pumaPlace());
  broken.waypoints[1].pose.p.x() = std::nan("");
  EXPECT_EQ(errorOf(broken), AnswerCode::kInvalidGoal);
  PlanRequest line = arm.request("cartesian_arc", {A, B, moved(A, 0.2, 0.0, 0.0)}, pumaPlace());
  EXPECT_EQ(errorOf(line), AnswerCode::kInvalidGoal);
  PlanRequest joints = arm.request("cartesian_line", {A, B}, pumaPlace());
  joints.waypoints[1].position = pumaPlace();
  joints.waypoints[1].position[3] += 1.0;
  EXPECT_EQ(errorOf(joints), AnswerCode::kSuccess);
  joints.waypoints[1].position[3] -= kPi;
  joints.waypoints[1].position[4] *= -1.0;
  joints.waypoints[1].position[5] += kPi;
  EXPECT_EQ(errorOf(joints), AnswerCode::kPathNotContinuous);
  EXPECT_TRUE(mentions(messageOf(joints), "give it as a pose")) << messageOf(joints);
  PlanRequest nothing = arm.request("cartesian_line", {A, A}, pumaPlace());
  EXPECT_EQ(plan(nothing).trajectory.duration(), 0.0);
}

}  // namespace
}  // namespace trajectory_test
}  // namespace screwline

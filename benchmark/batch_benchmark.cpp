// Batches of forward kinematics, Jacobians and inverse kinematics; the unit is KDL's forward kinematics of six joints.
// All are timed in turn, round after round, and the medians of the ratios printed, so that a drifting machine does not
// decide.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainjnttojacsolver.hpp>

#include "robots.h"
#include "screwline/ik/batch.h"
#include "screwline/kinematics/batch.h"
#include "screwline/kinematics/jacobian.h"

namespace screwline {
namespace benchmark_support {
namespace {

constexpr std::size_t kRows = 4096;
constexpr int kRounds = 101;
constexpr std::size_t kIkRows = 256;

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

struct Case {
  std::string name;
  std::size_t rows;
  std::function<void()> work;
  std::vector<double> times;  ///< [s] per row, a round each.
};

/// Keeps a result from being optimised away.
volatile double sink = 0.0;

/// Yaw, two pitches, spherical wrist: six turning joints.
SerialChain sixTurningJoints() {
  const Vector3 wrist(0.91, 0.15, 0.42);
  const std::vector<std::pair<Vector3, Vector3>> lines = {{Vector3::UnitZ(), Vector3::Zero()},
                                                          {Vector3::UnitY(), {0.1, 0.15, 0.4}},
                                                          {Vector3::UnitY(), {0.53, 0.15, 0.4}},
                                                          {Vector3::UnitX(), wrist},
                                                          {Vector3::UnitY(), wrist},
                                                          {Vector3::UnitX(), wrist}};
  ChainDescription d;
  d.name = "six_turning_joints";
  d.base_link = "base";
  d.tip_link = "tip";
  for (const auto& [direction, point] : lines) {
    Axis axis;
    axis.direction = direction;
    axis.point = point;
    axis.source = static_cast<int>(d.axes.size());
    d.axes.push_back(axis);
    d.joints.emplace_back();
    d.joints.back().name = "q" + std::to_string(d.axes.size());
  }
  d.home.p = wrist + 0.1 * Vector3::UnitX();
  d.links = {{"base", 0, {}}, {"tip", 6, d.home}};
  return SerialChain(d);
}

/// The same for KDL: a segment per joint, from each joint's point to the next.
KDL::Chain kdlOf(const SerialChain& chain) {
  KDL::Chain result;
  const auto vector = [](const Vector3& v) { return KDL::Vector(v.x(), v.y(), v.z()); };
  Vector3 place = Vector3::Zero();
  for (std::size_t i = 0; i < chain.axes().size(); ++i) {
    const Axis& axis = chain.axes()[i];
    const bool last = i + 1 == chain.axes().size();
    const Vector3 next = last ? chain.home().p : chain.axes()[i + 1].point;
    if (i == 0) result.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::None), KDL::Frame(vector(axis.point))));
    place = axis.point;
    const KDL::Joint joint(KDL::Vector::Zero(), vector(axis.direction), KDL::Joint::RotAxis);
    result.addSegment(KDL::Segment(joint, KDL::Frame(vector(next - place))));
  }
  return result;
}

/// What is timed on one chain.
class Cases {
 public:
  Cases(const SerialChain& chain, const KDL::Chain& kdl)
      : chain_(chain),
        n_(static_cast<std::size_t>(chain.size())),
        q_(kRows * n_),
        poses_(kRows * kPoseNumbers),
        jacobians_(kRows * 6 * n_),
        J_(6, chain.size()),
        solver_(chain, Task()),
        kdl_(kdl),
        forward_(kdl_),
        jacobian_(kdl_),
        kdl_q_(static_cast<unsigned>(n_)),
        kdl_J_(static_cast<unsigned>(n_)) {
    std::mt19937 random(kSeed);
    std::uniform_real_distribution<double> value(-1.0, 1.0);
    for (std::size_t i = 0; i < q_.size(); ++i)
      q_[i] = (chain.joint(static_cast<int>(i % n_)).isRevolute() ? 3.0 : 0.3) * value(random);
    for (std::size_t row = 0; row < kIkRows; ++row) targets_.push_back(forwardKinematics(chain_, at(row)));
    list();
  }

  void run(const std::string& title) {
    for (int round = 0; round < kRounds; ++round) {
      for (Case& timed : cases_) {
        const auto start = std::chrono::steady_clock::now();
        timed.work();
        const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
        timed.times.push_back(time.count() / static_cast<double>(timed.rows));
      }
    }
    std::printf("%s\n", title.c_str());
    for (const Case& timed : cases_) {
      std::vector<double> ratios;
      for (std::size_t round = 0; round < timed.times.size(); ++round) {
        ratios.push_back(timed.times[round] / cases_.front().times[round]);
      }
      std::printf("  %-44s median %9.1f ns, ratio %.4f\n", timed.name.c_str(), median(timed.times) * 1e9,
                  median(ratios));
    }
  }

 private:
  Eigen::Map<const VectorX> at(std::size_t row) const {
    return Eigen::Map<const VectorX>(&q_[row * n_], static_cast<Eigen::Index>(n_));
  }

  void list() {
    cases_.push_back({"KDL forward", kRows, [this] { forwardKdl(false); }, {}});
    cases_.push_back({"KDL forward and Jacobian", kRows, [this] { forwardKdl(true); }, {}});
    cases_.push_back({"one by one, forward", kRows, [this] { oneByOne(false); }, {}});
    cases_.push_back({"one by one, forward and Jacobian", kRows, [this] { oneByOne(true); }, {}});
    for (const int lanes : {2, 4, 8}) {
      const std::string suffix = ", at most " + std::to_string(lanes) + " lanes";
      cases_.push_back({"batch, forward" + suffix, kRows, [this, lanes] { batch(lanes, false); }, {}});
      cases_.push_back({"batch, forward and Jacobian" + suffix, kRows, [this, lanes] { batch(lanes, true); }, {}});
    }
    cases_.push_back({"batch, inverse, all solutions", kIkRows, [this] { inverse(); }, {}});
  }

  void forwardKdl(bool with_jacobian) {
    KDL::Frame frame;
    for (std::size_t row = 0; row < kRows; ++row) {
      kdl_q_.data = at(row);
      forward_.JntToCart(kdl_q_, frame);
      if (with_jacobian) jacobian_.JntToJac(kdl_q_, kdl_J_);
      sink = frame.p.x() + (with_jacobian ? kdl_J_.data(0, 0) : 0.0);
    }
  }

  void oneByOne(bool with_jacobian) {
    for (std::size_t row = 0; row < kRows; ++row) {
      sink = with_jacobian ? geometricJacobian(chain_, at(row), J_).p.x() : forwardKinematics(chain_, at(row)).p.x();
    }
  }

  void batch(int lanes, bool with_jacobian) {
    BatchOptions options;
    options.lanes = lanes;
    forwardBatch(chain_, {q_.data(), kRows, poses_.data(), nullptr, with_jacobian ? jacobians_.data() : nullptr},
                 options);
    sink = poses_.back();
  }

  void inverse() {
    IkBatchRequest request;
    request.targets = targets_.data();
    request.count = targets_.size();
    request.each.ignore_limits = true;
    sink = solveBatch(solver_, request).positions.back();
  }

  SerialChain chain_;
  std::size_t n_;
  std::vector<double> q_;
  std::vector<double> poses_;
  std::vector<double> jacobians_;
  std::vector<Pose> targets_;
  Matrix6X J_;
  InverseKinematics solver_;
  KDL::Chain kdl_;
  KDL::ChainFkSolverPos_recursive forward_;
  KDL::ChainJntToJacSolver jacobian_;
  KDL::JntArray kdl_q_;
  KDL::Jacobian kdl_J_;
  std::vector<Case> cases_;
};

}  // namespace
}  // namespace benchmark_support
}  // namespace screwline

int main() {
  using namespace screwline::benchmark_support;
  const screwline::SerialChain chain = sixTurningJoints();
  Cases(chain, kdlOf(chain)).run("six turning joints, spherical wrist");
  const Robot robot("rrprrr");
  Cases(robot.chain, robot.kdl).run("rrprrr");
  return 0;
}

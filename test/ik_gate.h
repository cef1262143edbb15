#ifndef SCREWLINE_TEST_IK_GATE_H
#define SCREWLINE_TEST_IK_GATE_H

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>

#include "screwline/ik/inverse_kinematics.h"
#include "screwline/ik/task_error.h"
#include "screwline/kinematics/forward.h"
#include "screwline/kinematics/jacobian.h"
#include "screwline/kinematics/singularity.h"
#include "screwline/spatial/svd.h"

namespace screwline {
namespace test {

/// A number from the environment, for longer runs than the usual one.
inline unsigned wished(const char* variable, unsigned usual) {
  const char* wish = std::getenv(variable);
  return wish == nullptr ? usual : static_cast<unsigned>(std::strtoul(wish, nullptr, 10));
}

/// Largest joint difference, turns modulo 2 pi.
inline double jointDifference(const SerialChain& chain, const VectorX& a, const VectorX& b) {
  double largest = 0.0;
  for (int i = 0; i < chain.size(); ++i) {
    const double d = a[i] - b[i];
    largest = std::max(largest, std::abs(chain.joint(i).isRevolute() ? std::remainder(d, kTwoPi) : d));
  }
  return largest;
}

/// How well a configuration is told by its pose: 1e-16 over the least singular value, and 1e-6 at which solutions are
/// one.
inline double placeTolerance(const SerialChain& chain, const Task& task, const VectorX& q) {
  return 1.5e-6 + 2e-14 * (1.0 + chain.characteristicLength()) /
                      std::max(singularValues(taskJacobian(chain, q, task)).minCoeff(), 1e-15);
}

/// What was asked of inverse kinematics about the pose of one configuration, and what came of it.
struct GateVerdict {
  bool answered = false;            ///< Every question had a solution.
  bool found_unseeded = false;      ///< The one without a seed had.
  bool proved_unreachable = false;  ///< Said of a pose that the configuration reaches.
  bool complete = false;
  bool threw = false;
  bool lost = false;        ///< The configuration is neither among the solutions nor on a continuum of them.
  bool seed_first = false;  ///< Given as the seed, it is the first answer, to 1e-9.
  bool merged = false;      ///< Another solution, next to it and different, has not an answer of its own.
  bool repeated = false;    ///< Two answers are one.
  bool finite = true;
  bool in_limits = true;
  bool seed_value_kept = true;  ///< Members of continua are the nearest to the seed.
  int count = 0;
  int continua = 0;
  double worst_error = 0.0;
  std::string message;

  bool isLawful() const {
    return answered && !proved_unreachable && !threw && seed_first && !merged && !repeated && finite && in_limits &&
           seed_value_kept && worst_error < 1e-9 && !(lost && complete);
  }
};

/// The laws of inverse kinematics at one configuration, which need not be regular.
class IkGate {
 public:
  IkGate(const InverseKinematics& ik, const VectorX& q, bool ignore_limits)
      : ik_(ik), chain_(ik.chain()), q_(q), target_(forwardKinematics(chain_, q)), ignore_limits_(ignore_limits) {}

  IkRequest request() const {
    IkRequest request;
    request.target = target_;
    request.ignore_limits = ignore_limits_;
    request.timeout = 20.0;  // What is searched ends by its own count: time is the machine's.
    request.find_closest = false;
    return request;
  }

  /// `displacement`: of a second seed beside the configuration, n values.
  GateVerdict judge(const VectorX& displacement) {
    try {
      unseeded();
      seeded();
      beside(displacement);
    } catch (const std::exception& error) {
      verdict_.threw = true;
      verdict_.message = error.what();
    }
    return verdict_;
  }

  /// Whether a configuration that solves the pose has an answer, or lies on a continuum that has.
  bool isKnown(const VectorX& solution, const IkResult& result, double tolerance) const {
    for (const IkAnswer& answer : result.solutions) {
      if (jointDifference(chain_, answer.position, solution) <= tolerance) return true;
      if (isSameToRounding(answer.position, solution)) return true;
    }
    // The nearest member to a seed beside a member cannot be farther than that member.
    const bool continuous = std::any_of(result.solutions.begin(), result.solutions.end(),
                                        [](const IkAnswer& answer) { return answer.self_motion.rows() > 0; });
    if (!continuous) return false;
    IkRequest question = request();
    const VectorX push = VectorX::LinSpaced(chain_.size(), -1e-3, 7e-4);
    question.seed = ignore_limits_ ? VectorX(solution + push) : chain_.clamped(solution + push);
    const IkResult near = ik_.solve(question);
    return !near.solutions.empty() &&
           near.solutions.front().distance <= (question.seed - solution).norm() * 1.001 + tolerance;
  }

  /// Where the pose is met to rounding on all the way between two solutions, it does not tell them apart. The way is
  /// taken in the weak directions alone, the others follow it: it bends.
  bool isSameToRounding(const VectorX& a, const VectorX& b) const {
    VectorX way = b - a;
    for (int i = 0; i < chain_.size(); ++i) {
      if (chain_.joint(i).isRevolute()) way[i] = std::remainder(way[i], kTwoPi);
    }
    if (way.norm() > 1e-2) return false;
    const Svd svd(taskJacobian(chain_, a + 0.5 * way, ik_.task()), Eigen::ComputeThinU | Eigen::ComputeThinV);
    for (double share : {0.25, 0.5, 0.75, 1.0}) {
      if (leastErrorAbout(a + share * way, svd) > 4e-15 * (1.0 + chain_.characteristicLength())) return false;
    }
    return true;
  }

 private:
  /// What is left of the error where the directions that are not weak have made good what they can: the weakest one is
  /// always one. `svd` of the task Jacobian near q.
  double leastErrorAbout(VectorX q, const Svd& svd) const {
    constexpr int kSteps = 3;
    const VectorX& sigma = svd.singularValues();
    const Eigen::Index strong = std::min<Eigen::Index>((sigma.array() > 1e-4 * sigma[0]).count(), sigma.size() - 1);
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k <= kSteps; ++k) {
      const Pose tip = forwardKinematics(chain_, q);
      const TaskError error = taskError(ik_.task(), target_, tip);
      least = std::min(least, error.norm());
      const VectorX along = svd.matrixU().leftCols(strong).transpose() * ik_.task().select(error.twist, tip.R);
      q += svd.matrixV().leftCols(strong) * along.cwiseQuotient(sigma.head(strong));
    }
    return least;
  }

  void note(const std::string& text) {
    if (verdict_.message.empty()) verdict_.message = text;
  }

  void unseeded() {
    const IkResult result = ik_.solve(request());
    verdict_.found_unseeded = result.status == IkStatus::kSolved;
    verdict_.answered = verdict_.found_unseeded || !ik_.complete();
    verdict_.proved_unreachable = result.status == IkStatus::kUnreachable;
    verdict_.complete = result.complete;
    verdict_.count = static_cast<int>(result.solutions.size());
    if (!verdict_.answered) note(result.message);
    for (const IkAnswer& answer : result.solutions) verdict_.continua += answer.self_motion.rows() > 0 ? 1 : 0;
    examine(result);
    const double tolerance = placeTolerance(chain_, ik_.task(), q_);
    verdict_.lost = ik_.complete() && !isKnown(q_, result, tolerance);
    if (verdict_.lost) note("lost: " + result.message);
    verdict_.merged = mateIsMissing(result);
    if (verdict_.complete && verdict_.continua > 0 && isFartherThanKnown(result)) {
      verdict_.seed_value_kept = false;
      note("a member is nearer to the seed than all that is told");
    }
  }

  void seeded() {
    IkRequest question = request();
    question.seed = q_;
    const IkResult result = ik_.solve(question);
    verdict_.answered = verdict_.answered && result.status == IkStatus::kSolved;
    if (result.status == IkStatus::kUnreachable) verdict_.proved_unreachable = true;
    verdict_.seed_first =
        !result.solutions.empty() && (result.solutions.front().position - q_).cwiseAbs().maxCoeff() <= 1e-9;
    if (!verdict_.seed_first) note("seed not first: " + result.message);
    examine(result);
  }

  void beside(const VectorX& displacement) {
    IkRequest question = request();
    question.seed = ignore_limits_ ? VectorX(q_ + displacement) : chain_.clamped(q_ + displacement);
    const IkResult result = ik_.solve(question);
    verdict_.answered = verdict_.answered && result.status == IkStatus::kSolved;
    if (result.solutions.empty() && verdict_.message.empty()) note("beside: " + result.message);
    examine(result);
    if (!ik_.complete()) return;
    for (const IkAnswer& answer : result.solutions) {
      if (!isNearestMember(answer, question.seed)) {
        verdict_.seed_value_kept = false;
        note("not the member nearest to the seed");
      }
    }
  }

  /// Continua are told by their members nearest to the seed, all of them counted: the configuration's own as well.
  bool isFartherThanKnown(const IkResult& result) const {
    VectorX away = q_ - chain_.clamped(VectorX::Zero(chain_.size()));
    double least = std::numeric_limits<double>::infinity();
    for (const IkAnswer& answer : result.solutions) least = std::min(least, answer.distance);
    for (int i = 0; i < chain_.size() && ignore_limits_; ++i) {
      if (chain_.joint(i).isRevolute()) away[i] = std::remainder(away[i], kTwoPi);
    }
    return least > away.norm() * (1.0 + 1e-9) + placeTolerance(chain_, ik_.task(), q_);
  }

  /// To first order: no step along the continuum comes nearer, unless the end of its range is met.
  bool isNearestMember(const IkAnswer& answer, const VectorX& seed) const {
    if (answer.self_motion.rows() != 1) return true;
    // Where curves cross, the pose does not tell the tangent.
    if (singularValues(taskJacobian(chain_, answer.position, ik_.task())).minCoeff() < 1e-7) return true;
    for (std::size_t k = 0; k < answer.free_joints.size(); ++k) {
      const double value = answer.position[answer.free_joints[k]];
      const auto i = static_cast<Eigen::Index>(k);
      if (value - answer.self_motion_lower[i] < 1e-7 || answer.self_motion_upper[i] - value < 1e-7) return true;
    }
    for (int i = 0; i < chain_.size() && !ignore_limits_; ++i) {
      const JointLimits& limits = chain_.joint(i).limits;
      const double value = answer.position[i];
      if (value - limits.lower < 1e-7 || limits.upper - value < 1e-7) return true;
    }
    const double along = (answer.position - seed).dot(VectorX(answer.self_motion.row(0).transpose()));
    return std::abs(along) <= 1e-5 * (1.0 + answer.distance);
  }

  void examine(const IkResult& result) {
    for (std::size_t i = 0; i < result.solutions.size(); ++i) {
      const IkAnswer& answer = result.solutions[i];
      verdict_.finite = verdict_.finite && answer.position.allFinite() && answer.self_motion.allFinite() &&
                        answer.self_motion_lower.allFinite() && answer.self_motion_upper.allFinite() &&
                        std::isfinite(answer.distance + answer.joint_error + answer.manipulability);
      const double error = taskError(ik_.task(), target_, forwardByExponentials(chain_, answer.position)).norm();
      verdict_.worst_error = std::max(verdict_.worst_error, std::isfinite(error) ? error : 1e9);
      const VectorX clamped = chain_.clamped(answer.position);
      if (!ignore_limits_ && (clamped - answer.position).cwiseAbs().maxCoeff() > 1e-9) verdict_.in_limits = false;
      for (std::size_t k = 0; k < i; ++k) {
        if (jointDifference(chain_, answer.position, result.solutions[k].position) > 1e-6) continue;
        verdict_.repeated = true;
        note("repeated: " + result.message);
      }
    }
  }

  /// Near a double root the residual along the almost null direction is sigma t + kappa t^2 / 2: zero at the
  /// configuration and once more.
  bool mateIsMissing(const IkResult& result) {
    if (!ik_.complete() || chain_.size() != ik_.task().size() || chain_.hasMimic()) return false;
    Matrix6X J;
    const auto residual = [&](const VectorX& at) {
      const Pose tip = geometricJacobian(chain_, at, J);
      return ik_.task().select(taskError(ik_.task(), target_, tip).twist, tip.R);
    };
    const Svd svd(taskJacobian(chain_, q_, ik_.task()), Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Eigen::Index last = chain_.size() - 1;
    const double sigma = svd.singularValues()[last];
    if (sigma > 1e-2 || sigma < 1e-10) return false;
    const VectorX n = svd.matrixV().col(last);
    const VectorX u = svd.matrixU().col(last);
    constexpr double kProbe = 1e-3;
    const double kappa = -u.dot(residual(q_ + kProbe * n) + residual(q_ - kProbe * n)) / (kProbe * kProbe);
    const double t = -2.0 * sigma / kappa;
    if (!(std::abs(t) < 0.1)) return false;
    VectorX mate = q_ + t * n;
    double last_step = 0.0;
    for (int k = 0; k < 30; ++k) {
      const VectorX error = residual(mate);
      const VectorX step = taskJacobian(chain_, mate, ik_.task()).fullPivLu().solve(error);
      last_step = step.norm();
      if (!(last_step <= 0.1)) return false;
      mate += step;
    }
    const double apart = jointDifference(chain_, mate, q_);
    if (!(residual(mate).norm() < 1e-13 && apart > 4e-6 && apart < 0.2)) return false;
    if (last_step > 0.1 * apart) return false;  // Where there is no root Newton's method goes to and fro.
    if (!ignore_limits_ && chain_.clamped(mate) != mate) return false;
    const double tolerance = std::min(placeTolerance(chain_, ik_.task(), mate), 0.4 * apart);
    if (isKnown(mate, result, tolerance)) return false;
    note("the mate " + std::to_string(apart) + " away is not known: " + result.message);
    return result.complete;
  }

  const InverseKinematics& ik_;
  const SerialChain& chain_;
  VectorX q_;
  Pose target_;
  bool ignore_limits_;
  GateVerdict verdict_;
};

}  // namespace test
}  // namespace screwline

#endif  // SCREWLINE_TEST_IK_GATE_H

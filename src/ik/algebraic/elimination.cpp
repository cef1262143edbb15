#include "elimination.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "dixon.h"
#include "screwline/kinematics/forward.h"

namespace screwline {
namespace {

constexpr int kDegree = 8;              ///< Of the determinant: half the number of solutions.
constexpr double kLargestNoise = 1e-5;  ///< Of the determinant's coefficients.
constexpr int kTrials = 32;
constexpr double kUsable = 1e-2;  ///< [rad] error of the worst trial but three.

}  // namespace

bool Elimination::solve(const DualQuaternion& closure, RootRefiner& refiner) const {
  const LoopSystem system(*loop_, labelling_, closure);
  const DixonPencil pencil(system);
  TrigonometricPolynomial determinant = pencil.determinant();
  determinant.truncate(kDegree);
  if (determinant.scale == 0.0 || determinant.noise > kLargestNoise) return false;
  const TrigonometricRoots roots = determinant.realRoots();
  bool all_found = !roots.overflow;
  for (int i = 0; i < roots.count; ++i) {
    const TrigonometricRoots::Root& root = roots.roots[static_cast<std::size_t>(i)];
    const std::array<JointParameter, 3> unknowns = pencil.unknownsAt(root.angle);
    const JointParameter hidden(std::cos(0.5 * root.angle), std::sin(0.5 * root.angle));
    JointParameter first;
    JointParameter second;
    system.solvePair(hidden, unknowns, first, second);
    Vector6 q;
    q[labelling_.hidden()] = root.angle;
    for (int k = 0; k < 3; ++k) {
      q[labelling_.unknown(k)] = loop_->displacement(labelling_.unknown(k), unknowns[static_cast<std::size_t>(k)]);
    }
    q[labelling_.pair(0)] = loop_->displacement(labelling_.pair(0), first);
    q[labelling_.pair(1)] = loop_->displacement(labelling_.pair(1), second);
    const Refined refined = refiner.add(q.cwiseQuotient(loop_->multipliers));
    if (!root.touching && refined == Refined::kFailed) all_found = false;
    if (refined == Refined::kKnown) all_found = all_found && root.touching;
  }
  return all_found;
}

double Elimination::errorAt(const DualQuaternion& closure, const Vector6& q) const {
  const DixonPencil pencil(LoopSystem(*loop_, labelling_, closure));
  TrigonometricPolynomial determinant = pencil.determinant();
  determinant.truncate(kDegree);
  const double angle = q[labelling_.hidden()] * loop_->multipliers[labelling_.hidden()];
  const std::array<double, 4> d = determinant.derivatives(angle);
  if (determinant.scale == 0.0 || determinant.noise > kLargestNoise || d[1] == 0.0) return kPi;
  double error = (std::abs(d[0]) + determinant.noise) / std::abs(d[1]);
  const std::array<JointParameter, 3> unknowns = pencil.unknownsAt(angle);
  for (int k = 0; k < 3; ++k) {
    const int joint = labelling_.unknown(k);
    const double apart =
        loop_->displacement(joint, unknowns[static_cast<std::size_t>(k)]) - q[joint] * loop_->multipliers[joint];
    error =
        std::max(error, loop_->prismatic[static_cast<std::size_t>(joint)] ? std::abs(apart) / loop_->length
                                                                          : std::abs(std::remainder(apart, kTwoPi)));
  }
  return std::isfinite(error) ? std::min(error, kPi) : kPi;
}

std::vector<Elimination> chooseEliminations(const SerialChain& chain, const Loop& loop) {
  std::mt19937 random(1);
  const auto unit = [&random] { return static_cast<double>(random()) / 2147483648.0 - 1.0; };
  std::vector<VectorX> trials;
  for (int i = 0; i < kTrials; ++i) {
    VectorX q(6);
    for (int k = 0; k < 6; ++k) q[k] = unit() * (chain.joint(k).isRevolute() ? kPi : loop.length);
    trials.push_back(q);
  }
  std::vector<std::pair<double, Elimination>> ranked;
  for (int i = 0; i < 12; ++i) {
    const Elimination elimination(loop, {i / 2, i % 2 == 1});
    if (loop.prismatic[static_cast<std::size_t>(elimination.labelling().hidden())]) continue;
    std::vector<double> errors;
    for (const VectorX& q : trials) {
      errors.push_back(elimination.errorAt(loop.closure(forwardKinematics(chain, q)), q));
    }
    std::sort(errors.begin(), errors.end());
    double score = 0.0;
    for (double error : errors) score += std::log10(error + 1e-16);
    if (errors[kTrials - 4] < kUsable) ranked.emplace_back(score, elimination);
  }
  std::stable_sort(ranked.begin(), ranked.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Elimination> chosen;
  for (const auto& [score, elimination] : ranked) chosen.push_back(elimination);
  return chosen;
}

}  // namespace screwline

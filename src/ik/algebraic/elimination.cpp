#include "elimination.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "screwline/kinematics/forward.h"
#include "slide_pencil.h"

namespace screwline {
namespace {

constexpr double kLargestNoise = 1e-5;  ///< Of the determinant's coefficients.
constexpr double kAtInfinity = 1e-6;    ///< Of a slide's parameters, the homogeneous one.
constexpr int kProbes = 8;              ///< Values of the hidden joint where all of them are roots.
constexpr int kTrials = 32;
constexpr double kUsable = 1e-2;  ///< [rad] error of the worst trial but three.

constexpr std::size_t kMaxEliminations = 3;

std::vector<Elimination> bestOf(std::vector<std::pair<double, Elimination>> ranked) {
  std::stable_sort(ranked.begin(), ranked.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Elimination> best;
  for (const auto& [score, elimination] : ranked) {
    if (best.size() < kMaxEliminations) best.push_back(elimination);
  }
  return best;
}

}  // namespace

Vector6 Elimination::configurationOf(const LoopSystem& system, double angle,
                                     const std::array<JointParameter, 3>& unknowns) const {
  JointParameter first;
  JointParameter second;
  system.solvePair({std::cos(0.5 * angle), std::sin(0.5 * angle)}, unknowns, first, second);
  Vector6 displacements;
  displacements[labelling_.hidden()] = angle;
  for (int k = 0; k < 3; ++k) {
    const int joint = labelling_.unknown(k);
    displacements[joint] = loop_->displacement(joint, unknowns[static_cast<std::size_t>(k)]);
  }
  displacements[labelling_.pair(0)] = loop_->displacement(labelling_.pair(0), first);
  displacements[labelling_.pair(1)] = loop_->displacement(labelling_.pair(1), second);
  return displacements.cwiseQuotient(loop_->multipliers);
}

int Elimination::turnBesideSlides() const {
  int slides = 0;
  int turn = -1;
  for (int i = 0; i < 3; ++i) {
    const bool slide = loop_->prismatic[static_cast<std::size_t>(labelling_.unknown(i))];
    slides += slide ? 1 : 0;
    if (!slide) turn = i;
  }
  return slides == 2 ? turn : -1;
}

bool Elimination::isAtInfinity(const std::array<JointParameter, 3>& unknowns) const {
  for (int i = 0; i < 3; ++i) {
    const bool slide = loop_->prismatic[static_cast<std::size_t>(labelling_.unknown(i))];
    if (slide && std::abs(unknowns[static_cast<std::size_t>(i)][0]) < kAtInfinity) return true;
  }
  return false;
}

bool Elimination::isSensible() const {
  if (loop_->prismatic[static_cast<std::size_t>(labelling_.hidden())]) return false;
  const bool inside = labelling_.hidden_place == 1 || labelling_.hidden_place == 2;
  return !inside || turnBesideSlides() >= 0;
}

Eliminated Elimination::solve(const DualQuaternion& closure, RootRefiner& refiner) const {
  const LoopSystem system(*loop_, labelling_, closure);
  const int turn = turnBesideSlides();
  return turn < 0 ? solveWith(DixonPencil(system), system, refiner)
                  : solveWith(SlidePencil(system, turn), system, refiner);
}

double Elimination::errorAt(const DualQuaternion& closure, const Vector6& q) const {
  const LoopSystem system(*loop_, labelling_, closure);
  const int turn = turnBesideSlides();
  return turn < 0 ? errorWith(DixonPencil(system), system, q) : errorWith(SlidePencil(system, turn), system, q);
}

template <class Pencil>
Eliminated Elimination::solveWith(const Pencil& pencil, const LoopSystem& system, RootRefiner& refiner) const {
  const CircleMap map = pencil.spread();
  TrigonometricPolynomial determinant = pencil.determinant(map);
  determinant.truncate(Pencil::kDegree);
  const bool vanishing = determinant.scale == 0.0 || determinant.noise > kLargestNoise || pencil.vanishes();
  TrigonometricRoots roots;
  if (!vanishing) roots = determinant.realRoots();
  if (vanishing || roots.overflow) {
    for (int i = 0; i < kProbes; ++i) {
      const double angle = kTwoPi * i / kProbes;
      refiner.add(configurationOf(system, angle, pencil.unknownsAt(angle)));
    }
    if (vanishing) return Eliminated::kVanishing;
  }
  bool all_found = !roots.overflow;
  std::array<bool, AlgebraicSolutions::kCapacity> taken{};
  for (int i = 0; i < roots.count; ++i) {
    const TrigonometricRoots::Root& root = roots.roots[static_cast<std::size_t>(i)];
    const double angle = map.angle(root.angle);
    const std::array<JointParameter, 3> at_root = pencil.unknownsAt(angle);
    if (isAtInfinity(at_root)) continue;
    int place = refiner.add(configurationOf(system, angle, at_root));
    const auto isNew = [&taken](int found) { return found >= 0 && !taken[static_cast<std::size_t>(found)]; };
    bool has_other = false;
    if (root.touching || !isNew(place)) {
      const LoopSystem::Coefficients equations = system.at({std::cos(0.5 * angle), std::sin(0.5 * angle)});
      for (const std::array<JointParameter, 3>& unknowns : pencil.doubleUnknownsAt(angle, equations)) {
        const int other = refiner.add(configurationOf(system, angle, unknowns));
        has_other = has_other || (other >= 0 && place >= 0 && other != place);
        if (isNew(other) || place < 0) place = other;
      }
    }
    if (root.touching) {
      // A double root of the hidden angle stands for two solutions, or for one that is double itself.
      all_found = all_found && (place < 0 || has_other || !refiner.isRegular(place));
      continue;
    }
    if (isNew(place)) {
      taken[static_cast<std::size_t>(place)] = true;
    } else {
      all_found = false;
    }
  }
  return all_found ? Eliminated::kAll : Eliminated::kUncertain;
}

template <class Pencil>
double Elimination::errorWith(const Pencil& pencil, const LoopSystem& system, const Vector6& q) const {
  const CircleMap map = pencil.spread();
  TrigonometricPolynomial determinant = pencil.determinant(map);
  determinant.truncate(Pencil::kDegree);
  const double angle = q[labelling_.hidden()] * loop_->multipliers[labelling_.hidden()];
  const double image = map.image(angle);
  const std::array<double, 4> d = determinant.derivatives(image);
  if (determinant.scale == 0.0 || determinant.noise > kLargestNoise || d[1] == 0.0) return kPi;
  double error = (std::abs(d[0]) + determinant.noise) / std::abs(d[1]) * map.slope(image);
  const Vector6 found = configurationOf(system, angle, pencil.unknownsAt(angle));
  for (int joint = 0; joint < 6; ++joint) {
    const double apart = (found[joint] - q[joint]) * loop_->multipliers[joint];
    const bool prismatic = loop_->prismatic[static_cast<std::size_t>(joint)];
    error = std::max(error, std::abs(prismatic ? apart / loop_->length : std::remainder(apart, kTwoPi)));
  }
  return std::isfinite(error) ? std::min(error, kPi) : kPi;
}

EliminationChoice chooseEliminations(const SerialChain& chain, const Loop& loop) {
  std::mt19937 random(1);
  const auto unit = [&random] { return static_cast<double>(random()) / 2147483648.0 - 1.0; };
  std::vector<VectorX> trials;
  for (int i = 0; i < kTrials; ++i) {
    VectorX q(6);
    for (int k = 0; k < 6; ++k) q[k] = unit() * (chain.joint(k).isRevolute() ? kPi : loop.length);
    trials.push_back(q);
  }
  std::vector<std::pair<double, Elimination>> ranked;
  std::vector<std::pair<double, Elimination>> reserves;
  for (int i = 0; i < 24; ++i) {
    const Elimination elimination(loop, {i / 4, i % 4});
    if (!elimination.isSensible()) continue;
    std::vector<double> errors;
    int vanishing = 0;
    for (const VectorX& q : trials) {
      errors.push_back(elimination.errorAt(loop.closure(forwardKinematics(chain, q)), q));
      vanishing += errors.back() == kPi ? 1 : 0;
    }
    std::sort(errors.begin(), errors.end());
    double score = 0.0;
    for (double error : errors) score += std::log10(error + 1e-16);
    if (errors[kTrials - 4] < kUsable) {
      ranked.emplace_back(score, elimination);
    } else if (vanishing < kTrials / 4) {
      reserves.emplace_back(score, elimination);
    }
  }
  EliminationChoice choice;
  choice.usable = bestOf(ranked);
  choice.reserves = bestOf(reserves);
  return choice;
}

}  // namespace screwline

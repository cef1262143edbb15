#include "hidden_turn.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "screwline/kinematics/forward.h"

namespace screwline {
namespace {

constexpr double kLargestNoise = 1e-5;  ///< Of the polynomial's coefficients.
constexpr double kLeastNoise = 1e-9;    ///< Above it, a root that leads nowhere may do so by rounding.
constexpr int kProbes = 8;              ///< Values of the hidden joint where all of them are roots.
constexpr int kTrials = 32;
constexpr double kUsable = 1e-2;  ///< [rad] error of the worst trial but three.
constexpr std::size_t kMostUsed = 3;
constexpr double kDouble = 0.1;  ///< Second derivative at a root of order two.

HiddenTurns bestOf(std::vector<std::pair<double, std::shared_ptr<const HiddenTurn>>> ranked) {
  std::stable_sort(ranked.begin(), ranked.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  HiddenTurns best;
  for (const auto& [score, turn] : ranked) {
    if (best.size() < kMostUsed) best.push_back(turn);
  }
  return best;
}

/// What a root of the polynomial led to.
struct RootFound {
  int place = -1;          ///< Of the solution among all; -1: none.
  bool has_other = false;  ///< A second one.
  int at_infinity = 0;     ///< Of both ways, those with a slide at infinity.
};

/// A double root of the hidden angle stands for two solutions, one of them or both at infinity maybe; or for one that
/// is double itself, or for none.
bool isExplained(const TrigonometricPolynomial& polynomial, double image, const RootFound& found,
                 const RootRefiner& refiner) {
  if (found.at_infinity > 0) {
    const bool two = found.at_infinity == 2 || found.place >= 0;
    return two && std::abs(polynomial.derivatives(image)[2]) > kDouble;
  }
  if (found.place < 0) return polynomial.noise < kLeastNoise;
  return found.has_other || !refiner.isRegular(found.place);
}

}  // namespace

Eliminated HiddenTurn::solve(const HiddenCondition& condition, RootRefiner& refiner) {
  const CircleMap map = condition.spread();
  const TrigonometricPolynomial polynomial = condition.polynomial(map);
  const bool vanishing = polynomial.scale == 0.0 || polynomial.noise > kLargestNoise || condition.vanishes();
  TrigonometricRoots roots;
  if (!vanishing) roots = polynomial.realRoots();
  if (vanishing || roots.overflow) {
    for (int i = 0; i < kProbes; ++i) {
      const std::optional<Vector6> q = condition.configurationAt(kTwoPi * i / kProbes);
      if (q) refiner.add(*q);
    }
    if (vanishing) return Eliminated::kVanishing;
  }
  bool all_found = !roots.overflow && !condition.isIllConditioned();
  std::array<bool, AlgebraicSolutions::kCapacity> taken{};
  for (int i = 0; i < roots.count; ++i) {
    const TrigonometricRoots::Root& root = roots.roots[static_cast<std::size_t>(i)];
    const double angle = map.angle(root.angle);
    const std::optional<Vector6> q = condition.configurationAt(angle);
    if (!q && !root.touching) continue;
    RootFound found;
    found.place = q ? refiner.add(*q) : -1;
    const auto isNew = [&taken](int place) { return place >= 0 && !taken[static_cast<std::size_t>(place)]; };
    if (root.touching || !isNew(found.place)) {
      for (const std::optional<Vector6>& one : condition.bothAt(angle)) {
        found.at_infinity += one ? 0 : 1;
        if (!one) continue;
        const int other = refiner.add(*one);
        found.has_other = found.has_other || (other >= 0 && found.place >= 0 && other != found.place);
        if (isNew(other) || found.place < 0) found.place = other;
      }
    }
    if (root.touching) {
      all_found = all_found && isExplained(polynomial, root.angle, found, refiner) &&
                  !condition.leavesFree(angle, found.at_infinity > 0);
    } else if (isNew(found.place)) {
      taken[static_cast<std::size_t>(found.place)] = true;
    } else {
      all_found = false;
    }
  }
  return all_found ? Eliminated::kAll : Eliminated::kUncertain;
}

double HiddenTurn::errorAt(const HiddenCondition& condition, const Loop& loop, int hidden, const Vector6& q) {
  const CircleMap map = condition.spread();
  const TrigonometricPolynomial polynomial = condition.polynomial(map);
  const double angle = q[hidden] * loop.multipliers[hidden];
  const double image = map.image(angle);
  const std::array<double, 4> d = polynomial.derivatives(image);
  if (polynomial.scale == 0.0 || polynomial.noise > kLargestNoise || d[1] == 0.0) return kPi;
  double error = (std::abs(d[0]) + polynomial.noise) / std::abs(d[1]) * map.slope(image);
  const std::optional<Vector6> found = condition.configurationAt(angle);
  if (!found) return kPi;
  for (int joint = 0; joint < 6; ++joint) {
    const double apart = ((*found)[joint] - q[joint]) * loop.multipliers[joint];
    const bool prismatic = loop.axes[static_cast<std::size_t>(joint)].prismatic;
    error = std::max(error, std::abs(prismatic ? apart / loop.length : std::remainder(apart, kTwoPi)));
  }
  return std::isfinite(error) ? std::min(error, kPi) : kPi;
}

HiddenTurnChoice chooseHiddenTurns(const SerialChain& chain, const Loop& loop, const HiddenTurns& all) {
  std::mt19937 random(1);
  const auto unit = [&random] { return static_cast<double>(random()) / 2147483648.0 - 1.0; };
  std::vector<VectorX> trials;
  for (int i = 0; i < kTrials; ++i) {
    VectorX q(6);
    for (int k = 0; k < 6; ++k) q[k] = unit() * (chain.joint(k).isRevolute() ? kPi : loop.length);
    trials.push_back(q);
  }
  std::vector<std::pair<double, std::shared_ptr<const HiddenTurn>>> ranked;
  std::vector<std::pair<double, std::shared_ptr<const HiddenTurn>>> reserves;
  for (const std::shared_ptr<const HiddenTurn>& turn : all) {
    std::vector<double> errors;
    int vanishing = 0;
    for (const VectorX& q : trials) {
      errors.push_back(turn->errorAt(forwardKinematics(chain, q), q));
      vanishing += errors.back() == kPi ? 1 : 0;
    }
    std::sort(errors.begin(), errors.end());
    double score = 0.0;
    for (double error : errors) score += std::log10(error + 1e-16);
    if (errors[kTrials - 4] < kUsable) {
      ranked.emplace_back(score, turn);
    } else if (vanishing < kTrials / 4) {
      reserves.emplace_back(score, turn);
    }
  }
  return {bestOf(std::move(ranked)), bestOf(std::move(reserves))};
}

}  // namespace screwline

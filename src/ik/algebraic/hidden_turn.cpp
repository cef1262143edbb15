#include "hidden_turn.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "screwline/kinematics/forward.h"
#include "screwline/spatial/rotation.h"

namespace screwline {
namespace {

constexpr double kLargestNoise = 1e-5;  ///< Of the polynomial's coefficients.
constexpr int kProbes = 8;              ///< Values of the hidden joint where all of them are roots.
constexpr int kTrials = 32;
constexpr double kUsable = 1e-2;  ///< [rad] error of the worst trial but three.
constexpr std::size_t kMostUsed = 3;

HiddenTurns bestOf(std::vector<std::pair<double, std::shared_ptr<const HiddenTurn>>> ranked) {
  std::stable_sort(ranked.begin(), ranked.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  HiddenTurns best;
  for (const auto& [score, turn] : ranked) {
    if (best.size() < kMostUsed) best.push_back(turn);
  }
  return best;
}

/// Roots of the polynomial that are not told apart, and what they led to.
struct RootsFound {
  RootCluster roots;
  double angle = 0.0;     ///< Of the hidden turn, at the disk's center.
  int nowhere = 0;        ///< Of the ways that were tried, those to no configuration.
  int accounted_for = 0;  ///< By the known solutions whose hidden turn is there.
  bool told = true;       ///< False: by one of them, nobody knows for how many.
};

/// Solutions at one place of the hidden turn.
class AtHiddenTurn {
 public:
  AtHiddenTurn(const CircleMap& map, const Loop& loop, int hidden)
      : map_(map), joint_(static_cast<std::size_t>(hidden)), multiplier_(loop.multipliers[hidden]) {}

  void account(const RootRefiner& refiner, RootsFound& found) const {
    found.accounted_for = 0;
    found.told = true;
    const AlgebraicSolutions& all = refiner.solutions();
    for (int place = 0; place < all.count; ++place) {
      if (!isIn(found, multiplier_ * all.q[static_cast<std::size_t>(place)][joint_])) continue;
      const int multiplicity = found.roots.multiplicity == 1 ? 1 : refiner.multiplicity(place);
      if (multiplicity == 0) found.told = false;
      found.accounted_for += multiplicity;
    }
  }

 private:
  bool isIn(const RootsFound& found, double angle) const {
    // The map's inverse moves nothing by more than its stretch.
    if (std::abs(withoutTurns(angle - found.angle)) > found.roots.radius * map_.stretch) return false;
    return std::abs(withoutTurns(map_.image(angle) - found.roots.angle)) <= found.roots.radius;
  }

  CircleMap map_;
  std::size_t joint_;
  double multiplier_;
};

/// Whether the known solutions are all that the roots stand for. Of a pose beside this one all are isolated, and each
/// stands for a root of its own: where they are as many, nothing else shares the angle.
bool isExplained(const RootsFound& found, const HiddenCondition& condition) {
  const int roots = found.roots.multiplicity;
  if (found.told && roots > 0 && found.accounted_for == roots) return true;
  if (roots != 2 || condition.leavesFree(found.angle, found.nowhere > 0)) return false;
  // Of no multiple solution there are less than two.
  return found.told ? found.nowhere > 0 && found.accounted_for + found.nowhere == roots : found.accounted_for == 0;
}

}  // namespace

Eliminated HiddenTurn::solve(const HiddenCondition& condition, const Loop& loop, int hidden, RootRefiner& refiner) {
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
  const AtHiddenTurn there(map, loop, hidden);
  bool all_found = !roots.overflow && !condition.isIllConditioned();
  for (int i = 0; i < roots.count; ++i) {
    RootsFound found;
    found.roots = roots.roots[static_cast<std::size_t>(i)];
    found.angle = map.angle(found.roots.angle);
    const bool multiple = found.roots.multiplicity != 1;
    const std::optional<Vector6> q = condition.configurationAt(found.angle);
    if (!q && !multiple) continue;
    if (q) refiner.add(*q);
    there.account(refiner, found);
    if (multiple || found.accounted_for == 0) {
      for (const std::optional<Vector6>& one : condition.bothAt(found.angle)) {
        found.nowhere += one ? 0 : 1;
        if (one) refiner.add(*one);
      }
      there.account(refiner, found);
    }
    all_found = all_found && isExplained(found, condition);
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

#include "factor_search.h"

#include <algorithm>
#include <cmath>

#include "factor_roots.h"
#include "sampling.h"
#include "screwline/spatial/rotation.h"

namespace screwline {
namespace {

constexpr int kProbes = 2;  ///< Points at which a law (does not matter, separates, is zero) must hold.
constexpr double kLawTolerance = 1e-9;
constexpr double kAntipodal = 1e-9;  ///< [rad]

SingularityFactor singleFactor(int joint, FactorTerm::Function function, double turns, double phase) {
  SingularityFactor factor;
  factor.joints = {joint};
  FactorTerm term;
  term.function = function;
  term.turns = {turns};
  term.phase = phase;
  term.powers = {0};
  factor.terms = {term};
  return factor;
}

/// sin(q - root), zero at root and opposite it; root in [0, pi).
SingularityFactor antipodalFactor(int joint, double root) {
  double first = root < 0.0 ? root + kPi : root;
  if (std::abs(first - kPi) <= kAntipodal) first = 0.0;
  const bool cosine = std::abs(first - kPi / 2.0) <= kAntipodal;
  SingularityFactor factor = singleFactor(joint, cosine ? FactorTerm::Function::kCosine : FactorTerm::Function::kSine,
                                          1.0, cosine ? 0.0 : -first);
  factor.roots = cosine ? std::vector<double>{-kPi / 2.0, kPi / 2.0}
                        : std::vector<double>{wrapAngle(first - kPi), wrapAngle(first)};
  std::sort(factor.roots.begin(), factor.roots.end());
  return factor;
}

/// cos(q - middle) - cos(half the difference).
SingularityFactor pairFactor(int joint, double first, double second) {
  const double middle = 0.5 * (first + second);
  SingularityFactor factor = singleFactor(joint, FactorTerm::Function::kCosine, 1.0, -middle);
  FactorTerm constant;
  constant.coefficient = -std::cos(0.5 * (second - first));
  constant.turns = {0.0};
  constant.powers = {0};
  factor.terms.push_back(constant);
  factor.roots = {first, second};
  return factor;
}

SingularityFactor slideFactor(int joint, double root) {
  SingularityFactor factor = singleFactor(joint, FactorTerm::Function::kOne, 0.0, 0.0);
  factor.terms.front().powers = {1};
  if (root != 0.0) {
    FactorTerm constant;
    constant.coefficient = -root;
    constant.turns = {0.0};
    constant.powers = {0};
    factor.terms.push_back(constant);
  }
  factor.roots = {root};
  return factor;
}

/// Factors in one joint whose zeros, with multiplicity, are `roots`.
std::vector<SingularityFactor> factorsFromRoots(const SerialChain& chain, int joint, std::vector<double> roots) {
  std::vector<SingularityFactor> factors;
  if (!chain.joint(joint).isRevolute()) {
    for (double root : roots) factors.push_back(slideFactor(joint, root));
    return factors;
  }
  std::vector<double> lonely;
  while (!roots.empty()) {
    const double root = roots.back();
    roots.pop_back();
    const auto opposite = std::find_if(roots.begin(), roots.end(), [root](double other) {
      return std::abs(std::abs(wrapAngle(root - other)) - kPi) <= kAntipodal;
    });
    if (opposite == roots.end()) {
      lonely.push_back(root);
    } else {
      factors.push_back(antipodalFactor(joint, std::min(root, *opposite)));
      roots.erase(opposite);
    }
  }
  // Over a whole turn a periodic function changes sign an even number of times: an odd one out belongs to a factor that
  // other joints are in too.
  if (lonely.size() % 2 != 0) return factors;
  std::sort(lonely.begin(), lonely.end());
  for (std::size_t i = 0; i < lonely.size(); i += 2) factors.push_back(pairFactor(joint, lonely[i], lonely[i + 1]));
  return factors;
}

}  // namespace

void FactorSearch::split(const JointFunction& f, const std::vector<int>& joints) {
  for (const std::vector<int>& block : blocksOf(f, joints)) {
    if (block.size() == 1) {
      add(factorsFromRoots(chain_, block[0], rootsAlong(f, block[0])));
    } else {
      peel(f, block);
    }
  }
}

VectorX FactorSearch::moved(VectorX q, const std::vector<int>& joints, int number) const {
  for (int joint : joints) q[joint] = sampleJoint(chain_, joint, number);
  return q;
}

std::vector<std::vector<int>> FactorSearch::blocksOf(const JointFunction& f, const std::vector<int>& joints) const {
  const double f_base = f(base_);
  std::vector<std::vector<int>> blocks;
  for (int joint : joints) {
    std::vector<int> block = {joint};
    if (!matters(f, f_base, joint)) continue;
    for (std::size_t k = 0; k < blocks.size();) {
      const bool tied =
          std::any_of(blocks[k].begin(), blocks[k].end(), [&](int other) { return interact(f, f_base, joint, other); });
      if (tied) {
        block.insert(block.end(), blocks[k].begin(), blocks[k].end());
        blocks.erase(blocks.begin() + static_cast<std::ptrdiff_t>(k));
      } else {
        ++k;
      }
    }
    std::sort(block.begin(), block.end());
    blocks.push_back(block);
  }
  std::sort(blocks.begin(), blocks.end());
  return blocks;
}

bool FactorSearch::matters(const JointFunction& f, double f_base, int joint) const {
  for (int probe = 1; probe <= kProbes; ++probe) {
    if (std::abs(f(moved(base_, {joint}, probe)) - f_base) > kLawTolerance * std::abs(f_base)) return true;
  }
  return false;
}

bool FactorSearch::interact(const JointFunction& f, double f_base, int a, int b) const {
  for (int probe = 1; probe <= kProbes; ++probe) {
    const double f_a = f(moved(base_, {a}, probe));
    const double f_b = f(moved(base_, {b}, probe));
    const double f_ab = f(moved(base_, {a, b}, probe));
    const double size = std::max({f_base * f_base, std::abs(f_base * f_ab), std::abs(f_a * f_b)});
    if (std::abs(f_base * f_ab - f_a * f_b) > kLawTolerance * size) return true;
  }
  return false;
}

std::vector<double> FactorSearch::rootsAlong(const JointFunction& f, int joint) const {
  VectorX q = base_;
  const auto along = [&](double value) {
    q[joint] = value;
    return f(q);
  };
  return chain_.joint(joint).isRevolute() ? circleRoots(along) : lineRoots(along, 2.0 * slideReach(chain_));
}

std::vector<double> FactorSearch::commonRoots(const JointFunction& f, const std::vector<int>& block, int joint) const {
  std::vector<double> roots = rootsAlong(f, joint);
  const auto moves = [&](double root) {
    for (int probe = 1; probe <= kProbes; ++probe) {
      VectorX q = moved(base_, block, probe);
      const double reference = std::max(std::abs(f(q)), std::abs(f(base_)));
      q[joint] = root;
      if (std::abs(f(q)) > kLawTolerance * reference) return true;
    }
    return false;
  };
  roots.erase(std::remove_if(roots.begin(), roots.end(), moves), roots.end());
  return roots;
}

void FactorSearch::peel(const JointFunction& f, const std::vector<int>& block) {
  std::vector<SingularityFactor> single;
  for (int joint : block) {
    for (SingularityFactor& factor : factorsFromRoots(chain_, joint, commonRoots(f, block, joint))) {
      single.push_back(std::move(factor));
    }
  }
  if (single.empty()) {
    fit(f, block);
    return;
  }
  add(single);
  split(
      [f, single](const VectorX& q) {
        double value = f(q);
        for (const SingularityFactor& factor : single) value /= factor.value(q);
        return value;
      },
      block);
}

void FactorSearch::fit(const JointFunction& f, const std::vector<int>& block) {
  SingularityFactor factor;
  factor.joints = block;
  factor.terms = fitTerms(f, chain_, base_, block);
  incomplete_ = incomplete_ || factor.terms.empty();
  if (factor.isExplicit()) factors_.push_back(std::move(factor));
}

void FactorSearch::add(const std::vector<SingularityFactor>& found) {
  for (const SingularityFactor& factor : found) {
    const bool known = std::any_of(factors_.begin(), factors_.end(), [&factor](const SingularityFactor& other) {
      return other.joints == factor.joints && other.roots == factor.roots && !factor.roots.empty();
    });
    if (!known) factors_.push_back(factor);
  }
}

}  // namespace screwline

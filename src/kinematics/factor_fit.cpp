#include "factor_fit.h"

#include <algorithm>
#include <cmath>

#include <Eigen/QR>

#include "sampling.h"

namespace screwline {
namespace {

constexpr std::size_t kMaxBasis = 64;
constexpr std::size_t kMaxTerms = 12;
constexpr double kFitTolerance = 1e-10;   ///< Of the largest value, at points that the fit has not seen.
constexpr double kNegligibleTerm = 1e-9;  ///< Of the largest coefficient.
constexpr int kChecks = 8;
constexpr int kFirstSample = 100;  ///< In the fixed sequence; apart from those of other uses.

double valueOf(const FactorTerm& term, const std::vector<int>& joints, const ConstVectorRef& q) {
  double angle = term.phase;
  double value = term.coefficient;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    angle += term.turns[i] * q[joints[i]];
    for (int k = 0; k < term.powers[i]; ++k) value *= q[joints[i]];
  }
  if (term.function == FactorTerm::Function::kSine) return value * std::sin(angle);
  if (term.function == FactorTerm::Function::kCosine) return value * std::cos(angle);
  return value;
}

/// Every term that repeats `partial` with one more joint: turns -degree..degree, or powers 0..degree.
std::vector<FactorTerm> extended(const std::vector<FactorTerm>& partial, bool revolute, int degree) {
  std::vector<FactorTerm> result;
  for (const FactorTerm& term : partial) {
    for (int k = revolute ? -degree : 0; k <= degree; ++k) {
      FactorTerm longer = term;
      longer.turns.push_back(revolute ? k : 0);
      longer.powers.push_back(revolute ? 0 : k);
      result.push_back(longer);
    }
  }
  return result;
}

/// Real Fourier basis times monomials: of turns and their negatives only those whose first turn is positive.
std::vector<FactorTerm> basisOf(const SerialChain& chain, const std::vector<int>& joints, int turns, int powers) {
  std::vector<FactorTerm> all(1);
  for (int joint : joints) {
    const bool revolute = chain.joint(joint).isRevolute();
    all = extended(all, revolute, revolute ? turns : powers);
  }
  std::vector<FactorTerm> basis;
  for (FactorTerm term : all) {
    const auto first = std::find_if(term.turns.begin(), term.turns.end(), [](double turn) { return turn != 0.0; });
    if (first == term.turns.end()) {
      basis.push_back(term);
    } else if (*first > 0.0) {
      term.function = FactorTerm::Function::kCosine;
      basis.push_back(term);
      term.function = FactorTerm::Function::kSine;
      basis.push_back(term);
    }
  }
  return basis;
}

VectorX pointOf(const SerialChain& chain, const VectorX& base, const std::vector<int>& joints, int number) {
  VectorX q = base;
  for (int joint : joints) q[joint] = sampleJoint(chain, joint, kFirstSample + number);
  return q;
}

/// Least squares over fixed samples, then small coefficients dropped, then the check at new points.
std::vector<FactorTerm> fitted(const JointFunction& f, const SerialChain& chain, const VectorX& base,
                               const std::vector<int>& joints, std::vector<FactorTerm> basis) {
  const Eigen::Index size = static_cast<Eigen::Index>(basis.size());
  const Eigen::Index count = size + size / 2 + 4;
  MatrixX A(count, size);
  VectorX b(count);
  for (Eigen::Index row = 0; row < count; ++row) {
    const VectorX q = pointOf(chain, base, joints, static_cast<int>(row));
    b[row] = f(q);
    for (Eigen::Index k = 0; k < size; ++k) A(row, k) = valueOf(basis[static_cast<std::size_t>(k)], joints, q);
  }
  const VectorX c = A.colPivHouseholderQr().solve(b);
  const double largest = c.cwiseAbs().maxCoeff();
  std::vector<FactorTerm> terms;
  for (Eigen::Index k = 0; k < size; ++k) {
    FactorTerm& term = basis[static_cast<std::size_t>(k)];
    term.coefficient = c[k];
    if (std::abs(c[k]) > kNegligibleTerm * largest) terms.push_back(term);
  }
  if (terms.size() > kMaxTerms) return {};
  const double scale = b.cwiseAbs().maxCoeff();
  for (int i = 0; i < kChecks; ++i) {
    const VectorX q = pointOf(chain, base, joints, static_cast<int>(count) + i);
    if (std::abs(valueOf(terms, joints, q) - f(q)) > kFitTolerance * std::max(scale, std::abs(f(q)))) return {};
  }
  return terms;
}

}  // namespace

double valueOf(const std::vector<FactorTerm>& terms, const std::vector<int>& joints, const ConstVectorRef& q) {
  double sum = 0.0;
  for (const FactorTerm& term : terms) sum += valueOf(term, joints, q);
  return sum;
}

std::vector<FactorTerm> fitTerms(const JointFunction& f, const SerialChain& chain, const VectorX& base,
                                 const std::vector<int>& joints) {
  static constexpr int kDegrees[][2] = {{1, 1}, {1, 2}, {2, 1}, {2, 2}};
  for (const auto& [turns, powers] : kDegrees) {
    const bool any_slide =
        std::any_of(joints.begin(), joints.end(), [&](int j) { return !chain.joint(j).isRevolute(); });
    if (powers > 1 && !any_slide) continue;
    std::size_t size = 1;
    for (int joint : joints)
      size *= static_cast<std::size_t>(chain.joint(joint).isRevolute() ? 2 * turns + 1 : powers + 1);
    if (size > kMaxBasis) continue;
    const std::vector<FactorTerm> terms = fitted(f, chain, base, joints, basisOf(chain, joints, turns, powers));
    if (!terms.empty()) return terms;
  }
  return {};
}

}  // namespace screwline

#include "screwline/symbolic/conditions.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "../kinematics/factor_names.h"
#include "../kinematics/factor_roots.h"
#include "../kinematics/sampling.h"
#include "exact_conditions.h"
#include "exact_determinant.h"
#include "numeric_terms.h"

namespace screwline {
namespace {

constexpr int kHalfTurn = 12;  ///< Steps of 15 degrees.
constexpr int kScaleSamples = 12;
constexpr std::size_t kMostTerms = 100;  ///< Of a determinant without factors that still says more than its name.

bool isJoint(const SymbolTable& symbols, int id) {
  return symbols[id].kind == SymbolKind::kAngle || symbols[id].kind == SymbolKind::kSlide;
}

/// Factors in joint values that all minors share.
std::vector<TrigPolynomial> sharedFactors(const ExactChain& exact, const ExactDeterminant& determinant) {
  std::vector<TrigPolynomial> shared;
  bool first = true;
  for (const FactoredPolynomial& minor : determinant.minors) {
    if (minor.coefficient.isZero()) continue;
    const auto isIn = [&minor](const TrigPolynomial& base) {
      return std::any_of(minor.factors.begin(), minor.factors.end(),
                         [&base](const PolynomialFactor& factor) { return factor.base == base; });
    };
    if (first) {
      for (const PolynomialFactor& factor : minor.factors) {
        if (!jointsOf(exact, factor.base).empty()) shared.push_back(factor.base);
      }
      first = false;
    }
    shared.erase(
        std::remove_if(shared.begin(), shared.end(), [&isIn](const TrigPolynomial& base) { return !isIn(base); }),
        shared.end());
  }
  return shared;
}

/// Angles where constant + a cos + b sin = 0.
std::optional<std::vector<Formula>> solvedAngle(const ExactChain& exact, const TrigPolynomial& f, int joint) {
  const Rational half(1, 2);
  const TrigPolynomial at_zero = f.atAngle(joint, 0);
  const TrigPolynomial at_half = f.atAngle(joint, kHalfTurn);
  const TrigPolynomial a = (at_zero - at_half).scaled(half);
  const TrigPolynomial constant = (at_zero + at_half).scaled(half);
  const TrigPolynomial b = f.atAngle(joint, kHalfTurn / 2) - constant;
  const std::vector<std::pair<int, int>> angle = {{joint, 1}};
  if (!(constant + a * TrigPolynomial::cosine(exact.ring, angle) + b * TrigPolynomial::sine(exact.ring, angle) == f))
    return std::nullopt;
  const Formula pi = Formula::pi();
  if (constant.isZero()) {
    if (a.isZero()) return std::vector<Formula>{Formula::number(0), pi};
    if (b.isZero()) return std::vector<Formula>{pi / Formula::number(2), -pi / Formula::number(2)};
    const Formula one = Formula::call(FormulaFunction::kArcTangent2, {exact.formula(-a), exact.formula(b)});
    return std::vector<Formula>{one, one + pi};
  }
  if (b.isZero() && constant == a) return std::vector<Formula>{pi};
  if (b.isZero() && constant == -a) return std::vector<Formula>{Formula::number(0)};
  const Formula size = Formula::sqrt(exact.formula(a * a + b * b));
  const Formula middle = Formula::call(FormulaFunction::kArcTangent2, {exact.formula(b), exact.formula(a)});
  const Formula reach = Formula::call(FormulaFunction::kArcCosine, {exact.formula(-constant) / size});
  return std::vector<Formula>{middle + reach, middle - reach};
}

std::optional<std::vector<Formula>> solvedSlide(const ExactChain& exact, const TrigPolynomial& f, int joint) {
  const TrigPolynomial constant = f.atScalar(joint, TrigPolynomial(exact.ring));
  const TrigPolynomial slope = f.atScalar(joint, TrigPolynomial::number(exact.ring, 1)) - constant;
  if (!(constant + slope * TrigPolynomial::scalar(exact.ring, joint) == f)) return std::nullopt;
  if (const std::optional<TrigPolynomial> value = exactSlide(f, joint))
    return std::vector<Formula>{exact.formula(*value)};
  return std::vector<Formula>{exact.formula(-constant) / exact.formula(slope)};
}

std::vector<ConditionSolution> solutionsOf(const ExactChain& exact, const TrigPolynomial& f) {
  std::vector<ConditionSolution> solutions;
  const std::vector<int> joints = jointsOf(exact, f);
  for (const int joint : joints) {
    const bool slide = exact.table.symbols[joint].kind == SymbolKind::kSlide;
    const auto values = slide ? solvedSlide(exact, f, joint) : solvedAngle(exact, f, joint);
    // Of several joints only what every choice of the others has: no arc cosine of a share that may be beyond 1.
    const bool always = slide || joints.size() == 1 || (f.atAngle(joint, 0) + f.atAngle(joint, kHalfTurn)).isZero();
    if (values && always) solutions.push_back({joint, *values});
  }
  return solutions;
}

void fillNumbers(const SerialChain& chain, SingularityFactor& factor) {
  factor.scale = 0.0;
  for (int k = 0; k < kScaleSamples; ++k)
    factor.scale = std::max(factor.scale, std::abs(factor.value(sampleConfiguration(chain, k))));
  if (factor.joints.size() != 1) return;
  const int joint = factor.joints.front();
  const auto value = [&](double x) {
    VectorX q = VectorX::Zero(chain.size());
    q[joint] = x;
    return factor.value(q);
  };
  factor.roots = chain.joint(joint).isRevolute() ? circleRoots(value) : lineRoots(value, slideReach(chain));
}

std::vector<SingularityFactor> namedFactors(const ExactChain& exact, const SerialChain& chain,
                                            const std::vector<TrigPolynomial>& polynomials) {
  std::vector<SingularityFactor> factors;
  for (const TrigPolynomial& polynomial : polynomials) {
    SingularityFactor factor;
    factor.joints = jointsOf(exact, polynomial);
    factor.terms = numericTerms(exact, polynomial, factor.joints);
    factors.push_back(std::move(factor));
  }
  nameFactors(chain, factors);
  for (SingularityFactor& factor : factors) fillNumbers(chain, factor);
  return factors;
}

}  // namespace

std::vector<int> jointsOf(const ExactChain& exact, const TrigPolynomial& polynomial) {
  std::vector<int> joints;
  for (const int id : polynomial.symbols()) {
    if (isJoint(exact.table.symbols, id)) joints.push_back(id);
  }
  return joints;
}

std::optional<int> exactSteps(const TrigPolynomial& f, int joint, double root) {
  const int steps = static_cast<int>(std::lround(root / (kPi / kHalfTurn)));
  if (!f.atAngle(joint, steps).isZero()) return std::nullopt;
  return steps;
}

std::optional<TrigPolynomial> exactSlide(const TrigPolynomial& f, int slide) {
  const TrigPolynomial constant = f.atScalar(slide, TrigPolynomial(f.ring()));
  const TrigPolynomial slope = f.atScalar(slide, TrigPolynomial::number(f.ring(), 1)) - constant;
  if (!slope.isNumber() || slope.isZero() || !(constant + slope * TrigPolynomial::scalar(f.ring(), slide) == f))
    return std::nullopt;
  return constant.scaled(Rational(-1) / slope.terms().begin()->second);
}

std::vector<ExactCondition> conditionsFrom(const ExactChain& exact, const SerialChain& chain,
                                           const std::vector<TrigPolynomial>& polynomials) {
  std::vector<SingularityFactor> named = namedFactors(exact, chain, polynomials);
  std::vector<ExactCondition> conditions;
  for (std::size_t i = 0; i < polynomials.size(); ++i) conditions.push_back({polynomials[i], std::move(named[i])});
  return conditions;
}

std::vector<ExactCondition> exactConditions(const ExactChain& exact, const SerialChain& chain, const Task& task) {
  return conditionsFrom(exact, chain, sharedFactors(exact, exactDeterminant(exact, task)));
}

std::vector<ConditionFormula> conditionsOf(const SymbolicChain& symbolic, const SerialChain& chain, const Task& task) {
  const ExactChain& exact = symbolic.exact();
  std::vector<ConditionFormula> conditions;
  for (const ExactCondition& condition : exactConditions(exact, chain, task)) {
    conditions.push_back({condition.numeric.name, condition.numeric.meaning, exact.formula(condition.base),
                          solutionsOf(exact, condition.base)});
  }
  return conditions;
}

std::optional<std::vector<SingularityFactor>> derivedFactorsOf(const SerialChain& chain, const Task& task,
                                                               const Progress& progress) {
  const ExactChain exact(chain, {}, progress);
  const ExactDeterminant& determinant = exactDeterminant(exact, task);
  const std::vector<TrigPolynomial> shared = sharedFactors(exact, determinant);
  const bool never = determinant.isSquare() && !determinant.minors.front().coefficient.isZero();
  if (shared.empty() && !never) return std::nullopt;
  std::vector<SingularityFactor> factors = namedFactors(exact, chain, shared);
  if (factors.size() == 1 && factors.front().terms.size() > kMostTerms) return std::nullopt;
  if (!determinant.isSquare()) {
    const std::vector<SingularityFactor> whole = factorsOf(chain, task);
    factors.insert(factors.end(), whole.begin(), whole.end());
  }
  return factors;
}

}  // namespace screwline

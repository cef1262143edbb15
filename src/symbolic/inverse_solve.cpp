// One equation in one joint, solved.

#include <cmath>
#include <utility>

#include "inverse_builder.h"

namespace screwline {
namespace {

Formula arcTangent(const Formula& y, const Formula& x) {
  return Formula::call(FormulaFunction::kArcTangent2, {y, x});
}

Formula square(const Formula& formula) {
  return Formula::power(formula, 2);
}

bool startsNegative(const TrigPolynomial& polynomial) {
  for (const auto& [key, coefficient] : polynomial.terms()) {
    if (coefficient.numerator() > 0) return false;
  }
  return !polynomial.isZero();
}

}  // namespace

bool InverseBuilder::partsOf(const InverseAxis& axis, const TrigPolynomial& polynomial, Parts& parts) const {
  const Rational half(1, 2);
  if (axis.slides) {
    const TrigPolynomial plus = polynomial.atScalar(axis.symbol, number(1));
    const TrigPolynomial minus = polynomial.atScalar(axis.symbol, number(-1));
    parts.k = polynomial.atScalar(axis.symbol, number(0));
    parts.a = (plus - minus).scaled(half);
    parts.b = (plus + minus).scaled(half) - parts.k;
    const TrigPolynomial q = symbol(axis.symbol);
    return polynomial == parts.k + parts.a * q + parts.b * q * q;
  }
  constexpr int kQuarter = 6;  // In steps of 15 degrees.
  const TrigPolynomial at_zero = polynomial.atAngle(axis.symbol, 0);
  const TrigPolynomial opposite = polynomial.atAngle(axis.symbol, 2 * kQuarter);
  parts.k = (at_zero + opposite).scaled(half);
  parts.a = (at_zero - opposite).scaled(half);
  parts.b = polynomial.atAngle(axis.symbol, kQuarter) - parts.k;
  const TrigPolynomial c = TrigPolynomial::cosine(ring(), {{axis.symbol, 1}});
  const TrigPolynomial s = TrigPolynomial::sine(ring(), {{axis.symbol, 1}});
  return polynomial == parts.k + parts.a * c + parts.b * s;
}

bool InverseBuilder::solve(const InverseAxis& axis, const TrigPolynomial& equation) {
  Parts parts{number(0), number(0), number(0)};
  if (!partsOf(axis, equation, parts)) return false;
  return axis.slides ? solveSlide(axis, parts) : solveTurn(axis, parts);
}

/// k + a cos + b sin = 0: cos, or sin, alone; else the sum of the direction of (a, b) and of what is left.
bool InverseBuilder::solveTurn(const InverseAxis& axis, const Parts& parts) {
  const bool no_a = isZero(parts.a);
  const bool no_b = isZero(parts.b);
  if (no_a && no_b) return false;
  const std::string j = suffix(axis);
  const bool constant = isConstant(parts.a) && isConstant(parts.b);
  if (isZero(parts.k)) {
    const Formula S = rootNamed("S" + j, Formula::number(1));
    const Formula a = no_a ? Formula::number(0) : constant && no_b ? Formula::number(1) : formula(parts.a);
    const Formula b = no_b ? Formula::number(0) : constant && no_a ? Formula::number(1) : formula(parts.b);
    const std::vector<Formula> free_if = constant ? std::vector<Formula>() : std::vector<Formula>{a, b};
    setJoint(axis.symbol, arcTangent(-(S * a), S * b), free_if);
    return true;
  }
  if (no_a || no_b) {
    const TrigPolynomial& amplitude = no_b ? parts.a : parts.b;
    const bool flip = startsNegative(amplitude);
    const Formula above = inputsFirst(flip ? parts.k : -parts.k);
    const Formula below = formula(flip ? -amplitude : amplitude);
    if (!constant) {  // No division by what may vanish.
      const Formula S = rootNamed("S" + j, square(below) - square(above));
      const Formula across = below * S;
      const Formula along = below * above;
      setJoint(axis.symbol, no_b ? arcTangent(across, along) : arcTangent(along, across), {above, below});
      return true;
    }
    const Formula D = formulaNamed("D" + j, above / below);
    const Formula S = rootNamed("S" + j, Formula::number(1) - square(D));
    setJoint(axis.symbol, no_b ? arcTangent(S, D) : arcTangent(D, S));
    return true;
  }
  const Formula A = formulaNamed("A" + j, formula(parts.a));
  const Formula B = formulaNamed("B" + j, formula(parts.b));
  const Formula C = formulaNamed("C" + j, inputsFirst(-parts.k));
  const Formula S = rootNamed("S" + j, square(A) + square(B) - square(C));
  const std::vector<Formula> free_if = constant ? std::vector<Formula>() : std::vector<Formula>{A, B};
  setJoint(axis.symbol, arcTangent(B, A) + arcTangent(S, C), free_if);
  return true;
}

/// k + a q + b q^2 = 0, of which the last term is a constant.
bool InverseBuilder::solveSlide(const InverseAxis& axis, const Parts& parts) {
  if (isZero(parts.b)) {
    if (isZero(parts.a) || !isConstant(parts.a)) return false;
    const bool flip = startsNegative(parts.a);
    setJoint(axis.symbol, formula(flip ? parts.k : -parts.k) / formula(flip ? -parts.a : parts.a));
    return true;
  }
  if (!isConstant(parts.b)) return false;
  const std::string j = suffix(axis);
  const TrigPolynomial one = number(1);
  if (parts.b == one || parts.b == -one) {
    const Rational sign = parts.b == one ? 1 : -1;
    const TrigPolynomial half = parts.a.scaled(sign * Rational(1, 2));
    const Formula radicand = inputsFirst(half * half - parts.k.scaled(sign));
    if (half.isZero()) {
      addRoot(axis.symbol, radicand);
    } else {
      setJoint(axis.symbol, rootNamed("S" + j, radicand) - formula(half));
    }
    return true;
  }
  const TrigPolynomial radicand = parts.a * parts.a - (parts.b * parts.k).scaled(4);
  const Formula S = rootNamed("S" + j, inputsFirst(radicand));
  setJoint(axis.symbol, (S - formula(parts.a)) / formula(parts.b.scaled(2)));
  return true;
}

void InverseBuilder::turnBetween(const InverseAxis& axis, const TrigPolynomial& from_x, const TrigPolynomial& from_y,
                                 const TrigPolynomial& to_x, const TrigPolynomial& to_y) {
  // Of a direction along a coordinate axis only the sign counts.
  const auto factor = [this](const TrigPolynomial& polynomial) {
    return isConstant(polynomial) ? Formula::number(valueOf(polynomial) < 0.0 ? -1 : 1) : formula(polynomial);
  };
  const Formula tx = formula(to_x);
  const Formula ty = formula(to_y);
  const Formula fx = formula(from_x);
  const Formula fy = formula(from_y);
  Formula u;
  if (isZero(from_y)) {
    u = arcTangent(factor(from_x) * ty, factor(from_x) * tx);
  } else if (isZero(from_x)) {
    u = arcTangent(-(factor(from_y) * tx), factor(from_y) * ty);
  } else if (isZero(to_y)) {
    u = arcTangent(-(factor(to_x) * fy), factor(to_x) * fx);
  } else if (isZero(to_x)) {
    u = arcTangent(factor(to_y) * fx, factor(to_y) * fy);
  } else {
    u = arcTangent(ty, tx) - arcTangent(fy, fx);
  }
  // Both directions vanish together; the one that is not along a coordinate axis tells more.
  std::vector<Formula> free_if;
  const bool one_sided = (isZero(to_x) || isZero(to_y)) && !isZero(from_x) && !isZero(from_y);
  if (!isConstant(to_x) || !isConstant(to_y))
    free_if = one_sided ? std::vector<Formula>{fx, fy} : std::vector<Formula>{tx, ty};
  setJoint(axis.symbol, axis.sense < 0 ? -u : u, free_if);
}

}  // namespace screwline

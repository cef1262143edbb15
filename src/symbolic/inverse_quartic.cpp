// Joints that take more than a square root: three axes of which the first two do not meet and are not parallel, a turn
// and a slide askew to it in front of a turn (Pieper 1968; Craig, ch. 4.6).

#include <algorithm>
#include <utility>

#include "inverse_builder.h"

namespace screwline {
namespace {

TrigPolynomial dot(const TrigMatrix& a, const TrigMatrix& b) {
  return a(0, 0) * b(0, 0) + a(1, 0) * b(1, 0) + a(2, 0) * b(2, 0);
}

bool hasNumber(const Formula& formula) {
  return formula.kind() == Formula::Kind::kProduct && formula.parts().front().kind() == Formula::Kind::kNumber;
}

/// A leading number is squared by itself: (-x)^2 is x^2.
Formula square(const Formula& formula) {
  if (formula.kind() == Formula::Kind::kNumber) return formula * formula;
  if (!hasNumber(formula)) return Formula::power(formula, 2);
  const Formula& number = formula.parts().front();
  return number * number * Formula::power(formula / number, 2);
}

/// Of a length; 2 l over twice a is l over a.
Formula overTwice(const Formula& formula, const Formula& length) {
  const Formula two = Formula::number(2);
  const bool is_even = hasNumber(formula) && formula.parts().front().numerator() % 2 == 0;
  return is_even ? formula / two / length : formula / (two * length);
}

bool isShort(const Formula& formula) {
  return formula.kind() == Formula::Kind::kNumber || formula.kind() == Formula::Kind::kSymbol ||
         (formula.kind() == Formula::Kind::kProduct && formula.parts().size() == 2 &&
          isShort(formula.parts().front()) && isShort(formula.parts().back()));
}

Formula half(const Formula& formula) {
  return formula / Formula::number(2);
}

}  // namespace

Formula InverseBuilder::briefly(const std::string& name, const Formula& value) {
  return isShort(value) ? value : formulaNamed(name, value);
}

std::optional<InverseBuilder::Form> InverseBuilder::formOf(const InverseAxis& axis, const std::string& letter,
                                                           const TrigPolynomial& polynomial) {
  Parts parts{number(0), number(0), number(0)};
  if (!partsOf(axis, polynomial, parts)) return std::nullopt;
  const auto part = [&](const char* place, const TrigPolynomial& value) {
    return isZero(value) ? Formula() : briefly(letter + place, inputsFirst(value));
  };
  Form form{part("0", parts.k), part("1", parts.a), part("2", parts.b), isConstant(parts.a) && isConstant(parts.b)};
  return form;
}

InverseBuilder::Form InverseBuilder::named(const std::string& letter, const Form& form) {
  Form result = form;
  result.k = briefly(letter + "0", form.k);
  result.a = briefly(letter + "1", form.a);
  result.b = briefly(letter + "2", form.b);
  return result;
}

Formula InverseBuilder::formula(const InverseAxis& axis, const Form& form) const {
  const Formula q = Formula::symbol(axis.symbol);
  const Formula first = axis.slides ? q : Formula::cos(q);
  const Formula second = axis.slides ? square(q) : Formula::sin(q);
  return form.k + form.a * first + form.b * second;
}

void InverseBuilder::solveSquares(const InverseAxis& axis, const std::vector<Form>& squares, const Form& rest) {
  const auto sum = [&squares](auto&& term) {
    std::vector<Formula> terms;
    for (const Form& form : squares) terms.push_back(term(form));
    return Formula::sum(terms);
  };
  const Formula two = Formula::number(2);
  const Formula kk = sum([](const Form& f) { return square(f.k); });
  const Formula both = sum([](const Form& f) { return square(f.a) + square(f.b); });
  const Formula difference = sum([](const Form& f) { return square(f.a) - square(f.b); });
  const Formula ka = sum([](const Form& f) { return f.k * f.a; });
  const Formula kb = sum([](const Form& f) { return f.k * f.b; });
  const Formula ab = sum([](const Form& f) { return f.a * f.b; });
  InverseStep step;
  step.symbol = axis.symbol;
  const std::string j = suffix(axis);
  if (axis.slides) {
    const Formula terms[5] = {kk - rest.k, two * ka - rest.a,
                              sum([](const Form& f) { return square(f.a); }) + two * kb - rest.b, two * ab,
                              sum([](const Form& f) { return square(f.b); })};
    for (int i = 0; i < 5; ++i) step.equation.push_back(briefly("E" + std::to_string(i), terms[i]));
  } else {
    step.equation = {briefly("K" + j, kk - rest.k + half(both)), briefly("A" + j, two * ka - rest.a),
                     briefly("B" + j, two * kb - rest.b), briefly("C" + j, half(difference)), briefly("D" + j, ab)};
    step.tangent = addSymbol("t" + j);
  }
  const auto isFixed = [](const Form& form) { return form.fixed; };
  if (!std::all_of(squares.begin(), squares.end(), isFixed)) step.free_if = step.equation;
  addStep(std::move(step));
}

bool writeSkewTurns(InverseBuilder& builder, const std::array<InverseAxis, 3>& axes, const TrigPose& K1,
                    const TrigMatrix& carried, const TrigMatrix& goal) {
  using Form = InverseBuilder::Form;
  if (!builder.isZero(K1.R(2, 0)) || !builder.isZero(K1.p(1, 0)) || !builder.isZero(K1.p(2, 0))) return false;
  const auto nameOf = [&](std::size_t i) { return builder.namesOf({axes[i].place}); };
  builder.say("The point that " + nameOf(2) + " carries lies at the height h along the axis of " + nameOf(1) +
              "; k is the square of its distance from where the common normal with the axis of " + nameOf(0) +
              " meets that axis. " + builder.marksOf(axes[2]) + ":");
  const std::optional<Form> h = builder.formOf(axes[2], "h", carried(2, 0));
  const std::optional<Form> k = builder.formOf(axes[2], "k", dot(carried, carried));
  if (!h || !k) return false;
  const Formula offset = builder.formula(K1.p(0, 0));
  const Formula reach = builder.inputsFirst(dot(goal, goal) - K1.p(0, 0) * K1.p(0, 0));
  const Formula sine = builder.formula(K1.R(2, 1));
  const Formula cosine = builder.formula(K1.R(2, 2));
  const Formula height = builder.formula(goal(2, 0));
  builder.say("Its place u along that normal, by its distance from " + nameOf(0) +
              "'s end of it, and v across it, by its height along the axis of " + nameOf(0) + ":");
  const Form u = builder.named(
      "u", {overTwice(reach - k->k, offset), overTwice(-k->a, offset), overTwice(-k->b, offset), k->fixed});
  const Form v =
      builder.named("v", {(height - cosine * h->k) / sine, -(cosine * h->a) / sine, -(cosine * h->b) / sine, h->fixed});
  builder.say("As u^2 + v^2 + h^2 = k, a quartic gives " + nameOf(2) + ":");
  builder.solveSquares(axes[2], {u, v, *h}, *k);
  builder.say("The place and " + nameOf(2) + " give " + nameOf(1) + ", the goal gives " + nameOf(0) + ":");
  const TrigPolynomial x = builder.named("u", builder.formula(axes[2], u));
  const TrigPolynomial y = builder.named("v", builder.formula(axes[2], v));
  builder.turnBetween(axes[1], carried(0, 0), carried(1, 0), x, y);
  TrigMatrix place = carried;
  place(0, 0) = x;
  place(1, 0) = y;
  const TrigMatrix G = times(K1, place);
  builder.turnBetween(axes[0], G(0, 0), G(1, 0), goal(0, 0), goal(1, 0));
  return true;
}

}  // namespace screwline

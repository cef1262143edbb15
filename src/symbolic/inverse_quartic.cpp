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

Formula square(const Formula& formula) {
  return formula.kind() == Formula::Kind::kNumber ? formula * formula : Formula::power(formula, 2);
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
  const Formula aa = sum([](const Form& f) { return square(f.a); });
  const Formula bb = sum([](const Form& f) { return square(f.b); });
  const Formula ka = sum([](const Form& f) { return f.k * f.a; });
  const Formula kb = sum([](const Form& f) { return f.k * f.b; });
  const Formula ab = sum([](const Form& f) { return f.a * f.b; });
  InverseStep step;
  step.symbol = axis.symbol;
  const std::string j = suffix(axis);
  if (axis.slides) {
    const Formula terms[5] = {kk - rest.k, two * ka - rest.a, aa + two * kb - rest.b, two * ab, bb};
    for (int i = 0; i < 5; ++i) step.equation.push_back(briefly("E" + std::to_string(i), terms[i]));
  } else {
    step.equation = {briefly("K" + j, kk - rest.k + half(aa + bb)), briefly("A" + j, two * ka - rest.a),
                     briefly("B" + j, two * kb - rest.b), briefly("C" + j, half(aa - bb)), briefly("D" + j, ab)};
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
  const std::string joint = axes[2].place < 0 ? "the open row" : builder.namesOf({axes[2].place});
  builder.say("The point that " + joint +
              " carries: its height h along the second axis, and the square k of its "
              "distance from where the common normal of the first two axes meets that one,");
  const std::optional<Form> h = builder.formOf(axes[2], "h", carried(2, 0));
  const std::optional<Form> k = builder.formOf(axes[2], "k", dot(carried, carried));
  if (!h || !k) return false;
  const Formula twice = builder.formula(K1.p(0, 0).scaled(2));
  const Formula reach = builder.inputsFirst(dot(goal, goal) - K1.p(0, 0) * K1.p(0, 0));
  const Formula sine = builder.formula(K1.R(2, 1));
  const Formula cosine = builder.formula(K1.R(2, 2));
  const Formula height = builder.formula(goal(2, 0));
  builder.say(
      "Where it has to come to, u along that normal and v across it, by its distance from the first axis' foot "
      "and its height along the first axis:");
  const Form u = builder.named("u", {(reach - k->k) / twice, -k->a / twice, -k->b / twice, k->fixed});
  const Form v =
      builder.named("v", {(height - cosine * h->k) / sine, -(cosine * h->a) / sine, -(cosine * h->b) / sine, h->fixed});
  builder.say("As u^2 + v^2 + h^2 = k, a quartic gives " + joint + ":");
  builder.solveSquares(axes[2], {u, v, *h}, *k);
  builder.say("The second joint brings the point there, the first to its goal:");
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

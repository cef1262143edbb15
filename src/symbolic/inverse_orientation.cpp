// Three turns that make an orientation (Paden's second subproblem; Craig, ch. 4.7).

#include "inverse_builder.h"

namespace screwline {
namespace {

TrigPolynomial dot(const TrigMatrix& a, const TrigMatrix& b) {
  return a(0, 0) * b(0, 0) + a(1, 0) * b(1, 0) + a(2, 0) * b(2, 0);
}

bool isUnit(const InverseBuilder& builder, const TrigPolynomial& polynomial) {
  return polynomial == builder.number(1) || polynomial == builder.number(-1);
}

/// What the three turns have to do, seen from the frame before them: M = Rz(first) C5 Rz(second) C6 Rz(third). How base
/// and tool are mounted is taken off first.
TrigMatrix rotationLeft(InverseBuilder& builder, int first) {
  const int n = builder.size();
  const TrigMatrix mounted = builder.base().R;
  const TrigMatrix tool = builder.step(n).R;
  builder.say("The rotation between the first and the last axis, base and tool taken off:");
  const TrigMatrix T = builder.namedEntries("t", mounted.transposed() * (builder.targetRotation() * tool.transposed()));
  TrigMatrix before = mounted.transposed();
  for (int i = 0; i < first; ++i) before = before * builder.step(i).R;
  before = before * builder.constantStep(first).R;
  TrigMatrix after = TrigMatrix::identity(builder.ring(), 3);
  for (int i = first + 3; i < n; ++i) after = after * builder.step(i).R;
  return before.transposed() * (T * after.transposed());
}

}  // namespace

/// The sine of a single middle angle from the two other entries of M's third column, which keep its digits where the
/// outer axes are almost in line.
bool InverseBuilder::solveMiddle(const InverseAxis& axis, const TrigMatrix& column, const TrigPolynomial& height) {
  Parts parts{number(0), number(0), number(0)};
  if (!partsOf(axis, height, parts)) return false;
  const bool by_cosine = isZero(parts.k) && isUnit(*this, parts.a) && isZero(parts.b);
  const bool by_sine = isZero(parts.k) && isUnit(*this, parts.b) && isZero(parts.a);
  if (!by_cosine && !by_sine) return solve(axis, height - column(2, 0));
  const TrigPolynomial along = by_cosine ? parts.a * column(2, 0) : parts.b * column(2, 0);
  const Formula across = formula(column(0, 0) * column(0, 0) + column(1, 0) * column(1, 0));
  const Formula S = rootNamed("S" + suffix(axis), across);
  const Formula C = formula(along);
  setJoint(axis.symbol, Formula::call(FormulaFunction::kArcTangent2,
                                      by_cosine ? std::vector<Formula>{S, C} : std::vector<Formula>{C, S}));
  return true;
}

bool writeOrientation(InverseBuilder& builder, int first) {
  const TrigMatrix left = rotationLeft(builder, first);
  builder.say("The rotation that " + builder.namesOf({first, first + 1, first + 2}) + " have to make:");
  const TrigMatrix M = builder.namedEntries("m", left);
  const InverseAxis axes[3] = {builder.axis(first, 1), builder.axis(first + 1, 1), builder.axis(first + 2, 1)};
  const TrigMatrix C5 = builder.constantStep(first + 1).R;
  const TrigMatrix C6 = builder.constantStep(first + 2).R;
  const TrigMatrix image = C5 * (builder.motion(axes[1]).R * C6.column(2));
  builder.say("The angle between the outer axes gives the middle one:");
  if (!builder.solveMiddle(axes[1], M.column(2), image(2, 0))) return false;
  builder.turnBetween(axes[0], image(0, 0), image(1, 0), M(0, 2), M(1, 2));
  // The middle axis lies across, or slants to, both outer ones: what the last turn leaves of it.
  const TrigMatrix middle = builder.motion(axes[0]).R * C5.column(2);
  const TrigMatrix seen = C6.transposed().column(2);
  builder.say("The middle axis, seen from behind, gives the last one:");
  const TrigPolynomial hx = builder.named("hx", dot(middle, M.column(0)));
  const TrigPolynomial hy = builder.named("hy", dot(middle, M.column(1)));
  builder.turnBetween(axes[2], hx, hy, seen(0, 0), seen(1, 0));
  return true;
}

}  // namespace screwline

// Three parallel axes among six turns: what points along them passes them unchanged (Elias & Wen 2022). The height of a
// point gives the single joint, the direction of the axes the pair, and two links in a plane are left.

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "inverse_builder.h"

namespace screwline {
namespace {

class ParallelWriter {
 public:
  ParallelWriter(InverseBuilder& builder, const InverseOutline& outline)
      : builder_(builder), outline_(outline), target_(builder.identity()) {
    const TrigPose to_table = builder.base().inverse();
    for (int i = 0; i < 6; ++i) {
      axes_.push_back(outline.reversed ? builder.axis(5 - i, -1) : builder.axis(i, 1));
      Z_.push_back(to_table * builder.between(0, axes_.back().frame));
    }
    const TrigPose all = lastFrame() * (to_table * builder.between(0, 6)).inverse();
    target_ = outline.reversed ? all.inverse() : all;
  }

  bool write() {
    if (!writeSingle() || !writePair()) return false;
    return writePlane();
  }

 private:
  /// Where the table's last frame has to be, seen from its first.
  TrigPose lastFrame() {
    TrigPose X = builder_.base().inverse() * TrigPose{builder_.targetRotation(), builder_.targetPoint()} *
                 builder_.step(6).inverse();
    builder_.say("The frame on the last axis, base and tool taken off:");
    const char* names[3] = {"wx", "wy", "wz"};
    for (int i = 0; i < 3; ++i) X.p(i, 0) = builder_.named(names[i], X.p(i, 0));
    X.R = builder_.namedEntries("t", X.R);
    return X;
  }

  const InverseAxis& axis(int place) const { return axes_[static_cast<std::size_t>(place)]; }
  const TrigPose& Z(int place) const { return Z_[static_cast<std::size_t>(place)]; }
  /// The motion of an axis, in the table's first frame.
  TrigPose turn(int place) const {
    const InverseAxis& a = axis(place);
    return Z(place) * builder_.motion(a) * Z(place).inverse();
  }
  TrigMatrix along() const { return Z(outline_.first_parallel).R.column(2); }
  bool isBefore() const { return outline_.single < outline_.first_parallel; }
  bool isBetween() const { return outline_.single > outline_.first_parallel && outline_.single < outline_.pair; }

  TrigPolynomial height(const TrigMatrix& point) const {
    const TrigMatrix h = along();
    return h(0, 0) * point(0, 0) + h(1, 0) * point(1, 0) + h(2, 0) * point(2, 0);
  }

  /// Where the pair's axes meet: the origin of the table's frame on the one nearer to the base.
  TrigMatrix meeting() const { return Z(outline_.reversed ? outline_.pair + 1 : outline_.pair).p; }

  bool writeSingle() {
    builder_.say("The height, along the parallel axes, of the point where the axes of " + pairNames() + " meet:");
    const TrigMatrix point = meeting();
    const TrigPose J = turn(outline_.single);
    TrigPolynomial equation(builder_.ring());
    if (isBefore()) {
      equation = height(times(J.inverse(), times(target_, point))) - height(point);
    } else if (isBetween()) {
      equation = height(times(J, point)) - height(times(target_, point));
    } else {
      equation = height(times(target_, times(J.inverse(), point))) - height(point);
    }
    return builder_.solve(axis(outline_.single), equation);
  }

  std::string pairNames() const { return builder_.namesOf({axis(outline_.pair).place, axis(outline_.pair + 1).place}); }

  /// Rz(first) K Rz(second) f = e: the parallel axes' direction seen from both sides of the pair.
  bool writePair() {
    const InverseAxis& first = axis(outline_.pair);
    const InverseAxis& second = axis(outline_.pair + 1);
    TrigMatrix from = target_.R.transposed() * along();
    TrigMatrix to = along();
    if (isBefore()) from = target_.R.transposed() * (turn(0).R * along());
    if (isBetween()) to = turn(outline_.single).R.transposed() * along();
    if (!isBefore() && !isBetween()) from = turn(outline_.single).R * from;
    builder_.say("The direction of the parallel axes, seen from behind " + pairNames() + ":");
    TrigMatrix f = Z(outline_.pair + 1).R.transposed() * from;
    const char* names[3] = {"hx", "hy", "hz"};
    for (int i = 0; i < 3; ++i) f(i, 0) = builder_.named(names[i], f(i, 0));
    const TrigMatrix e = Z(outline_.pair).R.transposed() * to;
    const TrigMatrix K = Z(outline_.pair).R.transposed() * Z(outline_.pair + 1).R;
    const TrigMatrix image = K.transposed() * (builder_.motion(first).R.transposed() * e);
    if (!builder_.solveMiddle(first, f, image(2, 0))) return false;
    builder_.turnBetween(second, f(0, 0), f(1, 0), image(0, 0), image(1, 0));
    return true;
  }

  /// Rz K2 Rz K3 Rz = Q: the place of the third parallel axis, and the heading behind it.
  bool writePlane() {
    const int k = outline_.first_parallel;
    TrigPose after = builder_.identity();
    for (int i = k + 3; i < 6; ++i) after = after * turn(i);
    TrigPose Q = target_ * after.inverse();
    if (isBefore()) Q = turn(0).inverse() * Q;
    Q = Z(k).inverse() * Q * Z(k + 2);
    const TrigPose K2 = Z(k).inverse() * Z(k + 1);
    const TrigPose K3 = Z(k + 1).inverse() * Z(k + 2);
    builder_.say("The place of the third parallel axis, seen from the first:");
    const TrigPolynomial u = builder_.named("u", Q.p(0, 0));
    const TrigPolynomial v = builder_.named("v", Q.p(1, 0));
    const TrigMatrix elbow = times(K2, times(builder_.motion(axis(k + 1)), K3.p));
    builder_.say("Its distance gives the elbow:");
    const TrigPolynomial stretch = elbow(0, 0) * elbow(0, 0) + elbow(1, 0) * elbow(1, 0) - u * u - v * v;
    if (!builder_.solve(axis(k + 1), stretch)) return false;
    builder_.turnBetween(axis(k), elbow(0, 0), elbow(1, 0), u, v);
    writeHeading(Q.R * (K2.R * K3.R).transposed(), (K2.R)(2, 2), (K2.R * K3.R)(2, 2));
    return true;
  }

  /// What is left of the heading, which sums the three angles with the signs of their axes.
  void writeHeading(const TrigMatrix& heading, const TrigPolynomial& second, const TrigPolynomial& third) {
    const int k = outline_.first_parallel;
    builder_.say("What is left of the heading:");
    const TrigPolynomial s = builder_.named("m21", heading(1, 0));
    const TrigPolynomial c = builder_.named("m11", heading(0, 0));
    const auto share = [&](int place, const TrigPolynomial& sign) {
      const int sense = axis(place).sense * (builder_.valueOf(sign) < 0.0 ? -1 : 1);
      return Formula::number(sense);
    };
    const Formula all = Formula::call(FormulaFunction::kArcTangent2, {builder_.formula(s), builder_.formula(c)});
    const Formula rest = all - share(k, builder_.number(1)) * Formula::symbol(axis(k).symbol) -
                         share(k + 1, second) * Formula::symbol(axis(k + 1).symbol);
    const Formula last = share(k + 2, third) * rest;
    builder_.setJoint(axis(k + 2).symbol, last);
  }

  InverseBuilder& builder_;
  const InverseOutline& outline_;
  std::vector<InverseAxis> axes_;
  std::vector<TrigPose> Z_;  ///< Frames on them at zero, in the table's first frame.
  TrigPose target_;
};

}  // namespace

bool writeParallel(InverseBuilder& builder, const InverseOutline& outline) {
  return ParallelWriter(builder, outline).write();
}

}  // namespace screwline

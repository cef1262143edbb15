// The position of a point moved by three axes, as the closed forms of ik/ take it apart: the first axis keeps the
// height along it and the distance from it, which leaves one equation each for the third and the second (Pieper 1968;
// Craig, ch. 4.6).

#include <algorithm>
#include <cmath>
#include <utility>

#include "inverse_builder.h"
#include "screwline/model/structure.h"

namespace screwline {
namespace {

using Axes = std::array<InverseAxis, 3>;

TrigPolynomial dot(const TrigMatrix& a, const TrigMatrix& b) {
  return a(0, 0) * b(0, 0) + a(1, 0) * b(1, 0) + a(2, 0) * b(2, 0);
}

TrigPolynomial squareAcross(const TrigMatrix& a) {
  return a(0, 0) * a(0, 0) + a(1, 0) * a(1, 0);
}

bool areParallel(const InverseAxis& a, const InverseAxis& b) {
  return a.line.direction.cross(b.line.direction).norm() <= kStructureAngleTolerance;
}

/// J1 K1 J2 K2 J3 s = g, in the frame of the first axis.
class PositionWriter {
 public:
  PositionWriter(InverseBuilder& builder, Axes axes, InversePoint start, InversePoint goal)
      : builder_(builder),
        axes_(std::move(axes)),
        start_(std::move(start)),
        goal_(std::move(goal)),
        K1_(builder.identity()),
        K2_(builder.identity()),
        g_(goal_.p),
        F_(start_.p) {}

  bool write() {
    orderAxes();
    if (axes_[0].slides && axes_[1].slides) return writeThreeSlides();
    const bool turns = !axes_[0].slides && !axes_[1].slides;
    if (turns && !alignFeet()) return false;
    K1_ = builder_.relative(axes_[0], axes_[1]);
    K2_ = builder_.relative(axes_[1], axes_[2]);
    if (axes_[0].slides) return writeSlideTurnSlide();
    takePoints();
    if (!turns) {
      return builder_.isZero(K1_.R(2, 2)) ? writeSlideAcross() : writeTurnAndSlide();
    }
    const AxisRelation relation = relate(axes_[0].line, axes_[1].line, builder_.chain().characteristicLength());
    if (relation.coincident) return false;
    const bool third_parallel = !axes_[2].slides && areParallel(axes_[1], axes_[2]);
    if (relation.orthogonal && third_parallel) return writeArmPlane();
    if (relation.parallel) return writeParallelTurns();
    return relation.intersecting ? writeMeetingTurns() : writeSkewTurns(builder_, axes_, K1_, F_, g_);
  }

 private:
  /// Slides parallel to all turns do not care when they come: last. Then turns before slides, from the tip if need be.
  void orderAxes() {
    const auto commutes = [this](const InverseAxis& slide) {
      return slide.slides && std::all_of(axes_.begin(), axes_.end(), [&](const InverseAxis& other) {
               return other.slides || areParallel(slide, other);
             });
    };
    std::stable_partition(axes_.begin(), axes_.end(), [&](const InverseAxis& axis) { return !commutes(axis); });
    if (!axes_[0].slides || axes_[2].slides) return;
    std::swap(axes_[0], axes_[2]);
    std::swap(start_, goal_);
    for (InverseAxis& axis : axes_) axis.sense = -axis.sense;
  }

  /// Moves the frames of the first two axes to their common normal, x along it.
  bool alignFeet() {
    InverseAxis& first = axes_[0];
    InverseAxis& second = axes_[1];
    if (builder_.isDhRow(first.place) && builder_.isDhRow(second.place) && std::abs(first.place - second.place) == 1) {
      InverseAxis& later = first.place < second.place ? second : first;
      ExactAngle back = builder_.offsetAbout(later.place);
      for (auto& share : back.symbols) share.second = -share.second;
      back.steps = -back.steps;
      later.local = later.local * builder_.shiftAlongZ(-builder_.offsetAlong(later.place));
      later.local.R = later.local.R * builder_.rotationAboutZ(back);
      return true;
    }
    if (!areParallel(first, second)) return false;
    const TrigPose K = builder_.relative(first, second);
    second.local = second.local * builder_.shiftAlongZ(-(K.p(2, 0) * K.R(2, 2)));
    return true;
  }

  /// The goal, or where the axes run from the tip the start, depends on the target: its coordinates get names.
  void takePoints() {
    g_ = builder_.seenFrom(axes_[0], goal_);
    TrigMatrix s = builder_.seenFrom(axes_[2], start_);
    const bool is_fixed = builder_.isConstant(goal_.p(0, 0)) && builder_.isConstant(goal_.p(1, 0));
    const char* names[3] = {"wx", "wy", "wz"};
    for (int i = 0; i < 3; ++i) {
      TrigPolynomial& entry = is_fixed ? s(i, 0) : g_(i, 0);
      entry = builder_.named(names[i], entry);
    }
    F_ = times(K2_, times(builder_.motion(axes_[2]), s));
  }

  /// What the second axis makes of F, in the frame of the first.
  TrigMatrix carried() const { return times(K1_, times(builder_.motion(axes_[1]), F_)); }

  void finishFirst() {
    const TrigMatrix G = carried();
    builder_.turnBetween(axes_[0], G(0, 0), G(1, 0), g_(0, 0), g_(1, 0));
  }

  bool writeArmPlane() {
    const TrigMatrix n = K1_.R.column(2);
    TrigMatrix m(builder_.ring(), 3, 1);
    if (builder_.isZero(n(0, 0))) {
      m(0, 0) = builder_.number(1);
    } else {
      m(0, 0) = n(1, 0);
      m(1, 0) = -n(0, 0);
    }
    const TrigPolynomial lateral = dot(n, K1_.p) + F_(2, 0);
    builder_.say("How far the point lies from the first axis in the arm's plane:");
    const TrigPolynomial f = builder_.root("f", squareAcross(g_) - lateral * lateral);
    TrigMatrix G = f * m + lateral * n;
    builder_.turnBetween(axes_[0], G(0, 0), G(1, 0), g_(0, 0), g_(1, 0));
    G(2, 0) = g_(2, 0);
    TrigMatrix place = K1_.R.transposed() * (G - K1_.p);
    builder_.say("The point in the arm's plane, from the second axis, and the two links that reach it:");
    place(0, 0) = builder_.named("u", place(0, 0));
    place(1, 0) = builder_.named("v", place(1, 0));
    if (!builder_.solve(axes_[2], squareAcross(F_) - squareAcross(place))) return false;
    builder_.turnBetween(axes_[1], F_(0, 0), F_(1, 0), place(0, 0), place(1, 0));
    return true;
  }

  bool writeMeetingTurns() {
    builder_.say("The distance from where the first two axes meet gives the third joint:");
    if (!builder_.solve(axes_[2], dot(F_, F_) - dot(g_, g_))) return false;
    builder_.say("The height along the first axis gives the second:");
    if (!builder_.solve(axes_[1], carried()(2, 0) - g_(2, 0))) return false;
    finishFirst();
    return true;
  }

  bool writeParallelTurns() {
    builder_.say("The height along the parallel axes:");
    if (!builder_.solve(axes_[2], carried()(2, 0) - g_(2, 0))) return false;
    builder_.say("The distance from the first axis:");
    if (!builder_.solve(axes_[1], squareAcross(carried()) - squareAcross(g_))) return false;
    finishFirst();
    return true;
  }

  bool writeTurnAndSlide() {
    const TrigPolynomial along = K1_.R(2, 2);
    const TrigMatrix rest = K1_.R * F_ + K1_.p;
    const TrigPolynomial left = g_(2, 0) - rest(2, 0);
    TrigMatrix across = along * rest + left * K1_.R.column(2);
    builder_.say("The distance from the first axis gives the third joint:");
    if (!builder_.solve(axes_[2], squareAcross(across) - along * along * squareAcross(g_)) && !solveAcross(across))
      return false;
    builder_.say("The height along it:");
    if (!builder_.solve(axes_[1], carried()(2, 0) - g_(2, 0))) return false;
    finishFirst();
    return true;
  }

  /// The same where the third joint turns: a quartic.
  bool solveAcross(const TrigMatrix& across) {
    builder_.say(
        "What " + builder_.namesOf({axes_[2].place}) +
        " carries is brought to the goal's height by the slide; then it lies at (u, v) from the first axis, both times "
        "the cosine between slide and axis. " +
        builder_.marksOf(axes_[2]) + ":");
    const auto u = builder_.formOf(axes_[2], "u", across(0, 0));
    const auto v = builder_.formOf(axes_[2], "v", across(1, 0));
    if (!u || !v) return false;
    const TrigPolynomial& along = K1_.R(2, 2);
    builder_.say("The distance from that axis is the goal's: a quartic gives " + builder_.namesOf({axes_[2].place}) +
                 ":");
    const Formula radius = builder_.formula(along * along) * builder_.formula(squareAcross(g_));
    builder_.solveSquares(axes_[2], {*u, *v}, {radius, Formula(), Formula()});
    return true;
  }

  bool writeSlideAcross() {
    const TrigMatrix rest = K1_.R * F_ + K1_.p;
    builder_.say("The height along the first axis:");
    if (!builder_.solve(axes_[2], rest(2, 0) - g_(2, 0))) return false;
    const TrigMatrix n = K1_.R.column(2);
    const TrigPolynomial lateral = rest(1, 0) * n(0, 0) - rest(0, 0) * n(1, 0);
    builder_.say("The distance from it:");
    const TrigPolynomial f = builder_.root("f", squareAcross(g_) - lateral * lateral);
    const TrigPolynomial value = f - n(0, 0) * rest(0, 0) - n(1, 0) * rest(1, 0);
    builder_.setJoint(axes_[1].symbol, builder_.formula(value.scaled(axes_[1].sense)));
    TrigMatrix G(builder_.ring(), 3, 1);
    G(0, 0) = f * n(0, 0) - lateral * n(1, 0);
    G(1, 0) = f * n(1, 0) + lateral * n(0, 0);
    builder_.turnBetween(axes_[0], G(0, 0), G(1, 0), g_(0, 0), g_(1, 0));
    return true;
  }

  /// The height along the turning axis gives one slide by the other, the distance from it the other. Whichever slide
  /// moves faster along that axis is the one that the height gives.
  bool writeSlideTurnSlide() {
    const auto share = [this](std::size_t i) { return std::abs(axes_[1].line.direction.dot(axes_[i].line.direction)); };
    if (share(2) < share(0)) {
      std::swap(axes_[0], axes_[2]);
      std::swap(start_, goal_);
      for (InverseAxis& axis : axes_) axis.sense = -axis.sense;
      K1_ = builder_.relative(axes_[0], axes_[1]);
      K2_ = builder_.relative(axes_[1], axes_[2]);
    }
    takePoints();
    TrigMatrix H = times(K1_.inverse(), times(builder_.motion(axes_[0]).inverse(), g_));
    InverseBuilder::Parts height{builder_.number(0), builder_.number(0), builder_.number(0)};
    if (!builder_.partsOf(axes_[2], F_(2, 0) - H(2, 0), height) || !builder_.isConstant(height.a)) return false;
    // Both sides of the distance times the square of how fast the height changes.
    TrigMatrix F = F_;
    for (int i = 0; i < 3; ++i) {
      InverseBuilder::Parts parts = height;
      if (!builder_.partsOf(axes_[2], F_(i, 0), parts)) return false;
      F(i, 0) = height.a * parts.k - height.k * parts.a;
    }
    builder_.say("The distance from the turning axis, then the height along it:");
    if (!builder_.solve(axes_[0], squareAcross(F) - height.a * height.a * squareAcross(H))) return false;
    if (!builder_.solve(axes_[2], F_(2, 0) - H(2, 0))) return false;
    builder_.turnBetween(axes_[1], F_(0, 0), F_(1, 0), H(0, 0), H(1, 0));
    return true;
  }

  bool writeThreeSlides() {
    TrigMatrix directions(builder_.ring(), 3, 3);
    for (int i = 0; i < 3; ++i) {
      const InverseAxis& axis = axes_[static_cast<std::size_t>(i)];
      const TrigMatrix z = builder_.between(0, axis.frame).R * axis.local.R.column(2);
      directions.setBlock(0, i, builder_.number(axis.sense) * z);
    }
    const auto inBase = [this](const InversePoint& point) { return times(builder_.between(0, point.frame), point.p); };
    const TrigMatrix way = inBase(goal_) - inBase(start_);
    const TrigPolynomial whole = determinant(directions);
    for (int i = 0; i < 3; ++i) {
      const InverseAxis& axis = axes_[static_cast<std::size_t>(i)];
      TrigMatrix replaced = directions;
      replaced.setBlock(0, i, way);
      const TrigPolynomial equation = whole * builder_.symbol(axis.symbol) - determinant(replaced);
      if (!builder_.solve(axis, equation)) return false;
    }
    return true;
  }

  InverseBuilder& builder_;
  Axes axes_;
  InversePoint start_;
  InversePoint goal_;
  TrigPose K1_;
  TrigPose K2_;
  TrigMatrix g_;
  TrigMatrix F_;
};

}  // namespace

bool writePosition(InverseBuilder& builder, std::array<InverseAxis, 3> axes, InversePoint start, InversePoint goal) {
  return PositionWriter(builder, std::move(axes), std::move(start), std::move(goal)).write();
}

}  // namespace screwline

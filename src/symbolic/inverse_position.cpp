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
  PositionWriter(InverseBuilder& builder, Axes axes, TrigMatrix start, TrigMatrix goal)
      : builder_(builder),
        axes_(std::move(axes)),
        start_(std::move(start)),
        goal_(std::move(goal)),
        K1_(builder.identity()),
        K2_(builder.identity()),
        g_(goal_),
        F_(start_) {}

  bool write() {
    orderAxes();
    if (axes_[0].slides && axes_[1].slides) return writeThreeSlides();
    const bool turns = !axes_[0].slides && !axes_[1].slides;
    if (turns && !alignFeet()) return false;
    K1_ = axes_[0].Z.inverse() * axes_[1].Z;
    K2_ = axes_[1].Z.inverse() * axes_[2].Z;
    takePoints();
    if (axes_[0].slides) return writeSlideTurnSlide();
    if (!turns) {
      return builder_.isZero(K1_.R(2, 2)) ? writeSlideAcross() : writeTurnAndSlide();
    }
    const AxisRelation relation = relate(axes_[0].line, axes_[1].line, builder_.chain().characteristicLength());
    if (relation.coincident) return false;
    const bool third_parallel = !axes_[2].slides && areParallel(axes_[1], axes_[2]);
    if (relation.orthogonal && third_parallel) return writeArmPlane();
    if (relation.parallel) return writeParallelTurns();
    return relation.intersecting && writeMeetingTurns();
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
    const bool neighbours = std::abs(first.joint - second.joint) == 1;
    if (neighbours) {
      InverseAxis& later = first.joint < second.joint ? second : first;
      ExactAngle back = builder_.offsetAbout(later.joint);
      for (auto& share : back.symbols) share.second = -share.second;
      back.steps = -back.steps;
      later.Z = later.Z * builder_.shiftAlongZ(-builder_.offsetAlong(later.joint));
      later.Z.R = later.Z.R * builder_.rotationAboutZ(back);
      return true;
    }
    if (!areParallel(first, second)) return false;
    const TrigPose K = first.Z.inverse() * second.Z;
    second.Z = second.Z * builder_.shiftAlongZ(-(K.p(2, 0) * K.R(2, 2)));
    return true;
  }

  /// The goal, or where the axes run from the tip the start, depends on the target: its coordinates get names.
  void takePoints() {
    g_ = times(axes_[0].Z.inverse(), goal_);
    TrigMatrix s = times(axes_[2].Z.inverse(), start_);
    const char* names[3] = {"wx", "wy", "wz"};
    for (int i = 0; i < 3; ++i) {
      TrigPolynomial& entry = builder_.isConstant(goal_(0, 0)) && builder_.isConstant(goal_(1, 0)) ? s(i, 0) : g_(i, 0);
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
    if (!builder_.solve(axes_[2], squareAcross(across) - along * along * squareAcross(g_))) return false;
    builder_.say("The height along it:");
    if (!builder_.solve(axes_[1], carried()(2, 0) - g_(2, 0))) return false;
    finishFirst();
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

  /// The height along the turning axis gives one slide by the other, the distance from it the other.
  bool writeSlideTurnSlide() {
    TrigMatrix H = times(K1_.inverse(), times(builder_.motion(axes_[0]).inverse(), g_));
    InverseBuilder::Parts parts{builder_.number(0), builder_.number(0), builder_.number(0)};
    const TrigPolynomial rise = F_(2, 0) - H(2, 0);
    if (!builder_.partsOf(axes_[2], rise, parts)) return false;
    const bool unit = parts.a == builder_.number(1) || parts.a == builder_.number(-1);
    if (!unit) return false;
    const TrigPolynomial third = parts.a == builder_.number(1) ? -parts.k : parts.k;
    TrigMatrix F = F_;
    for (int i = 0; i < 3; ++i) F(i, 0) = F(i, 0).atScalar(axes_[2].symbol, third);
    builder_.say("The distance from the turning axis, then the height along it:");
    if (!builder_.solve(axes_[0], squareAcross(F) - squareAcross(H))) return false;
    builder_.setJoint(axes_[2].symbol, builder_.formula(third));
    builder_.turnBetween(axes_[1], F_(0, 0), F_(1, 0), H(0, 0), H(1, 0));
    return true;
  }

  bool writeThreeSlides() {
    TrigMatrix directions(builder_.ring(), 3, 3);
    for (int i = 0; i < 3; ++i) {
      const InverseAxis& axis = axes_[static_cast<std::size_t>(i)];
      directions.setBlock(0, i, builder_.number(axis.sense) * axis.Z.R.column(2));
    }
    const TrigMatrix way = goal_ - start_;
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
  TrigMatrix start_;
  TrigMatrix goal_;
  TrigPose K1_;
  TrigPose K2_;
  TrigMatrix g_;
  TrigMatrix F_;
};

}  // namespace

bool writePosition(InverseBuilder& builder, std::array<InverseAxis, 3> axes, TrigMatrix start, TrigMatrix goal) {
  return PositionWriter(builder, std::move(axes), std::move(start), std::move(goal)).write();
}

}  // namespace screwline

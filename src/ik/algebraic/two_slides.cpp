#include "two_slides.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "surd.h"

namespace screwline {
namespace {

constexpr int kDegree = 4;             ///< Half the number of solutions.
constexpr double kFirstSample = 0.05;  ///< [rad] Where no arm's axes come into line by design.
constexpr double kAtInfinity = 1e6;    ///< [lengths] of a slide.
constexpr double kInLine = 2e-3;       ///< [rad] between axes: as well as a multiple root tells it.
constexpr double kParallel = 1e-4;     ///< [rad] between slides, or axes that are never in line.
constexpr double kComplex = 1e-3;  ///< Of the amplitude: no rounding, nor a multiple root's, makes w imaginary so far.
constexpr int kVanishingSamples = 7;
constexpr double kVanishing = 1e-13;

/// A vector that turns: u0 + cos u1 + sin u2.
struct Turning {
  Turning() = default;
  /// v by angles about the unit vector `axis`.
  Turning(const Vector3& axis, const Vector3& v)
      : constant(axis.dot(v) * axis), cosine(v - constant), sine(axis.cross(v)) {}

  Vector3 at(double c, double s) const { return constant + c * cosine + s * sine; }

  Vector3 constant = Vector3::Zero();
  Vector3 cosine = Vector3::Zero();
  Vector3 sine = Vector3::Zero();
};

/// Everything at one angle of the hidden turn, on both branches: w is their sign times the square root of `square`.
struct Branches {
  double square = 0.0;       ///< Negative: the orientation is out of reach.
  double sine_square = 0.0;  ///< Of the angle between the first and the last axis of the three.
  std::array<SurdTurn, 3> turns;
  std::array<SurdVector, 2> slides;  ///< Directions.
  SurdVector missing;                ///< What they have to move.
};

/// Of what the slides' directions and the missing way span: g.
Surd volumeOf(const Branches& branches) {
  const SurdVector normal = cross(branches.slides[0], branches.slides[1], branches.square);
  return dot(normal, branches.missing, branches.square);
}

/// The slides span a plane in which the rest of the way lies.
class PlaneCondition : public HiddenCondition {
 public:
  PlaneCondition(const Loop& loop, int hidden, const Pose& target);

  TrigonometricPolynomial polynomial(const CircleMap& map) const override;
  CircleMap spread() const override { return {kFirstSample, 1.0}; }
  bool vanishes() const override;
  bool isIllConditioned() const override;
  bool leavesFree(double angle, bool at_infinity) const override;
  std::optional<Vector6> configurationAt(double angle) const override;
  std::array<std::optional<Vector6>, 2> bothAt(double angle) const override;

 private:
  const Axis& turn(int i) const { return axes_[static_cast<std::size_t>(turns_[static_cast<std::size_t>(i)])]; }
  Branches at(double angle) const;
  void place(Branches& branches, const Vector3& goal) const;
  double amplitude() const { return cosine_ * cosine_ + sine_ * sine_; }
  std::optional<Vector6> configuration(double angle, const Branches& branches, double w) const;

  const Loop& loop_;
  int hidden_;
  std::array<Axis, 5> axes_;  ///< The other joints', in the loop's order behind the hidden one, its point the origin.
  std::array<int, 3> turns_{};
  Turning last_;   ///< Axis of the last turn, where the target has it, the hidden turn undone.
  Turning first_;  ///< Axis of the first turn, seen from the target.
  Turning goal_;   ///< Point of the last turn's axis, as `last_`.
  // Of the middle turn: constant + cosine cos u + sine sin u is the cosine between the axes beside it.
  double constant_ = 0.0;
  double cosine_ = 0.0;
  double sine_ = 0.0;
};

PlaneCondition::PlaneCondition(const Loop& loop, int hidden, const Pose& target) : loop_(loop), hidden_(hidden) {
  const Axis& turned = loop.axes[static_cast<std::size_t>(hidden)];
  Pose X = loop.motion(target);
  X.p += X.R * turned.point - turned.point;
  const Pose back = X.inverse();
  std::size_t count = 0;
  for (int i = 0; i < 5; ++i) {
    const int joint = (hidden + 1 + i) % 6;
    Axis& axis = axes_[static_cast<std::size_t>(i)];
    axis = loop.axes[static_cast<std::size_t>(joint)];
    axis.point -= turned.point;
    if (joint < hidden) {  // e1 X = X (X^-1 e1 X)
      axis.direction = back.R * axis.direction;
      axis.point = back * axis.point;
    }
    if (!axis.prismatic) turns_[count++] = i;
  }
  last_ = Turning(-turned.direction, X.R * turn(2).direction);
  goal_ = Turning(-turned.direction, X * turn(2).point);
  const Turning first(turned.direction, turn(0).direction);
  first_.constant = back.R * first.constant;
  first_.cosine = back.R * first.cosine;
  first_.sine = back.R * first.sine;
  const Vector3& middle = turn(1).direction;
  const Vector3 along = middle.dot(turn(2).direction) * middle;
  constant_ = turn(0).direction.dot(along);
  cosine_ = turn(0).direction.dot(turn(2).direction - along);
  sine_ = turn(0).direction.dot(middle.cross(turn(2).direction));
}

Branches PlaneCondition::at(double angle) const {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  const Vector3& axis1 = turn(0).direction;
  const Vector3& axis2 = turn(1).direction;
  const Vector3& axis3 = turn(2).direction;
  const Vector3 last = last_.at(c, s);
  const Vector3 first = first_.at(c, s);
  Branches branches;
  // cosine cos u + sine sin u = between
  const double between = axis1.dot(last) - constant_;
  branches.square = amplitude() - between * between;
  const double scale = 1.0 / amplitude();
  SurdTurn& middle = branches.turns[1];
  middle.cosine = {scale * cosine_ * between, -scale * sine_};
  middle.sine = {scale * sine_ * between, scale * cosine_};
  const SurdTurn undone = {middle.cosine, -1.0 * middle.sine};
  const Vector3 across1 = axis1.cross(last);
  const Vector3 across3 = axis3.cross(first);
  branches.sine_square = across1.squaredNorm();
  const double across_scale = 1.0 / branches.sine_square;
  const SurdVector image1 = cross(axis1, turned(axis2, middle, {axis3, Vector3::Zero()}, branches.square));
  const SurdVector image3 = cross(axis3, turned(axis2, undone, {axis1, Vector3::Zero()}, branches.square));
  // From the image to where the target has the axis; back to the image seen from the target.
  branches.turns[0] = {across_scale * dot(across1, image1), across_scale * dot(last, image1)};
  branches.turns[2] = {across_scale * dot(across3, image3), -across_scale * dot(first, image3)};
  place(branches, goal_.at(c, s));
  return branches;
}

/// From the tip to the base.
void PlaneCondition::place(Branches& branches, const Vector3& goal) const {
  SurdVector point{turn(2).point, Vector3::Zero()};
  std::size_t slide = 2;
  std::size_t turn_place = 3;
  for (std::size_t i = 5; i-- > 0;) {
    const Axis& axis = axes_[i];
    if (axis.prismatic) {
      branches.slides[--slide].a = axis.direction;
      continue;
    }
    const SurdTurn& turn = branches.turns[--turn_place];
    const SurdVector origin{axis.point, Vector3::Zero()};
    if (turn_place < 2) point = origin + turned(axis.direction, turn, point - origin, branches.square);
    for (std::size_t k = slide; k < 2; ++k) {
      branches.slides[k] = turned(axis.direction, turn, branches.slides[k], branches.square);
    }
  }
  branches.missing = SurdVector{goal, Vector3::Zero()} - point;
}

TrigonometricPolynomial PlaneCondition::polynomial(const CircleMap& map) const {
  std::array<double, kTrigonometricSamples> values;
  for (int i = 0; i < kTrigonometricSamples; ++i) {
    const Branches branches = at(map.angle(kTwoPi * i / kTrigonometricSamples));
    const Surd volume = volumeOf(branches);
    values[static_cast<std::size_t>(i)] =
        branches.sine_square * (volume.a * volume.a - branches.square * volume.b * volume.b);
  }
  TrigonometricPolynomial polynomial(values);
  polynomial.truncate(kDegree);
  return polynomial;
}

bool PlaneCondition::vanishes() const {
  for (int i = 0; i < kVanishingSamples; ++i) {
    const Branches branches = at(0.5 + kTwoPi * i / kVanishingSamples);
    const auto sizeOf = [&branches](const SurdVector& v) {
      return v.a.squaredNorm() + std::abs(branches.square) * v.b.squaredNorm();
    };
    const Surd volume = volumeOf(branches);
    const double value = volume.a * volume.a - branches.square * volume.b * volume.b;
    const double size = sizeOf(branches.slides[0]) * sizeOf(branches.slides[1]) * sizeOf(branches.missing);
    if (std::abs(value) > kVanishing * size) return false;
  }
  return true;
}

/// The middle turn's neighbours are almost in line with it, or with each other at every angle.
bool PlaneCondition::isIllConditioned() const {
  const Vector3& axis1 = turn(0).direction;
  const double mean = std::abs(axis1.dot(last_.constant));
  const double least = mean - std::hypot(axis1.dot(last_.cosine), axis1.dot(last_.sine));
  return amplitude() < kParallel * kParallel || least > 1.0 - 0.5 * kParallel * kParallel;
}

/// Of turns in line only a sum of angles is given, of parallel slides a sum of lengths.
bool PlaneCondition::leavesFree(double angle, bool at_infinity) const {
  const Branches branches = at(angle);
  const double w = std::sqrt(std::max(branches.square, 0.0));
  const auto area = [&branches](double side) {
    return branches.slides[0].at(side).cross(branches.slides[1].at(side)).squaredNorm();
  };
  const bool parallel = !at_infinity && std::min(area(w), area(-w)) < kParallel * kParallel;
  return parallel || branches.sine_square < kInLine * kInLine;
}

std::optional<Vector6> PlaneCondition::configuration(double angle, const Branches& branches, double w) const {
  const Vector3 first = branches.slides[0].at(w);
  const Vector3 second = branches.slides[1].at(w);
  const Vector3 missing = branches.missing.at(w);
  const Vector3 normal = first.cross(second);
  const Vector3 across1 = missing.cross(second);
  const Vector3 across2 = first.cross(missing);
  const double square = normal.squaredNorm();
  if (std::max(across1.squaredNorm(), across2.squaredNorm()) > kAtInfinity * kAtInfinity * square) return std::nullopt;
  const std::array<double, 2> slides = {normal.dot(across1) / square, normal.dot(across2) / square};
  Vector6 displacements;
  displacements[hidden_] = angle;
  std::size_t slide = 0;
  std::size_t turn = 0;
  for (int i = 0; i < 5; ++i) {
    const int joint = (hidden_ + 1 + i) % 6;
    displacements[joint] =
        axes_[static_cast<std::size_t>(i)].prismatic ? loop_.length * slides[slide++] : branches.turns[turn++].at(w);
  }
  return displacements.cwiseQuotient(loop_.multipliers);
}

std::optional<Vector6> PlaneCondition::configurationAt(double angle) const {
  const Branches branches = at(angle);
  const Surd volume = volumeOf(branches);
  const double w = std::sqrt(std::max(branches.square, 0.0));
  return configuration(angle, branches, volume.a * volume.b > 0.0 ? -w : w);
}

std::array<std::optional<Vector6>, 2> PlaneCondition::bothAt(double angle) const {
  const Branches branches = at(angle);
  if (branches.square < -kComplex * amplitude()) return {};
  const double w = std::sqrt(std::max(branches.square, 0.0));
  return {{configuration(angle, branches, w), configuration(angle, branches, -w)}};
}

}  // namespace

Eliminated TwoSlides::solve(const Pose& target, RootRefiner& refiner) const {
  return HiddenTurn::solve(PlaneCondition(*loop_, hidden_, target), *loop_, hidden_, refiner);
}

double TwoSlides::errorAt(const Pose& target, const Vector6& q) const {
  return HiddenTurn::errorAt(PlaneCondition(*loop_, hidden_, target), *loop_, hidden_, q);
}

std::string TwoSlides::words(const SerialChain& chain) const {
  return chain.joint(hidden_).name + " hidden, three turns make the orientation, two slides the position";
}

HiddenTurns slidePairsOf(const Loop& loop) {
  HiddenTurns all;
  for (int joint = 0; joint < 6; ++joint) {
    if (loop.axes[static_cast<std::size_t>(joint)].prismatic) continue;
    all.push_back(std::make_shared<const TwoSlides>(loop, joint));
  }
  return all;
}

}  // namespace screwline

#include "screwline/ik/numerical/ideal_geometry.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "screwline/spatial/rotation.h"

namespace screwline {
namespace {

constexpr double kExact = 1e-10;      ///< Residual below which there is nothing to snap.
constexpr double kFinished = 1e-14;   ///< Residual that Newton steps are to reach, ...
constexpr double kSatisfied = 1e-12;  ///< ... and with which they may end.
constexpr double kRank = 1e-5;        ///< Conditions that depend on each other are told by pivots below it.
constexpr double kDifference = 1e-6;  ///< Of the central differences.
constexpr double kLeastSine = 0.1;    ///< Common normals of axes closer to parallel have no certain feet.
constexpr int kMaxSteps = 12;

enum class Kind { kParallel, kOrthogonal, kMeeting, kCoincident, kFeetTogether };

/// What axes `first`, `second` (and `third`) share.
struct Condition {
  Kind kind;
  std::size_t first;
  std::size_t second;
  std::size_t third = 0;
};

double sineBetween(const Axis& a, const Axis& b) {
  return a.direction.cross(b.direction).norm();
}

double lineDistance(const Axis& a, const Axis& b) {
  const Vector3 normal = a.direction.cross(b.direction);
  return (b.point - a.point).dot(normal) / normal.norm();
}

Vector3 offLine(const Axis& a, const Axis& b) {
  return (b.point - a.point).cross(a.direction);
}

/// Where on `axis` the foot of its common normal with `other` is, from its point.
double footOn(const Axis& axis, const Axis& other) {
  const double b = axis.direction.dot(other.direction);
  const Vector3 r = axis.point - other.point;
  return (b * other.direction.dot(r) - axis.direction.dot(r)) / (1.0 - b * b);
}

/// The chain's axes as one vector: directions, and points in units of length.
class Axes {
 public:
  explicit Axes(const SerialChain& chain) : axes_(chain.axes()), length_(chain.characteristicLength()) {
    for (Axis& axis : axes_) axis.point /= length_;
  }

  const std::vector<Axis>& list() const { return axes_; }

  std::vector<Axis> inMetres() const {
    std::vector<Axis> axes = axes_;
    for (Axis& axis : axes) axis.point *= length_;
    return axes;
  }

  int size() const { return 6 * static_cast<int>(axes_.size()); }

  void add(const VectorX& step) {
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      const auto k = 6 * static_cast<Eigen::Index>(i);
      axes_[i].direction += step.segment<3>(k);
      axes_[i].point += step.segment<3>(k + 3);
    }
  }

  void normalize() {
    for (Axis& axis : axes_) axis.direction.normalize();
  }

 private:
  std::vector<Axis> axes_;
  double length_;
};

/// All that the axes almost share.
class Conditions {
 public:
  Conditions(const std::vector<Axis>& axes, const IdealTolerance& tolerance) : tolerance_(tolerance) {
    for (std::size_t i = 0; i + 1 < axes.size(); ++i) relateNeighbours(axes, i);
    for (std::size_t i = 0; i + 2 < axes.size(); ++i) relateFeet(axes, i);
  }

  bool empty() const { return conditions_.empty(); }

  VectorX residual(const std::vector<Axis>& axes) const {
    VectorX result(3 * static_cast<Eigen::Index>(conditions_.size()));
    result.setZero();
    for (std::size_t k = 0; k < conditions_.size(); ++k) {
      const Condition& condition = conditions_[k];
      const Axis& a = axes[condition.first];
      const Axis& b = axes[condition.second];
      auto rows = result.segment<3>(3 * static_cast<Eigen::Index>(k));
      switch (condition.kind) {
        case Kind::kParallel:
          rows = a.direction - std::copysign(1.0, a.direction.dot(b.direction)) * b.direction;
          break;
        case Kind::kOrthogonal:
          rows[0] = a.direction.dot(b.direction);
          break;
        case Kind::kMeeting:
          rows[0] = lineDistance(a, b);
          break;
        case Kind::kCoincident:
          rows = offLine(a, b);
          break;
        case Kind::kFeetTogether:
          rows[0] = footOn(b, a) - footOn(b, axes[condition.third]);
          break;
      }
    }
    return result;
  }

  MatrixX derivative(const Axes& axes) const {
    MatrixX D(3 * static_cast<Eigen::Index>(conditions_.size()), axes.size());
    for (Eigen::Index i = 0; i < D.cols(); ++i) {
      Axes ahead = axes;
      Axes behind = axes;
      ahead.add(kDifference * VectorX::Unit(D.cols(), i));
      behind.add(-kDifference * VectorX::Unit(D.cols(), i));
      D.col(i) = (residual(ahead.list()) - residual(behind.list())) / (2.0 * kDifference);
    }
    return D;
  }

 private:
  void relateNeighbours(const std::vector<Axis>& axes, std::size_t i) {
    // Slides turn nothing: the next turning axis keeps its angle to this one.
    std::size_t turning = i + 1;
    while (turning < axes.size() && axes[turning].prismatic && !axes[i].prismatic) ++turning;
    relateDirections(axes, i, i + 1);
    if (turning != i + 1 && turning < axes.size()) relateDirections(axes, i, turning);
    const Axis& a = axes[i];
    const Axis& b = axes[i + 1];
    if (a.prismatic || b.prismatic) return;
    if (sineBetween(a, b) <= tolerance_.angle) {
      if (offLine(a, b).norm() <= tolerance_.length) conditions_.push_back({Kind::kCoincident, i, i + 1});
    } else if (std::abs(lineDistance(a, b)) <= tolerance_.length) {
      conditions_.push_back({Kind::kMeeting, i, i + 1});
    }
  }

  void relateDirections(const std::vector<Axis>& axes, std::size_t i, std::size_t j) {
    if (sineBetween(axes[i], axes[j]) <= tolerance_.angle) conditions_.push_back({Kind::kParallel, i, j});
    if (std::abs(axes[i].direction.dot(axes[j].direction)) <= tolerance_.angle)
      conditions_.push_back({Kind::kOrthogonal, i, j});
  }

  void relateFeet(const std::vector<Axis>& axes, std::size_t i) {
    const Axis& a = axes[i];
    const Axis& b = axes[i + 1];
    const Axis& c = axes[i + 2];
    if (a.prismatic || b.prismatic || c.prismatic) return;
    if (sineBetween(a, b) < kLeastSine || sineBetween(b, c) < kLeastSine) return;
    if (std::abs(footOn(b, a) - footOn(b, c)) > tolerance_.length) return;
    conditions_.push_back({Kind::kFeetTogether, i, i + 1, i + 2});
  }

  IdealTolerance tolerance_;
  std::vector<Condition> conditions_;
};

/// Distance of a point to an axis's line; the line of a slide is anywhere.
double distanceToLine(const Axis& axis, const Vector3& point) {
  return axis.prismatic ? 0.0 : (point - axis.point).cross(axis.direction).norm();
}

}  // namespace

std::optional<IdealGeometry> idealized(const SerialChain& chain, const IdealTolerance& tolerance) {
  Axes axes(chain);
  const Conditions conditions(axes.list(), tolerance);
  if (conditions.empty()) return std::nullopt;
  VectorX residual = conditions.residual(axes.list());
  if (residual.cwiseAbs().maxCoeff() <= kExact) return std::nullopt;
  for (int step = 0; step < kMaxSteps && residual.cwiseAbs().maxCoeff() > kFinished; ++step) {
    Eigen::CompleteOrthogonalDecomposition<MatrixX> factor;
    factor.setThreshold(kRank);
    factor.compute(conditions.derivative(axes));
    axes.add(-factor.solve(residual));
    axes.normalize();
    residual = conditions.residual(axes.list());
  }
  if (!(residual.cwiseAbs().maxCoeff() <= kSatisfied)) return std::nullopt;
  ChainDescription description = chain.description();
  description.axes = axes.inMetres();
  double turn = 0.0;
  double move = 0.0;
  for (std::size_t i = 0; i < description.axes.size(); ++i) {
    turn = std::max(turn, std::asin(std::min(1.0, sineBetween(chain.axes()[i], description.axes[i]))));
    move = std::max(move, distanceToLine(description.axes[i], chain.axes()[i].point));
  }
  return IdealGeometry{SerialChain(std::move(description)), turn, move};
}

SerialChain withFixedJoint(const SerialChain& chain, int joint, double value) {
  ChainDescription description = chain.description();
  const auto k = static_cast<std::size_t>(joint);
  const Axis axis = chain.axes()[k];
  Pose X;
  if (axis.prismatic) {
    X.p = value * axis.direction;
  } else {
    X.R = rotationAbout(axis.direction, value);
    X.p = axis.point - X.R * axis.point;
  }
  for (std::size_t i = k + 1; i < description.axes.size(); ++i) {
    description.axes[i].direction = (X.R * description.axes[i].direction).normalized();
    description.axes[i].point = X * description.axes[i].point;
    description.axes[i].source = static_cast<int>(i) - 1;
  }
  description.axes.erase(description.axes.begin() + joint);
  description.joints.erase(description.joints.begin() + joint);
  description.home = X * chain.home();
  description.links = {{chain.tipLink(), static_cast<int>(description.axes.size()), description.home}};
  return SerialChain(std::move(description));
}

}  // namespace screwline

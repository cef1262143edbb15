#include "screwline/model/modified_dh.h"

#include <algorithm>
#include <cmath>

#include "screwline/spatial/rotation.h"

namespace screwline {
namespace {

constexpr double kRounding =
    1e-14;                         // Angles [rad] and lengths (over the chain's) below it are rounding, and written 0.
constexpr double kMeeting = 1e-9;  // Lines closer than this, over the chain's length, leave the sense of x open.

Pose aboutX(double a, double alpha) {
  return {rotationAbout(Vector3::UnitX(), alpha), Vector3(a, 0.0, 0.0)};
}

Pose aboutZ(double theta, double d) {
  return {rotationAbout(Vector3::UnitZ(), theta), Vector3(0.0, 0.0, d)};
}

double cleanAngle(double angle) {
  const double quarters = std::round(angle / (kPi / 2));
  if (std::abs(angle - quarters * (kPi / 2)) >= kRounding) return angle;
  return quarters == -2.0 ? kPi : quarters * (kPi / 2) + 0.0;  // + 0.0: no negative zero.
}

double cleanLength(double length, double scale) {
  return std::abs(length) < kRounding * scale ? 0.0 : length;
}

/// A line seen from a frame.
struct Line {
  Vector3 point;
  Vector3 direction;
};

Line seenFrom(const Pose& X, const Axis& axis) {
  return {X.R.transpose() * (axis.point - X.p), X.R.transpose() * axis.direction};
}

/// Sine of the angle between the line and the frame's z axis.
double sineToZ(const Line& line) {
  return std::hypot(line.direction.x(), line.direction.y());
}

/// Height on the frame's z axis of the common normal to a line that is not parallel to it.
double footOnZ(const Line& line) {
  const double across = line.point.head<2>().dot(line.direction.head<2>()) / std::pow(sineToZ(line), 2);
  return line.point.z() - across * line.direction.z();
}

/// Builds the table of axes that are all taken as lines. Every frame is placed on its axis by the frames before it as
/// they came out, rounding included, so that errors do not add up along the chain.
class TableBuilder {
 public:
  TableBuilder(const std::vector<Axis>& lines, const Pose& home, double scale)
      : lines_(lines), home_(home), scale_(scale) {}

  ModifiedDh build() {
    startAtBase();
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      const bool last = i + 1 == lines_.size();
      ModifiedDhRow& row = dh_.rows[i];
      if (!last) {
        turnToward(i);
      } else if (lines_[i].prismatic) {
        row.d = cleanLength((frame_.inverse() * home_.p).z(), scale_);
      }
      if (i == 0 && own_frame_) moveRowIntoBase();
      frame_ = frame_ * aboutZ(row.theta, row.d);
      if (!last) reach(i + 1);
    }
    dh_.tool_transform = frame_.inverse() * home_;
    for (int k = 0; k < 3; ++k) dh_.tool_transform.p[k] = cleanLength(dh_.tool_transform.p[k], scale_);
    return dh_;
  }

 private:
  /// Frame 0: the base where axis 1 is reached from it by Rx Tx; else the base moved to axis 1 where that has its
  /// direction; else frame 1 at zero.
  void startAtBase() {
    dh_.rows.assign(lines_.size(), {});
    const Vector3& u = lines_[0].direction;
    const Vector3& w = lines_[0].point;
    const bool across = std::abs(u.x()) < kRounding && std::abs(w.y() * u.z() - w.z() * u.y()) < kRounding * scale_;
    if (across) {
      reach(0);
      return;
    }
    Pose& X = dh_.base_transform;
    X.p = w - u * u.dot(w);
    if (std::hypot(u.x(), u.y()) > kRounding || u.z() < 0.0) {
      const Vector3 x = Vector3::UnitX() - u * u.x();
      X.R.col(2) = u;
      X.R.col(0) = x.norm() > 0.5 ? Vector3(x.normalized()) : anyPerpendicular(u);
      X.R.col(1) = u.cross(X.R.col(0));
      own_frame_ = true;
    }
    frame_ = X;
  }

  void moveRowIntoBase() {
    ModifiedDhRow& row = dh_.rows[0];
    frame_ = dh_.base_transform = frame_ * aboutZ(row.theta, row.d);
    row.theta = row.d = 0.0;
  }

  /// Chooses theta and d of row i, so that x lies along the common normal to the next axis.
  void turnToward(std::size_t i) {
    const Line next = seenFrom(frame_, lines_[i + 1]);
    ModifiedDhRow& row = dh_.rows[i];
    const double sine = sineToZ(next);
    if (sine > kDhParallelTolerance) {
      Vector3 x(-next.direction.y() / sine, next.direction.x() / sine, 0.0);
      const double distance = x.dot(next.point);
      const bool meet = std::abs(distance) < kMeeting * scale_;
      if (meet ? x.x() < -kRounding : distance < 0.0) x = -x;
      row.theta = cleanAngle(std::atan2(x.y(), x.x()));
      row.d = cleanLength(footOnZ(next), scale_);
      return;
    }
    const double distance = next.point.head<2>().norm();
    if (distance > 10.0 * kRounding * scale_) row.theta = cleanAngle(std::atan2(next.point.y(), next.point.x()));
    if (lines_[i].prismatic) row.d = cleanLength(heightAfterParallels(i), scale_);
  }

  /// Where axis i is followed by parallel ones, the height at which the last of them is left; 0 where the chain ends
  /// with them.
  double heightAfterParallels(std::size_t i) const {
    for (std::size_t k = i + 1; k < lines_.size(); ++k) {
      const Line line = seenFrom(frame_, lines_[k]);
      if (sineToZ(line) <= kDhParallelTolerance) continue;
      Pose on_previous = frame_;
      on_previous.p = lines_[k - 1].point;
      return footOnZ(seenFrom(on_previous, lines_[k])) + seenFrom(frame_, lines_[k - 1]).point.z();
    }
    return 0.0;
  }

  /// Chooses a and alpha of row i, so that z comes to lie on axis i.
  void reach(std::size_t i) {
    const Line line = seenFrom(frame_, lines_[i]);
    ModifiedDhRow& row = dh_.rows[i];
    row.alpha = cleanAngle(std::atan2(-line.direction.y(), line.direction.z()));
    row.a = cleanLength(line.point.x(), scale_);
    frame_ = frame_ * aboutX(row.a, row.alpha);
  }

  const std::vector<Axis>& lines_;
  const Pose& home_;
  const double scale_;
  ModifiedDh dh_;
  Pose frame_;  ///< The frame that is being placed, in the base.
  bool own_frame_ = false;
};

double scaleOf(const std::vector<Axis>& axes, const Pose& home) {
  double scale = std::max(1.0, home.p.norm());
  for (const Axis& axis : axes) scale = std::max(scale, axis.point.norm());
  return scale;
}

/// Numbers that are not zero, of the rows and of the translations around them.
int nonZeros(const ModifiedDh& dh) {
  int count = 0;
  for (const ModifiedDhRow& row : dh.rows)
    count += (row.a != 0.0) + (row.alpha != 0.0) + (row.d != 0.0) + (row.theta != 0.0);
  for (int k = 0; k < 3; ++k) count += (dh.base_transform.p[k] != 0.0) + (dh.tool_transform.p[k] != 0.0);
  return count;
}

/// Where the common normal before axis i meets it, in the base: the origin of its frame before theta and d, which the
/// next axis decides.
Vector3 reachedPoint(const ModifiedDh& dh, std::size_t i) {
  Pose X = dh.base_transform;
  for (std::size_t k = 0; k < i; ++k) X = X * dh.link(static_cast<int>(k) + 1, false, 0.0);
  return X * Vector3(dh.rows[i].a, 0.0, 0.0);
}

/// Points through which the line of a prismatic axis may be laid, the more usual ones first.
std::vector<Vector3> candidatePoints(const std::vector<Axis>& lines, const Pose& home, std::size_t i, double scale) {
  const Vector3 reached =
      i == 0 ? Vector3(0.0, 0.0, 0.0) : reachedPoint(TableBuilder(lines, home, scale).build(), i - 1);
  std::vector<Vector3> points{reached, home.p, lines[i].point};
  if (i + 1 == lines.size()) {
    std::swap(points[0], points[1]);
  } else {
    points[1] = lines[i + 1].point;
  }
  if (i + 2 < lines.size()) {
    Pose on_next{Matrix3::Identity(), lines[i + 1].point};
    on_next.R.col(2) = lines[i + 1].direction;
    on_next.R.col(0) = anyPerpendicular(on_next.R.col(2));
    on_next.R.col(1) = on_next.R.col(2).cross(on_next.R.col(0));
    const Line after = seenFrom(on_next, lines[i + 2]);
    if (sineToZ(after) > kDhParallelTolerance) points[1] += footOnZ(after) * lines[i + 1].direction;
  }
  return points;
}

}  // namespace

Pose ModifiedDh::link(int i, bool prismatic, double displacement) const {
  const ModifiedDhRow& row = rows[static_cast<std::size_t>(i - 1)];
  const double turn = prismatic ? 0.0 : displacement;
  const double slide = prismatic ? displacement : 0.0;
  const double ca = std::cos(row.alpha);
  const double sa = std::sin(row.alpha);
  const double ct = std::cos(row.theta + turn);
  const double st = std::sin(row.theta + turn);
  const double d = row.d + slide;
  Pose X;
  X.R << ct, -st, 0.0, st * ca, ct * ca, -sa, st * sa, ct * sa, ca;
  X.p << row.a, -d * sa, d * ca;
  return X;
}

ModifiedDh modifiedDhOf(const std::vector<Axis>& axes, const Pose& home) {
  if (axes.empty()) return {{}, {}, home};
  const double scale = scaleOf(axes, home);
  std::vector<Axis> lines = axes;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (!lines[i].prismatic) continue;
    int fewest = -1;
    Vector3 best = lines[i].point;
    for (const Vector3& point : candidatePoints(lines, home, i, scale)) {
      lines[i].point = point;
      const int count = nonZeros(TableBuilder(lines, home, scale).build());
      if (fewest >= 0 && count >= fewest) continue;
      fewest = count;
      best = point;
    }
    lines[i].point = best;
  }
  return TableBuilder(lines, home, scale).build();
}

std::vector<Axis> axesOf(const ModifiedDh& dh, const std::vector<bool>& prismatic) {
  std::vector<Axis> axes;
  Pose X = dh.base_transform;
  for (std::size_t i = 0; i < dh.rows.size(); ++i) {
    X = X * dh.link(static_cast<int>(i) + 1, prismatic[i], 0.0);
    axes.push_back({prismatic[i], X.R.col(2).normalized(), X.p, static_cast<int>(i), 1.0});
  }
  return axes;
}

Pose homeOf(const ModifiedDh& dh) {
  Pose X = dh.base_transform;
  for (std::size_t i = 0; i < dh.rows.size(); ++i) X = X * dh.link(static_cast<int>(i) + 1, false, 0.0);
  return X * dh.tool_transform;
}

}  // namespace screwline

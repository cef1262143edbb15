#include "screwline/symbolic/drawing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "../kinematics/sampling.h"
#include "drawing_shapes.h"

namespace screwline {
namespace {

constexpr double kSpan = 420.0;       ///< The mechanism's larger side in the drawing.
constexpr double kMargin = 70.0;      ///< Around it, for arrows and labels.
constexpr double kArrow = 58.0;       ///< Length of a frame's axis where it is seen from the side.
constexpr double kRadius = 11.0;      ///< Of a revolute joint's cylinder.
constexpr double kHalfHeight = 15.0;  ///< Of a joint along its axis.
constexpr double kSpacing = 36.0;     ///< Between joints whose frames have one origin.
constexpr int kTrials = 160;
constexpr std::array<double, 4> kTurns = {-0.95, -0.6, -2.2, 0.65};  ///< [rad] views about the vertical.
constexpr std::array<double, 2> kTilts = {0.42, 0.6};                ///< [rad] from above.

/// Rows: what is to the right, down, and towards the eye.
Matrix3 viewOf(double turn, double tilt) {
  const Vector3 towards(std::cos(tilt) * std::cos(turn), std::cos(tilt) * std::sin(turn), std::sin(tilt));
  const Vector3 right = Vector3::UnitZ().cross(towards).normalized();
  Matrix3 view;
  view << right.transpose(), right.cross(towards).transpose(), towards.transpose();
  return view;
}

/// Frames 0..n and the tip, and the way of the links from each to the next.
struct Skeleton {
  std::vector<Pose> frames;                ///< Of the table, 0..n, then the tip's; in the base link.
  std::vector<std::vector<Vector3>> ways;  ///< From frame i to i + 1: along x, then along z.
};

Skeleton skeletonOf(const SerialChain& chain, const VectorX& q) {
  const ModifiedDh& dh = chain.modifiedDh();
  Skeleton skeleton;
  skeleton.frames = {dh.base_transform};
  for (std::size_t i = 0; i < dh.rows.size(); ++i) {
    const Axis& axis = chain.axes()[i];
    const Pose& from = skeleton.frames.back();
    const Pose to = from * dh.link(static_cast<int>(i) + 1, axis.prismatic, axis.multiplier * q[axis.source]);
    const Vector3 corner = from * Vector3(dh.rows[i].a, 0.0, 0.0);
    skeleton.ways.push_back({from.p, corner, to.p});
    skeleton.frames.push_back(to);
  }
  const Pose& last = skeleton.frames.back();
  const Vector3 p = dh.tool_transform.p;
  const Pose tip = last * dh.tool_transform;
  skeleton.ways.push_back({last.p, last * Vector3(p.x(), 0.0, 0.0), last * Vector3(p.x(), p.y(), 0.0), tip.p});
  skeleton.frames.push_back(tip);
  return skeleton;
}

/// Joint values number `trial`: bends away from zero and from right angles, slides drawn out.
VectorX trialValues(const SerialChain& chain, int trial) {
  VectorX q(chain.size());
  for (int i = 0; i < chain.size(); ++i) {
    const double unit = fixedUniform(static_cast<std::uint64_t>(trial) * kMaxJoints + static_cast<std::uint64_t>(i));
    const double sign =
        fixedUniform(static_cast<std::uint64_t>(7000 + trial) * kMaxJoints + static_cast<std::uint64_t>(i)) < 0.5 ? -1.0
                                                                                                                  : 1.0;
    q[i] = chain.joint(i).isRevolute() ? sign * (0.25 + 0.9 * unit)
                                       : (0.35 + 0.4 * unit) * std::max(chain.characteristicLength(), 1e-3);
  }
  return q;
}

double segmentDistance(const DrawingPoint& p, const DrawingPoint& a, const DrawingPoint& b) {
  const DrawingPoint along = b - a;
  const double share = along.squaredNorm() < 1e-18 ? 0.0 : (p - a).dot(along) / along.squaredNorm();
  return (p - a - std::min(1.0, std::max(0.0, share)) * along).norm();
}

/// How far apart the corners are from each other and from the links that do not end there, as a share of the whole;
/// links that are seen from their end count as their length.
double legibility(const Skeleton& skeleton, const Matrix3& view) {
  std::vector<Vector3> corners;
  double size = 0.0;
  for (const auto& way : skeleton.ways) {
    for (const Vector3& p : way) {
      const bool known =
          std::any_of(corners.begin(), corners.end(), [&p](const Vector3& other) { return (p - other).norm() < 1e-9; });
      if (!known) corners.push_back(p);
    }
  }
  for (const Vector3& a : corners) size = std::max(size, (view * (a - corners.front())).head<2>().norm());
  double least = std::numeric_limits<double>::max();
  const auto flat = [&view](const Vector3& p) -> DrawingPoint { return (view * p).head<2>(); };
  for (const Vector3& p : corners) {
    for (const auto& way : skeleton.ways) {
      for (std::size_t k = 0; k + 1 < way.size(); ++k) {
        const double length = (way[k + 1] - way[k]).norm();
        if (length < 1e-9) continue;
        const bool ends_here = (way[k] - p).norm() < 1e-9 || (way[k + 1] - p).norm() < 1e-9;
        const double seen = (flat(way[k + 1]) - flat(way[k])).norm();
        if (seen < 0.4 * length) least = std::min(least, 0.5 * seen);
        if (!ends_here) least = std::min(least, segmentDistance(flat(p), flat(way[k]), flat(way[k + 1])));
      }
    }
  }
  double lowest = 0.0;
  for (const Vector3& p : corners) lowest = std::min(lowest, p.z() - corners.front().z());
  return size <= 0.0 ? 0.0 : (std::min(least, 0.3 * size) + 0.05 * lowest) / size;
}

/// Builds the shapes of one mechanism.
class Draughtsman {
 public:
  Draughtsman(const SerialChain& chain, const SymbolicChain& symbolic) : chain_(chain), symbolic_(symbolic) {
    double best = -std::numeric_limits<double>::max();
    for (int trial = 0; trial < kTrials; ++trial) {
      Skeleton skeleton = skeletonOf(chain, trialValues(chain, trial));
      for (const double turn : kTurns) {
        for (const double tilt : kTilts) {
          const Matrix3 view = viewOf(turn, tilt);
          const double value = legibility(skeleton, view);
          if (value <= best + 1e-9) continue;
          best = value;
          skeleton_ = skeleton;
          view_ = view;
        }
      }
    }
    setScale();
  }

  Drawing draw() {
    drawGround();
    for (const auto& way : skeleton_.ways) drawWay(way);
    drawJoints();
    drawTool();
    drawFrames();
    drawLengths();
    return sheet_.finished(kMargin);
  }

 private:
  void setScale() {
    double width = 0.0;
    for (const auto& way : skeleton_.ways) {
      for (const Vector3& p : way) {
        for (const auto& other : skeleton_.ways)
          width = std::max(width, (view_ * (p - other.front())).head<2>().cwiseAbs().maxCoeff());
      }
    }
    scale_ = width > 1e-9 ? kSpan / width : 1.0;
  }

  DrawingPoint flat(const Vector3& p) const { return scale_ * (view_ * p).head<2>(); }
  /// A direction's shadow at a length in the drawing's own units.
  DrawingPoint shadow(const Vector3& direction, double length) const { return length * (view_ * direction).head<2>(); }

  void drawGround() {
    const Pose& base = skeleton_.frames.front();
    const DrawingPoint foot = flat(base.p) - shadow(Vector3::UnitZ(), 26.0);
    sheet_.line({flat(base.p), foot}, DrawingShape::Colour::kLink, 5.0);
    std::vector<DrawingPoint> plate;
    for (const auto& corner : {std::array<double, 2>{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
      plate.push_back(foot + shadow(Vector3::UnitX(), 26.0 * corner[0]) + shadow(Vector3::UnitY(), 26.0 * corner[1]));
    sheet_.area(plate, DrawingShape::Colour::kGround);
  }

  void drawWay(const std::vector<Vector3>& way) {
    std::vector<DrawingPoint> points;
    for (const Vector3& p : way) points.push_back(flat(p));
    sheet_.line(points, DrawingShape::Colour::kLink, 5.0);
  }

  /// Joints of frames at one place are moved apart along their axes.
  void drawJoints() {
    std::vector<DrawingPoint> taken;
    std::vector<SolidJoint> joints;
    for (std::size_t i = 1; i + 1 < skeleton_.frames.size(); ++i) {
      const Pose& frame = skeleton_.frames[i];
      const bool prismatic = chain_.axes()[i - 1].prismatic;
      const Vector3 z = frame.R.col(2);
      const auto& way = skeleton_.ways[i - 1];
      const DrawingPoint home = prismatic ? flat(0.5 * (way[1] + way[2])) : flat(frame.p);
      DrawingPoint place = home;
      double clearest = -1.0;
      for (const double steps : {0.0, -1.0, 1.0, -2.0, 2.0}) {
        const DrawingPoint tried = home + shadow(z, steps * kSpacing);
        double clear = 1e9;
        for (const DrawingPoint& other : taken) clear = std::min(clear, (tried - other).norm());
        if (clear <= clearest + 1.0) continue;
        clearest = clear;
        place = tried;
        if (clear >= 0.8 * kSpacing) break;
      }
      taken.push_back(place);
      sheet_.line({flat(frame.p), place}, DrawingShape::Colour::kLink, 5.0);
      joints.push_back({place, view_ * z, view_ * frame.R.col(0), (view_ * frame.p).z(), prismatic});
    }
    std::stable_sort(joints.begin(), joints.end(), [](const auto& a, const auto& b) { return a.depth < b.depth; });
    for (const SolidJoint& joint : joints) sheet_.joint(joint, kRadius, kHalfHeight);
  }

  void drawTool() {
    const Pose& tip = skeleton_.frames.back();
    const auto& way = skeleton_.ways.back();
    Vector3 along = Vector3::Zero();
    for (const Vector3& corner : way) along = (tip.p - corner).norm() > 1e-9 ? Vector3(tip.p - corner) : along;
    if (along.norm() < 1e-9) {
      const auto& before = skeleton_.ways[skeleton_.ways.size() - 2];
      for (const Vector3& corner : before) along = (tip.p - corner).norm() > 1e-9 ? Vector3(tip.p - corner) : along;
    }
    if (along.norm() < 1e-9) along = tip.R.col(2);
    along.normalize();
    Vector3 side = along.cross(view_.row(2).transpose());
    side = side.norm() > 1e-6 ? side.normalized() : tip.R.col(1);
    const DrawingPoint p = flat(tip.p);
    for (const double sign : {-1.0, 1.0}) {
      const DrawingPoint palm = p + shadow(side, sign * 8.0);
      sheet_.line({p, palm, palm + shadow(along, 14.0)}, DrawingShape::Colour::kLink, 3.0);
    }
  }

  std::string frameName(std::size_t i) const { return i + 1 == skeleton_.frames.size() ? "T" : std::to_string(i); }

  /// Arrows of the same place and direction are one, with all their names.
  void drawFrames() {
    struct Arrow {
      DrawingPoint from;
      DrawingPoint shadow;
      DrawingShape::Colour colour;
      std::string names;
    };
    std::vector<Arrow> arrows;
    for (std::size_t i = 0; i < skeleton_.frames.size(); ++i) {
      const Pose& frame = skeleton_.frames[i];
      for (const int axis : {2, 0}) {
        const bool z = axis == 2;
        const Arrow arrow{flat(frame.p), shadow(frame.R.col(axis), z ? kArrow : 0.8 * kArrow),
                          z ? DrawingShape::Colour::kAxisZ : DrawingShape::Colour::kAxisX,
                          (z ? "z_" : "x_") + frameName(i)};
        const auto same = std::find_if(arrows.begin(), arrows.end(), [&arrow](const Arrow& other) {
          return (other.from - arrow.from).norm() < 1.0 && (other.shadow - arrow.shadow).norm() < 1.0;
        });
        if (same == arrows.end()) {
          arrows.push_back(arrow);
        } else {
          same->names += " " + arrow.names;
        }
      }
    }
    for (const Arrow& arrow : arrows) sheet_.arrow(arrow.from, arrow.from + arrow.shadow, arrow.colour);
    for (const Arrow& arrow : arrows) sheet_.label(arrow.from + arrow.shadow, arrow.shadow, arrow.names, arrow.colour);
  }

  /// The table's lengths beside the links that they measure.
  void drawLengths() {
    const std::vector<SymbolicDhRow> rows = symbolic_.dhRows();
    const auto label = [this](const Vector3& from, const Vector3& to, const Formula& formula) {
      const DrawingPoint along = flat(to) - flat(from);
      if (along.norm() < 12.0 || formula.isZero()) return;
      const std::string text = write(formula, symbolic_.symbols(), FormulaStyle::kText);
      if (text.size() > 12) return;
      sheet_.label(0.5 * (flat(from) + flat(to)), DrawingPoint(along.y(), -along.x()), withSubscripts(text),
                   DrawingShape::Colour::kLength);
    };
    for (std::size_t i = 0; i < rows.size(); ++i) {
      label(skeleton_.ways[i][0], skeleton_.ways[i][1], rows[i].a);
      label(skeleton_.ways[i][1], skeleton_.ways[i][2], rows[i].d);
    }
    const SymbolicPose tool = symbolic_.toolTransform();
    for (int k = 0; k < 3; ++k)
      label(skeleton_.ways.back()[static_cast<std::size_t>(k)], skeleton_.ways.back()[static_cast<std::size_t>(k + 1)],
            tool.p(k, 0));
  }

  /// "d_3" for "d3".
  static std::string withSubscripts(const std::string& text) {
    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i) {
      const bool digit = text[i] >= '0' && text[i] <= '9';
      const bool letter =
          i > 0 && ((text[i - 1] >= 'a' && text[i - 1] <= 'z') || (text[i - 1] >= 'A' && text[i - 1] <= 'Z'));
      if (digit && letter) result += '_';
      result += text[i];
    }
    return result;
  }

  const SerialChain& chain_;
  const SymbolicChain& symbolic_;
  Skeleton skeleton_;
  Matrix3 view_ = Matrix3::Identity();
  double scale_ = 1.0;
  DrawingSheet sheet_;
};

}  // namespace

Drawing drawingOf(const SerialChain& chain, const SymbolicChain& symbolic) {
  return Draughtsman(chain, symbolic).draw();
}

}  // namespace screwline

#include "arm_curves.h"

#include <algorithm>
#include <cmath>

#include "curve_tracer.h"

namespace screwline {
namespace {

constexpr double kInLine = OrientationProblem::kInLine;
constexpr double kSharp = 1e-2;        // Sine below which joints turn much faster than the arm.
constexpr double kAcrossEvent = 1e-3;  // [rad] of the arm angle on both sides of axes in line.
constexpr int kPieces = 16;
constexpr int kMaxDepth = 60;
constexpr double kMostTurn = 0.25;    // [rad] of the tangent between nodes.
constexpr double kMostSpeedup = 2.5;  // Of the arc over the arm angle.
constexpr double kMostStep = 1.5;     // [rad]
constexpr double kShortest = 1e-9;    // [rad] Speeds tell no shorter step.
constexpr double kMostOff = 0.1;      // Of a step, of what speeds tell.
constexpr int kCircleNodes = 16;

enum Line { kShoulder = 1, kWrist = 2 };
constexpr int kBoth = kShoulder | kWrist;

/// Values of the arm angle at which axes are in line, or nearest to it.
struct Event {
  double angle = 0.0;
  double sine = 0.0;  ///< Between the axes there.
  int in_line = 0;    ///< Bits of Line.
};

/// A solution circle of one elbow.
class Circle {
 public:
  Circle(PoseCurve& pose, std::shared_ptr<const ArmPose> arm, std::size_t elbow, SelfMotionSet& set)
      : pose_(pose), arm_(std::move(arm)), place_(elbow), set_(set) {}

  void add() {
    const double in_line = elbow().straight ? ArmPose::kFlat : kInLine;
    for (Line line : {kShoulder, kWrist}) {
      if (sideOf(line).tilt() <= in_line) {
        always_ |= line;
      } else {
        addEvents(line);
      }
    }
    std::sort(events_.begin(), events_.end(), [](const Event& a, const Event& b) { return a.angle < b.angle; });
    joinEvents();
    if (hasUntold()) {
      set_.complete = false;
      set_.note = "shoulder and wrist are almost in line at once beside a straight elbow";
    }
    if (always_ != 0) {
      isInLine(always_) ? addAlways() : addFlat();
    } else {
      addWays();
    }
    for (const Event& event : events_) addCrossing(event);
  }

 private:
  const ArmPose::Elbow& elbow() const { return arm_->elbows()[place_]; }

  const ArmPose::Side& sideOf(Line line) const { return line == kShoulder ? elbow().shoulder : elbow().wrist; }

  /// All along the circle, to rounding.
  bool isInLine(int lines) const {
    const auto in_line = [&](Line line) { return (lines & line) == 0 || sideOf(line).tilt() <= kInLine; };
    return in_line(kShoulder) && in_line(kWrist);
  }

  /// Where both groups are almost in line at once, a straight elbow's bend makes surfaces that are not told: the turns
  /// of either leave the surface of the other's, or they cross at an event.
  bool hasUntold() const {
    if (!elbow().straight) return false;
    if (always_ == kBoth) return !isInLine(kBoth);
    return std::any_of(events_.begin(), events_.end(), [&](const Event& event) {
      return event.in_line != kBoth && outOfLine(event.angle, kBoth) <= ArmPose::kFlat;
    });
  }

  void addEvents(Line line) {
    for (double angle : ArmPose::extremes(sideOf(line))) {
      const double sine = ArmPose::outOfLine(sideOf(line), angle);
      events_.push_back({angle, sine, sine <= kInLine ? line : 0});
    }
  }

  /// Both groups in line at one angle to rounding are one event.
  void joinEvents() {
    for (std::size_t i = 0; i + 1 < events_.size();) {
      Event& a = events_[i];
      const Event& b = events_[i + 1];
      const bool both = a.in_line != 0 && b.in_line != 0 && outOfLine(a.angle, b.in_line) <= kInLine;
      if (both || b.angle == a.angle) {
        a.in_line |= b.in_line;
        a.sine = std::min(a.sine, b.sine);
        events_.erase(events_.begin() + static_cast<std::ptrdiff_t>(i) + 1);
      } else {
        ++i;
      }
    }
  }

  double outOfLine(double angle, int line) const {
    double sine = 0.0;
    for (Line one : {kShoulder, kWrist}) {
      if ((line & one) != 0) sine = std::max(sine, ArmPose::outOfLine(sideOf(one), angle));
    }
    return sine;
  }

  /// Half of what lies between an event and others at which joints turn fast, at most kAcrossEvent.
  double besideOf(const Event& event) const {
    double beside = kAcrossEvent;
    for (const Event& other : events_) {
      if (&other == &event || other.sine > kSharp) continue;
      beside = std::min(beside, 0.5 * std::abs(std::remainder(other.angle - event.angle, kTwoPi)));
    }
    return beside;
  }

  bool inGap(double angle) const {
    return std::any_of(events_.begin(), events_.end(), [&](const Event& event) {
      return event.in_line != 0 && std::abs(std::remainder(angle - event.angle, kTwoPi)) < besideOf(event);
    });
  }

  /// Arm angles of nodes over one turn, from the start; where axes come into line, the gap behind which ways change.
  struct Stop {
    double angle = 0.0;
    int changes = 0;  ///< Bits of Line, on the way to the next stop.
  };
  std::vector<Stop> stops() const {
    std::vector<Stop> stops;
    const auto first = std::find_if(events_.begin(), events_.end(), [](const Event& e) { return e.in_line != 0; });
    const double start = first == events_.end() ? -kPi : first->angle + besideOf(*first);
    const auto after = [start](double angle) {
      return start + (angle - start) - kTwoPi * std::floor((angle - start) / kTwoPi);
    };
    for (int i = 0; i < kPieces; ++i) {
      const double angle = start + i * kTwoPi / kPieces;
      if (i == 0 || !inGap(angle)) stops.push_back({angle, 0});
    }
    for (const Event& event : events_) {
      if (event.in_line == 0) {
        if (!inGap(event.angle)) stops.push_back({after(event.angle), 0});
        continue;
      }
      const double beside = besideOf(event);
      stops.push_back({after(event.angle - beside), event.in_line});
      if (&event != &*first) stops.push_back({after(event.angle + beside), 0});
    }
    std::sort(stops.begin(), stops.end(), [](const Stop& a, const Stop& b) { return a.angle < b.angle; });
    stops.push_back({start + kTwoPi, 0});
    return stops;
  }

  void addWays() {
    const std::vector<Stop> all = stops();
    std::vector<ArmSigns> done;
    for (const ArmSigns& way : {ArmSigns{1, 1}, ArmSigns{1, -1}, ArmSigns{-1, 1}, ArmSigns{-1, -1}}) {
      if (std::find(done.begin(), done.end(), way) != done.end()) continue;
      SelfMotionCurve curve;
      ArmSigns signs = way;
      curve.nodes.push_back(node(all.front().angle, &signs, Vector7::Zero()));
      double turns = 0.0;
      do {
        done.push_back(signs);
        for (std::size_t i = 0; i + 1 < all.size(); ++i) {
          const double angle = turns + all[i + 1].angle;
          if (all[i].changes == 0) {
            refine(curve.nodes.back(), node(angle, &signs, curve.nodes.back().q), signs, 0, curve.nodes);
            continue;
          }
          if ((all[i].changes & kShoulder) != 0) signs.shoulder = -signs.shoulder;
          if ((all[i].changes & kWrist) != 0) signs.wrist = -signs.wrist;
          const SelfMotionNode& before = curve.nodes.back();
          const double share = 0.5 * (angle - before.angle) / before.angle_rate;
          curve.crossings.push_back(before.q + share * before.tangent);
          append(node(angle, nullptr, before.q + 2.0 * share * before.tangent), curve.nodes);
        }
        turns += kTwoPi;
      } while (!(signs == way) && turns < 5.0 * kTwoPi);
      curve.closed = true;
      set_.curves.push_back(std::move(curve));
    }
  }

  SelfMotionNode node(double angle, const ArmSigns* signs, const Vector7& near) const {
    SelfMotionNode result;
    arm_->at(elbow(), angle, signs, near, result);
    result.gain = pose_.gainAt(result.q);
    return result;
  }

  /// Nodes behind `a` up to `b`, so near that joints follow the tangents at their ends.
  void refine(const SelfMotionNode& a, const SelfMotionNode& b, const ArmSigns& signs, int depth,
              std::vector<SelfMotionNode>& nodes) const {
    const double turn = b.angle - a.angle;
    const Vector7 step = pose_.difference(a.q, b.q);
    const Vector7 told = 0.5 * turn * (a.tangent / a.angle_rate + b.tangent / b.angle_rate);
    const double speedup = a.angle_rate / b.angle_rate;
    const bool fine = a.tangent.dot(b.tangent) >= std::cos(kMostTurn) && speedup <= kMostSpeedup &&
                      speedup >= 1.0 / kMostSpeedup && step.norm() <= kMostStep &&
                      (step - told).norm() <= kMostOff * step.norm();
    if (fine || step.norm() <= kShortest || depth >= kMaxDepth || nodes.size() >= kMaxCurveNodes) {
      append(b, nodes);
      return;
    }
    const SelfMotionNode from = a;  // `nodes` may move.
    const SelfMotionNode middle = node(0.5 * (a.angle + b.angle), &signs, a.q);
    refine(from, middle, signs, depth + 1, nodes);
    refine(nodes.back(), b, signs, depth + 1, nodes);
  }

  void append(SelfMotionNode next, std::vector<SelfMotionNode>& nodes) const {
    const SelfMotionNode& last = nodes.back();
    const Vector7 step = pose_.difference(last.q, next.q);
    const double turn = std::acos(std::clamp(next.tangent.dot(last.tangent), -1.0, 1.0));
    next.q = last.q + step;
    next.arc = last.arc + step.norm() * (1.0 + turn * turn / 24.0);
    nodes.push_back(next);
  }

  /// Solutions at the angle at which axes are in line: circles on which two joints turn against each other, or sheets.
  void addCrossing(const Event& event) {
    if (event.in_line == 0) return;
    if ((event.in_line | always_) == kBoth) {
      addSheet({0, 4}, {1, 1}, [angle = event.angle](const Vector7&) { return angle; });
      return;
    }
    for (int sign : {1, -1}) addCircle(event.angle, {sign, sign}, event.in_line == kShoulder ? 0 : 4);
  }

  void addCircle(double angle, const ArmSigns& signs, int first) {
    SelfMotionCurve curve;
    Vector7 wished = Vector7::Zero();
    for (int i = 0; i <= kCircleNodes; ++i) {
      SelfMotionNode node;
      wished[first] = i * kTwoPi / kCircleNodes;
      arm_->solve(elbow(), angle, &signs, wished, node.q);
      wished = node.q;
      curve.nodes.push_back(node);
    }
    Vector7 tangent = curve.nodes[1].q - curve.nodes[0].q;
    for (std::size_t i = 0; i < curve.nodes.size(); ++i) {
      curve.nodes[i].tangent = tangent.normalized();
      curve.nodes[i].arc = static_cast<double>(i) * tangent.norm();
      curve.nodes[i].gain = pose_.gainAt(curve.nodes[i].q);
    }
    curve.closed = true;
    set_.curves.push_back(std::move(curve));
  }

  /// Axes in line all along the circle: the turns of two joints tell the arm angle, the other group follows.
  void addAlways() {
    const bool shoulder = (always_ & kShoulder) != 0;
    const bool both = always_ == kBoth;
    std::vector<int> free = shoulder ? std::vector<int>{0, 2} : std::vector<int>{4, 6};
    if (both) free.push_back(4);
    const auto angleOf = [arm = arm_, place = place_, shoulder](const Vector7& q) {
      return arm->angleOf(arm->elbows()[place], shoulder, q);
    };
    for (int sign : {1, -1}) {
      if (!both || sign > 0) addSheet(free, {sign, sign}, angleOf);
    }
  }

  /// Axes almost in line beside a straight elbow: by as little as rounding leaves it bent the line comes to where any
  /// two turns of the group have it.
  void addFlat() {
    const bool shoulder = (always_ & kShoulder) != 0;
    const std::vector<int> free = shoulder ? std::vector<int>{0, 2} : std::vector<int>{4, 6};
    for (int sign : {1, -1}) {
      const ArmSigns signs = shoulder ? ArmSigns{0, sign} : ArmSigns{sign, 0};
      Vector7 member;
      arm_->solve(elbow(), 0.0, &signs, Vector7::Zero(), member);
      set_.sheets.push_back(
          {member, free, false, "", [arm = arm_, place = place_, signs, shoulder](const VectorX& wished, VectorX& q) {
             const Vector7 near = wished;
             const std::optional<ArmPose::Elbow> bent = arm->bentFor(arm->elbows()[place], shoulder, near);
             if (!bent) return false;
             Vector7 found;
             arm->solve(*bent, arm->angleOf(*bent, shoulder, near), &signs, near, found);
             q = found;
             return true;
           }});
    }
  }

  template <typename AngleOf>
  void addSheet(const std::vector<int>& free, const ArmSigns& signs, const AngleOf& angle_of) {
    SelfMotionSheet sheet;
    sheet.free = free;
    sheet.member_at = [arm = arm_, place = place_, signs, angle_of](const VectorX& wished, VectorX& q) {
      const Vector7 near = wished;
      Vector7 member;
      arm->solve(arm->elbows()[place], angle_of(near), &signs, near, member);
      q = member;
      return true;
    };
    VectorX q;
    sheet.member_at(VectorX::Zero(kRedundantJoints), q);
    sheet.member = q;
    set_.sheets.push_back(std::move(sheet));
  }

  PoseCurve& pose_;
  std::shared_ptr<const ArmPose> arm_;
  std::size_t place_;
  SelfMotionSet& set_;
  int always_ = 0;  ///< Bits of Line: groups in line all along the circle.
  std::vector<Event> events_;
};

}  // namespace

void addArmCurves(PoseCurve& pose, const std::shared_ptr<const ArmPose>& arm, SelfMotionSet& set) {
  for (std::size_t i = 0; i < arm->elbows().size(); ++i) Circle(pose, arm, i, set).add();
}

}  // namespace screwline

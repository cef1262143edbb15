#ifndef SCREWLINE_IK_CLOSED_FORM_POSITION_PROBLEM_H
#define SCREWLINE_IK_CLOSED_FORM_POSITION_PROBLEM_H

#include <array>
#include <optional>

#include "screwline/ik/closed_form/roots.h"
#include "screwline/model/joint.h"
#include "screwline/spatial/turn_batch.h"

namespace screwline {

/// One way to bring the point to its goal.
struct PositionSolution {
  std::array<double, 3> q{};   ///< Displacements of the three axes.
  std::array<Turn, 3> turn{};  ///< The same of revolute axes; prismatic ones do not turn.
  std::array<bool, 3>
      free{};  ///< Any value of this axis does (the others' may depend on it): `q` holds the preferred one.
  std::array<int, 2>
      sign{};    ///< Which root of the eliminant, which sign of the square root; 0: two meet, or there is one only.
  int rank = 0;  ///< Counts eliminant roots of equal slope, where there can be more than one.
};

struct PositionSolutions {
  std::array<PositionSolution, 4> solutions;
  int count = 0;

  void add(const PositionSolution& solution) { solutions[static_cast<std::size_t>(count++)] = solution; }
  const PositionSolution* begin() const { return solutions.data(); }
  const PositionSolution* end() const { return solutions.data() + count; }
};

/// Which equation is left, and so what its roots mean.
enum class PositionKind {
  kArmPlane,        ///< R R R, axes 2 and 3 parallel, axis 1 across them: as kMeetingAxes. Most industrial arms.
  kMeetingAxes,     ///< R R x, axes 1 and 2 meet: sign 0 is the third axis', sign 1 the side of axis 1 (shoulder).
  kParallelAxes,    ///< R R x, axes 1 and 2 parallel: sign 0 is the third axis', sign 1 that of the two-link triangle.
  kSkewAxes,        ///< R R x in general: a quartic in the third.
  kTurnAndSlide,    ///< R P x, the slide not across axis 1: an equation in the third.
  kSlideAcross,     ///< R P x, the slide across axis 1: sign 0 is the third axis', sign 1 the slide's.
  kSlideTurnSlide,  ///< P R P: a quadratic.
  kThreeSlides,     ///< P P P: linear.
};

/// What the three axes share, folded in once. Axes stand in the order of elimination.
struct PositionGeometry {
  PositionKind kind = PositionKind::kThreeSlides;
  bool reversed =
      false;  ///< The axes were taken from the last to the first, start and goal exchanged, displacements negated.
  double length = 1.0;  ///< [m] the chain's size.
  std::array<Axis, 3> axes;
  Vector3 x1 = Vector3::UnitX();  ///< x1, y1: across axis 1.
  Vector3 y1 = Vector3::UnitY();
  Vector3 ex = Vector3::UnitX();  ///< ex, ey: across axis 2, along the tilt of axis 1 and along the common normal.
  Vector3 ey = Vector3::UnitY();
  double cosine = 1.0;  ///< Of the angle between axes 1 and 2.
  double sine = 0.0;
  double offset = 0.0;  ///< [m] of axis 2 from axis 1, along ey.
  /// kArmPlane: axis 3 from axis 2 in the plane of ex and ey, and which way axis 3 turns in it.
  double link_x = 0.0;
  double link_y = 0.0;
  double link = 0.0;  ///< [m] its length.
  double third_sense = 1.0;
};

/// J1(q1) J2(q2) J3(q3) start = goal for three axes, revolute or prismatic in any order: Pieper's problem. The first
/// axis is eliminated by what it cannot change (the goal's height along it and distance from it; or the two coordinates
/// across a slide), the second by the length of what it turns; one equation in the third is left: a sinusoid, a
/// quadratic, or, in general, a quartic (Pieper 1968; Craig, ch. 4.6; the cases are those of Elias & Wen's subproblems
/// 3 to 5). All in cosines and sines: the angles are taken at the end. Constants are folded in once; solving allocates
/// nothing.
class PositionProblem {
 public:
  /// `length` [m] is the chain's size, by which distances count as zero. Empty where the axes cannot solve a position
  /// in general.
  static std::optional<PositionProblem> compile(const std::array<Axis, 3>& axes, double length);

  /// All solutions. `preferred` gives values for axes that turn out free. Returns in `solutions`.
  void solve(const Vector3& start, const Vector3& goal, const std::array<double, 3>& preferred,
             PositionSolutions& solutions) const;

  /// The same in turns: `q` holds displacements of slides and values of free axes alone, until takeFrom() has the
  /// angles of addTurns().
  void solveInTurns(const Vector3& start, const Vector3& goal, const std::array<double, 3>& preferred,
                    PositionSolutions& solutions) const;
  /// One step of Newton's method on a solution without free axes, not on its `q` of turns; nothing where the three axes
  /// are singular. Returns what rounding leaves [rad, m].
  double refine(const Vector3& start, const Vector3& goal, PositionSolution& solution) const;
  /// At most 12. @pre the batch is empty.
  void addTurns(const PositionSolutions& solutions, TurnBatch& batch) const;
  void takeFrom(const TurnBatch& batch, PositionSolutions& solutions) const;

  PositionKind kind() const { return geometry_.kind; }
  const PositionGeometry& geometry() const { return geometry_; }

 private:
  /// Whether q is the angle of the turn: a free axis keeps the preferred value, not that value modulo a full turn.
  bool isAngle(const PositionSolution& solution, std::size_t axis) const {
    return !axisOf(axis).prismatic && !solution.free[axis];
  }
  /// As it stands in the chain.
  const Axis& axisOf(std::size_t axis) const { return geometry_.axes[geometry_.reversed ? 2 - axis : axis]; }

  PositionGeometry geometry_;
};

}  // namespace screwline

#endif  // SCREWLINE_IK_CLOSED_FORM_POSITION_PROBLEM_H

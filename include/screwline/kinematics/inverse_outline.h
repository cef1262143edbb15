#ifndef SCREWLINE_KINEMATICS_INVERSE_OUTLINE_H
#define SCREWLINE_KINEMATICS_INVERSE_OUTLINE_H

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "screwline/spatial/pose.h"

namespace screwline {

/// Into which small problems a closed form takes inverse kinematics apart, and in which order.
enum class InverseShape {
  kPosition,     ///< A point moved by three axes.
  kOrientation,  ///< Three turns.
  kWrist,        ///< The point where the last three axes meet by the first three, then an orientation by the last.
  kShoulder,     ///< The same from the tip: the first three axes meet.
  kHeading,      ///< A heading by the last turn, a point by the others.
  kParallel,     ///< Three neighbouring parallel axes: a height, a direction, a plane.
};

/// What a solver's plan does, for whoever writes it down as formulas.
struct InverseOutline {
  InverseShape shape = InverseShape::kPosition;
  bool has_position = false;                  ///< Not where only directions are asked for.
  std::array<int, 3> position{{-1, -1, -1}};  ///< Joints of the position problem, base to tip of the problem; -1: a row
                                              ///< that the task leaves open, a slide along it (ascending, first).
  int spherical_first = 0;                    ///< First joint of the orientation.
  int heading_joint = -1;
  int heading_row = 2;          ///< Base axis 0, 1, 2 that the heading is about.
  bool turning_slides = false;  ///< Slides behind the heading joint turn with it.
  /// kParallel: places counted from the base, or from the tip where `reversed`.
  bool reversed = false;
  int first_parallel = 0;
  int single = 0;
  int pair = 0;  ///< First of the two.
  /// The first or the last joint, of which the value is given; -1: none. All numbers above count the others only.
  int given = -1;
  /// 0, 1, 2: the axis x, y, z of the tool about which the task lets it turn: one joint more, behind the others. -1:
  /// none.
  int tool_turn = -1;
  int open_joint = -1;  ///< The joint that turns the tool so and does nothing else: any value does. -1: none.
};

/// All solutions of a pose, limits not looked at. Where the value of a joint is given it is that in `given` (n values).
using InverseSolver = std::function<std::vector<VectorX>(const Pose& target, const VectorX& given)>;

/// A solver as it is written about.
struct InverseMethod {
  std::vector<std::string> summary;       ///< For people, a line each; empty: nothing is known.
  std::optional<InverseOutline> outline;  ///< Empty where it has no closed form.
  InverseSolver solver;                   ///< What formulas are compared with; empty: they are not.
};

}  // namespace screwline

#endif  // SCREWLINE_KINEMATICS_INVERSE_OUTLINE_H

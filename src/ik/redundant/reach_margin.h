#ifndef SCREWLINE_SRC_IK_REDUNDANT_REACH_MARGIN_H
#define SCREWLINE_SRC_IK_REDUNDANT_REACH_MARGIN_H

#include <functional>
#include <optional>
#include <vector>

#include "screwline/ik/closed_form/position_problem.h"
#include "screwline/ik/redundant/redundant_solver.h"

namespace screwline {

/// How far the point where three axes meet is within reach of the three others, as a function of the parameter joint:
/// where that has a maximum just above zero, a curve may be too short in the parameter to be met by slices (an arm
/// almost straight). For turns of which the first two meet or are parallel, and a parameter joint at an end.
class ReachMargin {
 public:
  static std::optional<ReachMargin> compile(const SerialChain& chain, int parameter);

  /// Values of the parameter joint where the margin has a local maximum that is not negative.
  std::vector<double> maxima(const Pose& target, double first, double last, int samples) const;

  /// A function's value, and its slope by the parameter joint.
  struct Dual {
    double value = 0.0;
    double slope = 0.0;
  };

 private:
  struct Goal {
    Vector3 point;
    Vector3 rate;  ///< By the parameter joint.
  };

  Goal goalAt(const Pose& target, double value) const;
  /// In units of the chain's length; `side` chooses the root of the third axis.
  Dual at(const Pose& target, double value, double side) const;

  PositionGeometry geometry_;
  Vector3 center_;
  Pose home_;
  Vector6 parameter_;  ///< Screw of that joint; in the base frame where it is the first, in the tip's where the last.
  bool first_ = true;  ///< The parameter joint is the first.
  bool wrist_ = true;  ///< The axes that meet are the last; else the first.
};

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_REDUNDANT_REACH_MARGIN_H

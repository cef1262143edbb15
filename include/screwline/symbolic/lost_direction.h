#ifndef SCREWLINE_SYMBOLIC_LOST_DIRECTION_H
#define SCREWLINE_SYMBOLIC_LOST_DIRECTION_H

#include <vector>

#include "screwline/model/serial_chain.h"
#include "screwline/model/task.h"
#include "screwline/symbolic/symbolic_chain.h"

namespace screwline {

/// A motion of the tip's link that no joint rates give where a condition holds: f . v + n . w = 0 for the velocity v of
/// the link's point at the origin of frame `point` and the angular velocity w, all in the axes of frame `axes`. Where n
/// is zero the point does not move along f; where f is, the link does not turn about n. Their length means nothing.
struct LostDirection {
  FrameNumber point = 0;
  FrameNumber axes = 0;
  FormulaMatrix f;        ///< 3 x 1
  FormulaMatrix n;        ///< 3 x 1
  bool at_rest = false;   ///< Of a wrist: f is left out, the rotation about n is lost while the point is at rest.
  FormulaMatrix in_base;  ///< The one of the two that is not zero, in the base's axes; no rows where both are not.

  bool isTranslation() const;  ///< n is zero.
  bool isRotation() const;     ///< f is zero.
};

/// What a condition costs, where it holds alone.
struct ConditionLoss {
  std::vector<int> ranks;                 ///< Of the task where it holds, otherwise anywhere; empty: nowhere found.
  std::vector<LostDirection> directions;  ///< rows - the largest of `ranks`; empty where no short formulas are found.
  double deviation = 0.0;                 ///< The largest of |l J| over |l| |J| at such configurations, l = [f; n].
};

/// For each of conditionsOf(symbolic, chain, task). A direction is written at the point and in the axes where it has
/// fewest entries; there it is made of minors of the Jacobian, with all that contains the condition's factor left out,
/// and compared with the numeric Jacobian before it is given. Rows about the tool's axes are like any others: what they
/// lose is a motion that they ask for. Allocates. @throws DerivationStopped
std::vector<ConditionLoss> lossesOf(const SymbolicChain& symbolic, const SerialChain& chain, const Task& task);

/// Conditions that hold together.
struct ConditionMeeting {
  std::vector<std::size_t> conditions;  ///< By number in conditionsOf().
  std::vector<Formula> others;          ///< More left sides that are zero, which are no factors of the determinant.
  ConditionLoss loss;                   ///< No directions where fewer of the conditions leave the same rank.
};

/// Each pair of conditions, and all of them where there are more than two; then what else lowers the rank further where
/// one or two of them hold, or, where the task is not square, two or three conditions that do it together
/// (singular_sets.h). @throws DerivationStopped
std::vector<ConditionMeeting> meetingsOf(const SymbolicChain& symbolic, const SerialChain& chain, const Task& task);

}  // namespace screwline

#endif  // SCREWLINE_SYMBOLIC_LOST_DIRECTION_H

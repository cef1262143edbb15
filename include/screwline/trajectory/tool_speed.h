#ifndef SCREWLINE_TRAJECTORY_TOOL_SPEED_H
#define SCREWLINE_TRAJECTORY_TOOL_SPEED_H

#include "screwline/model/serial_chain.h"
#include "screwline/trajectory/path.h"
#include "screwline/trajectory/retime.h"

namespace screwline {

/// The speed of the tip's origin along a joint path, |dp/du|, bounded from above between any two places: by its values
/// at both ends of an interval and a bound of the third derivative of p over it, halved until that adds less than
/// 1e-4. The bound follows from reaches: a derivative of p by joint values is never longer than the way from the
/// innermost of these joints to the tip can be.
class ToolSpeed {
 public:
  /// Both have to outlive it. @pre path has the chain's joints.
  ToolSpeed(const SerialChain& chain, const JointPath& path);

  /// [m per u] No less than |dp/du| anywhere on [from, to] and, but where the tip all but rests, at most 1e-4 of the
  /// largest more.
  double greatest(double from, double to) const;

 private:
  double at(double u) const;
  double thirdDerivative(double from, double to) const;
  double onInterval(double from, double at_from, double to, double at_to, int halvings) const;

  const SerialChain& chain_;
  const JointPath& path_;
  double reach_ = 0.0;  ///< [m] Bounds every derivative of p by joint values (by m: without unit).
  VectorX weights_;     ///< How far a joint's axes turn, all of its mimics together, for one unit of it.
  double least_ = 0.0;  ///< [m per u] Below it the tip rests.
};

/// For retime(): the rates at which the tip keeps below a speed [m/s] > 0. Both have to outlive it.
RateBound toolSpeedBound(const SerialChain& chain, const JointPath& path, double speed);

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_TOOL_SPEED_H

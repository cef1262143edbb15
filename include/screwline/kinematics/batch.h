#ifndef SCREWLINE_KINEMATICS_BATCH_H
#define SCREWLINE_KINEMATICS_BATCH_H

#include <cstddef>
#include <functional>

#include "screwline/model/serial_chain.h"

namespace screwline {

/// Numbers of a pose in a row of a batch: x y z [m], then the unit quaternion qx qy qz qw.
constexpr int kPoseNumbers = 7;

/// What a batch is asked for: `count` configurations and where the answers go, rows one after another. Null: not
/// wanted. Arrays may not overlap; no alignment is needed.
struct ForwardBatch {
  const double* positions = nullptr;  ///< count x n [rad, m], joints base to tip.
  std::size_t count = 0;
  double* poses = nullptr;  ///< count x 7. qw >= 0; where it is 0 (half a turn) the one of qx qy qz that dominates
                            ///< is positive. The same rotation matrix always gives the same quaternion.
  Pose* frames = nullptr;   ///< count, X_BT.
  double* jacobians =
      nullptr;  ///< count x 6 x n, each row-major: the geometric Jacobian [v; w], as geometricJacobian().
};

struct BatchOptions {
  int threads = 1;  ///< At most; few rows are not shared among many. 0: as many as cores.
  /// Asked by the calling thread between pieces of about a thousand rows; true: no further piece is begun. May be
  /// empty.
  std::function<bool()> cancelled;
  int lanes = 0;  ///< Configurations computed at once: 2, 4 or 8; 0, and what the processor lacks: as many as it has.
};

/// Forward kinematics and geometric Jacobian of many configurations, computed side by side. Within 1e-14 of
/// forwardKinematics() and geometricJacobian() for a chain of lengths about 1 m; a row's answer is the same bytes
/// wherever it stands in the batch and however many threads there are (with other `lanes` the last bits may differ).
/// Quaternions are unit within rounding, and as accurate near half a turn as elsewhere. False: cancelled, and what
/// the arrays hold is not defined. Nothing is allocated per configuration; with one thread, nothing at all.
/// @pre q finite and within +-kMaxMagnitude (not checked here).
bool forwardBatch(const SerialChain& chain, const ForwardBatch& batch, const BatchOptions& options = {});

}  // namespace screwline

#endif  // SCREWLINE_KINEMATICS_BATCH_H

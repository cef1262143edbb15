#include "turn_in_place.h"

#include "screwline/ik/task_error.h"
#include "screwline/kinematics/forward.h"

namespace screwline {

bool keepsPose(const SerialChain& chain, const Task& task, const VectorX& from, const VectorX& to, double tolerance) {
  constexpr int kPlaces = 16;
  const Pose X = forwardKinematics(chain, from);
  for (int k = 1; k <= kPlaces; ++k) {
    const VectorX q = from + (to - from) * k / kPlaces;
    const TaskError error = taskError(task, X, forwardKinematics(chain, q));
    if (!(error.position <= tolerance && error.orientation <= tolerance)) return false;
  }
  return true;
}

PiecewisePolynomial turnInPlace(const VectorX& from, const VectorX& to, double u) {
  const int n = static_cast<int>(from.size());
  PiecewisePolynomial turn(n + 1, 5, {0.0, (to - from).norm()}, 2);
  for (int i = 0; i < n; ++i) {
    turn.at(0, 0, i) = from[i];
    turn.at(0, 1, i) = to[i] - from[i];
  }
  turn.at(0, 0, n) = u;
  return turn;
}

}  // namespace screwline

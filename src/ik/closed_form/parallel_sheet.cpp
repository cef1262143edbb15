#include "screwline/ik/closed_form/parallel_sheet.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "screwline/spatial/rotation.h"
#include "screwline/spatial/turn_batch.h"

namespace screwline {
namespace {

double lengthOf(const Turn& place) {
  return std::hypot(place.c, place.s);
}

std::size_t lowestBit(unsigned bits) {
  std::size_t place = 0;
  while ((bits >> place & 1U) == 0U) ++place;
  return place;
}

}  // namespace

ParallelSheet::ParallelSheet(const PlanarProblem& plane, double length, const PlaneJoints& joints, const Circle& circle,
                             const PlanSolution& fixed)
    : plane_(&plane), length_(length), joints_(joints), circle_(circle), fixed_(fixed), free_(lowestBit(fixed.free)) {}

/// By the angle from where the place is farthest: distance^2 = far^2 - 4 m r sin^2(angle / 2)
/// = near^2 + 4 m r cos^2(angle / 2) with the lengths m, r of middle and radius; so tan(angle / 2) is known.
std::vector<SheetStretch> ParallelSheet::stretches() const {
  const double m = lengthOf(circle_.middle);
  const double r = lengthOf(circle_.radius);
  const double far = m + r;
  const double near = std::abs(m - r);
  const double most = plane_->most();
  const double least = plane_->least();
  const double exact = PlanarProblem::kNoSlack * length_;
  if (far < least - exact || near > most + exact) return {};
  const double farthest = circle_.sense * (circle_.middle * circle_.radius.inverse()).angle();
  const bool all_straight = (near >= most - exact && far <= most + exact) || far <= least + exact;
  if (all_straight && near >= least - exact) return {{farthest, farthest + kTwoPi, false, false, true, true}};
  if (near >= most - exact) return {{farthest + kPi, farthest + kPi, false, false, true}};
  if (far <= least + exact) return {{farthest, farthest, false, false, true}};
  const bool is_stretched = far >= most - exact;
  const bool is_folded = near <= least + exact;
  const bool touches_most = far <= most + exact;
  const bool touches_least = near >= least - exact;
  const auto angleAt = [&](double distance) {
    const auto root = [](double a, double b) { return std::sqrt(std::max(0.0, (a - b) * (a + b))); };
    return 2.0 * std::atan2(root(far, distance), root(distance, near));
  };
  const double first = touches_most ? 0.0 : angleAt(most);
  const double last = touches_least ? kPi : angleAt(least);
  if (!is_stretched && !is_folded) return {{farthest, farthest + kTwoPi, false, false, false, true}};
  if (!is_folded) return {{farthest + first, farthest + kTwoPi - first, touches_most, touches_most}};
  if (!is_stretched) return {{farthest - last, farthest + last, touches_least, touches_least}};
  return {{farthest + first, farthest + last, touches_most, touches_least},
          {farthest + kTwoPi - last, farthest + kTwoPi - first, touches_least, touches_most}};
}

PlanSolution ParallelSheet::member(double value, int elbow) const {
  const Turn turn = turnBy(circle_.sense * value);
  const Turn round = circle_.radius * turn;
  PlanarSolutions planes;
  // At the ends of stretches rounding decides which side of them a value is on.
  plane_->solve(circle_.middle.c + round.c, circle_.middle.s + round.s, circle_.heading * turn,
                std::numeric_limits<double>::infinity(), 0.0, planes);
  const PlanarSolution& plane = planes.solutions[planes.count == 2 && elbow < 0 ? 1 : 0];
  TurnBatch batch;
  for (const Turn& one : plane.turns) batch.add(one);
  batch.takeAngles();
  PlanSolution solution = fixed_;
  solution.q[free_] = value;
  for (std::size_t i = 0; i < 3; ++i) solution.q[joints_.joint[i]] = joints_.sense[i] * batch[i];
  solution.sign[1] = plane.sign;
  return solution;
}

}  // namespace screwline

#ifndef SCREWLINE_SRC_IK_ALGEBRAIC_THREE_SLIDES_H
#define SCREWLINE_SRC_IK_ALGEBRAIC_THREE_SLIDES_H

#include <optional>

#include "root_refiner.h"
#include "screwline/ik/closed_form/orientation_problem.h"

namespace screwline {

/// Three turns and three slides in any order: the turns alone make the orientation, two ways at most; then the position
/// is linear in the slides.
class ThreeSlides {
 public:
  /// Empty where the chain has not three slides, or where they or the turns never span three dimensions.
  static std::optional<ThreeSlides> compile(const SerialChain& chain);

  /// Adds what it finds; false where a continuum passes through the pose. No allocation.
  bool solve(const SerialChain& chain, const Pose& target, RootRefiner& refiner) const;

 private:
  explicit ThreeSlides(const OrientationProblem& orientation) : orientation_(orientation) {}
  bool setSlides(const SerialChain& chain, const Pose& target, Vector6& q) const;

  OrientationProblem orientation_;
  Matrix3 home_turned_back_;
  std::array<int, 3> turns_{};
};

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_ALGEBRAIC_THREE_SLIDES_H

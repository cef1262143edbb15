#ifndef SCREWLINE_SRC_IK_ALGEBRAIC_HIDDEN_TURN_H
#define SCREWLINE_SRC_IK_ALGEBRAIC_HIDDEN_TURN_H

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "loop.h"
#include "root_refiner.h"
#include "trigonometric.h"

namespace screwline {

enum class Eliminated {
  kAll,        ///< Every root led to a solution of its own.
  kUncertain,  ///< Rounding hides something.
  kVanishing,  ///< Every value of the hidden joint is a root: a self-motion, or the method breaks down here.
};

/// What one pose asks of the hidden joint's angle alone: a trigonometric polynomial vanishes there.
class HiddenCondition {
 public:
  virtual ~HiddenCondition() = default;

  /// Over the image of the angle under `map`; what lies beyond the degree it must have is noise.
  virtual TrigonometricPolynomial polynomial(const CircleMap& map) const = 0;
  /// The map that spreads its roots over the circle, where they are crowded: they drown in rounding there.
  virtual CircleMap spread() const = 0;
  /// Whether it is zero at every angle, to rounding.
  virtual bool vanishes() const = 0;
  /// Whether the other joints are hardly told by this one, whatever its angle.
  virtual bool isIllConditioned() const = 0;
  /// Whether the angle, as well as a multiple root tells it, leaves some of the other joints free: any number of
  /// solutions may share it. Of slides it is not asked where roots that lead nowhere account for it.
  virtual bool leavesFree(double angle, bool nowhere) const = 0;
  /// Joint values at a root, or next to one; empty where a slide is at infinity.
  virtual std::optional<Vector6> configurationAt(double angle) const = 0;
  /// The same where two roots share the angle, or almost; empty also where they are complex.
  virtual std::array<std::optional<Vector6>, 2> bothAt(double angle) const = 0;
};

/// All solutions by the angle of one turn. Solving allocates nothing.
class HiddenTurn {
 public:
  virtual ~HiddenTurn() = default;

  /// Adds what it finds.
  virtual Eliminated solve(const Pose& target, RootRefiner& refiner) const = 0;
  /// How well a configuration is found for its pose: an error in rad, large where the method breaks down.
  virtual double errorAt(const Pose& target, const Vector6& q) const = 0;
  /// As "joint2 hidden, joint5 and joint6 eliminated linearly".
  virtual std::string words(const SerialChain& chain) const = 0;

 protected:
  /// Every cluster of roots has to have as many solutions as roots, whichever joint's angle they were found by.
  static Eliminated solve(const HiddenCondition& condition, const Loop& loop, int hidden, RootRefiner& refiner);
  static double errorAt(const HiddenCondition& condition, const Loop& loop, int hidden, const Vector6& q);
};

using HiddenTurns = std::vector<std::shared_ptr<const HiddenTurn>>;

/// Those that serve the chain, best first; tried at fixed configurations.
struct HiddenTurnChoice {
  HiddenTurns usable;
  HiddenTurns reserves;  ///< Where roots coincide, or are found badly: good for a second look only.
};

HiddenTurnChoice chooseHiddenTurns(const SerialChain& chain, const Loop& loop, const HiddenTurns& all);

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_ALGEBRAIC_HIDDEN_TURN_H

#include "elimination.h"

#include <cmath>

#include "dixon.h"

namespace screwline {
namespace {

/// Dixon's matrix is singular.
class DixonCondition : public HiddenCondition {
 public:
  DixonCondition(const Loop& loop, const Labelling& labelling, const Pose& target)
      : loop_(loop), labelling_(labelling), system_(loop, labelling, loop.closure(target)), pencil_(system_) {}

  TrigonometricPolynomial polynomial(const CircleMap& map) const override {
    TrigonometricPolynomial determinant = pencil_.determinant(map);
    determinant.truncate(DixonPencil::kDegree);
    return determinant;
  }
  CircleMap spread() const override { return pencil_.spread(); }
  bool vanishes() const override { return pencil_.vanishes(); }
  bool isIllConditioned() const override { return false; }
  bool leavesFree(double, bool) const override { return false; }
  std::optional<Vector6> configurationAt(double angle) const override {
    return configurationOf(angle, pencil_.unknownsAt(angle));
  }
  std::array<std::optional<Vector6>, 2> bothAt(double angle) const override {
    const LoopSystem::Coefficients equations = system_.at({std::cos(0.5 * angle), std::sin(0.5 * angle)});
    const auto both = pencil_.doubleUnknownsAt(angle, equations);
    if (!both) return {};
    return {{configurationOf(angle, (*both)[0]), configurationOf(angle, (*both)[1])}};
  }

 private:
  Vector6 configurationOf(double angle, const std::array<JointParameter, 3>& unknowns) const;

  const Loop& loop_;
  Labelling labelling_;
  LoopSystem system_;
  DixonPencil pencil_;
};

Vector6 DixonCondition::configurationOf(double angle, const std::array<JointParameter, 3>& unknowns) const {
  JointParameter first;
  JointParameter second;
  system_.solvePair({std::cos(0.5 * angle), std::sin(0.5 * angle)}, unknowns, first, second);
  Vector6 displacements;
  displacements[labelling_.hidden()] = angle;
  for (int k = 0; k < 3; ++k) {
    const int joint = labelling_.unknown(k);
    displacements[joint] = loop_.displacement(joint, unknowns[static_cast<std::size_t>(k)]);
  }
  displacements[labelling_.pair(0)] = loop_.displacement(labelling_.pair(0), first);
  displacements[labelling_.pair(1)] = loop_.displacement(labelling_.pair(1), second);
  return displacements.cwiseQuotient(loop_.multipliers);
}

}  // namespace

Eliminated Elimination::solve(const Pose& target, RootRefiner& refiner) const {
  return HiddenTurn::solve(DixonCondition(*loop_, labelling_, target), *loop_, labelling_.hidden(), refiner);
}

double Elimination::errorAt(const Pose& target, const Vector6& q) const {
  return HiddenTurn::errorAt(DixonCondition(*loop_, labelling_, target), *loop_, labelling_.hidden(), q);
}

std::string Elimination::words(const SerialChain& chain) const {
  return chain.joint(labelling_.hidden()).name + " hidden, " + chain.joint(labelling_.pair(0)).name + " and " +
         chain.joint(labelling_.pair(1)).name + " eliminated linearly";
}

HiddenTurns eliminationsOf(const Loop& loop) {
  HiddenTurns all;
  for (int pair = 0; pair < 6; ++pair) {
    for (int hidden : {0, 3}) {
      const Labelling labelling{pair, hidden};
      if (loop.axes[static_cast<std::size_t>(labelling.hidden())].prismatic) continue;
      all.push_back(std::make_shared<const Elimination>(loop, labelling));
    }
  }
  return all;
}

}  // namespace screwline

#include "screwline/symbolic/inverse_formulas.h"

#include <algorithm>
#include <string>
#include <utility>

#include "inverse_builder.h"

namespace screwline {
namespace {

constexpr double kMostSeconds = 5.0;  ///< What takes longer is too long to be read.

/// The axes of the position problem; open rows of the task come first.
std::array<InverseAxis, 3> positionAxes(const InverseBuilder& builder, const Task& task,
                                        const InverseOutline& outline) {
  std::vector<InverseAxis> axes;
  for (int row = 0; row < 3; ++row) {
    if (!task.contains(row)) axes.push_back(builder.openRow(row, static_cast<int>(axes.size())));
  }
  const int sense = outline.shape == InverseShape::kShoulder ? -1 : 1;
  for (int joint : outline.position) {
    if (joint >= 0) axes.push_back(builder.axis(joint, sense));
  }
  return {axes[0], axes[1], axes[2]};
}

InversePoint originOf(const InverseBuilder& builder, int frame) {
  return {frame, TrigMatrix(builder.ring(), 3, 1)};
}

bool writePoint(InverseBuilder& builder, const Task& task, const InverseOutline& outline) {
  if (task.translationCount() == 3) builder.takeOff(false);
  builder.say("The tip, seen from the first axis:");
  return writePosition(builder, positionAxes(builder, task, outline), originOf(builder, builder.size() + 1),
                       {0, builder.targetPoint()});
}

/// The centre of a spherical wrist or shoulder lies where the first two of its axes meet.
bool writeSpherical(InverseBuilder& builder, const InverseOutline& outline) {
  builder.takeOff(true);
  const int center = outline.spherical_first + 1;
  const int tip = builder.size() + 1;
  const TrigMatrix R = builder.targetRotation();
  const TrigMatrix p = builder.targetPoint();
  const bool is_wrist = outline.shape == InverseShape::kWrist;
  const InversePoint goal = is_wrist ? InversePoint{0, R * builder.between(tip, center).p + p}
                                     : InversePoint{tip, R.transposed() * (builder.between(0, center).p - p)};
  builder.say(is_wrist ? "The wrist's centre, seen from the first axis:"
                       : "The shoulder's centre, seen from the tip and turned into the axes at zero:");
  if (!writePosition(builder, positionAxes(builder, Task(), outline), originOf(builder, center), goal)) return false;
  return writeOrientation(builder, outline.spherical_first);
}

/// The heading is counted from zero joint values.
bool writeHeading(InverseBuilder& builder, const Task& task, const InverseOutline& outline) {
  if (outline.turning_slides) return false;
  const SerialChain& chain = builder.chain();
  const TrigPose home = builder.between(0, chain.size() + 1);
  const int x = (outline.heading_row + 1) % 3;
  const int y = (outline.heading_row + 2) % 3;
  const TrigMatrix turned = builder.targetRotation() * home.R.transposed();
  builder.say("The heading:");
  builder.setJoint(builder.heading(), Formula::call(FormulaFunction::kArcTangent2,
                                                    {builder.formula(turned(y, x)), builder.formula(turned(x, x))}));
  if (outline.has_position) {
    const int place = outline.heading_joint + 1;
    const TrigMatrix lever = home.p - builder.between(0, place).p;
    const TrigPolynomial c = TrigPolynomial::cosine(builder.ring(), {{builder.heading(), 1}});
    const TrigPolynomial s = TrigPolynomial::sine(builder.ring(), {{builder.heading(), 1}});
    TrigMatrix goal = builder.targetPoint() - lever;
    goal(x, 0) += lever(x, 0) - (c * lever(x, 0) - s * lever(y, 0));
    goal(y, 0) += lever(y, 0) - (s * lever(x, 0) + c * lever(y, 0));
    builder.say("The axis of joint " + std::to_string(outline.heading_joint + 1) + ", seen from the first axis:");
    if (!writePosition(builder, positionAxes(builder, task, outline), originOf(builder, place), {0, goal}))
      return false;
  }
  const auto senseOf = [&](const Axis& axis) { return axis.direction[outline.heading_row] < 0.0 ? -1 : 1; };
  Formula rest = Formula::symbol(builder.heading());
  for (int i = 0; i < chain.size(); ++i) {
    const Axis& axis = chain.axes()[static_cast<std::size_t>(i)];
    if (axis.prismatic || i == outline.heading_joint) continue;
    rest = rest - Formula::number(senseOf(axis)) * Formula::symbol(i);
  }
  const Axis& last = chain.axes()[static_cast<std::size_t>(outline.heading_joint)];
  builder.say("What is left of the heading:");
  builder.setJoint(outline.heading_joint, senseOf(last) < 0 ? -rest : rest);
  return true;
}

bool writePlan(InverseBuilder& builder, const Task& task, const InverseOutline& outline) {
  switch (outline.shape) {
    case InverseShape::kPosition:
      return writePoint(builder, task, outline);
    case InverseShape::kOrientation:
      builder.takeOff(true);
      return writeOrientation(builder, 0);
    case InverseShape::kWrist:
    case InverseShape::kShoulder:
      return writeSpherical(builder, outline);
    case InverseShape::kHeading:
      return writeHeading(builder, task, outline);
    case InverseShape::kParallel:
      return writeParallel(builder, outline);
  }
  return false;
}

}  // namespace

std::optional<InverseFormulas> inverseFormulasOf(const SerialChain& chain, const Task& task,
                                                 const InverseOutline& outline, const SymbolicOptions& options,
                                                 const Progress& progress) {
  if (chain.hasMimic()) return std::nullopt;
  InverseBuilder builder(chain, outline, options, progress);
  if (!writePlan(builder, task, outline)) return std::nullopt;
  return builder.finished();
}

InverseDerivation deriveInverse(const SerialChain& chain, const Task& task, const InverseMethod& method, int poses,
                                const SymbolicOptions& options, const Progress& progress) {
  InverseDerivation derivation;
  if (!method.outline) {
    derivation.reason = "no formulas: the solver has no closed form for this geometry and all rows of the task";
    return derivation;
  }
  Progress limited = progress;
  limited.time_limit = std::min(progress.time_limit, kMostSeconds);
  try {
    derivation.formulas = inverseFormulasOf(chain, task, *method.outline, options, limited);
  } catch (const DerivationStopped& stopped) {
    if (progress.cancelled && progress.cancelled()) throw;
    derivation.reason = std::string("no formulas: they grow too long to be read (") + stopped.what() + ")";
    return derivation;
  }
  if (!derivation.formulas) {
    derivation.reason = "no formulas: a case of the solver's closed form is not written";
    return derivation;
  }
  if (!method.solver) return derivation;
  derivation.check = checkInverse(*derivation.formulas, chain, task, method.solver, poses);
  if (derivation.check.agrees() && derivation.check.worst_task <= kInverseAgreement) return derivation;
  derivation.formulas.reset();
  derivation.reason = "no formulas: those of the ideal geometry do not hold for this chain's numbers";
  return derivation;
}

}  // namespace screwline

#include "factor_names.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "factor_fit.h"
#include "sampling.h"
#include "screwline/kinematics/forward.h"
#include "screwline/kinematics/kernel_sweep.h"
#include "screwline/model/structure.h"

namespace screwline {
namespace {

constexpr int kComparisons = 4;
constexpr int kFirstSample = 200;
constexpr int kFirstWristJoint = 3;  ///< Three joints place, those after them orient.
constexpr double kProportional = 1e-8;

struct AxesAt {
  std::array<Vector3, kMaxJoints> direction;
  std::array<Vector3, kMaxJoints> point;
  Pose tip;
};

AxesAt axesAt(const SerialChain& chain, const VectorX& q) {
  AxesAt axes;
  std::size_t count = 0;
  axes.tip =
      sweepKernel(chain.kernel(), q.data(), [&](const AxisKernel&, const Vector3& direction, const Vector3& point) {
        axes.direction[count] = direction;
        axes.point[count] = point;
        ++count;
      });
  return axes;
}

/// c where |factor| = |c g| at all compared configurations, up to sign; none where they are not proportional.
std::optional<double> ratioTo(const SerialChain& chain, const SingularityFactor& factor,
                              const std::function<double(const VectorX&)>& g) {
  std::optional<double> ratio;
  for (int k = 0; k < kComparisons; ++k) {
    const VectorX q = sampleConfiguration(chain, kFirstSample + k);
    const double reference = g(q);
    const double value = factor.value(q);
    if (std::abs(reference) <= 1e-12 * chain.characteristicLength()) return std::nullopt;
    if (ratio && std::abs(value - *ratio * reference) > kProportional * std::abs(value)) return std::nullopt;
    ratio = value / reference;
  }
  return ratio;
}

/// A point that geometry singles out: the tip, or where axes meet; moved along by the axes before it.
struct Landmark {
  std::string name;
  int axis_count;
  Vector3 home;
};

std::vector<Landmark> landmarksOf(const SerialChain& chain, const Structure& structure) {
  std::vector<Landmark> landmarks = {{"tip", static_cast<int>(chain.axes().size()), chain.home().p}};
  for (const ConcurrentGroup& group : structure.spherical)
    landmarks.push_back({"wrist centre", group.first, group.center});
  for (std::size_t i = 2; i < structure.neighbours.size(); ++i) {
    const AxisRelation& relation = structure.neighbours[i];
    if (relation.intersecting) {
      landmarks.push_back({"meeting point of axes " + chain.joint(static_cast<int>(i)).name + " and " +
                               chain.joint(static_cast<int>(i) + 1).name,
                           static_cast<int>(i), relation.meeting_point});
    }
  }
  return landmarks;
}

Vector3 positionOf(const SerialChain& chain, const Landmark& landmark, const VectorX& q) {
  Link link;
  link.axis_count = landmark.axis_count;
  link.home.p = landmark.home;
  return linkPose(chain, link, q).p;
}

void scaleTerms(SingularityFactor& factor, double share) {
  for (FactorTerm& term : factor.terms) term.coefficient *= share;
}

bool nameWrist(const SerialChain& chain, const Structure& structure, SingularityFactor& factor) {
  for (const ConcurrentGroup& group : structure.spherical) {
    const std::size_t first = static_cast<std::size_t>(group.first);
    if (group.count != 3 || factor.joints != std::vector<int>{group.first + 1}) continue;
    const auto triple = [&](const VectorX& q) {
      const AxesAt axes = axesAt(chain, q);
      return axes.direction[first].dot(axes.direction[first + 1].cross(axes.direction[first + 2]));
    };
    if (!ratioTo(chain, factor, triple)) continue;
    if (group.first > 0 && group.first + group.count < chain.size()) {
      factor.name = "elbow";  // Of an arm with axes on both sides that it moves apart.
      factor.meaning = "the arm is straight or folded at " + chain.joint(group.first + 1).name +
                       ": the tip cannot move along the arm";
      return true;
    }
    factor.name = "wrist";
    factor.meaning = "axes " + chain.joint(group.first).name + ", " + chain.joint(group.first + 1).name + ", " +
                     chain.joint(group.first + 2).name + " lie in one plane: no rotation about its normal";
    return true;
  }
  return false;
}

/// The velocity that joint 1 gives a landmark along axis 2: zero where axis 1 and axis 2's direction leave it no way
/// sideways.
bool nameShoulder(const SerialChain& chain, const Structure& structure, SingularityFactor& factor) {
  if (chain.size() < 2 || chain.axes()[0].prismatic || chain.axes()[1].prismatic) return false;
  if (factor.joints.size() < 2) return false;
  for (const Landmark& landmark : landmarksOf(chain, structure)) {
    const auto sideways = [&](const VectorX& q) {
      const AxesAt axes = axesAt(chain, q);
      return axes.direction[0].cross(positionOf(chain, landmark, q) - axes.point[0]).dot(axes.direction[1]);
    };
    const std::optional<double> ratio = ratioTo(chain, factor, sideways);
    if (!ratio) continue;
    scaleTerms(factor, 1.0 / *ratio);
    factor.name = "shoulder";
    factor.meaning = "the " + landmark.name + " is on the axis of " + chain.joint(0).name +
                     ", or straight beside it: it cannot leave the plane of the arm";
    return true;
  }
  return false;
}

bool isBetweenParallelAxes(const Structure& structure, int axis) {
  return std::any_of(structure.parallel.begin(), structure.parallel.end(), [axis](const ParallelGroup& group) {
    return std::find(group.axes.begin() + 1, group.axes.end(), axis) != group.axes.end();
  });
}

void nameSingle(const SerialChain& chain, const Structure& structure, SingularityFactor& factor) {
  const int joint = factor.joints.front();
  const std::string& name = chain.joint(joint).name;
  if (!chain.joint(joint).isRevolute()) {
    factor.name = "extension";
    factor.meaning = "the slide " + name + " is drawn in to where joints before it no longer move the tip across it";
  } else if (isBetweenParallelAxes(structure, joint)) {
    factor.name = "elbow";
    factor.meaning = "the arm is straight or folded at " + name + ": the tip cannot move along the arm";
  } else if (joint >= kFirstWristJoint) {
    factor.name = "wrist";
    factor.meaning = "at " + name + " the axes before and after it turn the tip alike: one rotation is lost";
  } else if (joint == 1) {
    factor.name = "shoulder";
    factor.meaning = "what " + name + " carries lies along or over the axis of " + chain.joint(0).name +
                     ": the two joints no longer move the tip apart";
  } else {
    factor.name = "elbow";
    factor.meaning = "at " + name + " the joints before and after it move the tip alike: one direction is lost";
  }
}

/// Largest coefficient 1, the first term positive.
void normalise(SingularityFactor& factor) {
  double largest = 0.0;
  for (const FactorTerm& term : factor.terms) largest = std::max(largest, std::abs(term.coefficient));
  scaleTerms(factor, 1.0 / largest);
}

/// Lengths that rounding has left: 0.69999999999999996 is 0.7 where that changes nothing that counts.
void tidy(SingularityFactor& factor) {
  const double sign = factor.terms.front().coefficient < 0.0 ? -1.0 : 1.0;
  for (FactorTerm& term : factor.terms) {
    const double rounded = std::round(sign * term.coefficient * 1e11) / 1e11;
    term.coefficient = std::abs(rounded) > 0.0 ? rounded : sign * term.coefficient;
  }
}

}  // namespace

void nameFactors(const SerialChain& chain, std::vector<SingularityFactor>& factors) {
  const Structure structure = structureOf(chain);
  for (SingularityFactor& factor : factors) {
    if (factor.joints.size() > 1) {
      if (!nameShoulder(chain, structure, factor)) {
        normalise(factor);
        factor.name = "arm";
        factor.meaning = "the joints of this condition together lose one direction of the task";
      }
    } else if (!nameWrist(chain, structure, factor)) {
      nameSingle(chain, structure, factor);
    }
    // The largest term first reads best: "0.7*cos(theta2) + 0.5*cos(theta2 + theta3)".
    if (factor.joints.size() > 1) {
      std::stable_sort(factor.terms.begin(), factor.terms.end(), [](const FactorTerm& a, const FactorTerm& b) {
        return std::abs(a.coefficient) > std::abs(b.coefficient) * (1.0 + 1e-9);
      });
      tidy(factor);
    }
    factor.expression = infixOf(chain, factor) + " = 0";
    factor.latex = latexOf(chain, factor) + " = 0";
  }
}

}  // namespace screwline

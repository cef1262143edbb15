#ifndef SCREWLINE_TEST_SINGULAR_POSES_H
#define SCREWLINE_TEST_SINGULAR_POSES_H

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "ik_arms.h"
#include "screwline/kinematics/kernel_sweep.h"
#include "screwline/kinematics/singularity_factors.h"
#include "screwline/model/structure.h"

namespace screwline {
namespace test {

/// One way for an arm to become singular: a function of the configuration that is zero there, and joints by each of
/// which it can be made zero.
struct SingularWay {
  std::string name;
  std::vector<int> joints;
  std::function<double(const VectorX&)> value;
};

/// One way, or several at once.
struct SingularKind {
  std::string name;
  std::vector<SingularWay> ways;
};

namespace singular_poses_detail {

struct AxesAt {
  std::vector<Vector3> direction;
  std::vector<Vector3> point;
};

inline AxesAt axesAt(const SerialChain& chain, const VectorX& q) {
  AxesAt axes;
  sweepKernel(chain.kernel(), q.data(), [&](const AxisKernel&, const Vector3& direction, const Vector3& point) {
    axes.direction.push_back(direction);
    axes.point.push_back(point);
  });
  return axes;
}

/// Point of the chain that lies at `home` at zero, and is carried by the axes before `count`.
inline Vector3 carried(const SerialChain& chain, int count, const Vector3& home, const VectorX& q) {
  Vector3 p = home;
  for (int i = count - 1; i >= 0; --i) {
    const Axis& axis = chain.axes()[static_cast<std::size_t>(i)];
    p = axis.prismatic ? Vector3(p + q[i] * axis.direction)
                       : Vector3(axis.point + rotationAbout(axis.direction, q[i]) * (p - axis.point));
  }
  return p;
}

inline std::string numbered(const std::string& name, const std::vector<SingularWay>& ways) {
  int count = 1;
  for (const SingularWay& way : ways) {
    if (way.name == name || way.name.rfind(name + " ", 0) == 0) ++count;
  }
  return count == 1 ? name : name + " " + std::to_string(count);
}

/// The determinant's own factors.
inline void addFactors(const std::shared_ptr<const SerialChain>& chain, const Task& task,
                       std::vector<SingularWay>& ways) {
  for (const SingularityFactor& factor : factorsOf(*chain, task)) {
    if (factor.name == "always") continue;
    SingularWay way;
    way.name = numbered(factor.name, ways);
    for (int joint : factor.joints) {
      if (joint > 0 || factor.joints.size() == 1) way.joints.push_back(joint);
    }
    if (factor.isExplicit()) {
      way.value = [factor](const VectorX& q) { return factor.value(q); };
    } else {
      way.value = [chain, task](const VectorX& q) { return TaskDeterminant(*chain, task)(q); };
    }
    ways.push_back(way);
  }
}

/// Two axes on both sides of a joint that it can make parallel.
inline void addAlignments(const std::shared_ptr<const SerialChain>& chain, std::vector<SingularWay>& ways) {
  const int n = chain->size();
  for (int i = 0; i + 2 < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const auto& axes = chain->axes();
    if (axes[at].prismatic || axes[at + 1].prismatic || axes[at + 2].prismatic) continue;
    const double first = std::abs(axes[at].direction.dot(axes[at + 1].direction));
    const double second = std::abs(axes[at + 1].direction.dot(axes[at + 2].direction));
    if (std::abs(first - second) > 1e-12 || first > 1.0 - 1e-9) continue;
    const std::string name = i == 0 ? "shoulder aligned"
                             : i + 3 == n
                                 ? "wrist aligned"
                                 : "axes " + std::to_string(i + 1) + ", " + std::to_string(i + 3) + " parallel";
    ways.push_back({name, {i + 1}, [chain, at](const VectorX& q) {
                      const AxesAt moved = axesAt(*chain, q);
                      return moved.direction[at].dot(moved.direction[at + 1].cross(moved.direction[at + 2]));
                    }});
  }
}

/// Distance of where the first axes meet from where the last ones do, largest or least.
inline void addElbow(const std::shared_ptr<const SerialChain>& chain, std::vector<SingularWay>& ways) {
  const Structure structure = structureOf(*chain);
  const int n = chain->size();
  if (n != 7 || !structure.neighbours.front().intersecting) return;
  for (int last : {n - 2, n - 3}) {
    const AxisRelation& relation = structure.neighbours[static_cast<std::size_t>(last)];
    if (!relation.intersecting) continue;
    const Vector3 shoulder = structure.neighbours.front().meeting_point;
    const Vector3 wrist = relation.meeting_point;
    ways.push_back({"elbow straight or folded", {3}, [chain, shoulder, wrist, last](const VectorX& q) {
                      const Vector3 to = carried(*chain, last, wrist, q) - carried(*chain, 0, shoulder, q);
                      const AxesAt moved = axesAt(*chain, q);
                      return to.dot(moved.direction[3].cross(carried(*chain, last, wrist, q) - moved.point[3]));
                    }});
    return;
  }
}

/// Three parallel axes in one plane: the arm is straight or folded.
inline void addPlanarElbow(const std::shared_ptr<const SerialChain>& chain, std::vector<SingularWay>& ways) {
  for (const ParallelGroup& group : structureOf(*chain).parallel) {
    if (group.axes.size() < 3) continue;
    const auto a = static_cast<std::size_t>(group.axes[0]);
    const auto b = static_cast<std::size_t>(group.axes[1]);
    const auto c = static_cast<std::size_t>(group.axes[2]);
    ways.push_back({"elbow", {group.axes[1]}, [chain, a, b, c](const VectorX& q) {
                      const AxesAt at = axesAt(*chain, q);
                      return at.direction[a].dot((at.point[b] - at.point[a]).cross(at.point[c] - at.point[b]));
                    }});
  }
}

}  // namespace singular_poses_detail

/// From the chain's geometry, whatever it is called: the factors of its determinant where the task is square, else axes
/// that come into line and arms that are straight.
inline std::vector<SingularWay> singularWaysOf(const SerialChain& chain, const Task& task) {
  const auto shared = std::make_shared<const SerialChain>(chain);
  std::vector<SingularWay> ways;
  if (task.size() == chain.size()) {
    singular_poses_detail::addFactors(shared, task, ways);
  } else {
    singular_poses_detail::addAlignments(shared, ways);
    singular_poses_detail::addElbow(shared, ways);
    singular_poses_detail::addPlanarElbow(shared, ways);
  }
  return ways;
}

/// Each way, each pair of ways, and all of them.
inline std::vector<SingularKind> singularKindsOf(const SerialChain& chain, const Task& task) {
  const std::vector<SingularWay> ways = singularWaysOf(chain, task);
  std::vector<SingularKind> kinds;
  for (const SingularWay& way : ways) kinds.push_back({way.name, {way}});
  for (std::size_t i = 0; i < ways.size(); ++i) {
    for (std::size_t k = i + 1; k < ways.size(); ++k)
      kinds.push_back({ways[i].name + " + " + ways[k].name, {ways[i], ways[k]}});
  }
  if (ways.size() > 2) kinds.push_back({"all at once", ways});
  return kinds;
}

/// Makes configurations singular.
class SingularPoses {
 public:
  SingularPoses(const SerialChain& chain, unsigned seed) : chain_(chain), random_(seed) {}

  VectorX regular() {
    VectorX q(chain_.size());
    for (int i = 0; i < q.size(); ++i) {
      const JointLimits& limits = chain_.joint(i).limits;
      const double span = chain_.joint(i).isRevolute() ? kPi : chain_.characteristicLength();
      q[i] =
          std::uniform_real_distribution<double>(std::max(limits.lower, -span), std::min(limits.upper, span))(random_);
    }
    return q;
  }

  /// A random configuration that is singular in all the kind's ways, but for `offset` of the joints that make it so.
  /// Empty where no such was met.
  std::optional<VectorX> make(const SingularKind& kind, double offset) {
    for (int trial = 0; trial < 40; ++trial) {
      VectorX q = regular();
      std::vector<int> joints;
      if (!chooseJoints(kind, joints) || !impose(kind, joints, q)) continue;
      for (int joint : joints) q[joint] += offset;
      return q;
    }
    return std::nullopt;
  }

 private:
  int index(std::size_t count) {
    return static_cast<int>(std::uniform_int_distribution<std::size_t>(0, count - 1)(random_));
  }

  /// A joint of its own for each way.
  bool chooseJoints(const SingularKind& kind, std::vector<int>& joints) {
    for (const SingularWay& way : kind.ways) {
      const int joint = way.joints[static_cast<std::size_t>(index(way.joints.size()))];
      if (std::find(joints.begin(), joints.end(), joint) != joints.end()) return false;
      joints.push_back(joint);
    }
    return true;
  }

  bool impose(const SingularKind& kind, const std::vector<int>& joints, VectorX& q) {
    constexpr int kRounds = 30;
    for (int round = 0; round < kRounds; ++round) {
      for (std::size_t i = 0; i < joints.size(); ++i) {
        if (!toRoot(kind.ways[i], joints[i], round == 0, q)) return false;
      }
      bool all = true;
      for (const SingularWay& way : kind.ways) all = all && std::abs(way.value(q)) <= 1e-14 * scale_;
      if (all) return true;
    }
    return false;
  }

  /// Sets one joint to a root of the way's function: any at first, later the nearest.
  bool toRoot(const SingularWay& way, int joint, bool any, VectorX& q) {
    constexpr int kSamples = 72;
    const double span = chain_.joint(joint).isRevolute() ? kPi : chain_.characteristicLength();
    const double start = q[joint];
    const auto at = [&](double value) {
      q[joint] = value;
      return way.value(q);
    };
    std::vector<double> roots;
    double before = at(-span);
    double largest = std::abs(before);
    for (int i = 1; i <= kSamples; ++i) {
      const double low = span * (2.0 * (i - 1) / kSamples - 1.0);
      const double high = span * (2.0 * i / kSamples - 1.0);
      const double value = at(high);
      largest = std::max(largest, std::abs(value));
      if ((before < 0.0) != (value < 0.0)) roots.push_back(rootBetween(at, low, high));
      before = value;
    }
    scale_ = std::max(1.0, largest);
    q[joint] = start;
    if (roots.empty()) return false;
    double chosen = roots[static_cast<std::size_t>(index(roots.size()))];
    for (double root : roots) {
      if (!any && std::abs(root - start) < std::abs(chosen - start)) chosen = root;
    }
    q[joint] = chosen;
    return true;
  }

  template <typename Function>
  static double rootBetween(const Function& at, double low, double high) {
    const bool negative = at(low) < 0.0;
    for (;;) {
      const double middle = 0.5 * (low + high);
      if (middle <= low || middle >= high) break;
      ((at(middle) < 0.0) == negative ? low : high) = middle;
    }
    const double root = std::abs(at(low)) < std::abs(at(high)) ? low : high;
    // The multiple of 45 degrees that it is but for rounding.
    const double round = 0.25 * kPi * std::round(root / (0.25 * kPi));
    return std::abs(root - round) < 1e-12 ? round : root;
  }

  const SerialChain& chain_;
  std::mt19937 random_;
  double scale_ = 1.0;
};

/// An arm that cannot be regular, whatever its configuration.
struct AlwaysSingularArm {
  std::string name;
  SerialChain chain;
};

inline std::vector<AlwaysSingularArm> alwaysSingularArms() {
  const Vector3 x = Vector3::UnitX();
  const Vector3 y = Vector3::UnitY();
  const Vector3 z = Vector3::UnitZ();
  const auto turn = ArmMaker::turn;
  const auto slide = ArmMaker::slide;
  const Pose tool{rotationAbout(y, 0.7), {1.3, 0.2, 0.4}};
  const std::vector<Axis> wrist = {turn(z, {1, 0, 0.5}), turn(y, {1, 0, 0.5}), turn(z, {1, 0, 0.5})};
  const auto arm = [&](std::vector<Axis> axes, const std::vector<Axis>& rest) {
    axes.insert(axes.end(), rest.begin(), rest.end());
    return ArmMaker::chain(axes, tool, Pose());
  };
  std::vector<Axis> planar;
  for (int i = 0; i < 6; ++i) planar.push_back(turn(z, {0.2 * i, 0.1 * (i % 3), 0}));
  return {
      {"six parallel axes", arm(planar, {})},
      {"two axes in line", arm({turn(z, {0, 0, 0}), turn(z, {0, 0, 0.3}), turn(y, {0.4, 0, 0.5})}, wrist)},
      {"four axes through one point", arm({turn(z, {0, 0, 0}), turn(y, {0.3, 0, 0.4}), turn(x, {1, 0, 0.5})}, wrist)},
      {"three slides in a plane", arm({slide(x), slide(x + y), slide(y)}, wrist)},
      {"two slides in line", arm({slide(x), slide(x), turn(y, {0, 0, 0.3})}, wrist)},
      {"seven joints, two axes in line",
       arm({turn(z, {0, 0, 0}), turn(z, {0, 0, 0.2}), turn(y, {0.1, 0, 0.3}), turn(y, {0.6, 0, 0.3})}, wrist)}};
}

}  // namespace test
}  // namespace screwline

#endif  // SCREWLINE_TEST_SINGULAR_POSES_H

#ifndef SCREWLINE_MODEL_SERIAL_CHAIN_H
#define SCREWLINE_MODEL_SERIAL_CHAIN_H

#include <optional>
#include <string>
#include <vector>

#include "screwline/model/chain_kernel.h"
#include "screwline/model/joint.h"
#include "screwline/model/modified_dh.h"

namespace screwline {

constexpr int kMaxJoints = 64;         ///< Degrees of freedom, and axes, that a chain may have.
constexpr double kMaxMagnitude = 1e6;  ///< Numbers beyond it are refused wherever they are read.

/// A link that moves with the chain: after `axis_count` axes, at `home` in the base frame at the zero configuration.
struct Link {
  std::string name;
  int axis_count = 0;
  Pose home;
};

/// What a chain is made from; SerialChain checks it.
struct ChainDescription {
  std::string name;
  std::string base_link;
  std::string tip_link;
  std::vector<Joint> joints;     ///< Degrees of freedom, base to tip.
  std::vector<Axis> axes;        ///< Base to tip; without mimic joints one per joint.
  Pose home;                     ///< X_BT at zero.
  std::vector<Link> links;       ///< Of the chain and rigidly attached to it; the base and tip links included.
  std::optional<ModifiedDh> dh;  ///< Given where the table was the source; else computed.
};

/// A serial chain: immutable, validated once, shared by all threads. Its configuration is q (n values: rad, m; base to
/// tip).
class SerialChain {
 public:
  /// @throws ModelError naming what is wrong: no joint, more than kMaxJoints, repeated or empty names, an axis that is
  /// not a unit vector, numbers not finite or beyond kMaxMagnitude, lower above upper, limits not positive, an unknown
  /// tip link.
  explicit SerialChain(ChainDescription description);

  const std::string& name() const { return description_.name; }
  int size() const { return static_cast<int>(description_.joints.size()); }  ///< n, degrees of freedom.
  const std::vector<Joint>& joints() const { return description_.joints; }
  const Joint& joint(int i) const { return description_.joints[static_cast<std::size_t>(i)]; }
  std::vector<std::string> jointNames() const;

  const std::string& baseLink() const { return description_.base_link; }
  const std::string& tipLink() const { return description_.tip_link; }
  const std::vector<Link>& links() const { return description_.links; }
  /// The link of that name, or null.
  const Link* findLink(const std::string& link_name) const;

  const std::vector<Axis>& axes() const { return description_.axes; }  ///< As many as joints unless hasMimic().
  bool hasMimic() const { return has_mimic_; }
  const Pose& home() const { return description_.home; }  ///< X_BT at zero.

  /// Screw axes [v; w] of the joints, base frame, zero configuration: 6 x n (a mimic joint's axis is added to its
  /// driver's).
  const Matrix6X& screwAxes() const { return screw_axes_; }

  const ChainKernel& kernel() const { return kernel_; }
  /// One row per axis.
  const ModifiedDh& modifiedDh() const { return *description_.dh; }

  VectorX lower() const;
  VectorX upper() const;
  /// q clamped into the position limits.
  VectorX clamped(const VectorX& q) const;

  /// A length [m] typical of the chain: the largest distance between neighbouring axes' points and the tip, at least
  /// 1e-6.
  double characteristicLength() const { return characteristic_length_; }

  /// What it was made of, for a chain that differs from it: without the table, which is the chain's own.
  ChainDescription description() const;

  /// A copy with other tip: `link` must be rigidly beyond the last axis. Used for link_name in inverse kinematics.
  SerialChain withTip(const Link& link) const;

 private:
  ChainDescription description_;
  bool has_mimic_ = false;
  ChainKernel kernel_;
  Matrix6X screw_axes_;
  double characteristic_length_ = 0.0;
};

/// Checks n joint values: size, finite, |q| <= kMaxMagnitude. `field` names the input in the message, as
/// "joint_state.position".
/// @throws InputError (kInvalidRobotState)
void requireConfiguration(const SerialChain& chain, const ConstVectorRef& q, const std::string& field);

}  // namespace screwline

#endif  // SCREWLINE_MODEL_SERIAL_CHAIN_H

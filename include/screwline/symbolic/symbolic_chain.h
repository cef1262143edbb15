#ifndef SCREWLINE_SYMBOLIC_SYMBOLIC_CHAIN_H
#define SCREWLINE_SYMBOLIC_SYMBOLIC_CHAIN_H

#include <memory>
#include <string>
#include <vector>

#include "screwline/model/serial_chain.h"
#include "screwline/symbolic/formula.h"
#include "screwline/symbolic/progress.h"

namespace screwline {

struct SymbolicOptions {
  bool share_equal_lengths = false;  ///< Lengths of equal size become one symbol.
};

/// Frames of a derivation by number: 0 is the base link, 1..n those of the modified-DH table (joint i about or along
/// its z), n + 1 the tip.
using FrameNumber = int;

/// A pose as formulas: rotation and position of one frame in another.
struct SymbolicPose {
  FormulaMatrix R;  ///< 3 x 3
  FormulaMatrix p;  ///< 3 x 1 [m]
};

/// One row of the modified-DH table as formulas, joint values in it.
struct SymbolicDhRow {
  Formula alpha;
  Formula a;
  Formula d;
  Formula theta;
};

/// Velocity of a frame (its origin) and of forces on it, as linear in joint rates and in the tip's wrench; components
/// in the frame itself.
struct SymbolicLinkVelocity {
  FormulaMatrix w;  ///< 3 x 1 [rad/s]
  FormulaMatrix v;  ///< 3 x 1 [m/s]
};
struct SymbolicLinkWrench {
  FormulaMatrix f;  ///< 3 x 1 [N]
  FormulaMatrix n;  ///< 3 x 1 [N m]
};

struct ExactChain;

/// A chain in exact form: joint values, lengths and odd angles are symbols (named after the modified-DH parameters a_i,
/// d_i, alpha_i, theta_i; the tip's offsets continue them: a_n along x, b_n along y, d_{n+1} along z), angles that are
/// multiples of 15 degrees are exact (to kExactAngle), with square roots of 2 and 3. Everything it returns is in
/// canonical form: the same chain gives the same text. Not for two threads at once; the formulas that it gave are.
class SymbolicChain {
 public:
  /// Keeps no reference to the chain. @throws DerivationStopped where the chain has mimic joints with multipliers that
  /// are not integers, or more symbols than a derivation handles; later by whatever `progress` asks.
  explicit SymbolicChain(const SerialChain& chain, const SymbolicOptions& options = {}, const Progress& progress = {});
  ~SymbolicChain();
  SymbolicChain(const SymbolicChain&) = delete;
  SymbolicChain& operator=(const SymbolicChain&) = delete;

  int size() const;    ///< n, axes.
  int joints() const;  ///< Degrees of freedom; as many as axes where no joint mimics another.
  const SymbolTable& symbols() const;
  std::vector<SymbolicDhRow> dhRows() const;
  SymbolicPose baseTransform() const;  ///< DH frame 0 in the base link.
  SymbolicPose toolTransform() const;  ///< The tip in DH frame n.

  /// Frame `frame` seen from frame `reference`.
  SymbolicPose pose(FrameNumber reference, FrameNumber frame) const;
  /// Geometric Jacobian of the tip's origin [v; w], 6 x joints(), components in `frame`.
  FormulaMatrix jacobian(FrameNumber frame) const;
  /// Outward recursion: frames 1..n (Craig eq. 5.45 to 5.48).
  std::vector<SymbolicLinkVelocity> velocities() const;
  /// Inward recursion: frames 1..n (Craig eq. 5.80, 5.81), of the wrench [f; n] exerted by the tip on the environment,
  /// about the tip's origin, components in the tip frame.
  std::vector<SymbolicLinkWrench> wrenches() const;

  /// What the formulas are made of, for the module itself.
  const ExactChain& exact() const { return *exact_; }
  ExactChain& exact() { return *exact_; }

 private:
  std::unique_ptr<ExactChain> exact_;
};

constexpr double kExactAngle = 1e-12;  ///< [rad] An angle this near to a multiple of 15 degrees is it.

}  // namespace screwline

#endif  // SCREWLINE_SYMBOLIC_SYMBOLIC_CHAIN_H

#ifndef SCREWLINE_IK_ALGEBRAIC_ALGEBRAIC_SOLVER_H
#define SCREWLINE_IK_ALGEBRAIC_ALGEBRAIC_SOLVER_H

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "screwline/model/serial_chain.h"

namespace screwline {

/// All real solutions of a pose. A general chain of six joints has 16 at most; more are met only as members of a
/// continuum.
struct AlgebraicSolutions {
  static constexpr std::size_t kCapacity = 24;

  std::array<std::array<double, 6>, kCapacity> q{};  ///< rad, m; turns in (-pi, pi], limits not looked at.
  int count = 0;
  bool complete = false;    ///< Every check says that no isolated solution is missing.
  bool degenerate = false;  ///< A self-motion passes through a solution: of it, `q` has some members.

  const std::array<double, 6>* begin() const { return q.data(); }
  const std::array<double, 6>* end() const { return q.data() + count; }
};

/// Inverse kinematics of any chain of six joints, turns and slides in any order, for a whole pose: all real
/// solutions.
///
/// The chain and its tip make a closed loop of dual quaternions, linear in each joint's half-angle parameter. The
/// motions of two neighbouring joints span four of eight dimensions, which leaves four equations that are linear in
/// each of four parameters; Dixon's 6 x 6 matrix eliminates three of them. Over the angle of the fourth its determinant
/// is a trigonometric polynomial of degree 8: the 16 solutions, and nothing else. It is known from 32 samples, which
/// measure its noise as well; its real roots are isolated, the null vectors give the other joints, Newton's method on
/// the chain itself has the last word. Which joints are the pair and the fourth is chosen for the chain by trial, with
/// alternatives where a pose is ill-conditioned. With two slides the four turns alone make the orientation: one of them
/// is hidden, the other three follow in closed form in two ways, and the slides' plane must hold the rest of the way: a
/// polynomial of degree 4, for the 8 solutions. With three slides the turns alone make the orientation. Sources: Husty
/// & Pfurner 2007 (joint pairs span linear spaces, on Study's quadric), Dixon 1908, Sturmfels & Zelevinsky 1994 (exact
/// multilinear resultants), Raghavan & Roth 1993 (16 is the degree).
class AlgebraicSolver {
 public:
  /// Empty where the chain has not six joints, has mimic joints, or no choice of the hidden joint reproduces its
  /// configurations (as where the tip moves in less than six dimensions). Takes about 5 ms; allocates.
  static std::optional<AlgebraicSolver> compile(const SerialChain& chain);

  /// All solutions, each verified: errors by forward kinematics below 1e-10 (rad, and characteristic lengths).
  /// Different from each other by more than 1e-6 in some joint. Deterministic; no allocation; may be called from many
  /// threads. @pre: the target is finite and its R a rotation.
  /// @param find_continua false: self-motions are not looked for, for who does not read `complete` and `degenerate`.
  void solve(const Pose& target, AlgebraicSolutions& solutions, bool find_continua = true) const;

  /// As "algebraic: joint2 hidden, joints joint5 and joint6 eliminated linearly".
  const std::string& method() const;

 private:
  struct Implementation;
  explicit AlgebraicSolver(std::shared_ptr<const Implementation> implementation);

  std::shared_ptr<const Implementation> implementation_;
};

}  // namespace screwline

#endif  // SCREWLINE_IK_ALGEBRAIC_ALGEBRAIC_SOLVER_H

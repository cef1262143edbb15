#ifndef SCREWLINE_IK_CLOSED_FORM_ORIENTATION_PROBLEM_H
#define SCREWLINE_IK_CLOSED_FORM_ORIENTATION_PROBLEM_H

#include <array>
#include <optional>

#include "screwline/model/joint.h"
#include "screwline/spatial/turn_batch.h"

namespace screwline {

/// One way to turn to the goal.
struct OrientationSolution {
  std::array<double, 3> q{};  ///< [rad], not wrapped.
  bool free = false;  ///< Axes 1 and 3 are in line: only a sum of their angles is fixed; q[0] is the preferred value.
  int sign = 0;  ///< Of the sine of the middle angle from where axes 1 and 3 come nearest; 0 where two solutions meet.
};

struct OrientationSolutions {
  std::array<OrientationSolution, 2> solutions;
  int count = 0;

  const OrientationSolution* begin() const { return solutions.data(); }
  const OrientationSolution* end() const { return solutions.data() + count; }
};

/// The same, its angles still to be taken: their turns are in a batch.
struct OrientationTurns {
  std::size_t place = 0;     ///< Of the first turn; the others follow.
  int count = 0;             ///< Solutions.
  bool free = false;         ///< As OrientationSolution.
  bool is_double = false;    ///< Two solutions meet in one.
  bool half_turned = false;  ///< The second has axes 1 and 3 half a turn on: of its turns only the middle one is there.
};

/// R1(q1) R2(q2) R3(q3) = Q for three revolute axes of any directions (neighbours not parallel): what axis 1 keeps of
/// axis 3's image gives the middle angle, the others follow (Paden's second subproblem; Craig, ch. 4.7). Seen from a
/// frame N on axis 1 and a frame F on axis 3, N^T Q F = Rz(q1) Ry(a) Rz(u) Ry(-b) Rz(q3), with a and b the angles
/// between neighbours and u the middle angle from where axes 1 and 3 come nearest. Solving allocates nothing.
class OrientationProblem {
 public:
  /// Sine below which axis 3 counts as in line with axis 1: rounding.
  static constexpr double kInLine = 1e-13;

  /// Empty where neighbouring directions are parallel.
  static std::optional<OrientationProblem> compile(const std::array<Axis, 3>& axes);

  /// @param preferred value of q1 where it turns out free.
  void solve(const Matrix3& Q, double preferred, OrientationSolutions& solutions) const {
    TurnBatch batch;
    const OrientationTurns turns = turnsInFrames(near_.transpose() * Q * far_, 0.0, preferred, batch);
    batch.takeAngles();
    takeFrom(batch, turns, preferred, solutions);
  }

  /// The turns of all solutions for M = N^T Q F, added to the batch (6 at most); takeFrom() makes solutions of them
  /// once the batch has taken its angles. `error` [rad] of M beyond rounding: axes that it may have put out of line are
  /// in line.
  OrientationTurns turnsInFrames(const Matrix3& M, double error, double preferred, TurnBatch& batch) const;
  static void takeFrom(const TurnBatch& batch, const OrientationTurns& turns, double preferred,
                       OrientationSolutions& solutions);

  bool isAcross() const { return across_; }           ///< Neighbours are at right angles.
  const Matrix3& nearFrame() const { return near_; }  ///< N; its z is axis 1.
  const Matrix3& farFrame() const { return far_; }    ///< F; its z is axis 3.

 private:
  struct Middle {
    Turn turn;  ///< u, in [0, pi].
    bool reached = true;
    bool is_double = false;
  };
  Middle middleOf(double cosine, double sine) const;
  void addAcross(const Matrix3& M, double sine, TurnBatch& batch) const;

  Matrix3 near_;
  Matrix3 far_;
  Turn first_;    ///< Between axes 1 and 2, in (0, pi).
  Turn second_;   ///< Between axes 2 and 3.
  Turn nearest_;  ///< Middle angle at which axis 3 is nearest to axis 1.
  Turn half_sum_;
  Turn half_difference_;
  bool across_ = false;  ///< Neighbours are at right angles.
};

}  // namespace screwline

#endif  // SCREWLINE_IK_CLOSED_FORM_ORIENTATION_PROBLEM_H

#ifndef SCREWLINE_SRC_IK_ALGEBRAIC_ROOT_REFINER_H
#define SCREWLINE_SRC_IK_ALGEBRAIC_ROOT_REFINER_H

#include "screwline/ik/algebraic/algebraic_solver.h"

namespace screwline {

/// Takes approximate solutions of one pose to the chain's true ones and gathers them. No allocation.
class RootRefiner {
 public:
  /// `length` [m] weighs positions against angles.
  RootRefiner(const SerialChain& chain, double length, const Pose& target, AlgebraicSolutions& solutions);

  /// Newton's method, verification, comparison with what is there. A solution that is almost singular brings the one
  /// that it almost meets.
  void add(Vector6 q);
  const AlgebraicSolutions& solutions() const { return solutions_; }
  /// How many solutions the one at `place` is: 1 where it is regular, 2 at a fold unless the other one is known as
  /// well; 0: any number from 2 on.
  int multiplicity(int place) const;
  /// Looks for self-motions through the solutions that are singular, and sets `degenerate`.
  void findContinua();

 private:
  struct Point {
    Vector6 residual;  ///< Target minus pose: position over length, rotation.
    Matrix6 J;         ///< Its derivative, negative.
    double error = 0.0;
  };

  /// Where J is almost singular, J n = sigma u: a step t n changes the residual by -sigma t u - t^2 / 2 bend.
  struct Fold {
    Vector6 u;
    Vector6 n;  ///< [rad], [lengths]
    Vector6 bend;
    double sigma = 0.0;
    double largest = 0.0;      ///< Of the singular values.
    double kappa = 0.0;        ///< u . bend
    bool is_only_one = false;  ///< No other direction is almost lost.
  };

  /// What steps have come to.
  struct Convergence {
    bool is_slow = false;       ///< Newton's, from the last place.
    bool newton_fails = false;  ///< From here.
    bool may_cross = true;      ///< A fold, as far as is known.
    bool crosses = false;       ///< The present step does.
  };

  void evaluate(const Vector6& q, Point& point) const;
  bool undampedStep(const Vector6& q, const Point& point, Convergence& so_far, Vector6& step) const;
  bool refine(Vector6& q, Point& point) const;
  bool isKnown(const Vector6& q) const;
  void insert(const Vector6& q);
  bool isSame(const Vector6& a, const Vector6& b) const;
  Vector6 difference(const Vector6& to, const Vector6& from) const;
  Fold foldAt(const Vector6& q, const Point& point) const;
  static bool stepAcross(const Point& point, const Fold& fold, Vector6& step);
  void addFold(const Vector6& q, const Point& point);
  bool continues(const Vector6& q, const Vector6& direction) const;

  const SerialChain& chain_;
  double length_;
  Vector6 unit_ = Vector6::Ones();  ///< Of the joints' steps: rad, or the length.
  const Pose& target_;
  AlgebraicSolutions& solutions_;
};

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_ALGEBRAIC_ROOT_REFINER_H

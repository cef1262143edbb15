#ifndef SCREWLINE_SRC_TRAJECTORY_CURVE_TRACER_H
#define SCREWLINE_SRC_TRAJECTORY_CURVE_TRACER_H

#include <vector>

#include "path_system.h"
#include "screwline/trajectory/piecewise_polynomial.h"

namespace screwline {

enum class TraceEnd {
  kGoal,
  kFold,   ///< The curve turns back: two solutions meet and vanish.
  kLimit,  ///< Of a redundant chain: a joint is at its limit and the others cannot help it.
  kLost,   ///< No step, however short, stays on the curve.
};

/// A curve (q, u) as quintic pieces over its arc length: n + 1 rows, the last one u.
struct TracedCurve {
  PiecewisePolynomial curve;  ///< Without pieces where not one step was possible.
  TraceEnd end = TraceEnd::kGoal;
  VectorX last;            ///< y where it ends.
  int joint = -1;          ///< kLimit: which.
  double deviation = 0.0;  ///< Largest error of the pieces met when they were checked [m or rad, in units].
};

/// Follows a curve of a PathSystem by predictor and corrector with steps of adapted length (Allgower & Georg,
/// Numerical Continuation Methods): by arc length, so that neither a fold nor the quick turn of a wrist beside its
/// singularity is anything special. A step is taken only where the quintic between its ends stays within the tolerance
/// of the path; so a curve cannot be left for another that is farther away than that, and curves that cross (an exactly
/// met singularity) are followed straight on.
class CurveTracer {
 public:
  CurveTracer(PathSystem& system, const SerialChain& chain, double tolerance);

  /// From y (a solution) with u growing (sign 1) or falling (-1), to u = goal. @pre sign * (goal - u) > 0.
  TracedCurve trace(const VectorX& y, double sign, double goal);

 private:
  struct Knot {
    VectorX y;
    VectorX direction;
    VectorX bend;
    double gap = 0.0;
  };
  struct Piece {
    double length = 0.0;
    std::vector<Polynomial> rows;
  };

  Knot knotAt(const VectorX& y, const VectorX& previous);
  Piece pieceBetween(const Knot& from, const Knot& to) const;
  VectorX valueOf(const Piece& piece, double x) const;
  double errorOf(const Piece& piece);
  bool tryStep(const Knot& from, double h, Knot& to, Piece& piece, double& error);
  bool step(const Knot& from, double& h, Knot& to, Piece& piece);
  bool arrive(const Knot& from, const Knot& to, const Piece& piece, double sign, double goal, TracedCurve& result);
  bool landOn(const Knot& from, const Piece& piece, double x, double goal);
  bool meetsLimit(const Piece& piece, TracedCurve& result);
  void append(const Piece& piece) { pieces_.push_back(piece); }
  void finish(TracedCurve& result) const;

  PathSystem& system_;
  const SerialChain& chain_;
  double tolerance_;
  int n_;
  double worst_ = 0.0;
  std::vector<Piece> pieces_;
};

}  // namespace screwline

#endif  // SCREWLINE_SRC_TRAJECTORY_CURVE_TRACER_H

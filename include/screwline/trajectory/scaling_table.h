#ifndef SCREWLINE_TRAJECTORY_SCALING_TABLE_H
#define SCREWLINE_TRAJECTORY_SCALING_TABLE_H

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "screwline/trajectory/break_table.h"
#include "screwline/trajectory/piecewise_polynomial.h"
#include "screwline/trajectory/sample_kernel.h"

namespace screwline {

/// 1 / length, the next larger number where the product of the two would come out below 1; 0 where the length is none.
inline double inverseLengthOf(double length) {
  if (!(length > kNoTime)) return 0.0;
  double inverse = 1.0 / length;
  while (inverse * length < 1.0) inverse = std::nextafter(inverse, std::numeric_limits<double>::infinity());
  return inverse;
}

/// A scalar s(t) from polynomial pieces, laid out to be sampled: for each piece, rows of the coefficients of x^k in s,
/// s', s'', s''', so that one pass gives all four.
class ScalingTable {
 public:
  ScalingTable() = default;

  /// @param pieces of one joint with breaks from 0. @param stretch how much longer the motion takes than the breaks say
  /// (derivatives are by the stretched time). Allocates.
  explicit ScalingTable(const PiecewisePolynomial& pieces, double stretch = 1.0);

  bool empty() const { return spans_.empty(); }
  bool hasLongRows() const { return long_rows_; }

  /// The rows that hold at t and the place of t in their piece; at a breakpoint the later piece's, behind the last
  /// the end. Does not allocate. @pre t >= 0
  ScalingRows at(double t) const {
    const std::size_t k = breaks_.find(t);
    const Span& span = spans_[k];
    const double x = std::min(1.0, (t - span.start) * span.inverse_length);
    return {rows_.data() + k * stride_, long_rows_, x};
  }

 private:
  struct Span {
    double start = 0.0;
    double inverse_length = 1.0;  ///< Rounded up: at its end the place in a piece is 1. 0 for one that takes no time.
  };

  BreakTable breaks_;
  std::vector<Span> spans_;
  std::vector<double> rows_;
  std::size_t stride_ = 32;
  bool long_rows_ = true;  ///< 8 rows for each piece, else 4.
};

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_SCALING_TABLE_H

#include "screwline/trajectory/scaling_table.h"

#include <algorithm>
#include <limits>

namespace screwline {

ScalingTable::ScalingTable(const PiecewisePolynomial& pieces, double stretch)
    : row_count_(pieces.degree > 5   ? 8
                 : pieces.degree > 3 ? 6
                                     : 4) {
  std::vector<double> breaks;
  for (double b : pieces.breaks) breaks.push_back(b * stretch);
  breaks_ = BreakTable(breaks);
  few_.assign(kFew, std::numeric_limits<double>::infinity());
  if (pieces.segments() >= 2 && pieces.segments() <= kFew + 1)
    std::copy(breaks.begin() + 1, breaks.end() - 1, few_.begin());
  const std::size_t rows = static_cast<std::size_t>(row_count_);
  pieces_.resize(pieces.segments() * strideOf(row_count_), 0.0);
  double* to = pieces_.data();
  for (std::size_t segment = 0; segment < pieces.segments(); ++segment, to += strideOf(row_count_)) {
    const double inverse_length = inverseLengthOf(breaks[segment + 1] - breaks[segment]);
    Polynomial derivative = pieces.piece(segment, 0);
    double rate = 1.0;
    for (std::size_t order = 0; order < 4; ++order) {
      for (std::size_t k = 0; k < rows; ++k) to[4 * k + order] = derivative.c[k] * rate;
      derivative = derivative.derivative();
      rate *= inverse_length;
    }
    to[4 * rows] = breaks[segment];
    to[4 * rows + 1] = inverse_length;
  }
}

}  // namespace screwline

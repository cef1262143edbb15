#include "screwline/trajectory/scaling_table.h"

namespace screwline {

ScalingTable::ScalingTable(const PiecewisePolynomial& pieces, double stretch)
    : stride_(pieces.degree > 3 ? 32 : 16), long_rows_(pieces.degree > 3) {
  std::vector<double> breaks;
  for (double b : pieces.breaks) breaks.push_back(b * stretch);
  breaks_ = BreakTable(breaks);
  for (std::size_t segment = 0; segment < pieces.segments(); ++segment) {
    const double inverse_length = inverseLengthOf(breaks[segment + 1] - breaks[segment]);
    spans_.push_back({breaks[segment], inverse_length});
    const std::size_t begin = rows_.size();
    rows_.resize(begin + stride_, 0.0);
    Polynomial derivative = pieces.piece(segment, 0);
    double rate = 1.0;
    for (std::size_t order = 0; order < 4; ++order) {
      for (std::size_t k = 0; 4 * k < stride_; ++k) rows_[begin + 4 * k + order] = derivative.c[k] * rate;
      derivative = derivative.derivative();
      rate *= inverse_length;
    }
  }
}

}  // namespace screwline

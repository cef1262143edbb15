#ifndef SCREWLINE_SRC_TRAJECTORY_PENTADIAGONAL_H
#define SCREWLINE_SRC_TRAJECTORY_PENTADIAGONAL_H

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace screwline {

/// A symmetric matrix of five diagonals: [row] the diagonal and the two entries right of it.
class Pentadiagonal {
 public:
  explicit Pentadiagonal(std::size_t size) : rows_(size + 2) {}

  void clear() { std::fill(rows_.begin(), rows_.end(), std::array<double, 3>{}); }
  double& at(std::size_t row, std::size_t right) { return rows_[row][right]; }

  void fix(std::size_t row) {
    rows_[row] = {1.0, 0.0, 0.0};
    if (row >= 1) rows_[row - 1][1] = 0.0;
    if (row >= 2) rows_[row - 2][2] = 0.0;
  }

  /// Factors in place and solves: L D L^T. @pre positive definite.
  void solve(std::vector<double>& x) {
    const std::size_t n = x.size();
    for (std::size_t i = 0; i < n; ++i) {
      auto& row = rows_[i];
      const double one = row[1] / row[0];
      const double two = row[2] / row[0];
      if (i + 1 < n) {
        rows_[i + 1][0] -= one * row[1];
        rows_[i + 1][1] -= one * row[2];
        x[i + 1] -= one * x[i];
      }
      if (i + 2 < n) {
        rows_[i + 2][0] -= two * row[2];
        x[i + 2] -= two * x[i];
      }
      row[1] = one;
      row[2] = two;
    }
    for (std::size_t i = n; i-- > 0;) {
      x[i] /= rows_[i][0];
      if (i + 1 < n) x[i] -= rows_[i][1] * x[i + 1];
      if (i + 2 < n) x[i] -= rows_[i][2] * x[i + 2];
    }
  }

 private:
  std::vector<std::array<double, 3>> rows_;
};

}  // namespace screwline

#endif  // SCREWLINE_SRC_TRAJECTORY_PENTADIAGONAL_H

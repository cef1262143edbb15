#include "singular_matrix.h"

#include <array>
#include <cmath>
#include <utility>

namespace screwline {
namespace {

Eigen::Index largestBelow(const Matrix6& M, Eigen::Index step) {
  Eigen::Index best = step;
  for (Eigen::Index i = step + 1; i < 6; ++i) {
    if (std::abs(M(i, step)) > std::abs(M(best, step))) best = i;
  }
  return best;
}

/// Subtracts the pivot row from those below; the factors stay where zeros would be.
void eliminate(Matrix6& M, Eigen::Index step) {
  const double inverse = 1.0 / M(step, step);
  for (Eigen::Index i = step + 1; i < 6; ++i) M(i, step) *= inverse;
  for (Eigen::Index j = step + 1; j < 6; ++j) {
    const double factor = M(step, j);
    for (Eigen::Index i = step + 1; i < 6; ++i) M(i, j) -= M(i, step) * factor;
  }
}

}  // namespace

double determinantOf(Matrix6 M) {
  double determinant = 1.0;
  for (Eigen::Index step = 0; step < 6; ++step) {
    const Eigen::Index pivot = largestBelow(M, step);
    if (pivot != step) {
      M.row(pivot).swap(M.row(step));
      determinant = -determinant;
    }
    if (M(step, step) == 0.0) return 0.0;
    determinant *= M(step, step);
    eliminate(M, step);
  }
  return determinant;
}

NullVectors nullVectorsOf(Matrix6 M) {
  std::array<Eigen::Index, 6> rows{{0, 1, 2, 3, 4, 5}};
  std::array<Eigen::Index, 6> columns = rows;
  double first = 0.0;
  for (Eigen::Index step = 0; step < 5; ++step) {
    Eigen::Index row = 0;
    Eigen::Index column = 0;
    M.bottomRightCorner(6 - step, 6 - step).cwiseAbs().maxCoeff(&row, &column);
    row += step;
    column += step;
    M.row(row).swap(M.row(step));
    M.col(column).swap(M.col(step));
    std::swap(rows[static_cast<std::size_t>(row)], rows[static_cast<std::size_t>(step)]);
    std::swap(columns[static_cast<std::size_t>(column)], columns[static_cast<std::size_t>(step)]);
    if (step == 0) first = std::abs(M(0, 0));
    if (M(step, step) == 0.0) break;
    eliminate(M, step);
  }
  NullVectors null;
  Vector6 right = Vector6::Unit(5);
  Vector6 left = Vector6::Unit(5);
  for (Eigen::Index i = 4; i >= 0; --i) {
    double along_row = 0.0;
    double along_column = 0.0;
    for (Eigen::Index j = i + 1; j < 6; ++j) {
      along_row += M(i, j) * right[j];
      along_column += M(j, i) * left[j];
    }
    right[i] = M(i, i) != 0.0 ? -along_row / M(i, i) : 0.0;
    left[i] = -along_column;
  }
  for (std::size_t i = 0; i < 6; ++i) {
    null.right[columns[i]] = right[static_cast<Eigen::Index>(i)];
    null.left[rows[i]] = left[static_cast<Eigen::Index>(i)];
  }
  null.pivot_ratio = first > 0.0 ? std::abs(M(5, 5)) / first : 0.0;
  return null;
}

bool solveLinear(Matrix6 M, Vector6 b, Vector6& x) {
  for (Eigen::Index step = 0; step < 6; ++step) {
    const Eigen::Index pivot = largestBelow(M, step);
    if (pivot != step) {
      M.row(pivot).swap(M.row(step));
      std::swap(b[pivot], b[step]);
    }
    if (M(step, step) == 0.0) return false;
    eliminate(M, step);
    for (Eigen::Index i = step + 1; i < 6; ++i) b[i] -= M(i, step) * b[step];
  }
  for (Eigen::Index j = 5; j >= 0; --j) {
    x[j] = b[j] / M(j, j);
    for (Eigen::Index i = 0; i < j; ++i) b[i] -= M(i, j) * x[j];
  }
  return true;
}

}  // namespace screwline

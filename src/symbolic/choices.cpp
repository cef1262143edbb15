#include "choices.h"

#include <algorithm>

#include "screwline/kinematics/singularity.h"
#include "screwline/spatial/svd.h"

namespace screwline {
namespace {

constexpr double kIndependent = 1e-6;  ///< Smallest over largest singular value, of columns and of directions.

}  // namespace

std::vector<std::vector<int>> choicesOf(int size, int count) {
  std::vector<std::vector<int>> all;
  std::vector<bool> taken(static_cast<std::size_t>(size), false);
  std::fill_n(taken.begin(), count, true);
  do {
    std::vector<int> choice;
    for (int i = 0; i < size; ++i) {
      if (taken[static_cast<std::size_t>(i)]) choice.push_back(i);
    }
    all.push_back(choice);
  } while (std::prev_permutation(taken.begin(), taken.end()));
  return all;
}

MatrixX selected(const MatrixX& matrix, const std::vector<int>& rows, const std::vector<int>& columns) {
  MatrixX result(rows.size(), columns.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t j = 0; j < columns.size(); ++j)
      result(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = matrix(rows[i], columns[j]);
  }
  return result;
}

TrigMatrix selected(const TrigMatrix& matrix, const std::vector<int>& rows, const std::vector<int>& columns) {
  return matrix.selected(rows).transposed().selected(columns).transposed();
}

MatrixX valuesOf(const ExactChain& exact, const TrigMatrix& matrix, const VectorX& q) {
  const std::vector<double> values = exact.table.symbols.valuesAt(q);
  MatrixX result(matrix.rows(), matrix.columns());
  for (int i = 0; i < matrix.rows(); ++i) {
    for (int j = 0; j < matrix.columns(); ++j) result(i, j) = matrix(i, j).evaluate(values);
  }
  return result;
}

bool hasFullRank(const MatrixX& matrix) {
  const VectorX values = singularValues(matrix);
  return values.size() == 0 || values[values.size() - 1] > kIndependent * values[0];
}

MatrixX leftNull(const MatrixX& matrix, double zero, double least) {
  if (matrix.cols() == 0) return MatrixX::Identity(matrix.rows(), matrix.rows());
  const Svd svd(matrix, Eigen::ComputeFullU);
  const VectorX& values = svd.singularValues();
  const Eigen::Index rank = (values.array() > std::max(zero * values[0], least)).count();
  return svd.matrixU().rightCols(matrix.rows() - rank);
}

TrigMatrix withoutZeros(const TrigMatrix& matrix, const std::vector<MatrixX>& values) {
  double largest = 0.0;
  for (const MatrixX& at_point : values) largest = std::max(largest, at_point.cwiseAbs().maxCoeff());
  TrigMatrix result = matrix;
  for (int i = 0; i < matrix.rows(); ++i) {
    for (int j = 0; j < matrix.columns(); ++j) {
      const bool zero = std::all_of(values.begin(), values.end(), [&](const MatrixX& at_point) {
        return std::abs(at_point(i, j)) <= kNothing * largest;
      });
      if (zero) result(i, j) = TrigPolynomial(matrix.ring());
    }
  }
  return result;
}

}  // namespace screwline

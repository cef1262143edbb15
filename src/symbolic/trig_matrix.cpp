#include "trig_matrix.h"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

namespace screwline {
namespace {

/// Set of columns, one bit each.
using ColumnSet = std::uint64_t;

/// Determinants of the first rows with every set of as many columns, row after row (Laplace's expansion, each
/// subdeterminant once). None where one has more than `most_terms`.
std::optional<std::map<ColumnSet, TrigPolynomial>> minorsOfRows(const TrigMatrix& matrix, std::size_t most_terms) {
  std::map<ColumnSet, TrigPolynomial> minors;
  minors.emplace(ColumnSet{0}, TrigPolynomial::number(matrix.ring(), 1));
  for (int row = 0; row < matrix.rows(); ++row) {
    std::map<ColumnSet, TrigPolynomial> next;
    for (const auto& [columns, minor] : minors) {
      int sign = 1;
      for (int j = matrix.columns() - 1; j >= 0; --j) {
        const ColumnSet bit = ColumnSet{1} << j;
        if ((columns & bit) != 0) {
          sign = -sign;
          continue;
        }
        if (matrix(row, j).isZero() || minor.isZero()) continue;
        TrigPolynomial part = matrix(row, j) * minor;
        const auto entry = next.try_emplace(columns | bit, matrix.ring()).first;
        if (sign > 0) {
          entry->second += part;
        } else {
          entry->second -= part;
        }
      }
    }
    const bool is_long = std::any_of(
        next.begin(), next.end(), [most_terms](const auto& minor) { return minor.second.terms().size() > most_terms; });
    if (is_long) return std::nullopt;
    minors = std::move(next);
  }
  return minors;
}

}  // namespace

TrigMatrix::TrigMatrix(RingPointer ring, int rows, int columns)
    : ring_(std::move(ring)),
      rows_(rows),
      columns_(columns),
      entries_(static_cast<std::size_t>(rows * columns), TrigPolynomial(ring_)) {}

TrigMatrix TrigMatrix::identity(const RingPointer& ring, int size) {
  TrigMatrix result(ring, size, size);
  for (int i = 0; i < size; ++i) result(i, i) = TrigPolynomial::number(ring, 1);
  return result;
}

TrigMatrix TrigMatrix::transposed() const {
  TrigMatrix result(ring_, columns_, rows_);
  for (int i = 0; i < rows_; ++i) {
    for (int j = 0; j < columns_; ++j) result(j, i) = (*this)(i, j);
  }
  return result;
}

TrigMatrix TrigMatrix::column(int j) const {
  TrigMatrix result(ring_, rows_, 1);
  for (int i = 0; i < rows_; ++i) result(i, 0) = (*this)(i, j);
  return result;
}

void TrigMatrix::setBlock(int row, int column, const TrigMatrix& block) {
  for (int i = 0; i < block.rows(); ++i) {
    for (int j = 0; j < block.columns(); ++j) (*this)(row + i, column + j) = block(i, j);
  }
}

TrigMatrix TrigMatrix::selected(const std::vector<int>& rows) const {
  TrigMatrix result(ring_, static_cast<int>(rows.size()), columns_);
  for (int i = 0; i < result.rows(); ++i) {
    for (int j = 0; j < columns_; ++j) result(i, j) = (*this)(rows[static_cast<std::size_t>(i)], j);
  }
  return result;
}

std::size_t TrigMatrix::termCount() const {
  return std::accumulate(entries_.begin(), entries_.end(), std::size_t{0},
                         [](std::size_t sum, const TrigPolynomial& entry) { return sum + entry.terms().size(); });
}

TrigMatrix TrigMatrix::operator-() const {
  TrigMatrix result = *this;
  for (TrigPolynomial& entry : result.entries_) entry = -entry;
  return result;
}

TrigMatrix operator*(const TrigMatrix& a, const TrigMatrix& b) {
  TrigMatrix result(a.ring(), a.rows(), b.columns());
  for (int i = 0; i < a.rows(); ++i) {
    for (int j = 0; j < b.columns(); ++j) {
      for (int k = 0; k < a.columns(); ++k) {
        if (!a(i, k).isZero() && !b(k, j).isZero()) result(i, j) += a(i, k) * b(k, j);
      }
    }
  }
  return result;
}

TrigMatrix operator+(const TrigMatrix& a, const TrigMatrix& b) {
  TrigMatrix result = a;
  for (int i = 0; i < a.rows(); ++i) {
    for (int j = 0; j < a.columns(); ++j) result(i, j) += b(i, j);
  }
  return result;
}

TrigMatrix operator-(const TrigMatrix& a, const TrigMatrix& b) {
  return a + (-b);
}

TrigMatrix operator*(const TrigPolynomial& a, const TrigMatrix& b) {
  TrigMatrix result = b;
  for (int i = 0; i < b.rows(); ++i) {
    for (int j = 0; j < b.columns(); ++j) result(i, j) = a * b(i, j);
  }
  return result;
}

TrigMatrix cross(const TrigMatrix& a, const TrigMatrix& b) {
  TrigMatrix result(a.ring(), 3, 1);
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const int k = (i + 2) % 3;
    result(i, 0) = a(j, 0) * b(k, 0) - a(k, 0) * b(j, 0);
  }
  return result;
}

TrigPose operator*(const TrigPose& a, const TrigPose& b) {
  return {a.R * b.R, a.R * b.p + a.p};
}

std::vector<TrigPolynomial> largestMinors(const TrigMatrix& matrix) {
  return *largestMinors(matrix, std::numeric_limits<std::size_t>::max());
}

std::optional<std::vector<TrigPolynomial>> largestMinors(const TrigMatrix& matrix, std::size_t most_terms) {
  if (matrix.rows() > matrix.columns()) return largestMinors(matrix.transposed(), most_terms);
  const std::optional<std::map<ColumnSet, TrigPolynomial>> found = minorsOfRows(matrix, most_terms);
  if (!found) return std::nullopt;
  std::vector<TrigPolynomial> all;
  for (ColumnSet set = 0; set < (ColumnSet{1} << matrix.columns()); ++set) {
    int count = 0;
    for (ColumnSet rest = set; rest != 0; rest &= rest - 1) ++count;
    if (count != matrix.rows()) continue;
    const auto minor = found->find(set);
    all.push_back(minor == found->end() ? TrigPolynomial(matrix.ring()) : minor->second);
  }
  return all;
}

TrigPolynomial determinant(const TrigMatrix& matrix) {
  return largestMinors(matrix).front();
}

}  // namespace screwline

#ifndef SCREWLINE_SRC_SYMBOLIC_CHOICES_H
#define SCREWLINE_SRC_SYMBOLIC_CHOICES_H

#include <vector>

#include "exact_chain.h"

namespace screwline {

/// All choices of `count` of 0..size-1, ascending, in lexicographic order. @pre 0 <= count <= size
std::vector<std::vector<int>> choicesOf(int size, int count);

MatrixX selected(const MatrixX& matrix, const std::vector<int>& rows, const std::vector<int>& columns);
TrigMatrix selected(const TrigMatrix& matrix, const std::vector<int>& rows, const std::vector<int>& columns);

/// The matrix with the symbols' values at q.
MatrixX valuesOf(const ExactChain& exact, const TrigMatrix& matrix, const VectorX& q);

/// Whether the smallest singular value counts beside the largest.
bool hasFullRank(const MatrixX& matrix);

/// Orthonormal columns l with l . matrix = 0: singular values below the share `zero` of the largest, and below `least`,
/// are none.
MatrixX leftNull(const MatrixX& matrix, double zero, double least = 0.0);

/// The largest of each entry at the configurations, beside which nothing is left of one that is zero at all of them.
constexpr double kNothing = 1e-9;

/// The matrix with the entries that are zero at all of the configurations left out.
TrigMatrix withoutZeros(const TrigMatrix& matrix, const std::vector<MatrixX>& values);

}  // namespace screwline

#endif  // SCREWLINE_SRC_SYMBOLIC_CHOICES_H

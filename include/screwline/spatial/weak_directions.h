#ifndef SCREWLINE_SPATIAL_WEAK_DIRECTIONS_H
#define SCREWLINE_SPATIAL_WEAK_DIRECTIONS_H

#include "screwline/spatial/small_svd.h"

namespace screwline {

/// The two smallest singular values (one of a 1 x 1 matrix) of a square matrix of up to six rows with their vectors:
/// A V = U diag(sigma), A^T U = V diag(sigma).
struct WeakDirections {
  SmallMatrix U;      ///< Two columns.
  SmallVector sigma;  ///< Descending; as SmallSvd's, never quite zero.
  SmallMatrix V;
  double largest = 0.0;  ///< Singular value.
  double product = 0.0;  ///< Of all singular values.
};

/// From the whole decomposition. No allocation.
WeakDirections weakDirectionsOf(const SmallSvd& svd);

/// The same by inverse iteration on the triangular factor, two vectors at once (Golub & Van Loan, Matrix Computations,
/// ch. 8.2): a few steps where the smallest value is far below the others; where the steps do not settle, and so among
/// three small ones, from the whole decomposition. The second one's vectors are exact only where it is below a
/// thousandth of the largest. No allocation.
/// @param largest singular value of A.
WeakDirections weakDirectionsOf(const SmallMatrix& A, double largest);

}  // namespace screwline

#endif  // SCREWLINE_SPATIAL_WEAK_DIRECTIONS_H

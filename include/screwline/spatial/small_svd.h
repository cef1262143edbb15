#ifndef SCREWLINE_SPATIAL_SMALL_SVD_H
#define SCREWLINE_SPATIAL_SMALL_SVD_H

#include "screwline/spatial/pose.h"

namespace screwline {

using SmallMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;
using SmallVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1>;

/// Singular value decomposition A = U diag(sigma) V^T of a square matrix of up to six rows, by one-sided Jacobi
/// rotations of its triangular factor (Drmac & Veselic 2008): as exact as Svd, several times as fast. U and V are
/// orthogonal to rounding whatever the rank; singular values below 1e-30 of the largest are that. No allocation.
struct SmallSvd {
  explicit SmallSvd(const SmallMatrix& A);

  SmallMatrix U;
  SmallVector sigma;  ///< Descending.
  SmallMatrix V;
};

}  // namespace screwline

#endif  // SCREWLINE_SPATIAL_SMALL_SVD_H

#ifndef SCREWLINE_SPATIAL_SVD_H
#define SCREWLINE_SPATIAL_SVD_H

#include <Eigen/SVD>

#include "screwline/spatial/pose.h"

namespace screwline {

/// Singular value decomposition (one-sided Jacobi, after Golub & Van Loan, Matrix Computations, 8.6) of a matrix of any
/// shape. Allocates.
using Svd = Eigen::JacobiSVD<MatrixX>;

}  // namespace screwline

// Compiled once, in svd.cpp: each file that made its own would take the compiler seconds.
extern template class Eigen::JacobiSVD<screwline::MatrixX>;

#endif  // SCREWLINE_SPATIAL_SVD_H

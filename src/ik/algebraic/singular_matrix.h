#ifndef SCREWLINE_SRC_IK_ALGEBRAIC_SINGULAR_MATRIX_H
#define SCREWLINE_SRC_IK_ALGEBRAIC_SINGULAR_MATRIX_H

#include "screwline/spatial/pose.h"

namespace screwline {

/// Null vectors of a matrix that is almost singular, and how singular it is.
struct NullVectors {
  Vector6 left;
  Vector6 right;
  double pivot_ratio = 0.0;  ///< The last pivot over the first.
};

/// By elimination with partial pivoting.
double determinantOf(Matrix6 M);

/// By elimination with full pivoting: the last pivot is taken for zero.
NullVectors nullVectorsOf(Matrix6 M);

/// x with M x = b; false where a pivot is zero.
bool solveLinear(Matrix6 M, Vector6 b, Vector6& x);

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_ALGEBRAIC_SINGULAR_MATRIX_H

#ifndef SCREWLINE_SRC_SYMBOLIC_TRIG_MATRIX_H
#define SCREWLINE_SRC_SYMBOLIC_TRIG_MATRIX_H

#include <optional>
#include <vector>

#include "trig_polynomial.h"

namespace screwline {

/// A matrix of polynomials of one ring.
class TrigMatrix {
 public:
  TrigMatrix(RingPointer ring, int rows, int columns);
  static TrigMatrix identity(const RingPointer& ring, int size);

  int rows() const { return rows_; }
  int columns() const { return columns_; }
  const RingPointer& ring() const { return ring_; }
  const TrigPolynomial& operator()(int i, int j) const { return entries_[index(i, j)]; }
  TrigPolynomial& operator()(int i, int j) { return entries_[index(i, j)]; }
  TrigMatrix transposed() const;
  TrigMatrix column(int j) const;
  void setBlock(int row, int column, const TrigMatrix& block);
  TrigMatrix selected(const std::vector<int>& rows) const;
  std::size_t termCount() const;
  TrigMatrix operator-() const;

 private:
  std::size_t index(int i, int j) const { return static_cast<std::size_t>(i * columns_ + j); }

  RingPointer ring_;
  int rows_;
  int columns_;
  std::vector<TrigPolynomial> entries_;
};

TrigMatrix operator*(const TrigMatrix& a, const TrigMatrix& b);
TrigMatrix operator+(const TrigMatrix& a, const TrigMatrix& b);
TrigMatrix operator-(const TrigMatrix& a, const TrigMatrix& b);
TrigMatrix operator*(const TrigPolynomial& a, const TrigMatrix& b);
/// Of 3 x 1 columns.
TrigMatrix cross(const TrigMatrix& a, const TrigMatrix& b);

struct TrigPose {
  TrigMatrix R;
  TrigMatrix p;

  TrigPose inverse() const { return {R.transposed(), -(R.transposed() * p)}; }
};
TrigPose operator*(const TrigPose& a, const TrigPose& b);

/// All determinants of r rows and r columns, r the smaller of the matrix's sizes: entry by entry in the order of the
/// left-out rows or columns' complement, lexicographic. One where the matrix is square.
std::vector<TrigPolynomial> largestMinors(const TrigMatrix& matrix);
/// The same; none as soon as one of them, or of the smaller ones that they are made of, has more than `most_terms`.
std::optional<std::vector<TrigPolynomial>> largestMinors(const TrigMatrix& matrix, std::size_t most_terms);
TrigPolynomial determinant(const TrigMatrix& matrix);

}  // namespace screwline

#endif  // SCREWLINE_SRC_SYMBOLIC_TRIG_MATRIX_H

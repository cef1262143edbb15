#ifndef SCREWLINE_TRAJECTORY_SCALING_TABLE_H
#define SCREWLINE_TRAJECTORY_SCALING_TABLE_H

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <new>
#include <vector>

#include "screwline/trajectory/break_table.h"
#include "screwline/trajectory/piecewise_polynomial.h"
#include "screwline/trajectory/sample_kernel.h"

namespace screwline {

/// 1 / length, the next larger number where the product of the two would come out below 1; 0 where the length is none.
inline double inverseLengthOf(double length) {
  if (!(length > kNoTime)) return 0.0;
  double inverse = 1.0 / length;
  while (inverse * length < 1.0) inverse = std::nextafter(inverse, std::numeric_limits<double>::infinity());
  return inverse;
}

/// Memory from the beginning of a cache line on: no four neighbours that begin at a multiple of four are in two.
template <typename T>
struct CacheAligned {
  using value_type = T;
  static constexpr std::align_val_t kLine{64};
  CacheAligned() = default;
  template <typename U>
  CacheAligned(const CacheAligned<U>& /*other*/) {}
  T* allocate(std::size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), kLine)); }
  void deallocate(T* values, std::size_t /*n*/) { ::operator delete(values, kLine); }
  bool operator==(const CacheAligned& /*other*/) const { return true; }
  bool operator!=(const CacheAligned& /*other*/) const { return false; }
};
using AlignedValues = std::vector<double, CacheAligned<double>>;

/// A scalar s(t) from polynomial pieces, laid out to be sampled: for each piece, rows of the coefficients of x^k in s,
/// s', s'', s''', so that one pass gives all four.
class ScalingTable {
 public:
  ScalingTable() = default;

  /// @param pieces of one joint with breaks from 0. @param stretch how much longer the motion takes than the breaks say
  /// (derivatives are by the stretched time). Allocates.
  explicit ScalingTable(const PiecewisePolynomial& pieces, double stretch = 1.0);

  bool empty() const { return pieces_.empty(); }
  int rowCount() const { return row_count_; }                                 ///< 4, 6 or 8.
  std::size_t size() const { return pieces_.size() / strideOf(row_count_); }  ///< Pieces.

  /// The rows that hold at t and the place of t in their piece; at a breakpoint the later piece's, behind the last
  /// the end. Does not allocate. @pre t >= 0
  ScalingRows at(double t) const { return at(t, row_count_); }

  /// The same for code that is compiled for one number of rows. @pre row_count is rowCount()
  ScalingRows at(double t, int row_count) const { return in(breaks_.find(t), t, row_count); }

  /// The same for one piece alone. @pre size() is 1
  ScalingRows inOnly(double t, int row_count) const {
    return {pieces_.data(), row_count, std::min(1.0, t * pieces_[4 * static_cast<std::size_t>(row_count) + 1])};
  }

  /// The same in a piece that is known.
  ScalingRows in(std::size_t k, double t, int row_count) const {
    const double* piece = pieces_.data() + k * strideOf(row_count);
    const double* span = piece + 4 * row_count;
    return {piece, row_count, std::min(1.0, (t - span[0]) * span[1])};
  }

  /// Of at most kFew + 1 pieces the breaks between them, then infinity, kFew values: as few are compared all at once.
  static constexpr std::size_t kFew = 8;
  const double* fewBreaks() const { return few_.data(); }

 private:
  /// Whole cache lines for the rows of a piece, its start, and its inverse length: rounded up, so that the place at its
  /// end is 1, and 0 for a piece that takes no time.
  static std::size_t strideOf(int row_count) { return (4 * static_cast<std::size_t>(row_count) + 2 + 7) / 8 * 8; }

  BreakTable breaks_;
  AlignedValues few_;
  AlignedValues pieces_;
  int row_count_ = 8;
};

/// A scalar s(t) and what it moves: start + delta s(t), values of each joint.
struct ScaledLine {
  ScalingTable scale;         ///< Empty for the cycloid:
  double cycloid_rate = 0.0;  ///< [1/s] of its tau; 0: none.
  std::ptrdiff_t joints = 0;
  AlignedValues start;
  AlignedValues delta;
};

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_SCALING_TABLE_H

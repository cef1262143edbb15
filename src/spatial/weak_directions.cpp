#include "screwline/spatial/weak_directions.h"

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace screwline {
namespace {

constexpr double kFloor = 1e-30;    // Of the largest pivot, as SmallSvd has it.
constexpr double kSettled = 1e-14;  // By which a step may still move a unit vector.
constexpr double kRoughly = 0.1;    // The same of a value that is not weak, relative.
constexpr double kWeak = 1e-3;      // Of the largest singular value.
constexpr int kMostSteps = 8;
constexpr int kMostRotations = 4;

/// Two vectors side by side: [0] becomes that of the smallest singular value, [1] of the second smallest.
using Two = Eigen::Array2d;
using Vectors = std::array<Two, 6>;

/// An upper triangle whose inverse is applied to two vectors at a time.
class Triangle {
 public:
  explicit Triangle(const SmallMatrix& R) : n_(static_cast<std::size_t>(R.rows())) {
    const double floor = std::max(kFloor * std::abs(R(0, 0)), 1e-150);
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t k = i; k < n_; ++k) rows_[i][k] = R(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k));
      const double pivot = std::abs(rows_[i][i]) < floor ? floor : rows_[i][i];
      product_ *= std::abs(pivot);
      reciprocal_[i] = 1.0 / pivot;
    }
  }

  std::size_t size() const { return n_; }
  double product() const { return product_; }

  void solve(Vectors& x) const {
    for (std::size_t i = n_; i-- > 0;) {
      for (std::size_t k = i + 1; k < n_; ++k) x[i] -= rows_[i][k] * x[k];
      x[i] *= reciprocal_[i];
    }
  }

  void solveTransposed(Vectors& x) const {
    for (std::size_t i = 0; i < n_; ++i) {
      x[i] *= reciprocal_[i];
      for (std::size_t k = i + 1; k < n_; ++k) x[k] -= rows_[i][k] * x[i];
    }
  }

 private:
  std::size_t n_;
  std::array<std::array<double, 6>, 6> rows_{};
  std::array<double, 6> reciprocal_{};
  double product_ = 1.0;
};

double dot(const Vectors& x, std::size_t n) {
  double sum = 0.0;
  for (std::size_t i = 0; i < n; ++i) sum += x[i][0] * x[i][1];
  return sum;
}

Two squares(const Vectors& x, std::size_t n) {
  Two sum = Two::Zero();
  for (std::size_t i = 0; i < n; ++i) sum += x[i] * x[i];
  return sum;
}

/// Turns the two towards each other until they are orthogonal, the longer one first, and makes them of length 1.
/// Returns their lengths.
Two orthonormalize(Vectors& x, std::size_t n) {
  constexpr double kOrthogonal = std::numeric_limits<double>::epsilon();
  Two square = squares(x, n);
  for (int k = 0; k < kMostRotations; ++k) {
    const double c = dot(x, n);
    if (c * c <= kOrthogonal * kOrthogonal * square[0] * square[1]) break;
    const double cotangent = (square[1] - square[0]) / (2.0 * c);  // Of twice the angle.
    const double tangent =
        std::copysign(1.0, cotangent) / (std::abs(cotangent) + std::sqrt(1.0 + cotangent * cotangent));
    const double cosine = 1.0 / std::sqrt(1.0 + tangent * tangent);
    const double sine = cosine * tangent;
    for (std::size_t i = 0; i < n; ++i) {
      x[i] = Two(cosine * x[i][0] - sine * x[i][1], sine * x[i][0] + cosine * x[i][1]);
    }
    square = squares(x, n);
  }
  if (square[1] > square[0]) {
    for (std::size_t i = 0; i < n; ++i) x[i] = x[i].reverse().eval();
    square = square.reverse().eval();
  }
  const Two length = square.sqrt();
  for (std::size_t i = 0; i < n; ++i) x[i] /= length;
  return length;
}

/// By how much two pairs of unit vectors differ, up to their signs.
Two changeOf(const Vectors& a, const Vectors& b, std::size_t n) {
  Two same = Two::Zero();
  Two opposite = Two::Zero();
  for (std::size_t i = 0; i < n; ++i) {
    same += (a[i] - b[i]).square();
    opposite += (a[i] + b[i]).square();
  }
  return same.min(opposite).sqrt();
}

/// False where the steps do not settle.
bool iterate(const Triangle& R, double largest, Vectors& U, Vectors& V, Two& sigma) {
  const std::size_t n = R.size();
  V.fill(Two::Zero());
  V[n - 1][0] = 1.0;
  V[n - 2][1] = 1.0;
  sigma = Two::Zero();
  for (int k = 0; k < kMostSteps; ++k) {
    const Two known = sigma;
    U = V;
    R.solveTransposed(U);
    orthonormalize(U, n);
    Vectors next = U;
    R.solve(next);
    sigma = 1.0 / orthonormalize(next, n);
    const Two change = changeOf(next, V, n);
    V = next;
    const bool second =
        sigma[1] > kWeak * largest ? std::abs(known[1] - sigma[1]) <= kRoughly * sigma[1] : change[1] <= kSettled;
    // Half a step on, where U is, it would be less by the ratio of the values.
    if (change[0] * sigma[0] <= kSettled * sigma[1] && second) return true;
  }
  return false;
}

SmallMatrix columnsOf(const Vectors& x, Eigen::Index n) {
  SmallMatrix columns(n, 2);
  for (Eigen::Index i = 0; i < n; ++i) {
    columns(i, 0) = x[static_cast<std::size_t>(i)][1];
    columns(i, 1) = x[static_cast<std::size_t>(i)][0];
  }
  return columns;
}

template <typename Matrix>
WeakDirections byIteration(const Matrix& A, double largest) {
  const Eigen::Index n = A.rows();
  const Eigen::ColPivHouseholderQR<Matrix> qr(A);
  const Triangle R{SmallMatrix(qr.matrixQR())};
  Vectors U;
  Vectors V;
  Two sigma;
  if (!iterate(R, largest, U, V, sigma)) return weakDirectionsOf(SmallSvd(SmallMatrix(A)));
  WeakDirections weak;
  weak.U = columnsOf(U, n);
  for (Eigen::Index i = n; i-- > 0;) {
    // H = I - tau w w^T with w = (1, essential part) from row i on.
    const auto essential = qr.matrixQR().col(i).tail(n - i - 1);
    for (Eigen::Index k = 0; k < 2; ++k) {
      auto column = weak.U.col(k);
      const double share = qr.hCoeffs()[i] * (column[i] + essential.dot(column.tail(n - i - 1)));
      column[i] -= share;
      column.tail(n - i - 1) -= share * essential;
    }
  }
  weak.V = qr.colsPermutation() * columnsOf(V, n);
  weak.sigma.resize(2);
  weak.sigma << sigma[1], sigma[0];
  weak.largest = largest;
  weak.product = R.product();
  return weak;
}

}  // namespace

WeakDirections weakDirectionsOf(const SmallSvd& svd) {
  const Eigen::Index count = std::min<Eigen::Index>(2, svd.sigma.size());
  return {svd.U.rightCols(count), svd.sigma.tail(count), svd.V.rightCols(count), svd.sigma[0], svd.sigma.prod()};
}

WeakDirections weakDirectionsOf(const SmallMatrix& A, double largest) {
  if (A.rows() < 3) return weakDirectionsOf(SmallSvd(A));
  return A.rows() == 6 ? byIteration(Matrix6(A), largest) : byIteration(A, largest);
}

}  // namespace screwline

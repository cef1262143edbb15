#include "screwline/spatial/small_svd.h"

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace screwline {
namespace {

constexpr int kMaxSweeps = 30;
constexpr double kFloor = 1e-30;  ///< Of the largest pivot: below rounding, and it keeps all columns from vanishing.
constexpr double kOrthogonal = std::numeric_limits<double>::epsilon();  ///< Cosine of what needs no more rotation.
constexpr double kTiny = 1e-300;

/// Six whatever the size, the last of them zero: the compiler knows their length.
using Columns = Eigen::Matrix<double, 6, 6>;
using Column = Eigen::Matrix<double, 6, 1>;

/// Every column meets every other in five rounds of pairs that have none in common.
using Pair = std::array<Eigen::Index, 2>;
using Round = std::array<Pair, 3>;
constexpr std::array<Round, 5> kRounds = {{{{{0, 1}, {2, 5}, {3, 4}}},
                                           {{{0, 2}, {3, 1}, {4, 5}}},
                                           {{{0, 3}, {4, 2}, {5, 1}}},
                                           {{{0, 4}, {5, 3}, {1, 2}}},
                                           {{{0, 5}, {1, 4}, {2, 3}}}}};

/// Turns the pairs of columns of G towards each other until they are orthogonal, those of W with them; false where
/// they are.
bool rotate(const Round& round, Columns& G, Columns& W) {
  using Lanes = Eigen::Array<double, 4, 1>;  // Of three pairs, so that square roots and quotients run side by side.
  Lanes difference = Lanes::Zero();
  Lanes twice = Lanes::Zero();
  bool orthogonal = true;
  for (std::size_t p = 0; p < round.size(); ++p) {
    const auto lane = static_cast<Eigen::Index>(p);
    const double a = G.col(round[p][0]).squaredNorm();
    const double b = G.col(round[p][1]).squaredNorm();
    const double c = G.col(round[p][0]).dot(G.col(round[p][1]));
    difference[lane] = b - a;
    twice[lane] = 2.0 * c;
    orthogonal = orthogonal && c * c <= kOrthogonal * kOrthogonal * a * b;
  }
  if (orthogonal) return false;
  const Lanes length = (difference.square() + twice.square()).sqrt();
  const Lanes tangent = (difference < 0.0).select(-twice, twice) / (difference.abs() + length + kTiny);
  const Lanes cosine = (1.0 + tangent.square()).sqrt().inverse();
  const Lanes sine = cosine * tangent;
  for (std::size_t p = 0; p < round.size(); ++p) {
    const auto lane = static_cast<Eigen::Index>(p);
    for (Columns* M : {&G, &W}) {
      const Column first = M->col(round[p][0]);
      const Column second = M->col(round[p][1]);
      M->col(round[p][0]) = cosine[lane] * first - sine[lane] * second;
      M->col(round[p][1]) = sine[lane] * first + cosine[lane] * second;
    }
  }
  return true;
}

/// A P = Q R: then with R^T W = Y diag(sigma), A = (Q W) diag(sigma) (P Y)^T.
struct Factors {
  Columns G = Columns::Zero();          ///< R^T
  Columns W = Columns::Zero();          ///< Q
  std::array<Eigen::Index, 6> place{};  ///< Of R's columns in A.
};

template <typename Matrix>
Factors factorsOf(const Matrix& A) {
  const Eigen::Index n = A.rows();
  const Eigen::ColPivHouseholderQR<Matrix> qr(A);
  Factors factors;
  factors.G.topLeftCorner(n, n) = qr.matrixQR().transpose().template triangularView<Eigen::Lower>();
  factors.W.topLeftCorner(n, n) = qr.householderQ() * Matrix::Identity(n, n);
  const auto& places = qr.colsPermutation().indices();
  for (Eigen::Index i = 0; i < n; ++i) factors.place[static_cast<std::size_t>(i)] = places[i];
  const double floor = std::max(kFloor * std::abs(factors.G(0, 0)), 1e-150);
  for (Eigen::Index i = 0; i < n; ++i) {
    if (std::abs(factors.G(i, i)) < floor) factors.G(i, i) = floor;
  }
  return factors;
}

}  // namespace

SmallSvd::SmallSvd(const SmallMatrix& A) : sigma(A.rows()), V(A.rows(), A.rows()) {
  const Eigen::Index n = A.rows();
  auto [G, W, place] = n == 6 ? factorsOf<Columns>(A) : factorsOf<SmallMatrix>(A);
  bool turned = true;
  for (int sweep = 0; sweep < kMaxSweeps && turned; ++sweep) {
    turned = false;
    for (const Round& round : kRounds) turned = rotate(round, G, W) || turned;
  }
  U = W.topLeftCorner(n, n);
  for (Eigen::Index i = 0; i < n; ++i) V.row(place[static_cast<std::size_t>(i)]) = G.row(i).head(n);
  for (Eigen::Index i = 0; i < n; ++i) sigma[i] = V.col(i).norm();
  for (Eigen::Index i = 0; i < n; ++i) {
    Eigen::Index largest = 0;
    sigma.tail(n - i).maxCoeff(&largest);
    if (largest > 0) {
      std::swap(sigma[i], sigma[i + largest]);
      U.col(i).swap(U.col(i + largest));
      V.col(i).swap(V.col(i + largest));
    }
    V.col(i) /= sigma[i];
  }
}

}  // namespace screwline

#include "screwline/spatial/small_svd.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace screwline {
namespace {

constexpr int kMaxSweeps = 30;
constexpr double kFloor = 1e-30;  ///< Of the largest pivot: below rounding, and it keeps all columns from vanishing.
constexpr double kOrthogonal = std::numeric_limits<double>::epsilon();  ///< Cosine of what needs no more rotation.

/// Turns columns i and k of G towards each other until they are orthogonal, those of W with them; false where they are.
bool rotate(Eigen::Index i, Eigen::Index k, SmallMatrix& G, SmallMatrix& W) {
  const double a = G.col(i).squaredNorm();
  const double b = G.col(k).squaredNorm();
  const double c = G.col(i).dot(G.col(k));
  if (std::abs(c) <= kOrthogonal * std::sqrt(a) * std::sqrt(b)) return false;
  const double zeta = (b - a) / (2.0 * c);
  const double tangent = std::copysign(1.0, zeta) / (std::abs(zeta) + std::hypot(1.0, zeta));
  const double cosine = 1.0 / std::sqrt(1.0 + tangent * tangent);
  const double sine = cosine * tangent;
  for (SmallMatrix* M : {&G, &W}) {
    const SmallVector before = M->col(i);
    M->col(i) = cosine * before - sine * M->col(k);
    M->col(k) = sine * before + cosine * M->col(k);
  }
  return true;
}

}  // namespace

SmallSvd::SmallSvd(const SmallMatrix& A) : sigma(A.rows()) {
  const Eigen::Index n = A.rows();
  const Eigen::ColPivHouseholderQR<SmallMatrix> qr(A);
  // A P = Q R; with R^T W = Y diag(sigma), A = (Q W) diag(sigma) (P Y)^T.
  SmallMatrix G = qr.matrixQR().transpose().triangularView<Eigen::Lower>();
  const double floor = std::max(kFloor * std::abs(G(0, 0)), 1e-150);
  for (Eigen::Index i = 0; i < n; ++i) {
    if (std::abs(G(i, i)) < floor) G(i, i) = floor;
  }
  SmallMatrix W = qr.householderQ() * SmallMatrix::Identity(n, n);
  bool turned = true;
  for (int sweep = 0; sweep < kMaxSweeps && turned; ++sweep) {
    turned = false;
    for (Eigen::Index i = 0; i + 1 < n; ++i) {
      for (Eigen::Index k = i + 1; k < n; ++k) turned = rotate(i, k, G, W) || turned;
    }
  }
  U = W;
  V = qr.colsPermutation() * G;
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

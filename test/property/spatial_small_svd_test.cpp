// The small singular value decomposition against Eigen's, on matrices of every rank.

#include "screwline/spatial/small_svd.h"
#include "screwline/spatial/weak_directions.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <Eigen/SVD>
#include <cmath>
#include <random>

namespace screwline {
namespace {

constexpr unsigned kSeed = 20261128;
constexpr double kTolerance = 1e-14;  // Of the largest singular value; of 1 for U and V.

MatrixX randomMatrix(Eigen::Index n, std::mt19937& random) {
  std::uniform_real_distribution<double> entry(-1.0, 1.0);
  return MatrixX::NullaryExpr(n, n, [&] { return entry(random); });
}

/// A matrix whose last `weak` singular values are `small`.
MatrixX nearlySingular(Eigen::Index n, Eigen::Index weak, double small, std::mt19937& random) {
  const MatrixX U = randomMatrix(n, random).householderQr().householderQ();
  const MatrixX V = randomMatrix(n, random).householderQr().householderQ();
  VectorX sigma = VectorX::LinSpaced(n, 2.0, 0.5);
  sigma.tail(weak).setConstant(small);
  return U * sigma.asDiagonal() * V.transpose();
}

void expectDecomposed(const MatrixX& A) {
  SCOPED_TRACE(testing::Message() << "seed " << kSeed << ", A =\n" << A);
  const Eigen::Index n = A.rows();
  const SmallSvd svd{SmallMatrix(A)};
  const VectorX expected = Eigen::JacobiSVD<MatrixX>(A).singularValues();
  const MatrixX I = MatrixX::Identity(n, n);
  EXPECT_LE((svd.sigma - expected).norm(), kTolerance * expected[0]);
  EXPECT_LE((svd.U * svd.sigma.asDiagonal() * svd.V.transpose() - A).norm(), kTolerance * expected[0]);
  EXPECT_LE((svd.U.transpose() * svd.U - I).norm(), kTolerance);
  EXPECT_LE((svd.V.transpose() * svd.V - I).norm(), kTolerance);
  for (Eigen::Index i = 0; i + 1 < n; ++i) EXPECT_GE(svd.sigma[i], svd.sigma[i + 1]);
}

TEST(SmallSvd, RegularMatrices) {
  std::mt19937 random(kSeed);
  for (Eigen::Index n = 1; n <= 6; ++n) {
    for (int k = 0; k < 100; ++k) expectDecomposed(randomMatrix(n, random));
  }
}

TEST(SmallSvd, SingularAndNearlySingularMatrices) {
  std::mt19937 random(kSeed);
  for (Eigen::Index n = 1; n <= 6; ++n) {
    for (Eigen::Index weak = 1; weak < n; ++weak) {
      for (const double small : {1e-3, 1e-8, 1e-13, 1e-18, 0.0}) {
        for (int k = 0; k < 10; ++k) expectDecomposed(nearlySingular(n, weak, small, random));
      }
    }
  }
}

TEST(SmallSvd, ColumnsThatVanishOrRepeat) {
  std::mt19937 random(kSeed);
  for (Eigen::Index n = 2; n <= 6; ++n) {
    MatrixX A = randomMatrix(n, random);
    A.col(0).setZero();
    expectDecomposed(A);
    A.col(0) = A.col(n - 1);
    expectDecomposed(A);
    A.row(0) = A.row(n - 1);
    expectDecomposed(A);
    expectDecomposed(MatrixX::Identity(n, n));
  }
  const SmallSvd zero{SmallMatrix(MatrixX::Zero(6, 6))};
  EXPECT_LE(zero.sigma[0], 1e-100);
  EXPECT_TRUE(zero.U.allFinite() && zero.V.allFinite());
}

/// Against the whole decomposition, and by what the vectors do.
void expectWeak(const MatrixX& A) {
  SCOPED_TRACE(testing::Message() << "seed " << kSeed << ", A =\n" << A);
  const SmallSvd svd{SmallMatrix(A)};
  const WeakDirections weak = weakDirectionsOf(SmallMatrix(A), svd.sigma[0]);
  const Eigen::Index count = std::min<Eigen::Index>(2, A.rows());
  ASSERT_EQ(weak.sigma.size(), count);
  const double most = std::max(svd.sigma[0], 1e-100);
  const bool second_weak = count == 2 && svd.sigma[A.rows() - 2] < 1e-3 * most;
  for (Eigen::Index i = count - 1; i >= 0; --i) {
    if (i == 0 && count == 2 && !second_weak) break;
    EXPECT_NEAR(weak.sigma[i], svd.sigma[A.rows() - count + i], kTolerance * most);
    EXPECT_LE((A * weak.V.col(i) - weak.sigma[i] * weak.U.col(i)).norm(), 10.0 * kTolerance * most);
    EXPECT_LE((A.transpose() * weak.U.col(i) - weak.sigma[i] * weak.V.col(i)).norm(), 10.0 * kTolerance * most);
  }
  if (count == 2 && !second_weak) {
    EXPECT_GE(weak.sigma[0], 1e-3 * most * (1.0 - 1e-12));
  }
  const MatrixX I = MatrixX::Identity(count, count);
  EXPECT_LE((weak.U.transpose() * weak.U - I).norm(), kTolerance);
  EXPECT_LE((weak.V.transpose() * weak.V - I).norm(), kTolerance);
  EXPECT_NEAR(weak.product, svd.sigma.prod(), kTolerance * std::pow(most, A.rows()));
}

TEST(WeakDirections, OfNearlySingularMatrices) {
  std::mt19937 random(kSeed);
  for (Eigen::Index n = 1; n <= 6; ++n) {
    for (Eigen::Index weak = 1; weak < n; ++weak) {
      for (const double small : {1e-3, 1e-5, 1e-8, 1e-13, 1e-18, 0.0}) {
        for (int k = 0; k < 10; ++k) expectWeak(nearlySingular(n, weak, small, random));
      }
    }
  }
}

TEST(WeakDirections, OfAnyOther) {
  std::mt19937 random(kSeed);
  for (Eigen::Index n = 1; n <= 6; ++n) {
    for (int k = 0; k < 30; ++k) expectWeak(randomMatrix(n, random));
    expectWeak(MatrixX::Identity(n, n));
    MatrixX A = randomMatrix(n, random);
    A.row(0) = A.row(n - 1);
    A.col(0).setZero();
    expectWeak(A);
  }
  // Two weak ones of different size, which the values of both tell apart.
  MatrixX A = MatrixX::Identity(6, 6);
  A(2, 2) = 1e-6;
  A(4, 4) = 3e-12;
  const MatrixX Q = randomMatrix(6, random).householderQr().householderQ();
  const MatrixX B = Q * A * Q;
  expectWeak(B);
  const WeakDirections weak = weakDirectionsOf(SmallMatrix(B), 1.0);
  EXPECT_NEAR(weak.sigma[0], 1e-6, 1e-15);
  EXPECT_NEAR(weak.sigma[1], 3e-12, 1e-15);
}

}  // namespace
}  // namespace screwline

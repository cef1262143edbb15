#ifndef SCREWLINE_TEST_ALGEBRAIC_LAWS_H
#define SCREWLINE_TEST_ALGEBRAIC_LAWS_H

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "ik_arms.h"
#include "screwline/ik/algebraic/algebraic_solver.h"
#include "screwline/ik/task_error.h"
#include "screwline/kinematics/forward.h"
#include "screwline/kinematics/jacobian.h"

namespace screwline {
namespace test {

inline VectorX valuesOf(const std::array<double, 6>& q) {
  return Eigen::Map<const Vector6>(q.data());
}

inline double difference(const SerialChain& chain, const VectorX& a, const VectorX& b) {
  double largest = 0.0;
  for (int i = 0; i < chain.size(); ++i) {
    const double d = a[i] - b[i];
    largest = std::max(largest, std::abs(chain.joint(i).isRevolute() ? std::remainder(d, kTwoPi) : d));
  }
  return largest;
}

inline double nearest(const SerialChain& chain, const AlgebraicSolutions& solutions, const VectorX& q) {
  double least = 10.0;
  for (const std::array<double, 6>& solution : solutions)
    least = std::min(least, difference(chain, valuesOf(solution), q));
  return least;
}

inline VectorX randomConfiguration(ArmMaker& maker, const SerialChain& chain) {
  VectorX q(chain.size());
  for (int i = 0; i < chain.size(); ++i) q[i] = maker.uniform(-kPi, kPi) * (chain.joint(i).isRevolute() ? 1.0 : 0.3);
  return q;
}

/// Turns at multiples of right angles, slides at steps of 0.1 m.
inline VectorX latticeConfiguration(ArmMaker& maker, const SerialChain& chain) {
  VectorX q(chain.size());
  for (int i = 0; i < chain.size(); ++i) {
    q[i] = chain.joint(i).isRevolute() ? 0.5 * kPi * (maker.index(4) - 1) : 0.1 * (maker.index(9) - 4);
  }
  return q;
}

/// Laws of every answer: the pose is reached, nothing is there twice, all is finite.
inline void expectLawful(const SerialChain& chain, const Pose& target, const AlgebraicSolutions& solutions) {
  for (int i = 0; i < solutions.count; ++i) {
    const VectorX q = valuesOf(solutions.q[static_cast<std::size_t>(i)]);
    ASSERT_TRUE(q.allFinite());
    EXPECT_LE(taskError(Task(), target, forwardByExponentials(chain, q)).norm(), 1e-9);
    for (int j = 0; j < i; ++j) {
      EXPECT_GT(difference(chain, q, valuesOf(solutions.q[static_cast<std::size_t>(j)])), 1e-6);
    }
  }
}

/// A configuration between two where the Jacobian's determinant has different signs.
inline VectorX singularConfiguration(const SerialChain& chain, ArmMaker& maker) {
  Matrix6X J(6, 6);
  const auto determinant = [&](const VectorX& q) {
    geometricJacobian(chain, q, J);
    return Matrix6(J).determinant();
  };
  VectorX low = randomConfiguration(maker, chain);
  VectorX high = randomConfiguration(maker, chain);
  while (determinant(low) * determinant(high) > 0.0) high = randomConfiguration(maker, chain);
  for (int i = 0; i < 60; ++i) {
    const VectorX middle = 0.5 * (low + high);
    (determinant(middle) * determinant(low) > 0.0 ? low : high) = middle;
  }
  return low;
}

}  // namespace test
}  // namespace screwline

#endif  // SCREWLINE_TEST_ALGEBRAIC_LAWS_H

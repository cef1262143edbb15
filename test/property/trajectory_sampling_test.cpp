// How motions are sampled: the kernels against polynomials evaluated one by one, the piece lookup against a search from
// the front.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "screwline/trajectory/joint_trajectory.h"
#include "screwline/trajectory/scaling_table.h"

namespace screwline {
namespace {

constexpr unsigned kSeed = 20261127;
constexpr double kRoom = 7.0;  // Behind the values of n joints nothing is written: it stays as it is.

double uniform(std::mt19937& random, double from, double to) {
  return std::uniform_real_distribution<double>(from, to)(random);
}

/// Four arrays of n values, and one more value in each.
struct Samples {
  explicit Samples(int joints) : values(4, std::vector<double>(static_cast<std::size_t>(joints) + 1, kRoom)) {}
  std::vector<std::vector<double>> values;  ///< Position to jerk.
};

PiecewisePolynomial randomPieces(std::mt19937& random, int joints, int degree, std::vector<double> breaks) {
  PiecewisePolynomial pieces(joints, degree, std::move(breaks), 0);
  for (double& c : pieces.coefficients) c = uniform(random, -1.0, 1.0);
  return pieces;
}

/// The derivative of `order` by the piece's own x.
double derivativeAt(Polynomial polynomial, int order, double x) {
  for (int k = 0; k < order; ++k) polynomial = polynomial.derivative();
  return polynomial(x);
}

void expectSamples(const Samples& samples, const std::vector<std::vector<double>>& expected, const std::string& what) {
  for (std::size_t order = 0; order < 4; ++order) {
    const std::vector<double>& values = samples.values[order];
    for (std::size_t i = 0; i + 1 < values.size(); ++i) {
      EXPECT_NEAR(values[i], expected[order][i], 1e-12 * (1.0 + std::abs(expected[order][i])))
          << what << ", order " << order << ", joint " << i;
    }
    EXPECT_EQ(values.back(), kRoom) << what << ": written behind the last joint, order " << order;
  }
}

TEST(SampleKernels, PiecesAreTheirPolynomials) {
  std::mt19937 random(kSeed);
  for (const SampleKernels* kernels : {&sampleKernels(), &plainSampleKernels()}) {
    for (int joints = 1; joints <= 13; ++joints) {
      for (int degree = 0; degree <= Polynomial::kMaxDegree; ++degree) {
        const PiecewisePolynomial pieces = randomPieces(random, joints, degree, {0.0, 1.0});
        const double x = uniform(random, 0.0, 1.0);
        const double rate = uniform(random, 0.1, 3.0);
        std::vector<std::vector<double>> expected(4);
        for (int order = 0; order < 4; ++order) {
          for (int joint = 0; joint < joints; ++joint) {
            const double value = derivativeAt(pieces.piece(0, joint), order, x);
            expected[static_cast<std::size_t>(order)].push_back(value * std::pow(rate, order));
          }
        }
        Samples piece(joints);
        Samples segment(joints);
        const auto outputOf = [](Samples& samples) {
          auto& v = samples.values;
          return SampleOutput{v[0].data(), v[1].data(), v[2].data(), v[3].data()};
        };
        const SampleOutput to = outputOf(piece);
        const PieceShape shape{joints, degree};
        kernels->piece(shape)(pieces.coefficients.data(), shape, x, rate, to.position, to.velocity, to.acceleration,
                              to.jerk);
        kernels->segment({pieces.coefficients.data(), joints, degree}, x,
                         {rate, 0.0, rate * rate, 0.0, 0.0, rate * rate * rate}, outputOf(segment));
        const std::string what = std::to_string(joints) + " joints, degree " + std::to_string(degree);
        expectSamples(piece, expected, "piece of " + what);
        expectSamples(segment, expected, "segment of " + what);
      }
    }
  }
}

/// A random line over a scalar of these pieces, and what its samples have to be.
class RandomLine {
 public:
  RandomLine(std::mt19937& random, int joints, int degree, const std::vector<double>& breaks)
      : pieces_(randomPieces(random, 1, degree, breaks)) {
    line.scale = ScalingTable(pieces_, kStretch);
    line.joints = joints;
    for (int i = 0; i < joints; ++i) {
      line.start.push_back(uniform(random, -3.0, 3.0));
      line.delta.push_back(uniform(random, -3.0, 3.0));
    }
  }

  std::vector<std::vector<double>> at(double tau) const {
    std::size_t k = 0;
    while (k + 1 < pieces_.segments() && pieces_.breaks[k + 1] <= tau) ++k;
    const double length = pieces_.length(k);
    std::vector<std::vector<double>> expected(4);
    for (std::size_t order = 0; order < 4; ++order) {
      const int times = static_cast<int>(order);
      const double by_x = derivativeAt(pieces_.piece(k, 0), times, (tau - pieces_.breaks[k]) / length);
      for (std::size_t i = 0; i < line.start.size(); ++i) {
        const double moved = line.delta[i] * by_x / std::pow(kStretch * length, order);
        expected[order].push_back(order == 0 ? line.start[i] + moved : moved);
      }
    }
    return expected;
  }

  static constexpr double kStretch = 2.0;
  ScaledLine line;

 private:
  PiecewisePolynomial pieces_;
};

TEST(SampleKernels, LinesFollowTheScaling) {
  std::mt19937 random(kSeed + 1);
  // One piece, few and many are found in ways of their own.
  const std::vector<double> breaks[] = {
      {0.0, 1.0}, {0.0, 0.2, 0.7, 1.0}, {0.0, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0}};
  for (const SampleKernels* kernels : {&sampleKernels(), &plainSampleKernels()}) {
    for (int trial = 0; trial < 3 * 13 * (Polynomial::kMaxDegree + 1); ++trial) {
      const int joints = 1 + trial / 3 % 13;
      const int degree = trial / 3 / 13;
      const RandomLine motion(random, joints, degree, breaks[static_cast<std::size_t>(trial % 3)]);
      for (double tau : {0.0, uniform(random, 0.0, 0.2), 0.2, uniform(random, 0.2, 0.7), 0.7, 1.0}) {
        Samples samples(joints);
        auto& v = samples.values;
        kernels->line(motion.line)(motion.line, RandomLine::kStretch * tau, v[0].data(), v[1].data(), v[2].data(),
                                   v[3].data());
        expectSamples(
            samples, motion.at(tau),
            std::to_string(joints) + " joints, degree " + std::to_string(degree) + ", tau " + std::to_string(tau));
      }
    }
  }
}

TEST(SampleKernels, CycloidsAreTheirFormula) {
  std::mt19937 random(kSeed + 3);
  const double turn = 2.0 * std::acos(-1.0);
  for (int joints = 1; joints < 10; ++joints) {
    const VectorX start = VectorX::NullaryExpr(joints, [&] { return uniform(random, -3.0, 3.0); });
    const VectorX delta = VectorX::NullaryExpr(joints, [&] { return uniform(random, -3.0, 3.0); });
    const double T = uniform(random, 0.5, 5.0);
    const JointTrajectory motion = JointTrajectory::scaled(start, delta, TimeLaw::cycloidal(), T);
    TrajectoryPoint point(joints);
    for (int i = 0; i <= 100; ++i) {
      const double tau = i / 100.0;
      motion.sample(tau * T, point);
      const double sine = std::sin(turn * tau), cosine = std::cos(turn * tau);
      const double rate = turn / T;
      EXPECT_LT((point.position - start - delta * (tau - sine / turn)).cwiseAbs().maxCoeff(), 1e-14);
      EXPECT_LT((point.velocity - delta * ((1.0 - cosine) / T)).cwiseAbs().maxCoeff(), 1e-13);
      EXPECT_LT((point.acceleration - delta * (rate / T * sine)).cwiseAbs().maxCoeff(), 1e-12);
      EXPECT_LT((point.jerk - delta * (rate * rate / T * cosine)).cwiseAbs().maxCoeff(), 1e-11);
    }
    EXPECT_EQ(point.position, VectorX(start + delta)) << "exactly at the end";
  }
}

TEST(BreakTable, FindsWhatASearchFromTheFrontFinds) {
  std::mt19937 random(kSeed + 2);
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<double> breaks{0.0};
    const int segments = 1 + static_cast<int>(random() % 40);
    // Pieces of very different length, some of none.
    for (int k = 0; k < segments; ++k)
      breaks.push_back(breaks.back() + (k > 0 && random() % 5 == 0 ? 0.0 : std::pow(10.0, uniform(random, -6.0, 1.0))));
    const BreakTable table(breaks);
    std::vector<double> instants = breaks;
    for (int k = 0; k < 60; ++k) instants.push_back(uniform(random, -0.1, 1.1) * breaks.back());
    for (double t : instants) {
      std::size_t expected = 0;
      while (expected + 1 < static_cast<std::size_t>(segments) && breaks[expected + 1] <= t) ++expected;
      EXPECT_EQ(table.find(t), expected) << "seed " << kSeed + 2 << ", trial " << trial << ", t " << t;
    }
    EXPECT_LT(table.find(std::numeric_limits<double>::quiet_NaN()), static_cast<std::size_t>(segments));
  }
}

TEST(InverseLength, ReachesOneAtTheEndAndIsZeroForNoLength) {
  std::mt19937 random(kSeed + 3);
  for (int trial = 0; trial < 10000; ++trial) {
    const double length = std::pow(10.0, uniform(random, -12.0, 12.0));
    const double product = length * inverseLengthOf(length);
    EXPECT_GE(product, 1.0) << length;
    EXPECT_LE(product, 1.0 + 4e-16) << length;
  }
  EXPECT_EQ(inverseLengthOf(0.0), 0.0);
  EXPECT_EQ(inverseLengthOf(1e-70), 0.0);
}

}  // namespace
}  // namespace screwline

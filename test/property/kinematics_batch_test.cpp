// Batches against the same question asked one by one: any chain, any remainder, any number of threads and lanes.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstring>

#include "model_random.h"
#include "screwline/kinematics/batch.h"
#include "screwline/kinematics/jacobian.h"
#include "screwline/kinematics/row_pieces.h"

namespace screwline {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr double kMarker = 1234.5;  // What an array holds where nothing may be written.

struct Answers {
  std::vector<double> poses;
  std::vector<Pose> frames;
  std::vector<double> jacobians;
  bool done = false;
};

std::size_t index(Eigen::Index i) {
  return static_cast<std::size_t>(i);
}

RowMajor configurations(RandomModel& random, Eigen::Index count, int joints, double bound = 3.0) {
  return RowMajor::NullaryExpr(count, joints, [&] { return random.uniform(-bound, bound); });
}

/// Everything that a batch can be asked for, with one row more than asked for to see that it stays as it is.
Answers ask(const SerialChain& chain, const RowMajor& q, const BatchOptions& options = {}) {
  const std::size_t n = index(chain.size());
  const std::size_t count = index(q.rows());
  Answers answers;
  answers.poses.assign((count + 1) * 7, kMarker);
  answers.frames.assign(count + 1, {Matrix3::Constant(kMarker), Vector3::Constant(kMarker)});
  answers.jacobians.assign((count + 1) * 6 * n, kMarker);
  answers.done = forwardBatch(
      chain, {q.data(), count, answers.poses.data(), answers.frames.data(), answers.jacobians.data()}, options);
  return answers;
}

Quaternion quaternionOf(const Answers& answers, Eigen::Index row) {
  const double* q = &answers.poses[index(row) * 7 + 3];
  return {q[3], q[0], q[1], q[2]};
}

void expectRow(const SerialChain& chain, const VectorX& q, const Answers& answers, Eigen::Index row,
               double tolerance = 2e-14) {
  Matrix6X J(6, chain.size());
  const Pose X_BT = geometricJacobian(chain, q, J);
  const Pose& frame = answers.frames[index(row)];
  const double scale = 1.0 + X_BT.p.cwiseAbs().maxCoeff() + J.cwiseAbs().maxCoeff();
  EXPECT_LE((frame.R - X_BT.R).cwiseAbs().maxCoeff(), tolerance);
  EXPECT_LE((frame.p - X_BT.p).cwiseAbs().maxCoeff(), tolerance * scale);
  const Quaternion quaternion = quaternionOf(answers, row);
  EXPECT_NEAR(quaternion.norm(), 1.0, 1e-15);
  EXPECT_GE(quaternion.w(), 0.0);
  EXPECT_LE((quaternion.toRotationMatrix() - X_BT.R).cwiseAbs().maxCoeff(), tolerance);
  EXPECT_EQ(Vector3::Map(&answers.poses[index(row) * 7]), frame.p);
  const auto jacobian = Eigen::Map<const RowMajor>(&answers.jacobians[index(row * 6 * chain.size())], 6, chain.size());
  EXPECT_LE((jacobian - J).cwiseAbs().maxCoeff(), tolerance * scale);
}

bool sameBytes(const std::vector<double>& a, const std::vector<double>& b, std::size_t count) {
  return std::memcmp(a.data(), b.data(), count * sizeof(double)) == 0;
}

/// Whether the first `count` rows are the same bytes.
bool same(const SerialChain& chain, const Answers& a, const Answers& b, std::size_t count) {
  return sameBytes(a.poses, b.poses, count * 7) &&
         sameBytes(a.jacobians, b.jacobians, count * 6 * index(chain.size())) &&
         std::memcmp(a.frames.data(), b.frames.data(), count * sizeof(Pose)) == 0;
}

class Batch : public testing::TestWithParam<int> {
 protected:
  BatchOptions options(int threads = 1) const {
    BatchOptions result;
    result.threads = threads;
    result.lanes = GetParam();
    return result;
  }
};

TEST_P(Batch, EqualsOneByOneForAnyChain) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    RandomModel random(seed);
    const SerialChain chain = random.chain(random.integer(1, 10), seed % 2 == 1);
    const RowMajor q = configurations(random, random.integer(1, 40), chain.size());
    const Answers answers = ask(chain, q, options());
    EXPECT_TRUE(answers.done);
    for (Eigen::Index row = 0; row < q.rows(); ++row) expectRow(chain, q.row(row), answers, row);
  }
}

TEST_P(Batch, EqualsOneByOneForManyJoints) {
  RandomModel random(7);
  for (const bool mimic : {false, true}) {
    const SerialChain chain = random.chain(kMaxJoints, mimic);
    const RowMajor q = configurations(random, 21, chain.size());
    const Answers answers = ask(chain, q, options());
    for (Eigen::Index row = 0; row < q.rows(); ++row) expectRow(chain, q.row(row), answers, row, 2e-13);
  }
}

TEST_P(Batch, EveryRemainderGivesTheSameBytesAndWritesNoMore) {
  RandomModel random(11);
  for (const int joints : {1, 2, 3, 6, 7}) {
    const SerialChain chain = random.chain(joints);
    const RowMajor all = configurations(random, 40, joints);
    const Answers expected = ask(chain, all, options());
    for (Eigen::Index count = 0; count <= 17; ++count) {
      const Answers answers = ask(chain, all.topRows(count), options());
      EXPECT_TRUE(answers.done);
      EXPECT_TRUE(same(chain, answers, expected, index(count))) << count;
      EXPECT_EQ(answers.poses[index(count) * 7], kMarker);
      EXPECT_EQ(answers.frames[index(count)].R(0, 0), kMarker);
      EXPECT_EQ(answers.jacobians[index(count * 6 * joints)], kMarker);
    }
  }
}

TEST_P(Batch, ARowsAnswerDoesNotDependOnWhereItStands) {
  RandomModel random(13);
  const SerialChain chain = random.chain(6);
  const RowMajor all = configurations(random, 64, 6);
  const Answers expected = ask(chain, all, options());
  for (Eigen::Index shift = 1; shift < 12; ++shift) {
    const Answers answers = ask(chain, all.bottomRows(64 - shift), options());
    EXPECT_TRUE(std::equal(answers.poses.begin(), answers.poses.end() - 7, expected.poses.begin() + shift * 7));
    EXPECT_TRUE(
        std::equal(answers.jacobians.begin(), answers.jacobians.end() - 36, expected.jacobians.begin() + shift * 36));
  }
}

TEST_P(Batch, AnyNumberOfThreadsGivesTheSameBytes) {
  RandomModel random(17);
  const SerialChain chain = random.chain(6, true);
  const RowMajor q = configurations(random, 50003, chain.size());
  const Answers expected = ask(chain, q, options());
  for (int threads = 0; threads <= 5; ++threads) {
    const Answers answers = ask(chain, q, options(threads));
    EXPECT_TRUE(answers.done);
    EXPECT_TRUE(same(chain, answers, expected, index(q.rows()))) << threads;
  }
}

TEST_P(Batch, LargeAngles) {
  RandomModel random(19);
  for (int i = 0; i < 20; ++i) {
    // A slide of 1e6 m would leave no digits: turning joints only.
    SerialChain chain = random.chain(3);
    while (chain.axes()[0].prismatic || chain.axes()[1].prismatic || chain.axes()[2].prismatic) chain = random.chain(3);
    const RowMajor q = configurations(random, 33, 3, kMaxMagnitude);
    const Answers answers = ask(chain, q, options());
    // One unit in the last place of 1e6 rad is 1.2e-10: both ways have to round the sum with the offset alike.
    for (Eigen::Index row = 0; row < q.rows(); ++row) expectRow(chain, q.row(row), answers, row, 5e-10);
  }
}

TEST_P(Batch, QuaternionsNearHalfATurnLoseNothing) {
  for (unsigned seed = 0; seed < 30; ++seed) {
    SCOPED_TRACE(seed);
    RandomModel random(seed);
    ChainDescription d;
    d.name = "turntable";
    d.base_link = "base";
    d.tip_link = "tip";
    Axis axis;
    axis.direction = seed < 3 ? Vector3(Vector3::Unit(static_cast<int>(seed))) : random.direction();
    d.axes = {axis};
    d.joints.resize(1);
    d.joints[0].name = "turn";
    d.links = {{"base", 0, {}}, {"tip", 1, {}}};
    const SerialChain chain(d);
    RowMajor q(41, 1);
    for (int i = 0; i <= 40; ++i) q(i, 0) = i == 40 ? kPi : kPi + (i % 2 == 0 ? 1.0 : -1.0) * std::pow(10.0, -0.4 * i);
    const Answers answers = ask(chain, q, options());
    for (Eigen::Index row = 0; row < q.rows(); ++row) {
      const double half = 0.5 * q(row, 0);
      Eigen::Vector4d expected;
      expected << std::sin(half) * axis.direction, std::cos(half);
      const Eigen::Vector4d quaternion = quaternionOf(answers, row).coeffs();
      EXPECT_LE(std::min((quaternion - expected).norm(), (quaternion + expected).norm()), 1e-15) << row;
      if (quaternion[3] != 0.0) continue;
      Eigen::Index largest = 0;
      quaternion.cwiseAbs().maxCoeff(&largest);
      EXPECT_GT(quaternion[largest], 0.0);
    }
  }
}

TEST_P(Batch, WritesOnlyWhatIsAskedFor) {
  RandomModel random(23);
  const SerialChain chain = random.chain(6);
  const RowMajor q = configurations(random, 9, 6);
  const Answers expected = ask(chain, q, options());
  std::vector<double> poses(9 * 7);
  EXPECT_TRUE(forwardBatch(chain, {q.data(), 9, poses.data()}, options()));
  EXPECT_TRUE(std::equal(poses.begin(), poses.end(), expected.poses.begin()));
  std::vector<double> jacobians(9 * 36);
  EXPECT_TRUE(forwardBatch(chain, {q.data(), 9, nullptr, nullptr, jacobians.data()}, options()));
  EXPECT_TRUE(std::equal(jacobians.begin(), jacobians.end(), expected.jacobians.begin()));
  EXPECT_TRUE(forwardBatch(chain, {q.data(), 9}, options()));
  EXPECT_TRUE(forwardBatch(chain, {}, options()));
}

INSTANTIATE_TEST_SUITE_P(Lanes, Batch, testing::Values(0, 2, 4, 8));

TEST(BatchCancellation, StopsBetweenPieces) {
  RandomModel random(29);
  const SerialChain chain = random.chain(2);
  const RowMajor q = configurations(random, 100000, 2);
  for (const int threads : {1, 3}) {
    int asked = 0;
    BatchOptions options;
    options.threads = threads;
    // Only the calling thread asks; how many pieces the others leave to it is their luck, but for the first question.
    const int patience = threads == 1 ? 2 : 0;
    options.cancelled = [&asked, patience] { return ++asked > patience; };
    if (ask(chain, q, options).done) {
      EXPECT_GT(threads, 1);  // The others had taken all before it could ask.
      EXPECT_EQ(asked, 0);
    } else {
      EXPECT_EQ(asked, patience + 1);
    }
    options.cancelled = [] { return false; };
    EXPECT_TRUE(ask(chain, q, options).done);
  }
}

TEST(RowPieces, EachPieceOnce) {
  for (int threads = 0; threads <= 5; ++threads) {
    for (const std::size_t count : {0U, 1U, 7U, 8U, 1001U}) {
      std::vector<std::atomic<int>> seen(count);
      EXPECT_TRUE(forPieces({count, 8, 1, threads}, {}, [&seen](std::size_t first, std::size_t last) {
        EXPECT_LE(last - first, 8U);
        for (std::size_t i = first; i < last; ++i) ++seen[i];
      }));
      for (const std::atomic<int>& times : seen) EXPECT_EQ(times, 1);
    }
  }
}

TEST(RowPieces, AnExceptionReachesTheCaller) {
  for (const int threads : {1, 4}) {
    const auto fail = [](std::size_t first, std::size_t) {
      if (first == 40) throw std::runtime_error("row 40");
    };
    EXPECT_THROW(forPieces({1000, 8, 1, threads}, {}, fail), std::runtime_error);
  }
}

}  // namespace
}  // namespace screwline

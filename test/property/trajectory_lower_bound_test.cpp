// How near time_optimal through waypoints comes to what is possible: held against a lower bound made in another way.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "property/trajectory_random.h"

namespace screwline {
namespace trajectory_test {
namespace {

/// Least time of one joint over a distance D from velocity v0 to v1 where nothing but velocity V and acceleration A is
/// limited: up to a peak, along, down.
double leastTime(double v0, double v1, double D, double V, double A) {
  if (D < 0.5 * (v0 + v1) * std::abs(v1 - v0) / A) return leastTime(-v0, -v1, -D, V, A);
  const double peak = std::max({std::sqrt(std::max(0.0, A * D + 0.5 * (v0 * v0 + v1 * v1))), v0, v1});
  const double top = std::min(V, peak);
  const double cruise = peak > V ? (D - (2.0 * V * V - v0 * v0 - v1 * v1) / (2.0 * A)) / V : 0.0;
  return (2.0 * top - v0 - v1) / A + cruise;
}

/// Of the durations of any motion through the waypoints, without jerk limits. A segment lasts at least any mean of the
/// times that its joints need; with weights fixed, each joint by itself takes its best velocities at the waypoints
/// (from a grid). Weights are moved to the joints that need longest: Lagrange's dual, so each of its values is a bound,
/// to the grid.
class LowerBound {
 public:
  explicit LowerBound(const PlanRequest& r)
      : segments_(r.waypoints.size() - 1), joints_(static_cast<std::size_t>(r.limits.joints())) {
    for (std::size_t j = 0; j < joints_; ++j) {
      const double V = r.limits.velocity[static_cast<int>(j)];
      const double A = r.limits.acceleration[static_cast<int>(j)];
      for (std::size_t k = 0; k < segments_; ++k) {
        const double D =
            r.waypoints[k + 1].position[static_cast<int>(j)] - r.waypoints[k].position[static_cast<int>(j)];
        std::vector<double> table;
        for (int a = 0; a < kGrid; ++a) {
          for (int b = 0; b < kGrid; ++b) table.push_back(leastTime(velocity(a, V), velocity(b, V), D, V, A));
        }
        times_.push_back(table);
      }
    }
  }

  double find() {
    constexpr int kRounds = 150;
    weights_.assign(joints_ * segments_, 1.0 / static_cast<double>(joints_));
    double best = 0.0;
    for (int round = 0; round < kRounds; ++round) {
      std::vector<double> needed(joints_ * segments_);
      double sum = 0.0;
      for (std::size_t j = 0; j < joints_; ++j) sum += bestOf(j, needed);
      best = std::max(best, sum);
      shift(needed, 0.5 / std::sqrt(round + 1.0));
    }
    return best;
  }

 private:
  static constexpr int kGrid = 41;
  static double velocity(int place, double V) { return -V + 2.0 * V * place / (kGrid - 1); }

  /// The least weighted sum of one joint's times, from rest to rest, and the times.
  double bestOf(std::size_t j, std::vector<double>& needed) const {
    std::vector<std::vector<double>> cost(segments_ + 1, std::vector<double>(kGrid, HUGE_VAL));
    std::vector<std::vector<int>> from(segments_ + 1, std::vector<int>(kGrid, 0));
    cost[0][kGrid / 2] = 0.0;
    for (std::size_t k = 0; k < segments_; ++k) {
      const std::vector<double>& table = times_[j * segments_ + k];
      for (int a = 0; a < kGrid; ++a) {
        const std::size_t row = static_cast<std::size_t>(a);
        for (std::size_t b = 0; b < kGrid; ++b) {
          const double value = cost[k][row] + weights_[j * segments_ + k] * table[row * kGrid + b];
          if (value >= cost[k + 1][b]) continue;
          cost[k + 1][b] = value;
          from[k + 1][b] = a;
        }
      }
    }
    std::size_t b = kGrid / 2;
    const double sum = cost[segments_][b];
    for (std::size_t k = segments_; k-- > 0;) {
      const std::size_t a = static_cast<std::size_t>(from[k + 1][b]);
      needed[j * segments_ + k] = times_[j * segments_ + k][a * kGrid + b];
      b = a;
    }
    return sum;
  }

  void shift(const std::vector<double>& needed, double step) {
    for (std::size_t k = 0; k < segments_; ++k) {
      double mean = 0.0;
      for (std::size_t j = 0; j < joints_; ++j) mean += needed[j * segments_ + k] / static_cast<double>(joints_);
      double sum = 0.0;
      for (std::size_t j = 0; j < joints_; ++j) {
        double& weight = weights_[j * segments_ + k];
        weight = std::max(1e-6, weight * std::exp(step * (needed[j * segments_ + k] / mean - 1.0)));
        sum += weight;
      }
      for (std::size_t j = 0; j < joints_; ++j) weights_[j * segments_ + k] /= sum;
    }
  }

  std::size_t segments_;
  std::size_t joints_;
  std::vector<std::vector<double>> times_;  ///< [joint][segment]: by velocities at both ends.
  std::vector<double> weights_;
};

TEST(TimeOptimalThroughWaypoints, IsWithinPercentsOfALowerBoundThatKnowsNoJerk) {
  constexpr unsigned kSeed = 95;
  constexpr double kOfGrid = 0.998;
  Random random(kSeed);
  double to_bound = 0.0;
  double to_stops = 0.0;
  constexpr int kTrials = 20;
  for (int trial = 0; trial < kTrials; ++trial) {
    const int joints = random.integer(2, 6);
    std::vector<VectorX> way;
    for (int k = random.integer(3, 8); k > 0; --k) way.push_back(random.vector(joints, -2.0, 2.0));
    const Limits limits{
        random.vector(joints, 1.0, 3.0), random.vector(joints, 3.0, 15.0), random.vector(joints, 50.0, 400.0), {}, {}};
    const PlanRequest r = request("time_optimal", way, limits);
    const double duration = plan(r).trajectory.duration();
    double stops = 0.0;
    for (std::size_t k = 1; k < way.size(); ++k)
      stops += plan(request("time_optimal", {way[k - 1], way[k]}, limits)).trajectory.duration();
    const double bound = LowerBound(r).find();
    const std::string what = "seed 95, trial " + std::to_string(trial);
    EXPECT_GE(duration, kOfGrid * bound) << what;
    EXPECT_LE(duration, 1.1 * bound) << what;
    EXPECT_LE(duration, stops * (1.0 + 1e-9)) << what;
    to_bound += duration / bound / kTrials;
    to_stops += duration / stops / kTrials;
  }
  RecordProperty("mean_ratio_to_bound", std::to_string(to_bound));
  RecordProperty("mean_ratio_to_stops", std::to_string(to_stops));
  EXPECT_LT(to_bound, 1.03);
  EXPECT_LT(to_stops, 0.95);
}

TEST(LowerBound, OfOneSegmentIsTheTrapezoid) {
  const Limits limits = limitsOf(2, 1.0, 4.0, 40.0);
  for (const double other : {0.0, 1.2}) {  // The dual comes near to its best where two joints need almost the same.
    const PlanRequest r = request("trapezoidal", {vector({0.0, 0.0}), vector({1.2, other / 1.2})}, limits);
    const double duration = plan(r).trajectory.duration();
    const double bound = LowerBound(r).find();
    EXPECT_LE(bound, duration + 1e-9);
    EXPECT_GE(bound, 0.97 * duration);
  }
  EXPECT_NEAR(leastTime(0.5, -0.5, 0.0, 1.0, 1.0), 1.0, 1e-12);
  EXPECT_NEAR(leastTime(0.0, 0.0, -1.0, 1.0, 4.0), 1.25, 1e-12);
}

}  // namespace
}  // namespace trajectory_test
}  // namespace screwline

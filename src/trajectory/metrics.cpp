#include "screwline/trajectory/metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "screwline/spatial/golden_section.h"

namespace screwline {
namespace {

constexpr double kRelativeTolerance = 1e-9;
constexpr int kGrid = 400;

struct Integral {
  double value = 0.0;
  double error = 0.0;
};

/// Gauss-Kronrod 7/15 on [from, to]. Nodes and weights: Piessens et al., QUADPACK, qk15.
Integral gaussKronrod(const std::function<double(double)>& f, double from, double to) {
  constexpr double kNodes[] = {0.991455371120812639206854697526329, 0.949107912342758524526189684047851,
                               0.864864423359769072789712788640926, 0.741531185599394439863864773280788,
                               0.586087235467691130294144691693,    0.405845151377397166906606412076961,
                               0.207784955007898467600689403773245, 0.0};
  constexpr double kKronrod[] = {0.022935322010529224963732008058970, 0.063092092629978553290700663189204,
                                 0.104790010322250183839876322541518, 0.140653259715525918745189590510238,
                                 0.169004726639267902826583426598550, 0.190350578064785409913256402421014,
                                 0.204432940075298892414161999234649, 0.209482141084727828012999174891714};
  constexpr double kGauss[] = {0.129484966168869693270611432679082, 0.279705391489276667901467771423780,
                               0.381830050505118944950369775488975, 0.417959183673469387755102040816327};
  const double middle = 0.5 * (from + to);
  const double half = 0.5 * (to - from);
  double kronrod = 0.0;
  double gauss = 0.0;
  for (int i = 0; i < 8; ++i) {
    const double value = i == 7 ? f(middle) : f(middle - half * kNodes[i]) + f(middle + half * kNodes[i]);
    kronrod += kKronrod[i] * value;
    if (i % 2 == 1) gauss += kGauss[i / 2] * value;
  }
  return {kronrod * half, std::abs(kronrod - gauss) * half};
}

/// Halves the worst part until the error is below the tolerance of the whole.
Integral integrate(const std::function<double(double)>& f, const std::vector<double>& breaks) {
  struct Part {
    double from, to;
    Integral integral;
  };
  constexpr std::size_t kMostParts = 4000;
  const auto less = [](const Part& a, const Part& b) { return a.integral.error < b.integral.error; };
  std::vector<Part> parts;
  Integral total;
  const auto add = [&](double from, double to) {
    const Integral part = gaussKronrod(f, from, to);
    parts.push_back({from, to, part});
    std::push_heap(parts.begin(), parts.end(), less);
    total = {total.value + part.value, total.error + part.error};
  };
  for (std::size_t k = 1; k < breaks.size(); ++k) add(breaks[k - 1], breaks[k]);
  const std::size_t most = std::max(kMostParts, 2 * parts.size());
  while (total.error > kRelativeTolerance * total.value && parts.size() < most) {
    std::pop_heap(parts.begin(), parts.end(), less);
    const Part worst = parts.back();
    parts.pop_back();
    total = {total.value - worst.integral.value, total.error - worst.integral.error};
    const double middle = 0.5 * (worst.from + worst.to);
    add(worst.from, middle);
    add(middle, worst.to);
  }
  return total;
}

/// Largest value on [from, to], where it has one maximum.
double goldenMaximum(const std::function<double(double)>& f, double from, double to) {
  return f(goldenMinimum([&f](double t) { return -f(t); }, from, to, 45));
}

double maximum(const std::function<double(double)>& f, const std::vector<double>& grid) {
  std::vector<double> values;
  for (double t : grid) values.push_back(f(t));
  double largest = *std::max_element(values.begin(), values.end());
  const double coarse = largest;
  for (std::size_t k = 0; k < grid.size(); ++k) {
    const double before = k > 0 ? values[k - 1] : -1.0;
    const double after = k + 1 < grid.size() ? values[k + 1] : -1.0;
    // Peaks far below the largest cannot overtake it on a grid that resolves the path.
    if (values[k] < before || values[k] < after || values[k] < 0.8 * coarse) continue;
    largest = std::max(largest, goldenMaximum(f, grid[k > 0 ? k - 1 : 0], grid[std::min(k + 1, grid.size() - 1)]));
  }
  return largest;
}

std::vector<double> gridOf(const JointTrajectory& trajectory, const std::vector<double>& breaks) {
  const int each = std::max(8, kGrid / static_cast<int>(breaks.size()));
  std::vector<double> grid{0.0};
  for (std::size_t k = 1; k < breaks.size(); ++k) {
    for (int i = 1; i <= each; ++i) grid.push_back(breaks[k - 1] + (breaks[k] - breaks[k - 1]) * i / each);
  }
  grid.back() = trajectory.duration();
  return grid;
}

}  // namespace

JointMetrics jointMetrics(const JointTrajectory& trajectory, const Limits& limits, const VectorX& goal) {
  const int n = trajectory.joints();
  const double infinity = std::numeric_limits<double>::infinity();
  JointMetrics m;
  for (VectorX* values : {&m.peak_velocity, &m.peak_acceleration, &m.peak_jerk, &m.acceleration_step,
                          &m.rms_acceleration, &m.jerk_integral, &m.travel, &m.limit_ratio}) {
    *values = VectorX::Zero(n);
  }
  for (int j = 0; j < n; ++j) {
    const JointExtrema e = trajectory.extrema(j);
    m.peak_velocity[j] = e.peak(1);
    m.peak_acceleration[j] = e.peak(2);
    m.peak_jerk[j] = e.peak(3);
    m.acceleration_step[j] = std::isinf(e.peak(3)) ? e.acceleration_step : 0.0;
    const double squared_acceleration = std::isinf(e.peak(2)) ? infinity : e.squared_acceleration;
    m.rms_acceleration[j] = trajectory.duration() > 0.0 ? std::sqrt(squared_acceleration / trajectory.duration()) : 0.0;
    m.jerk_integral[j] = std::isinf(e.peak(3)) ? infinity : e.squared_jerk;
    m.travel[j] = e.travel;
    m.energy += squared_acceleration;
    for (int order = 1; order <= 3; ++order) {
      if (std::isfinite(e.peak(order)))
        m.limit_ratio[j] = std::max(m.limit_ratio[j], e.peak(order) / limits.bound(j, order));
    }
  }
  TrajectoryPoint end(n);
  trajectory.sample(trajectory.duration(), end);
  if (n > 0) m.goal_error = (end.position - goal).cwiseAbs().maxCoeff();
  return m;
}

ToolMetrics toolMetrics(const JointTrajectory& trajectory, const ToolKinematics& tool) {
  ToolMetrics metrics;
  if (trajectory.duration() <= 0.0) return metrics;
  TrajectoryPoint state(trajectory.joints());
  const auto at = [&](double t) {
    trajectory.sample(t, state);
    return tool(state);
  };
  const auto speed = [&](double t) { return at(t).velocity.norm(); };
  std::vector<double> breaks{0.0};
  for (double corner : trajectory.corners()) breaks.push_back(corner);
  breaks.push_back(trajectory.duration());
  const std::vector<double> grid = gridOf(trajectory, breaks);

  const Integral length = integrate(speed, breaks);
  metrics.path_length = length.value;
  metrics.path_length_error = length.error;
  metrics.peak_speed = maximum(speed, grid);
  if (metrics.peak_speed <= 0.0) return metrics;
  const double standstill = 1e-6 * metrics.peak_speed;
  metrics.max_curvature = maximum(
      [&](double t) {
        const ToolMotion motion = at(t);
        const double v = motion.velocity.norm();
        return v > standstill ? motion.velocity.cross(motion.acceleration).norm() / (v * v * v) : 0.0;
      },
      grid);
  return metrics;
}

}  // namespace screwline

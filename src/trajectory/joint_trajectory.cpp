#include "screwline/trajectory/joint_trajectory.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace screwline {
namespace {

/// Weights of the coefficients of u^k in the four derivatives by time: falling factorial * u^(k - order) / h^order.
using Weights = std::array<std::array<double, Polynomial::kMaxDegree + 1>, 4>;

void fillWeights(double u, double inverse_length, int degree, Weights& w) {
  const double r = inverse_length;
  double u0 = 1.0, u1 = 0.0, u2 = 0.0, u3 = 0.0;  // u^k, u^(k-1), u^(k-2), u^(k-3)
  for (int k = 0; k <= degree; ++k) {
    const std::size_t i = static_cast<std::size_t>(k);
    const double f1 = k;
    const double f2 = f1 * (k - 1);
    w[0][i] = u0;
    w[1][i] = f1 * u1 * r;
    w[2][i] = f2 * u2 * (r * r);
    w[3][i] = f2 * (k - 2) * u3 * (r * r * r);
    u3 = u2;
    u2 = u1;
    u1 = u0;
    u0 *= u;
  }
}

/// The four sums of a block of neighbouring joints, kept in registers over all powers.
template <int kJoints>
void weigh(const double* c, int stride, int degree, const Weights& w, double* p, double* v, double* a, double* j) {
  using Block = Eigen::Array<double, kJoints, 1>;
  Block sums[4] = {Block::Zero(), Block::Zero(), Block::Zero(), Block::Zero()};
  for (std::size_t k = 0; k <= static_cast<std::size_t>(degree); ++k, c += stride) {
    const Block powers = Eigen::Map<const Block>(c);
    for (std::size_t order = 0; order < 4; ++order) sums[order] += w[order][k] * powers;
  }
  Eigen::Map<Block>{p} = sums[0];
  Eigen::Map<Block>{v} = sums[1];
  Eigen::Map<Block>{a} = sums[2];
  Eigen::Map<Block>{j} = sums[3];
}

/// Integral of |cos| from 0 to angle.
double cosineTravel(double angle) {
  const double half_turns = std::floor(angle / kPi + 0.5);
  const double sign = std::fmod(std::abs(half_turns), 2.0) == 0.0 ? 1.0 : -1.0;
  return 2.0 * half_turns + sign * std::sin(angle);
}

/// Range of sin over [from, to].
Range sineRange(double from, double to) {
  Range range{std::min(std::sin(from), std::sin(to)), std::max(std::sin(from), std::sin(to))};
  const auto passes = [&](double angle) {
    return std::ceil((from - angle) / kTwoPi) <= std::floor((to - angle) / kTwoPi);
  };
  if (passes(0.5 * kPi)) range.upper = 1.0;
  if (passes(-0.5 * kPi)) range.lower = -1.0;
  return range;
}

}  // namespace

JointTrajectory JointTrajectory::scaled(VectorX start, VectorX delta, TimeLaw scaling, double duration) {
  JointTrajectory trajectory;
  trajectory.form_ = Form::kScaled;
  trajectory.joints_ = static_cast<int>(start.size());
  trajectory.duration_ = duration;
  trajectory.inverse_duration_ = duration > kNoTime ? 1.0 / duration : 0.0;
  trajectory.start_ = std::move(start);
  trajectory.delta_ = std::move(delta);
  trajectory.scaling_ = std::move(scaling);
  return trajectory;
}

JointTrajectory JointTrajectory::piecewise(PiecewisePolynomial motion) {
  JointTrajectory trajectory;
  trajectory.joints_ = motion.joints;
  trajectory.duration_ = motion.duration();
  for (std::size_t k = 0; k < motion.segments(); ++k) {
    trajectory.inverse_lengths_.push_back(motion.length(k) > kNoTime ? 1.0 / motion.length(k) : 0.0);
  }
  trajectory.pieces_ = std::move(motion);
  return trajectory;
}

JointTrajectory JointTrajectory::sinusoidal(Sinusoid motion, double duration) {
  JointTrajectory trajectory;
  trajectory.form_ = Form::kSinusoidal;
  trajectory.joints_ = static_cast<int>(motion.offset.size());
  trajectory.duration_ = duration;
  trajectory.sinusoid_ = std::move(motion);
  return trajectory;
}

int JointTrajectory::continuity() const {
  if (form_ == Form::kScaled) return scaling_.continuity();
  if (form_ == Form::kSinusoidal) return 3;
  const bool joins_rest = pieces_.starts_at_rest || pieces_.ends_at_rest;
  return joins_rest ? std::min(pieces_.continuity, pieces_.rest_continuity) : pieces_.continuity;
}

std::vector<double> JointTrajectory::corners() const {
  std::vector<double> corners;
  if (form_ == Form::kScaled) {
    for (double tau : scaling_.breaks()) corners.push_back(tau * duration_);
  } else if (form_ == Form::kPiecewise && pieces_.breaks.size() > 2) {
    corners.assign(pieces_.breaks.begin() + 1, pieces_.breaks.end() - 1);
  }
  return corners;
}

void JointTrajectory::sample(double t, TrajectoryPoint& point) const {
  if (point.position.size() != joints_) point = TrajectoryPoint(joints_);
  sample(t, point.position.data(), point.velocity.data(), point.acceleration.data(), point.jerk.data());
}

void JointTrajectory::sample(double t, double* position, double* velocity, double* acceleration, double* jerk) const {
  const double inside = std::min(std::max(t, 0.0), duration_);
  switch (form_) {
    case Form::kScaled:
      sampleScaled(inside, position, velocity, acceleration, jerk);
      break;
    case Form::kPiecewise:
      samplePieces(inside, position, velocity, acceleration, jerk);
      break;
    case Form::kSinusoidal:
      sampleSinusoid(inside, position, velocity, acceleration, jerk);
      break;
  }
  if (t < 0.0 || t > duration_) {
    std::fill_n(velocity, joints_, 0.0);
    std::fill_n(acceleration, joints_, 0.0);
    std::fill_n(jerk, joints_, 0.0);
  }
}

void JointTrajectory::sampleScaled(double t, double* p, double* v, double* a, double* j) const {
  const double r = inverse_duration_;
  // t / T may round to just below 1 at t = T; the end is exactly the end.
  const ScalingSample s = scaling_.at(t >= duration_ && duration_ > 0.0 ? 1.0 : t * r);
  const double ds = s.ds * r;
  const double dds = s.dds * (r * r);
  const double ddds = s.ddds * (r * r * r);
  const double* start = start_.data();
  const double* delta = delta_.data();
  for (int i = 0; i < joints_; ++i) {
    p[i] = start[i] + delta[i] * s.s;
    v[i] = delta[i] * ds;
    a[i] = delta[i] * dds;
    j[i] = delta[i] * ddds;
  }
}

void JointTrajectory::samplePieces(double t, double* p, double* v, double* a, double* j) const {
  if (pieces_.segments() == 0) return;
  std::size_t segment = 0;
  if (pieces_.segments() > 1) {
    const auto after = std::upper_bound(pieces_.breaks.begin() + 1, pieces_.breaks.end() - 1, t);
    segment = static_cast<std::size_t>(after - pieces_.breaks.begin()) - 1;
  }
  const double inverse = inverse_lengths_[segment];
  const bool at_end = t >= pieces_.breaks[segment + 1] && inverse > 0.0;
  const double u = at_end ? 1.0 : (t - pieces_.breaks[segment]) * inverse;
  Weights w;
  fillWeights(u, inverse, pieces_.degree, w);
  const double* c = pieces_.coefficients.data() +
                    segment * static_cast<std::size_t>(pieces_.degree + 1) * static_cast<std::size_t>(joints_);
  int i = 0;
  for (; i + 4 <= joints_; i += 4) weigh<4>(c + i, joints_, pieces_.degree, w, p + i, v + i, a + i, j + i);
  for (; i + 2 <= joints_; i += 2) weigh<2>(c + i, joints_, pieces_.degree, w, p + i, v + i, a + i, j + i);
  if (i < joints_) weigh<1>(c + i, joints_, pieces_.degree, w, p + i, v + i, a + i, j + i);
}

void JointTrajectory::sampleSinusoid(double t, double* p, double* v, double* a, double* j) const {
  for (int i = 0; i < joints_; ++i) {
    const double omega = sinusoid_.omega[i];
    const double angle = omega * t + sinusoid_.phase[i];
    const double sine = sinusoid_.amplitude[i] * std::sin(angle);
    const double cosine = sinusoid_.amplitude[i] * std::cos(angle);
    p[i] = sinusoid_.offset[i] + sine;
    v[i] = omega * cosine;
    a[i] = -omega * omega * sine;
    j[i] = -omega * omega * omega * cosine;
  }
}

JointExtrema JointTrajectory::extrema(int joint) const {
  if (form_ == Form::kPiecewise) return pieces_.extrema(joint);
  return form_ == Form::kScaled ? scaledExtrema(joint) : sinusoidExtrema(joint);
}

JointExtrema JointTrajectory::scaledExtrema(int joint) const {
  const JointExtrema s = scaling_.extrema();
  const double d = std::abs(delta_[joint]);
  const double r = inverse_duration_;
  const double ends[] = {start_[joint] + delta_[joint] * s.position.lower,
                         start_[joint] + delta_[joint] * s.position.upper};
  JointExtrema e;
  e.position = {std::min(ends[0], ends[1]), std::max(ends[0], ends[1])};
  e.velocity = s.velocity * d * r;
  e.acceleration = s.acceleration * d * r * r;
  e.jerk = s.jerk * d * r * r * r;
  e.velocity_step = s.velocity_step * d * r;
  e.acceleration_step = s.acceleration_step * d * r * r;
  e.travel = s.travel * d;
  e.squared_acceleration = s.squared_acceleration * d * d * r * r * r;
  e.squared_jerk = s.squared_jerk * d * d * std::pow(r, 5);
  return e;
}

JointExtrema JointTrajectory::sinusoidExtrema(int joint) const {
  const double offset = sinusoid_.offset[joint];
  const double amplitude = sinusoid_.amplitude[joint];
  const double omega = sinusoid_.omega[joint];
  const double first = sinusoid_.phase[joint];
  const double swept = omega * duration_;
  const double from = std::min(first, first + swept);
  const double to = std::max(first, first + swept);
  const Range sine = sineRange(from, to);
  const Range cosine = sineRange(from + 0.5 * kPi, to + 0.5 * kPi);
  const double ends[] = {offset + amplitude * sine.lower, offset + amplitude * sine.upper};
  JointExtrema e;
  e.position = {std::min(ends[0], ends[1]), std::max(ends[0], ends[1])};
  e.velocity = std::abs(amplitude * omega) * cosine.peak();
  e.acceleration = std::abs(amplitude) * omega * omega * sine.peak();
  e.jerk = std::abs(amplitude * omega) * omega * omega * cosine.peak();
  e.travel = std::abs(amplitude) * (cosineTravel(to) - cosineTravel(from));
  // Integrals of sin^2 and cos^2: T/2 -+ sin(omega T) cos(omega T + 2 phase) / (2 omega).
  const double wave = omega != 0.0 ? std::sin(swept) * std::cos(swept + 2.0 * first) / (2.0 * omega) : 0.0;
  e.squared_acceleration = amplitude * amplitude * std::pow(omega, 4) * (0.5 * duration_ - wave);
  e.squared_jerk = amplitude * amplitude * std::pow(omega, 6) * (0.5 * duration_ + wave);
  return e;
}

}  // namespace screwline

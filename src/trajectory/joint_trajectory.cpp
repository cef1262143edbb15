#include "screwline/trajectory/joint_trajectory.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "along_path.h"

namespace screwline {
namespace {

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
  if (duration > kNoTime) {
    ScaledLine& line = trajectory.line_;
    if (trajectory.scaling_.isCycloidal()) {
      line.cycloid_rate = inverseLengthOf(duration);
    } else {
      line.scale = ScalingTable(trajectory.scaling_.pieces(), duration);
    }
    line.joints = trajectory.start_.size();
    line.start.assign(trajectory.start_.data(), trajectory.start_.data() + line.joints);
    line.delta.assign(trajectory.delta_.data(), trajectory.delta_.data() + line.joints);
    trajectory.line_kernel_ = sampleKernels().line(line);
  }
  return trajectory;
}

JointTrajectory JointTrajectory::alongPath(JointPath path, const TimeLaw& scaling, double duration) {
  JointTrajectory trajectory;
  trajectory.form_ = Form::kAlongPath;
  trajectory.joints_ = path.joints();
  trajectory.duration_ = duration;
  trajectory.inverse_duration_ = duration > kNoTime ? 1.0 / duration : 0.0;
  trajectory.scaling_ = TimeLaw(scalingAlongPath(path, scaling));
  if (duration > kNoTime) {
    trajectory.extrema_ = extremaAlongPath(path, trajectory.scaling_.pieces(), duration);
    PiecewisePolynomial u = trajectory.scaling_.pieces();
    for (double& c : u.coefficients) c *= path.length();
    trajectory.along_ = ScalingTable(u, duration);
  }
  trajectory.path_ = std::move(path);
  return trajectory;
}

JointTrajectory JointTrajectory::piecewise(PiecewisePolynomial motion) {
  JointTrajectory trajectory;
  trajectory.joints_ = motion.joints;
  trajectory.duration_ = motion.duration();
  trajectory.breaks_ = BreakTable(motion.breaks);
  trajectory.stride_ = static_cast<std::size_t>(motion.degree + 1) * static_cast<std::size_t>(motion.joints);
  for (std::size_t k = 0; k < motion.segments(); ++k) {
    trajectory.spans_.push_back({motion.breaks[k], inverseLengthOf(motion.length(k))});
  }
  trajectory.piece_kernel_ = sampleKernels().piece({motion.joints, motion.degree});
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
  if (form_ == Form::kAlongPath) return pathContinuity();
  const bool joins_rest = pieces_.starts_at_rest || pieces_.ends_at_rest;
  return joins_rest ? std::min(pieces_.continuity, pieces_.rest_continuity) : pieces_.continuity;
}

bool JointTrajectory::startsMoving() const {
  const TimeLaw* const law = scaling();
  if (law != nullptr) return !law->isCycloidal() && !law->pieces().starts_at_rest;
  return form_ == Form::kPiecewise && !pieces_.starts_at_rest;
}

/// A path that turns is stopped at, so its motion may be smoother than the path: what steps decides.
int JointTrajectory::pathContinuity() const {
  const PiecewisePolynomial& s = scaling_.pieces();
  const bool joins_rest = s.starts_at_rest || s.ends_at_rest;
  int continuity = joins_rest ? std::min(s.continuity, s.rest_continuity) : s.continuity;
  if (path_.curve().continuity > 0) continuity = std::min(continuity, path_.curve().continuity);
  for (const JointExtrema& e : extrema_) {
    if (std::isinf(e.peak(3))) continuity = std::min(continuity, 1);
    if (std::isinf(e.peak(2))) continuity = 0;
  }
  return continuity;
}

std::vector<double> JointTrajectory::corners() const {
  std::vector<double> corners;
  if (form_ == Form::kScaled || form_ == Form::kAlongPath) {
    for (double tau : scaling_.breaks()) corners.push_back(tau * duration_);
  } else if (form_ == Form::kPiecewise && pieces_.breaks.size() > 2) {
    corners.assign(pieces_.breaks.begin() + 1, pieces_.breaks.end() - 1);
  }
  return corners;
}

void JointTrajectory::resize(TrajectoryPoint& point) const {
  point = TrajectoryPoint(joints_);
}

void JointTrajectory::sampleOther(double t, const SampleOutput& output) const {
  const double inside = std::min(std::max(t, 0.0), duration_);
  switch (form_) {
    case Form::kScaled:
      sampleScaled(inside, output);
      break;
    case Form::kAlongPath:
      samplePath(inside, output);
      break;
    case Form::kPiecewise:
      if (!spans_.empty()) samplePieces(inside, output);
      break;
    case Form::kSinusoidal:
      sampleSinusoid(inside, output);
      break;
  }
  if (t < 0.0 || t > duration_) {
    std::fill_n(output.velocity, joints_, 0.0);
    std::fill_n(output.acceleration, joints_, 0.0);
    std::fill_n(output.jerk, joints_, 0.0);
  }
}

void JointTrajectory::sampleScaled(double t, const SampleOutput& output) const {
  if (line_kernel_ != nullptr) {
    line_kernel_(line_, t, output.position, output.velocity, output.acceleration, output.jerk);
    return;
  }
  const double r = inverse_duration_;
  // t / T may round to just below 1 at t = T; the end is exactly the end.
  const ScalingSample s = scaling_.at(t >= duration_ && duration_ > 0.0 ? 1.0 : t * r);
  const double row[] = {s.s, s.ds * r, s.dds * (r * r), s.ddds * (r * r * r)};
  scaleDelta(row, start_.data(), delta_.data(), joints_, output);
}

void JointTrajectory::samplePath(double t, const SampleOutput& output) const {
  double u[4] = {0.0, 0.0, 0.0, 0.0};  // And its derivatives by time.
  if (!along_.empty()) sampleKernels().scaling(along_.at(t), u);
  const std::size_t k = path_.segmentAt(u[0]);
  const double r = path_.inverseLength(k);
  const double x = std::min(std::max((u[0] - path_.breaks()[k]) * r, 0.0), 1.0);
  const double d1 = u[1] * r, d2 = u[2] * r, d3 = u[3] * r;
  sampleKernels().segment(path_.segment(k), x, {d1, d2, d1 * d1, d3, 3.0 * d1 * d2, d1 * d1 * d1}, output);
}

void JointTrajectory::sampleSinusoid(double t, const SampleOutput& output) const {
  for (int i = 0; i < joints_; ++i) {
    const double omega = sinusoid_.omega[i];
    const double angle = omega * t + sinusoid_.phase[i];
    const double sine = sinusoid_.amplitude[i] * std::sin(angle);
    const double cosine = sinusoid_.amplitude[i] * std::cos(angle);
    output.position[i] = sinusoid_.offset[i] + sine;
    output.velocity[i] = omega * cosine;
    output.acceleration[i] = -omega * omega * sine;
    output.jerk[i] = -omega * omega * omega * cosine;
  }
}

JointExtrema JointTrajectory::extrema(int joint) const {
  if (form_ == Form::kPiecewise) return pieces_.extrema(joint);
  if (form_ == Form::kAlongPath) return pathExtrema(joint);
  return form_ == Form::kScaled ? scaledExtrema(joint) : sinusoidExtrema(joint);
}

JointExtrema JointTrajectory::pathExtrema(int joint) const {
  if (!extrema_.empty()) return extrema_[static_cast<std::size_t>(joint)];
  JointExtrema rest;
  const double q = path_.curve().at(0, 0, joint);
  rest.position = {q, q};
  return rest;
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

#include "solution_curve.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "screwline/spatial/rotation.h"
#include "turns.h"

namespace screwline {
namespace {

constexpr double kMoves = 1e-7;       // A joint whose range is smaller does not move.
constexpr double kDifference = 2e-6;  // Of the period, for tangents.
constexpr double kValue = 1e-14;      // [rad, m] that a joint's extreme value still gains.
constexpr double kWider = 10.0;       // Differences, where rounding hides them.
constexpr double kSettled = 3e-6;     // Of the period: a step whose square is nothing,
constexpr double kLinear = 0.01;      // where steps shrink by more than this.
constexpr int kMostSteps = 12;

/// Joints that move along the run.
std::vector<int> movingJoints(const CurveRun& run) {
  MemberVector lower = run.samples.front().q;
  MemberVector upper = lower;
  for (const CurveSample& sample : run.samples) {
    lower = lower.cwiseMin(sample.q);
    upper = upper.cwiseMax(sample.q);
  }
  std::vector<int> joints;
  for (Eigen::Index i = 0; i < lower.size(); ++i) {
    if (upper[i] - lower[i] > kMoves) joints.push_back(static_cast<int>(i));
  }
  return joints;
}

/// Half the second derivative of the parabola through three members' values of a joint.
double bendOf(const CurveSample& a, const CurveSample& b, const CurveSample& c, int joint) {
  const double left = (b.q[joint] - a.q[joint]) / (b.at - a.at);
  const double right = (c.q[joint] - b.q[joint]) / (c.at - b.at);
  return (right - left) / (c.at - a.at);
}

/// Where the parabola through three members' values of a joint turns back; NaN where they lie on a line.
double vertexOf(const CurveSample& a, const CurveSample& b, const CurveSample& c, int joint) {
  const double left = (b.q[joint] - a.q[joint]) / (b.at - a.at);
  return 0.5 * (a.at + b.at) - 0.5 * left / bendOf(a, b, c, joint);
}

double square(double x) {
  return x * x;
}

/// The limit beyond which a value is.
std::optional<double> brokenLimit(const JointLimits& limits, double value) {
  if (value < limits.lower - kLimitBand) return limits.lower;
  if (value > limits.upper + kLimitBand) return limits.upper;
  return std::nullopt;
}

/// Ranges up to a member.
void widen(const SerialChain& chain, const MemberVector& q, Continuum& continuum) {
  for (std::size_t i = 0; i < continuum.free_joints.size(); ++i) {
    const int joint = continuum.free_joints[i];
    const JointLimits& limits = chain.joint(joint).limits;
    const double value = std::clamp(q[joint], limits.lower, limits.upper);
    const auto k = static_cast<Eigen::Index>(i);
    continuum.lower[k] = std::min(continuum.lower[k], value);
    continuum.upper[k] = std::max(continuum.upper[k], value);
  }
}

}  // namespace

/// Successive parabolas through the three members nearest to where the joint turns back.
CurveSample SolutionCurve::turningPoint(CurveSample before, CurveSample middle, CurveSample behind, int joint) const {
  const double from = before.at;
  const double to = behind.at;
  for (int k = 0; k < kMostSteps; ++k) {
    const double vertex = vertexOf(before, middle, behind, joint);
    if (!(vertex > from && vertex < to)) break;
    if (std::abs(vertex - middle.at) <= kFine * period_ || vertex == before.at || vertex == behind.at) break;
    if (k > 0 && std::abs(bendOf(before, middle, behind, joint)) * square(vertex - middle.at) <= kValue) break;
    CurveSample next = sampleAt(vertex, middle.q);
    if (!next.exists()) break;
    const double gain = std::abs(next.q[joint] - middle.q[joint]);
    // Of the three before, the farthest goes.
    const bool early = std::abs(before.at - vertex) > std::abs(behind.at - vertex);
    (early ? before : behind) = std::move(middle);
    middle = std::move(next);
    if (gain <= kValue) break;
  }
  return middle;
}

void SolutionCurve::addTurningPoints(CurveRun& run) const {
  const std::vector<CurveSample>& samples = run.samples;
  const std::size_t last = samples.size() - 1;
  std::vector<CurveSample> found;
  const auto look = [&](const CurveSample& before, const CurveSample& middle, const CurveSample& behind, int joint) {
    const double one = middle.q[joint] - before.q[joint];
    const double other = behind.q[joint] - middle.q[joint];
    if (one * other < 0.0) found.push_back(turningPoint(before, middle, behind, joint));
  };
  for (int joint : movingJoints(run)) {
    for (std::size_t i = 1; i < last; ++i) look(samples[i - 1], samples[i], samples[i + 1], joint);
    if (!run.closed || last < 2) continue;
    CurveSample before = samples[last - 1];
    before.at -= period_;
    bringNear(chain_, samples.front().q, before.q);
    look(before, samples.front(), samples[1], joint);
    if (found.empty() || found.back().at >= samples.front().at) continue;
    found.back().at += period_;
    bringNear(chain_, samples.back().q, found.back().q);
  }
  insert(run, std::move(found));
}

/// Where between two members a joint has a value, by regula falsi (Illinois).
CurveSample SolutionCurve::passing(CurveSample from, CurveSample to, int joint, double value) const {
  double at_from = from.q[joint] - value;
  double at_to = to.q[joint] - value;
  if (at_from == 0.0) return from;
  for (int k = 0; k < kMostBisections && std::abs(to.at - from.at) > 1e-6 * kFine * period_; ++k) {
    const double at = (from.at * at_to - to.at * at_from) / (at_to - at_from);
    CurveSample next = sampleAt(at, from.q);
    if (!next.exists()) break;
    const double value_there = next.q[joint] - value;
    if (std::abs(value_there) <= 10.0 * kValue) return next;
    if ((value_there < 0.0) == (at_to < 0.0)) {
      at_from *= 0.5;
    } else {
      from = std::move(to);
      at_from = at_to;
    }
    to = std::move(next);
    at_to = value_there;
  }
  return std::abs(at_from) < std::abs(at_to) ? from : to;
}

/// Members where a joint passes a limit, in whichever turn.
void SolutionCurve::addLimits(CurveRun& run) const {
  std::vector<CurveSample> found;
  for (int joint : movingJoints(run)) {
    const JointLimits& limits = chain_.joint(joint).limits;
    const bool turns = chain_.joint(joint).isRevolute();
    for (double limit : {limits.lower, limits.upper}) {
      if (!std::isfinite(limit)) continue;
      for (std::size_t i = 1; i < run.samples.size(); ++i) {
        const CurveSample& from = run.samples[i - 1];
        const CurveSample& to = run.samples[i];
        const auto [low, high] = std::minmax(from.q[joint], to.q[joint]);
        const double turn = turns ? std::ceil((low - limit) / kTwoPi) : 0.0;
        const double value = limit + turn * kTwoPi;
        if (value > low && value < high) found.push_back(passing(from, to, joint, value));
      }
    }
  }
  insert(run, std::move(found));
}

/// From the seed to a member, in the turns that are taken.
MemberVector SolutionCurve::awayFrom(const MemberVector& q, const VectorX& seed, bool honour) const {
  if (honour) return chooseTurns(chain_, q, seed, true, false, kLimitBand).q - seed;
  MemberVector away = q - seed;
  for (int i = 0; i < chain_.size(); ++i) {
    if (chain_.joint(i).isRevolute()) away[i] = withoutTurns(away[i]);
  }
  return away;
}

/// Newton's method on the distance to the seed, with the curve's own curvature.
CurveSample SolutionCurve::nearestAbout(const CurveSample& start, double from, double to, const VectorX& seed,
                                        bool honour) const {
  CurveSample best = start;
  MemberVector away = awayFrom(best.q, seed, honour);
  double h = kDifference * period_;
  double moved = period_;
  for (int k = 0; k < kMostSteps && best.at - h >= from && best.at + h <= to; ++k) {
    const CurveSample ahead = sampleAt(best.at + h, best.q);
    const CurveSample behind = sampleAt(best.at - h, best.q);
    if (!ahead.exists() || !behind.exists()) break;
    const MemberVector rate = (ahead.q - behind.q) / (2.0 * h);
    const double bend = (ahead.q - 2.0 * best.q + behind.q).dot(away) / (h * h);
    const double steepness = rate.squaredNorm() + std::max(bend, -0.5 * rate.squaredNorm());
    if (!(steepness > 0.0)) {  // Rounding has put the three members on one place.
      h *= kWider;
      continue;
    }
    double step = -rate.dot(away) / steepness;
    const double last = moved;
    moved = 0.0;
    for (int half = 0; half < 10; ++half, step *= 0.5) {
      CurveSample next = sampleAt(std::clamp(best.at + step, from, to), best.q);
      if (!next.exists()) continue;
      const MemberVector away_there = awayFrom(next.q, seed, honour);
      if (away_there.squaredNorm() > away.squaredNorm()) continue;
      moved = std::abs(next.at - best.at);
      best = std::move(next);
      away = away_there;
      break;
    }
    const bool is_quadratic = moved <= kSettled * period_ && moved <= kLinear * last;  // So the next is nothing.
    if (moved <= kFine * period_ || is_quadratic) break;
  }
  return best;
}

/// From one side at an end of the run.
MemberVector SolutionCurve::tangentAt(const CurveRun& run, const CurveSample& sample) const {
  const double h = kDifference * period_;
  const bool goes_on = run.closed || sample.at + h <= run.samples.back().at;
  const bool came_on = run.closed || sample.at - h >= run.samples.front().at;
  const CurveSample ahead = goes_on ? sampleAt(sample.at + h, sample.q) : sample;
  const CurveSample behind = came_on ? sampleAt(sample.at - h, sample.q) : sample;
  return (ahead.exists() ? ahead.q : sample.q) - (behind.exists() ? behind.q : sample.q);
}

/// From the nearest member until a joint meets a limit or the run ends; all the way round where it is closed.
void SolutionCurve::walk(const CurveRun& run, const CurveSample& nearest, int way, Continuum& continuum) const {
  const std::vector<CurveSample>& samples = run.samples;
  const MemberVector turned = continuum.nearest - nearest.q;  // By full turns.
  const auto count = static_cast<std::ptrdiff_t>(samples.size()) - 1;
  const auto place = std::upper_bound(samples.begin(), samples.end(), nearest.at,
                                      [](double at, const CurveSample& sample) { return at < sample.at; }) -
                     samples.begin();
  CurveSample inside = nearest;
  bool open = true;
  for (std::ptrdiff_t step = 0; open && step <= count; ++step) {
    const std::ptrdiff_t i = way > 0 ? place + step : place - 1 - step;
    if (!run.closed && (i < 0 || i > count)) break;
    const bool is_round = run.closed && step == count;
    CurveSample next = is_round ? roundsOn(run, nearest, way) : sampleOf(run, i);
    for (int joint : continuum.free_joints) {
      const std::optional<double> limit = brokenLimit(chain_.joint(joint).limits, next.q[joint] + turned[joint]);
      if (!limit) continue;
      next = passing(inside, next, joint, *limit - turned[joint]);
      open = false;
    }
    widen(chain_, next.q + turned, continuum);
    inside = std::move(next);
  }
}

/// The same member, so many times round.
CurveSample SolutionCurve::roundsOn(const CurveRun& run, CurveSample sample, std::ptrdiff_t rounds) const {
  sample.at += static_cast<double>(rounds) * period_;
  sample.q += static_cast<double>(rounds) * (run.samples.back().q - run.samples.front().q);
  return sample;
}

/// Counted on beyond the ends of a closed run.
CurveSample SolutionCurve::sampleOf(const CurveRun& run, std::ptrdiff_t i) const {
  if (!run.closed) return run.samples[static_cast<std::size_t>(i)];
  const auto count = static_cast<std::ptrdiff_t>(run.samples.size()) - 1;
  const std::ptrdiff_t rounds = i >= 0 ? i / count : (i - count + 1) / count;
  return roundsOn(run, run.samples[static_cast<std::size_t>(i - rounds * count)], rounds);
}

/// The squared distance to the seed in the nearest turns; no other turns are nearer.
double SolutionCurve::leastSquare(const MemberVector& q, const VectorX& seed) const {
  double sum = 0.0;
  for (int i = 0; i < chain_.size(); ++i) {
    const double apart = std::abs(q[i] - seed[i]);
    const bool other_turn = apart > kPi && chain_.joint(i).isRevolute();
    const double d = other_turn ? apart - kTwoPi * std::round(apart / kTwoPi) : apart;
    sum += d * d;
  }
  return sum;
}

/// Run and number of the sample nearest to the seed; within limits, where they are honoured. False: there is none.
bool SolutionCurve::nearestSample(const std::vector<CurveRun>& runs, const VectorX& seed, bool honour,
                                  const CurveRun*& run, std::size_t& number) const {
  double least = std::numeric_limits<double>::infinity();
  for (const CurveRun& one : runs) {
    for (std::size_t i = 0; i < one.samples.size(); ++i) {
      double square = leastSquare(one.samples[i].q, seed);
      if (square >= least) continue;
      if (honour) {
        const Turned turned = chooseTurns(chain_, one.samples[i].q, seed, true, false, kLimitBand);
        square = (turned.q - seed).squaredNorm();
        if (!turned.within_limits || square >= least) continue;
      }
      least = square;
      run = &one;
      number = i;
    }
  }
  return std::isfinite(least);
}

/// How far from a sample one may look to one side: to its neighbour, or to the next one where that is too near for
/// differences; not beyond one that is outside limits, where they are honoured.
double SolutionCurve::reachFrom(const CurveRun& run, std::size_t number, int way, const VectorX& seed,
                                bool honour) const {
  const auto last = static_cast<std::ptrdiff_t>(run.samples.size()) - 1;
  const double start = run.samples[number].at;
  double reach = start;
  double round = 0.0;
  for (auto i = static_cast<std::ptrdiff_t>(number) + way; std::abs(reach - start) <= 2.0 * kDifference * period_;
       i += way) {
    if (i < 0 || i > last) {
      if (!run.closed) break;
      round += way * period_;
      i = way > 0 ? 1 : last - 1;
    }
    const CurveSample& sample = run.samples[static_cast<std::size_t>(i)];
    if (honour && !chooseTurns(chain_, sample.q, seed, true, false, kLimitBand).within_limits) break;
    reach = sample.at + round;
  }
  return reach;
}

/// Between a sample and its neighbours.
CurveSample SolutionCurve::nearestIn(const CurveRun& run, std::size_t number, const VectorX& seed, bool honour) const {
  const std::vector<CurveSample>& samples = run.samples;
  const double from = reachFrom(run, number, -1, seed, honour);
  const double to = reachFrom(run, number, 1, seed, honour);
  CurveSample nearest = nearestAbout(samples[number], from, to, seed, honour);
  if (nearest.at < samples.front().at || nearest.at > samples.back().at) {
    const double round = nearest.at < samples.front().at ? 1.0 : -1.0;
    nearest.at += round * period_;
    nearest.q += round * (samples.back().q - samples.front().q);
  }
  return nearest;
}

Continuum SolutionCurve::describe(double start, const VectorX& q, const VectorX& seed, bool ignore_limits,
                                  CurveImage* image) const {
  std::vector<CurveRun> runs = runsFrom(start, q, image);
  if (!ignore_limits) {
    for (CurveRun& run : runs) addLimits(run);
  }
  const CurveRun* run = &runs.front();
  std::size_t number = 0;
  const bool within = !ignore_limits && nearestSample(runs, seed, true, run, number);
  if (!within) nearestSample(runs, seed, false, run, number);
  const CurveSample nearest = nearestIn(*run, number, seed, within);
  Continuum continuum;
  continuum.nearest = chooseTurns(chain_, nearest.q, seed, true, ignore_limits, kLimitBand).q;
  continuum.directions = tangentAt(*run, nearest).normalized().transpose();
  continuum.free_joints = movingJoints(*run);
  const auto count = static_cast<Eigen::Index>(continuum.free_joints.size());
  continuum.lower.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    continuum.lower[i] = continuum.nearest[continuum.free_joints[static_cast<std::size_t>(i)]];
  }
  continuum.upper = continuum.lower;
  const bool breaks = std::any_of(continuum.free_joints.begin(), continuum.free_joints.end(), [&](int joint) {
    return brokenLimit(chain_.joint(joint).limits, continuum.nearest[joint]).has_value();
  });
  if (breaks) return continuum;
  for (int way : {1, -1}) walk(*run, nearest, way, continuum);
  return continuum;
}

}  // namespace screwline

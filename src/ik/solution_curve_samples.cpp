// Members all the way round a continuum, and the stretches that they make.
#include <algorithm>
#include <cmath>
#include <iterator>

#include "solution_curve.h"

namespace screwline {
namespace {

constexpr int kSamples = 24;      // All the way round,
constexpr int kEndSamples = 192;  // and where some are missing.
constexpr double kFar = 0.4;      // [rad; m per characteristic length] from one sample to the next, at most.

}  // namespace

CurveSample SolutionCurve::sampleAt(double at, const MemberVector& near) const {
  CurveSample sample{at, near};
  if (!at_(at, near, sample.q)) sample.q.resize(0);
  return sample;
}

bool SolutionCurve::movesFar(const MemberVector& a, const MemberVector& b) const {
  for (int i = 0; i < chain_.size(); ++i) {
    const double apart = std::abs(a[i] - b[i]);
    if (chain_.joint(i).isRevolute() ? apart > kFar : apart > kFar * chain_.characteristicLength()) return true;
  }
  return false;
}

/// Members between two, by halves. Where a joint jumps there is another singularity on the way: a gap.
void SolutionCurve::refine(const CurveSample& from, const CurveSample& to, std::vector<CurveSample>& samples) const {
  if (!from.exists() && !to.exists()) return;
  const bool both = from.exists() && to.exists();
  if (both && !movesFar(from.q, to.q)) return;
  if (!both && to.at - from.at < 1.5 * period_ / kEndSamples) return;
  CurveSample middle = sampleAt(0.5 * (from.at + to.at), from.exists() ? from.q : to.q);
  if (to.at - from.at < kFine * period_) {
    middle.q.resize(0);
    samples.push_back(std::move(middle));
    return;
  }
  refine(from, middle, samples);
  samples.push_back(middle);
  refine(middle, to, samples);
}

std::vector<CurveSample> SolutionCurve::allRound(double start, const MemberVector& q) const {
  std::vector<CurveSample> samples = {{start, q}};
  samples.reserve(4 * kSamples);
  CurveSample before = samples.front();
  MemberVector near = q;
  for (int i = 1; i <= kSamples; ++i) {
    CurveSample next = sampleAt(start + period_ * i / kSamples, near);
    refine(before, next, samples);
    if (next.exists()) near = next.q;
    samples.push_back(next);
    before = std::move(next);
  }
  return samples;
}

/// With the members in which joints turn back; by those of an image, where they are known.
std::vector<CurveRun> SolutionCurve::runsFrom(double start, const MemberVector& q, CurveImage* image) const {
  if (image != nullptr && !image->runs.empty() && image->start == start) {
    std::vector<CurveRun> runs = image->runs;
    for (CurveRun& run : runs) {
      for (CurveSample& sample : run.samples) {
        sample.q -= image->q;
        sample.q[image->mirrored] *= -1.0;
        sample.q += q;
      }
    }
    return runs;
  }
  std::vector<CurveRun> runs = runsOf(allRound(start, q));
  for (CurveRun& run : runs) addTurningPoints(run);
  if (image != nullptr) {
    image->start = start;
    image->q = q;
    image->runs = runs;
  }
  return runs;
}

/// The last member towards `outside`, where there is none. At a jump it is there already; at a fold the joints move
/// with the root of what is left.
CurveSample SolutionCurve::endOf(CurveSample inside, double outside) const {
  if (std::abs(outside - inside.at) < kFine * period_) return inside;
  for (int i = 0; i < kMostBisections && std::abs(outside - inside.at) > 1e-6 * kFine * period_; ++i) {
    CurveSample middle = sampleAt(0.5 * (inside.at + outside), inside.q);
    if (middle.exists()) {
      inside = std::move(middle);
    } else {
      outside = middle.at;
    }
  }
  return inside;
}

/// Stretches without a gap; the one that goes on beyond the start is put together.
std::vector<CurveRun> SolutionCurve::runsOf(std::vector<CurveSample> samples) const {
  const auto gap = std::find_if(samples.begin(), samples.end(), [](const CurveSample& s) { return !s.exists(); });
  std::vector<CurveRun> runs;
  if (gap == samples.end()) {
    runs.push_back({std::move(samples), true});
  } else {
    samples.pop_back();  // The first, once more.
    std::rotate(samples.begin(), samples.begin() + (gap - samples.begin()), samples.end());
    samples.push_back(samples.front());
    const double first = samples.front().at;
    for (CurveSample& sample : samples) sample.at += sample.at < first ? period_ : 0.0;
    samples.back().at = first + period_;
    for (std::size_t i = 1; i < samples.size(); ++i) {
      if (!samples[i].exists()) {
        if (samples[i - 1].exists()) runs.back().samples.push_back(endOf(samples[i - 1], samples[i].at));
        continue;
      }
      if (!samples[i - 1].exists()) runs.push_back({{endOf(samples[i], samples[i - 1].at)}, false});
      runs.back().samples.push_back(samples[i]);
    }
  }
  for (CurveRun& run : runs) bringTogether(run);
  // The members in a jump itself are of the continuum that crosses.
  const auto first_point = std::stable_partition(runs.begin(), runs.end(), [this](const CurveRun& run) {
    return run.samples.back().at - run.samples.front().at > 2.0 * kFine * period_;
  });
  if (first_point != runs.begin()) runs.erase(first_point, runs.end());
  return runs;
}

/// Each into the turns next to the one before.
void SolutionCurve::bringTogether(CurveRun& run) const {
  for (std::size_t i = 1; i < run.samples.size(); ++i) bringNear(chain_, run.samples[i - 1].q, run.samples[i].q);
}

/// Members into their places among those of the run.
void SolutionCurve::insert(CurveRun& run, std::vector<CurveSample> found) const {
  const auto isBefore = [](const CurveSample& a, const CurveSample& b) { return a.at < b.at; };
  std::stable_sort(found.begin(), found.end(), isBefore);
  std::vector<CurveSample> all;
  all.reserve(run.samples.size() + found.size());
  std::merge(run.samples.begin(), run.samples.end(), found.begin(), found.end(), std::back_inserter(all), isBefore);
  run.samples = std::move(all);
  bringTogether(run);
}

}  // namespace screwline

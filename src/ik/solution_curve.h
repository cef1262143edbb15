#ifndef SCREWLINE_SRC_IK_SOLUTION_CURVE_H
#define SCREWLINE_SRC_IK_SOLUTION_CURVE_H

#include <cstddef>
#include <optional>
#include <vector>

#include "solution_line.h"

namespace screwline {

/// One member of a continuum; without values where there is none.
struct CurveSample {
  double at = 0.0;  ///< The parameter's value.
  MemberVector q;

  bool exists() const { return q.size() > 0; }
};

/// A stretch of a continuum: members at growing values of the parameter, each in the turns next to the one before.
/// Closed: the last is the first, one period on.
struct CurveRun {
  std::vector<CurveSample> samples;
  bool closed = false;
};

/// What continua share that are each other's images: between theirs, the members' values differ by constants, after one
/// joint's have changed sign. Kept by whichever is described first.
struct CurveImage {
  int mirrored = 0;  ///< That joint.
  double start = 0.0;
  MemberVector q;  ///< The member there.
  std::vector<CurveRun> runs;
};

/// A bent continuum of one dimension, by exact members at values of a parameter that comes round after `period`.
class SolutionCurve {
 public:
  /// The chain must outlive it.
  SolutionCurve(const SerialChain& chain, MemberAt at, double period)
      : chain_(chain), at_(std::move(at)), period_(period) {}

  /// The member nearest to the seed (of those within limits, where any are), and how far the joints move from there
  /// until one of them meets a limit. 24 members all the way round and more where a joint moves farther than 0.4 rad
  /// from one to the next; the nearest member and the ends of ranges (where a joint turns back, meets a limit, or the
  /// branch ends at a fold or another singularity) are refined to 1e-9 of the period.
  /// @param q the member at `start`.
  /// @param image where there is one.
  Continuum describe(double start, const VectorX& q, const VectorX& seed, bool ignore_limits,
                     CurveImage* image = nullptr) const;

 private:
  static constexpr double kFine = 1e-9;  ///< Of the period.
  static constexpr int kMostBisections = 60;

  CurveSample sampleAt(double at, const MemberVector& near) const;
  std::vector<CurveRun> runsFrom(double start, const MemberVector& q, CurveImage* image) const;
  std::vector<CurveSample> allRound(double start, const MemberVector& q) const;
  void refine(const CurveSample& from, const CurveSample& to, std::vector<CurveSample>& samples) const;
  bool movesFar(const MemberVector& a, const MemberVector& b) const;
  std::vector<CurveRun> runsOf(std::vector<CurveSample> samples) const;
  CurveSample endOf(CurveSample inside, double outside) const;
  void bringTogether(CurveRun& run) const;
  void insert(CurveRun& run, std::vector<CurveSample> found) const;
  void addTurningPoints(CurveRun& run) const;
  CurveSample turningPoint(CurveSample before, CurveSample middle, CurveSample behind, int joint) const;
  void addLimits(CurveRun& run) const;
  CurveSample passing(CurveSample from, CurveSample to, int joint, double value) const;
  MemberVector awayFrom(const MemberVector& q, const VectorX& seed, bool honour) const;
  CurveSample nearestAbout(const CurveSample& start, double from, double to, const VectorX& seed, bool honour) const;
  double leastSquare(const MemberVector& q, const VectorX& seed) const;
  bool nearestSample(const std::vector<CurveRun>& runs, const VectorX& seed, bool honour, const CurveRun*& run,
                     std::size_t& number) const;
  double reachFrom(const CurveRun& run, std::size_t number, int way, const VectorX& seed, bool honour) const;
  CurveSample nearestIn(const CurveRun& run, std::size_t number, const VectorX& seed, bool honour) const;
  MemberVector tangentAt(const CurveRun& run, const CurveSample& sample) const;
  CurveSample roundsOn(const CurveRun& run, CurveSample sample, std::ptrdiff_t rounds) const;
  CurveSample sampleOf(const CurveRun& run, std::ptrdiff_t i) const;
  void walk(const CurveRun& run, const CurveSample& nearest, int way, Continuum& continuum) const;

  const SerialChain& chain_;
  MemberAt at_;
  double period_;
};

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_SOLUTION_CURVE_H

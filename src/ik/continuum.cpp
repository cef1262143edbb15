#include "continuum.h"

#include <Eigen/QR>
#include <cmath>

#include "screwline/spatial/golden_section.h"
#include "solution_curve.h"
#include "solution_line.h"
#include "turns.h"

namespace screwline {
namespace {

constexpr double kDifference = 1e-5;  // [rad, m] step of the central differences.
constexpr double kStep = kPi / 90.0;  // [rad] along a continuum.
constexpr double kMoves = 1e-7;       // A joint whose share of every tangent is below does not move.
constexpr int kMaxNearestIterations = 30;
constexpr int kMaxTurnings = 3;
constexpr int kGoldenSteps = 38;      // From a step to 1e-9 of it and less.
constexpr double kStationary = 1e-6;  // Of the distance, along the continuum.

double stepOf(const SerialChain& chain, int joint) {
  return chain.joint(joint).isRevolute() ? kStep : 0.02 * chain.characteristicLength();
}

bool isWithinLimits(const SerialChain& chain, const VectorX& q) {
  return chooseTurns(chain, q, q, true, false, kLimitBand).within_limits;
}

/// Members as a function of the free joints' values, on one sheet: revolute values follow on from `q`.
class Family {
 public:
  Family(const SerialChain& chain, const Candidate& candidate) : chain_(chain), candidate_(candidate) {}

  bool at(const VectorX& parameters, const VectorX& near, VectorX& q) const {
    preferred_ = near;
    for (Eigen::Index i = 0; i < parameters.size(); ++i)
      preferred_[candidate_.free[static_cast<std::size_t>(i)]] = parameters[i];
    if (!memberIn(near)) return false;
    q = member_;
    return true;
  }

  /// The same where one joint is free. `near` may be `q`.
  bool at(double value, const MemberVector& near, MemberVector& q) const {
    preferred_ = near;
    preferred_[candidate_.free.front()] = value;
    if (!memberIn(near)) return false;
    q = member_;
    return true;
  }

  VectorX parameters(const VectorX& q) const {
    VectorX values(static_cast<Eigen::Index>(candidate_.free.size()));
    for (Eigen::Index i = 0; i < values.size(); ++i) values[i] = q[candidate_.free[static_cast<std::size_t>(i)]];
    return values;
  }

  /// k x n derivatives of the members by the parameters.
  MatrixX tangents(const VectorX& q) const {
    MatrixX rows(static_cast<Eigen::Index>(candidate_.free.size()), q.size());
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
      VectorX ahead = q;
      VectorX behind = q;
      VectorX parameter = parameters(q);
      parameter[i] += kDifference;
      at(parameter, q, ahead);
      parameter[i] -= 2.0 * kDifference;
      at(parameter, q, behind);
      rows.row(i) = ((ahead - behind) / (2.0 * kDifference)).transpose();
    }
    return rows;
  }

 private:
  /// In the turns next to `near`; the free joints themselves are set, not wrapped.
  bool memberIn(const Eigen::Ref<const VectorX>& near) const {
    if (!candidate_.member(preferred_, member_)) return false;
    bringNear(chain_, near, member_);
    for (int joint : candidate_.free) member_[joint] = preferred_[joint];
    return true;
  }

  const SerialChain& chain_;
  const Candidate& candidate_;
  mutable VectorX preferred_;  ///< Kept for their memory.
  mutable VectorX member_;
};

double distanceTo(const SerialChain& chain, const VectorX& q, const VectorX& seed) {
  return (nearestTurns(chain, q, seed) - seed).norm();
}

/// Gauss-Newton on the distance to the seed, steps halved until they help.
VectorX nearestMember(const SerialChain& chain, const Family& family, const VectorX& start, const VectorX& seed) {
  VectorX q = nearestTurns(chain, start, seed);
  double distance = (q - seed).norm();
  for (int i = 0; i < kMaxNearestIterations; ++i) {
    const MatrixX T = family.tangents(q);
    const VectorX step = T.transpose().colPivHouseholderQr().solve(seed - q);
    bool moved = false;
    for (double share = 1.0; share > 1e-3 && !moved; share *= 0.5) {
      VectorX next;
      if (!family.at(family.parameters(q) + share * step, q, next)) continue;
      if ((next - seed).norm() >= distance) continue;
      q = next;
      moved = true;
    }
    if (!moved) break;
    const double gain = distance - (q - seed).norm();
    distance -= gain;
    if (gain <= 1e-15 * (1.0 + distance)) break;
  }
  return q;
}

/// Where the distance to the seed has its least value about `q`, by golden section: for what Gauss-Newton leaves, far
/// from the seed and where a continuum is bent.
VectorX goldenNearest(const SerialChain& chain, const Family& family, double step, const VectorX& q,
                      const VectorX& seed) {
  const double center = family.parameters(q)[0];
  VectorX member;
  const auto distanceAt = [&](double value) {
    return family.at(VectorX::Constant(1, value), q, member) ? distanceTo(chain, member, seed)
                                                             : std::numeric_limits<double>::infinity();
  };
  const double nearest = goldenMinimum(distanceAt, center - step, center + step, kGoldenSteps);
  const bool found = family.at(VectorX::Constant(1, nearest), q, member);
  return found && distanceTo(chain, member, seed) < distanceTo(chain, q, seed) ? member : q;
}

bool isStationary(const Family& family, const VectorX& q, const VectorX& seed) {
  const MatrixX T = family.tangents(q);
  return std::abs(T.row(0).normalized().dot(q - seed)) <= kStationary * (1.0 + (q - seed).norm());
}

VectorX nearestFrom(const SerialChain& chain, const Family& family, const Candidate& candidate, const VectorX& start,
                    const VectorX& seed) {
  VectorX q = nearestMember(chain, family, start, seed);
  // On the way a joint may have come nearer to the seed by another turn.
  for (int k = 0; k < kMaxTurnings && nearestTurns(chain, q, seed) != q; ++k) q = nearestMember(chain, family, q, seed);
  if (candidate.free.size() > 1) {
    // Where a sum of angles is given, each may be in its best turn and the sum be not: with the seed's own values it
    // is.
    VectorX beside;
    if (family.at(family.parameters(seed), seed, beside)) beside = nearestMember(chain, family, beside, seed);
    if (beside.size() > 0 && (beside - seed).norm() < (q - seed).norm()) q = beside;
  }
  if (candidate.free.size() != 1 || isStationary(family, q, seed)) return q;
  return nearestTurns(chain, goldenNearest(chain, family, stepOf(chain, candidate.free.front()), q, seed), seed);
}

/// The member within limits nearest to the seed along the first parameter, where `q` itself is not within.
bool nearestWithinLimits(const SerialChain& chain, const Family& family, const Candidate& candidate,
                         const VectorX& seed, VectorX& q) {
  const int joint = candidate.free.front();
  const double step = stepOf(chain, joint);
  const int count = chain.joint(joint).isRevolute() ? 180 : 500;
  double least = std::numeric_limits<double>::infinity();
  VectorX best;
  VectorX outside;
  VectorX member = q;
  for (int direction : {1, -1}) {
    VectorX near = q;
    VectorX parameters = family.parameters(q);
    for (int i = 0; i < count; ++i) {
      parameters[0] += direction * step;
      if (!family.at(parameters, near, member)) break;
      if (isWithinLimits(chain, member) && distanceTo(chain, member, seed) < least) {
        least = distanceTo(chain, member, seed);
        best = member;
        outside = near;
      }
      near = member;
    }
  }
  if (!std::isfinite(least)) return false;
  // Back towards the outside neighbour, up to the limit itself.
  for (int i = 0; i < 40 && !isWithinLimits(chain, outside); ++i) {
    VectorX middle;
    if (!family.at(0.5 * (family.parameters(best) + family.parameters(outside)), best, middle)) break;
    (isWithinLimits(chain, middle) ? best : outside) = middle;
  }
  q = best;
  return true;
}

bool breaksLimits(const SerialChain& chain, const VectorX& q, const std::vector<int>& moving) {
  for (int joint : moving) {
    const JointLimits& limits = chain.joint(joint).limits;
    if (q[joint] < limits.lower - kLimitBand || q[joint] > limits.upper + kLimitBand) return true;
  }
  return false;
}

/// Walks along one parameter until a limit is met, a full turn is done, or the continuum ends; widens the ranges as it
/// goes.
void walk(const SerialChain& chain, const Family& family, const Candidate& candidate, Eigen::Index parameter,
          double direction, Continuum& continuum) {
  const int joint = candidate.free[static_cast<std::size_t>(parameter)];
  const double step = direction * stepOf(chain, joint);
  const auto widen = [&](const VectorX& q) {
    for (std::size_t i = 0; i < continuum.free_joints.size(); ++i) {
      const JointLimits& limits = chain.joint(continuum.free_joints[i]).limits;
      const double value = std::clamp(q[continuum.free_joints[i]], limits.lower, limits.upper);
      const auto k = static_cast<Eigen::Index>(i);
      continuum.lower[k] = std::min(continuum.lower[k], value);
      continuum.upper[k] = std::max(continuum.upper[k], value);
    }
  };
  VectorX inside = continuum.nearest;
  const int count = chain.joint(joint).isRevolute() ? 180 : 5000;
  for (int i = 0; i < count; ++i) {
    VectorX parameters = family.parameters(inside);
    parameters[parameter] += step;
    VectorX next;
    const bool exists = family.at(parameters, inside, next);
    if (exists && !breaksLimits(chain, next, continuum.free_joints)) {
      inside = next;
      widen(inside);
      continue;
    }
    double low = 0.0;
    double high = step;
    for (int k = 0; k < 60 && std::abs(high - low) > 1e-11; ++k) {
      parameters = family.parameters(inside);
      parameters[parameter] += 0.5 * (low + high);
      const bool good = family.at(parameters, inside, next) && !breaksLimits(chain, next, continuum.free_joints);
      if (good) widen(next);
      (good ? low : high) = 0.5 * (low + high);
    }
    return;
  }
}

/// Widens the ranges along one parameter, the others standing still.
void widenAlong(const SerialChain& chain, const Family& family, const Candidate& candidate, std::size_t parameter,
                Continuum& continuum) {
  const auto place = static_cast<Eigen::Index>(parameter);
  const auto at = [&](double value, const MemberVector& near, MemberVector& member) {
    VectorX values = family.parameters(continuum.nearest);
    values[place] = value;
    VectorX found;
    if (!family.at(values, near, found)) return false;
    member = found;
    return true;
  };
  if (widenAlongLine(chain, at, candidate.free[parameter], continuum)) return;
  for (double direction : {-1.0, 1.0}) walk(chain, family, candidate, place, direction, continuum);
}

MatrixX orthonormalRows(const MatrixX& rows) {
  const Eigen::HouseholderQR<MatrixX> qr(rows.transpose());
  MatrixX Q = qr.householderQ() * MatrixX::Identity(rows.cols(), rows.rows());
  for (Eigen::Index i = 0; i < Q.cols(); ++i) {
    if (Q.col(i).dot(rows.row(i).transpose()) < 0.0) Q.col(i) = -Q.col(i);
  }
  return Q.transpose();
}

Continuum describeRound(const SerialChain& chain, const WayRound& round, const VectorX& q, const VectorX& seed,
                        bool ignore_limits) {
  MemberVector first = q;
  round.at(round.start, seed, first);
  return SolutionCurve(chain, round.at, round.period).describe(round.start, first, seed, ignore_limits);
}

}  // namespace

Continuum describeContinuum(const SerialChain& chain, const Candidate& candidate, const VectorX& seed,
                            bool ignore_limits) {
  const Family family(chain, candidate);
  if (candidate.free.size() == 1 && candidate.member) {
    const auto at = [&](double value, const MemberVector& near, MemberVector& q) { return family.at(value, near, q); };
    const std::optional<Continuum> line =
        describeLine(chain, at, candidate.q, candidate.free.front(), seed, ignore_limits);
    if (line) return *line;
    const int joint = candidate.free.front();
    if (!candidate.round && chain.joint(joint).isRevolute()) {
      return SolutionCurve(chain, at, kTwoPi)
          .describe(candidate.q[joint], candidate.q, seed, ignore_limits, candidate.image.get());
    }
  }
  if (candidate.round) return describeRound(chain, *candidate.round, candidate.q, seed, ignore_limits);
  Continuum continuum;
  VectorX q = nearestFrom(chain, family, candidate, candidate.q, seed);
  if (!ignore_limits && !isWithinLimits(chain, q)) nearestWithinLimits(chain, family, candidate, seed, q);
  continuum.nearest = chooseTurns(chain, q, seed, true, ignore_limits, kLimitBand).q;
  continuum.directions = orthonormalRows(family.tangents(continuum.nearest));
  for (int i = 0; i < chain.size(); ++i) {
    if (continuum.directions.col(i).cwiseAbs().maxCoeff() > kMoves) continuum.free_joints.push_back(i);
  }
  const auto count = static_cast<Eigen::Index>(continuum.free_joints.size());
  continuum.lower = VectorX::Constant(count, std::numeric_limits<double>::infinity());
  continuum.upper = -continuum.lower;
  for (Eigen::Index i = 0; i < count; ++i) {
    continuum.lower[i] = continuum.upper[i] = continuum.nearest[continuum.free_joints[static_cast<std::size_t>(i)]];
  }
  for (std::size_t parameter = 0; parameter < candidate.free.size(); ++parameter) {
    widenAlong(chain, family, candidate, parameter, continuum);
  }
  return continuum;
}

}  // namespace screwline

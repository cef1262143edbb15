#include "solution_line.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "turns.h"

namespace screwline {
namespace {

constexpr double kStraight = 1e-11;   // [rad, m] by which members may be off the line.
constexpr double kMostSlide = 100.0;  // Characteristic lengths that a slide without limits is said to go.

/// Rates of all joints for the free one's 1; empty where the continuum is not straight.
std::optional<VectorX> directionOf(const SerialChain& chain, const MemberAt& at, const VectorX& q, int joint) {
  // Far apart, and no multiples of each other.
  const double unit = chain.joint(joint).isRevolute() ? 1.0 : 0.3 * chain.characteristicLength();
  MemberVector member = q;
  if (!at(q[joint] + unit, member, member)) return std::nullopt;
  const VectorX direction = (member - q) / unit;
  for (double steps : {2.3, -1.7}) {
    const MemberVector expected = q + steps * unit * direction;
    if (!at(expected[joint], expected, member)) return std::nullopt;
    if (!((member - expected).cwiseAbs().maxCoeff() <= kStraight)) return std::nullopt;
  }
  return VectorX((direction.cwiseAbs().array() > kStraight).select(direction, 0.0));
}

/// How far along the line a full turn of the free joint (or a slide's way) goes to one side.
double reachOf(const SerialChain& chain, int joint) {
  return chain.joint(joint).isRevolute() ? kTwoPi : kMostSlide * chain.characteristicLength();
}

/// Where between -reach and reach a joint changes its turn next to the seed's, or passes a limit in some turn.
std::vector<double> cutsOf(const SerialChain& chain, const VectorX& q, const VectorX& direction, double reach,
                           const VectorX& seed, bool ignore_limits) {
  std::vector<double> cuts = {-reach, reach};
  for (int i = 0; i < chain.size(); ++i) {
    if (direction[i] == 0.0) continue;
    const bool turns = chain.joint(i).isRevolute();
    const auto addPassing = [&](double value) {
      const double a = q[i] - std::abs(direction[i]) * reach - value;
      const double b = q[i] + std::abs(direction[i]) * reach - value;
      const double first = turns ? std::ceil(a / kTwoPi) : 0.0;
      const double last = turns ? std::floor(b / kTwoPi) : 0.0;
      for (double turn = first; turn <= last; ++turn) {
        const double cut = (value + turn * kTwoPi - q[i]) / direction[i];
        if (std::abs(cut) < reach) cuts.push_back(cut);
      }
    };
    if (turns) addPassing(seed[i] + kPi);
    const JointLimits& limits = chain.joint(i).limits;
    for (double limit : {limits.lower, limits.upper}) {
      if (!ignore_limits && std::isfinite(limit)) addPassing(limit);
    }
  }
  std::sort(cuts.begin(), cuts.end());
  return cuts;
}

/// The member nearest to the seed, of those within limits if there are any.
VectorX nearestOf(const SerialChain& chain, const VectorX& q, const VectorX& direction, double reach,
                  const VectorX& seed, bool ignore_limits) {
  const std::vector<double> cuts = cutsOf(chain, q, direction, reach, seed, ignore_limits);
  VectorX best = q;
  double least = std::numeric_limits<double>::infinity();
  bool within = false;
  for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
    const double middle = 0.5 * (cuts[k] + cuts[k + 1]);
    const Turned turned = chooseTurns(chain, q + middle * direction, seed, true, ignore_limits, kLimitBand);
    const bool counts = ignore_limits || turned.within_limits;
    if (within && !counts) continue;
    const double foot = middle + (seed - turned.q).dot(direction) / direction.squaredNorm();
    const double nearest = std::clamp(foot, cuts[k], cuts[k + 1]);
    const VectorX member = turned.q + (nearest - middle) * direction;
    const double distance = (member - seed).norm();
    if (distance >= least && within == counts) continue;
    best = member;
    least = distance;
    within = counts;
  }
  return best;
}

/// How far from `q` the line goes to one side before a moving joint meets a limit.
double wayWithinLimits(const SerialChain& chain, const VectorX& q, const VectorX& direction, double reach) {
  double way = reach;
  for (int i = 0; i < chain.size(); ++i) {
    if (direction[i] == 0.0) continue;
    const JointLimits& limits = chain.joint(i).limits;
    if (q[i] < limits.lower - kLimitBand || q[i] > limits.upper + kLimitBand) return 0.0;
    const double room = direction[i] > 0.0 ? limits.upper - q[i] : q[i] - limits.lower;
    way = std::min(way, std::max(0.0, room) / std::abs(direction[i]));
  }
  return way;
}

void startRanges(Continuum& continuum) {
  const auto count = static_cast<Eigen::Index>(continuum.free_joints.size());
  continuum.lower.resize(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    continuum.lower[k] = continuum.nearest[continuum.free_joints[static_cast<std::size_t>(k)]];
  }
  continuum.upper = continuum.lower;
}

/// The ranges by what the joints go along the line from the nearest member.
void widen(const SerialChain& chain, const VectorX& direction, double reach, Continuum& continuum) {
  const double ahead = wayWithinLimits(chain, continuum.nearest, direction, reach);
  const double behind = wayWithinLimits(chain, continuum.nearest, -direction, reach);
  for (Eigen::Index k = 0; k < continuum.lower.size(); ++k) {
    const int i = continuum.free_joints[static_cast<std::size_t>(k)];
    const double rate = direction[i];
    const JointLimits& limits = chain.joint(i).limits;
    const double value = continuum.nearest[i];
    const double one = value + (rate > 0.0 ? -behind : ahead) * rate;
    const double other = value + (rate > 0.0 ? ahead : -behind) * rate;
    // What rounding left beyond a limit; a member that breaks it already is told as it is.
    continuum.lower[k] = std::min({continuum.lower[k], value, std::max(one, limits.lower)});
    continuum.upper[k] = std::max({continuum.upper[k], value, std::min(other, limits.upper)});
  }
}

}  // namespace

std::optional<Continuum> describeLine(const SerialChain& chain, const MemberAt& at, const VectorX& q, int joint,
                                      const VectorX& seed, bool ignore_limits) {
  const std::optional<VectorX> direction = directionOf(chain, at, q, joint);
  if (!direction) return std::nullopt;
  const double reach = reachOf(chain, joint);
  // Half a turn to both sides is the whole circle.
  const double half = chain.joint(joint).isRevolute() ? kPi : reach;
  const VectorX best = nearestOf(chain, q, *direction, half, seed, ignore_limits);
  Continuum continuum;
  continuum.nearest = chooseTurns(chain, best, seed, true, ignore_limits, kLimitBand).q;
  continuum.directions = direction->normalized().transpose();
  for (int i = 0; i < chain.size(); ++i) {
    if ((*direction)[i] != 0.0) continuum.free_joints.push_back(i);
  }
  startRanges(continuum);
  widen(chain, *direction, reach, continuum);
  return continuum;
}

bool widenAlongLine(const SerialChain& chain, const MemberAt& at, int joint, Continuum& continuum) {
  const std::optional<VectorX> direction = directionOf(chain, at, continuum.nearest, joint);
  if (direction) widen(chain, *direction, reachOf(chain, joint), continuum);
  return direction.has_value();
}

}  // namespace screwline

#include "retime_jerk.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "dilation.h"
#include "lead_law.h"
#include "screwline/exception.h"
#include "screwline/trajectory/format.h"
#include "screwline/trajectory/limits.h"

namespace screwline {
namespace {

using ArrayX = Eigen::ArrayXd;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kLeastCells = 500;
constexpr int kUsualPerSegment = 50;
constexpr int kUsualCells = 4000;
constexpr int kLeastOfPart = 40;

/// A law by its nodes: u, du/dt, d^2u/dt^2 at instants.
struct Nodes {
  std::vector<double> time{};
  std::vector<double> u{};
  std::vector<double> rate{};
  std::vector<double> change{};
};

/// The pieces of a path between two of its breakpoints.
JointPath partOf(const JointPath& path, std::size_t from, std::size_t to) {
  const PiecewisePolynomial& whole = path.curve();
  std::vector<double> breaks;
  for (std::size_t k = from; k <= to; ++k) breaks.push_back(whole.breaks[k] - whole.breaks[from]);
  PiecewisePolynomial part(whole.joints, whole.degree, std::move(breaks), 2);
  const std::size_t stride = static_cast<std::size_t>(whole.degree + 1) * static_cast<std::size_t>(whole.joints);
  std::copy(whole.coefficients.begin() + static_cast<std::ptrdiff_t>(from * stride),
            whole.coefficients.begin() + static_cast<std::ptrdiff_t>(to * stride), part.coefficients.begin());
  return JointPath(std::move(part));
}

/// Breakpoints at which a motion without steps in acceleration has to stand still: 0, the bends, the last.
std::vector<std::size_t> stopsOf(const JointPath& path) {
  std::vector<std::size_t> stops{0};
  for (std::size_t k = 1; k + 1 < path.breaks().size(); ++k) {
    if (path.bendsAt(k)) stops.push_back(k);
  }
  stops.push_back(path.breaks().size() - 1);
  return stops;
}

/// Accelerations beyond what jerk can build up within a motion of that way are as good as none.
Limits usefulLimits(const JointPath& path, const Limits& limits) {
  double time = 0.0;
  for (int j = 0; j < path.joints(); ++j) {
    time = std::max(time, std::cbrt(32.0 * path.curve().extrema(j).travel / limits.jerk[j]));
  }
  Limits useful = limits;
  for (int j = 0; j < path.joints(); ++j) {
    if (std::isfinite(limits.jerk[j]))
      useful.acceleration[j] = std::min(limits.acceleration[j], 0.5 * time * limits.jerk[j]);
  }
  return useful;
}

/// The time in which jerk builds up what the motion without its limits takes of acceleration.
double rampOf(const JointPath& path, const RetimeResult& timed, const Limits& limits) {
  const auto motion = JointTrajectory::alongPath(path, timed.law, timed.duration);
  double ramp = 0.0;
  for (int j = 0; j < path.joints(); ++j) ramp = std::max(ramp, motion.extrema(j).acceleration / limits.jerk[j]);
  return std::min(std::max(ramp, 1e-3 * timed.duration), timed.duration);
}

/// @param narrowed [cell] by which factor of time the limits are narrowed there.
Dilation dilationOf(const JointPath& path, const LeadLaw& lead, const Limits& limits, const RetimeOptions& options,
                    const std::vector<double>& narrowed) {
  Dilation problem;
  const Eigen::Index n = path.joints();
  problem.joints = static_cast<std::size_t>(n);
  problem.cells = lead.cells();
  problem.step = lead.step;
  problem.ceiling.assign(problem.cells + 1, kInfinity);
  const ArrayX by_accel = limits.acceleration.array().inverse();
  const ArrayX by_jerk = limits.jerk.array().inverse();
  VectorX q(n), first(n), second(n), third(n);
  const auto put = [](std::vector<double>& to, const ArrayX& values) {
    to.insert(to.end(), values.data(), values.data() + values.size());
  };
  for (std::size_t i = 0; i <= problem.cells; ++i) {
    path.at(lead.u[i], q.data(), first.data(), second.data(), third.data());
    const double before = narrowed[i > 0 ? i - 1 : 0];
    const double after = narrowed[std::min(i, problem.cells - 1)];
    const double here = std::max(before, after);
    const double rate = lead.rate[i];
    const double change = lead.change[i];
    const ArrayX velocity = first.array() * rate;
    const ArrayX acceleration = second.array() * (rate * rate) + first.array() * change;
    const double share = (velocity.abs() / limits.velocity.array()).maxCoeff();
    double& ceiling = problem.ceiling[i];
    if (share > 0.0) ceiling = 1.0 / (share * share * here * here);
    if (options.rate_bound && rate > 0.0) {
      const double bound =
          options.rate_bound(lead.u[i > 0 ? i - 1 : 0], lead.u[std::min(i + 1, problem.cells)]) / (rate * here);
      ceiling = std::min(ceiling, bound * bound);
    }
    put(problem.first_by_accel, velocity * by_accel * (here * here));
    put(problem.second_by_accel, acceleration * by_accel * (here * here));
    put(problem.first_by_jerk, velocity * by_jerk * (here * here * here));
    put(problem.second_by_jerk, acceleration * by_jerk * (here * here * here));
    const ArrayX jerk = third.array() * (rate * rate * rate) + second.array() * (3.0 * rate * change);
    const auto withThird = [&](std::size_t cell) {
      return ArrayX((jerk + first.array() * ((lead.change[cell + 1] - lead.change[cell]) / lead.step)) * by_jerk *
                    (here * here * here));
    };
    if (i > 0) put(problem.third_by_jerk, withThird(i - 1));
    if (i < problem.cells) put(problem.third_by_jerk, withThird(i));
  }
  const auto ratio = [](double asked, double has) { return asked / has * (asked / has); };
  if (options.start_rate > 0.0) problem.first = ratio(options.start_rate, lead.rate.front());
  if (options.end_rate > 0.0) problem.last = ratio(options.end_rate, lead.rate.back());
  return problem;
}

/// The nodes of the lead law in the new time: between two a quartic, whose length meets both their u.
Nodes dilated(const LeadLaw& lead, const DilationSpline& r) {
  Nodes nodes;
  for (std::size_t i = 0; i < lead.u.size(); ++i) {
    const double root = std::sqrt(r.at(i));
    nodes.u.push_back(lead.u[i]);
    nodes.rate.push_back(lead.rate[i] * root);
    nodes.change.push_back(lead.change[i] * r.at(i) + 0.5 * lead.rate[i] * r.slopeAt(i, lead.step));
    if (i == 0) {
      nodes.time.push_back(0.0);
      continue;
    }
    const double way = nodes.u[i] - nodes.u[i - 1];
    const double mean = 0.5 * (nodes.rate[i - 1] + nodes.rate[i]);
    const double square = mean * mean + (nodes.change[i - 1] - nodes.change[i]) / 3.0 * way;
    nodes.time.push_back(nodes.time[i - 1] + 2.0 * way / (mean + std::sqrt(std::max(0.0, square))));
  }
  return nodes;
}

/// u / length between two nodes: the quartic with their rates and changes.
Polynomial pieceOf(const Nodes& nodes, std::size_t i, double length) {
  const double h = nodes.time[i + 1] - nodes.time[i];
  const double v = nodes.rate[i] * h / length;
  const double gain = nodes.rate[i + 1] * h / length - v;
  const double a = nodes.change[i] * h * h / length;
  const double b = nodes.change[i + 1] * h * h / length;
  return {{nodes.u[i] / length, v, 0.5 * a, gain - (2.0 * a + b) / 3.0, 0.25 * (a + b) - 0.5 * gain}};
}

/// Where a polynomial that increases over [0, 1] reaches a value.
double placeOf(const Polynomial& u, double value) {
  double low = 0.0;
  double high = 1.0;
  for (int k = 0; k < 50; ++k) {
    const double middle = 0.5 * (low + high);
    (u(middle) < value ? low : high) = middle;
  }
  return high;
}

/// [cell] by which factor it would have to take longer to keep the joints' limits at some places inside of it.
std::vector<double> excesses(const JointPath& path, const Nodes& nodes, const Limits& limits) {
  constexpr int kPlaces = 6;
  constexpr double kBeside = 1e-9;
  const Eigen::Index n = path.joints();
  VectorX q(n), first(n), second(n), third(n);
  std::vector<double> factors;
  std::size_t next = 1;  // Breakpoint of the path: its third derivative steps there.
  for (std::size_t i = 0; i + 1 < nodes.u.size(); ++i) {
    const double h = nodes.time[i + 1] - nodes.time[i];
    const Polynomial u = pieceOf(nodes, i, 1.0);
    const Polynomial du = u.derivative();
    const Polynomial ddu = du.derivative();
    const Polynomial dddu = ddu.derivative();
    double factor = 0.0;
    const auto take = [&](double x) {
      const double v = du(x) / h, a = ddu(x) / (h * h), j = dddu(x) / (h * h * h);
      path.at(u(x), q.data(), first.data(), second.data(), third.data());
      const ArrayX acceleration = first.array() * a + second.array() * (v * v);
      const ArrayX jerk = first.array() * j + second.array() * (3.0 * v * a) + third.array() * (v * v * v);
      factor = std::max(factor, (first.array() * v / limits.velocity.array()).abs().maxCoeff());
      factor = std::max(factor, std::sqrt((acceleration / limits.acceleration.array()).abs().maxCoeff()));
      factor = std::max(factor, std::cbrt((jerk / limits.jerk.array()).abs().maxCoeff()));
    };
    for (int k = 0; k <= kPlaces; ++k) take(static_cast<double>(k) / kPlaces);
    for (; next + 1 < path.breaks().size() && path.breaks()[next] <= nodes.u[i + 1]; ++next) {
      const double x = placeOf(u, path.breaks()[next]);
      take(std::max(0.0, x - kBeside));
      take(std::min(1.0, x + kBeside));
    }
    factors.push_back(factor);
  }
  return factors;
}

TimeLaw lawOf(const Nodes& nodes) {
  const double duration = nodes.time.back();
  const double length = nodes.u.back();
  std::vector<double> breaks;
  for (double t : nodes.time) breaks.push_back(t / duration);
  PiecewisePolynomial s(1, 4, std::move(breaks), 2);
  s.starts_at_rest = nodes.rate.front() == 0.0;
  s.ends_at_rest = nodes.rate.back() == 0.0;
  for (std::size_t i = 0; i + 1 < nodes.u.size(); ++i) s.setPiece(i, 0, pieceOf(nodes, i, length));
  return TimeLaw(std::move(s));
}

void append(Nodes& all, const Nodes& part, double from_u) {
  const double from = all.time.empty() ? 0.0 : all.time.back();
  for (std::size_t i = all.time.empty() ? 0 : 1; i < part.u.size(); ++i) {
    all.time.push_back(from + part.time[i]);
    all.u.push_back(from_u + part.u[i]);
    all.rate.push_back(part.rate[i]);
    all.change.push_back(part.change[i]);
  }
}

/// What binds at each node: bound is the rate at which a velocity limit is met.
void fillPoints(const JointPath& path, const Nodes& nodes, double stretch, const Limits& limits, RetimeResult& result) {
  const Eigen::Index n = path.joints();
  VectorX q(n), first(n), second(n), third(n);
  for (std::size_t i = 0; i < nodes.u.size(); ++i) {
    path.at(nodes.u[i], q.data(), first.data(), second.data(), third.data());
    const double share = (first.array().abs() / limits.velocity.array()).maxCoeff();
    result.points.push_back({nodes.u[i], nodes.rate[i] / stretch, share > 0.0 ? 1.0 / share : kInfinity});
  }
}

/// Whether both ends are at rest, so that time may be stretched.
bool rests(const RetimeOptions& options) {
  return options.start_rate == 0.0 && options.end_rate == 0.0;
}

/// The dilated lead, with limits that are narrowed where the last motion passed them between the nodes: of a few
/// motions the one that is the shortest once all of it is slowed down as much as its worst place needs.
std::optional<Nodes> narrowedNodes(const JointPath& piece, const LeadLaw& lead, const Limits& limits,
                                   const RetimeOptions& options, RetimeResult& refused) {
  constexpr int kMostRounds = 4;
  constexpr double kNear = 2e-4;
  std::vector<double> narrowed(lead.cells(), 1.0);
  std::optional<Nodes> best;
  double shortest = kInfinity;
  for (int round = 0; round < kMostRounds; ++round) {
    const DilationResult result = fastestDilation(dilationOf(piece, lead, limits, options, narrowed));
    if (!result.found) {
      refused.status = options.start_rate > 0.0 ? RetimeStatus::kStartTooFast : RetimeStatus::kEndTooFast;
      refused.start_rate = result.reached * options.start_rate;
      refused.end_rate = result.reached * options.end_rate;
      break;
    }
    Nodes nodes = dilated(lead, result.r);
    const std::vector<double> factors = excesses(piece, nodes, limits);
    const double worst = std::max(1.0, *std::max_element(factors.begin(), factors.end()));
    const double needed = worst * nodes.time.back();
    if (needed < shortest) {
      shortest = needed;
      best = std::move(nodes);
    }
    if (worst < 1.0 + kNear) break;
    for (std::size_t i = 0; i < factors.size(); ++i) narrowed[i] *= std::max(1.0, factors[i]);
  }
  return best;
}

/// One smooth part from u = `from` on, of so many cells. @return nothing where its ends are too fast; if velocities or
/// accelerations alone forbid them, `refused` says what these allow, else to which share of both one comes.
std::optional<Nodes> partNodes(const JointPath& piece, double from, const Limits& limits, RetimeOptions options,
                               RetimeResult& refused) {
  options.hold_jerk = false;
  options.duration = 0.0;
  if (options.rate_bound) {
    options.rate_bound = [from, whole = options.rate_bound](double low, double high) {
      return whole(from + low, from + high);
    };
  }
  RetimeOptions steady = options;
  steady.rate_bound = steadyRate(piece, limits, options.rate_bound);
  RetimeResult timed = retime(piece, usefulLimits(piece, limits), steady);
  if (timed.status != RetimeStatus::kDone) timed = retime(piece, limits, options);
  if (timed.status != RetimeStatus::kDone) {
    refused = timed;
    return std::nullopt;
  }
  const LeadLaw lead = leadLaw(timed, piece.length(), rampOf(piece, timed, limits), options.grid_points);
  return narrowedNodes(piece, lead, limits, options, refused);
}

/// The whole path, part by part.
std::optional<Nodes> allNodes(const JointPath& path, const Limits& limits, const RetimeOptions& options,
                              RetimeResult& refused) {
  const std::vector<std::size_t> stops = stopsOf(path);
  const double segments = static_cast<double>(path.breaks().size() - 1);
  const double usual = std::max<double>(kLeastCells, std::min(kUsualPerSegment * segments, 1.0 * kUsualCells));
  const double cells = options.grid_points > 0 ? options.grid_points : usual;
  Nodes nodes;
  for (std::size_t part = 0; part + 1 < stops.size(); ++part) {
    RetimeOptions own = options;
    if (part > 0) own.start_rate = 0.0;
    if (part + 2 < stops.size()) own.end_rate = 0.0;
    const double share = static_cast<double>(stops[part + 1] - stops[part]) / segments;
    own.grid_points = std::max(kLeastOfPart, static_cast<int>(std::ceil(share * cells)));
    const double from = path.breaks()[stops[part]];
    const auto piece = partNodes(partOf(path, stops[part], stops[part + 1]), from, limits, own, refused);
    if (!piece) return std::nullopt;
    append(nodes, *piece, from);
  }
  nodes.u.back() = path.length();
  return nodes;
}

/// By which factor the motion has to take longer so that all limits hold, exactly: 1 at least one is met.
double excessOf(const JointPath& path, const Nodes& nodes, const TimeLaw& law, const Limits& limits,
                const RateBound& rate_bound) {
  double factor = tightestUse(JointTrajectory::alongPath(path, law, nodes.time.back()), limits).stretch;
  for (std::size_t i = 0; rate_bound && i + 1 < nodes.u.size(); ++i) {
    const double per_time = path.length() / (nodes.time[i + 1] - nodes.time[i]);
    const double rate = rangeOverUnitInterval(law.pieces().piece(i, 0).derivative()).upper * per_time;
    factor = std::max(factor, rate / rate_bound(nodes.u[i], nodes.u[i + 1]));
  }
  return factor;
}

/// All limits for a motion that takes longer by a factor.
Limits slower(Limits limits, double factor) {
  limits.velocity /= factor;
  limits.acceleration /= factor * factor;
  limits.jerk /= factor * factor * factor;
  return limits;
}

/// The motion, or nothing where its ends are too fast. What little the grid's points let pass between them is made up
/// for by time; moving ends forbid that, so there the limits are narrowed by as much and the motion is found anew.
std::optional<RetimeResult> timedWithJerk(const JointPath& path, const Limits& limits, const RetimeOptions& options,
                                          RetimeResult& refused) {
  constexpr int kMostRounds = 6;
  double narrowed = 1.0;
  for (int round = 0; round < kMostRounds; ++round) {
    RetimeOptions own = options;
    if (options.rate_bound) {
      own.rate_bound = [&](double from, double to) { return options.rate_bound(from, to) / narrowed; };
    }
    const auto nodes = allNodes(path, slower(limits, narrowed), own, refused);
    if (!nodes) return std::nullopt;
    RetimeResult result;
    result.law = lawOf(*nodes);
    result.duration = nodes->time.back();
    result.start_rate = options.start_rate;
    result.end_rate = options.end_rate;
    const double factor = excessOf(path, *nodes, result.law, limits, options.rate_bound);
    if (rests(options) || factor <= 1.0) {
      const double stretch = rests(options) ? factor : 1.0;
      result.duration *= stretch;
      fillPoints(path, *nodes, stretch, limits, result);
      return result;
    }
    narrowed *= 1.0 + 1.5 * (factor - 1.0);
  }
  return std::nullopt;
}

}  // namespace

RetimeResult retimeWithJerk(const JointPath& path, const Limits& limits, const RetimeOptions& options) {
  RetimeResult refused;
  if (auto result = timedWithJerk(path, limits, options, refused)) {
    if (options.duration > 0.0 && std::abs(options.duration - result->duration) > kLimitTolerance * result->duration) {
      throw InputError(AnswerCode::kLimitsInfeasible, "a duration of " + number(options.duration) +
                                                          " s is not planned for a motion with moving ends "
                                                          "under jerk limits: its own is " +
                                                          number(result->duration) + " s");
    }
    return *std::move(result);
  }
  if (refused.status != RetimeStatus::kDone) return refused;
  throw Exception("internal error: no motion along the path within its jerk limits was found");
}

}  // namespace screwline

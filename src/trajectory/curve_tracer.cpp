#include "curve_tracer.h"

#include <algorithm>
#include <cmath>

#include "screwline/trajectory/hermite.h"

namespace screwline {
namespace {

constexpr double kFirstStep = 0.02;
constexpr double kLongestStep = 0.3;  ///< rad or characteristic lengths, as the arc length.
constexpr double kShortestStep = 1e-7;
constexpr std::size_t kMostPieces = 20000;
constexpr double kCrossing = 1e-5;  ///< A gap below this: two curves cross, their directions cannot be told apart.
constexpr double kTouch = 1e-9;     ///< Of u: a curve whose fold is so near has reached it.
constexpr double kAtLimit = 1e-9;   ///< [rad, m]

/// Where in [0, upper] the polynomial, which grows (sign 1) or falls through the value, has it.
double crossing(const Polynomial& p, double value, double sign, double upper) {
  double low = 0.0;
  double high = upper;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (sign * (p(middle) - value) < 0.0 ? low : high) = middle;
  }
  return high;
}

/// The polynomial over [0, x] as one over [0, 1].
Polynomial cut(Polynomial p, double x) {
  double power = 1.0;
  for (double& c : p.c) {
    c *= power;
    power *= x;
  }
  return p;
}

}  // namespace

CurveTracer::CurveTracer(PathSystem& system, const SerialChain& chain, double tolerance)
    : system_(system), chain_(chain), tolerance_(tolerance), n_(chain.size()) {}

CurveTracer::Knot CurveTracer::knotAt(const VectorX& y, const VectorX& previous) {
  system_.evaluate(y);
  Knot knot{y, system_.direction(previous), {}, system_.gap()};
  knot.bend = system_.bend(y, knot.direction);
  return knot;
}

/// The quintic that meets values, directions and bends; its length is chosen so that it is run through at unit speed.
CurveTracer::Piece CurveTracer::pieceBetween(const Knot& from, const Knot& to) const {
  constexpr double kNodes[] = {0.046910077030668, 0.230765344947158, 0.5, 0.769234655052842, 0.953089922969332};
  constexpr double kWeights[] = {0.118463442528095, 0.239314335249683, 0.284444444444444, 0.239314335249683,
                                 0.118463442528095};
  Piece piece;
  piece.length = system_.lengthOf(to.y - from.y);
  piece.rows.resize(static_cast<std::size_t>(n_) + 1);
  for (int round = 0; round < 3; ++round) {
    for (int i = 0; i <= n_; ++i) {
      piece.rows[static_cast<std::size_t>(i)] = quinticBetween({from.y[i], from.direction[i], from.bend[i]},
                                                               {to.y[i], to.direction[i], to.bend[i]}, piece.length);
    }
    if (round == 2) break;
    double arc = 0.0;
    VectorX speed(n_ + 1);
    for (int k = 0; k < 5; ++k) {
      for (int i = 0; i <= n_; ++i) speed[i] = piece.rows[static_cast<std::size_t>(i)].derivative()(kNodes[k]);
      arc += kWeights[k] * system_.lengthOf(speed);
    }
    piece.length = arc;
  }
  return piece;
}

VectorX CurveTracer::valueOf(const Piece& piece, double x) const {
  VectorX y(n_ + 1);
  for (int i = 0; i <= n_; ++i) y[i] = piece.rows[static_cast<std::size_t>(i)](x);
  return y;
}

double CurveTracer::errorOf(const Piece& piece) {
  double error = 0.0;
  for (double x : {0.2, 0.5, 0.8}) {
    system_.evaluate(valueOf(piece, x));
    error = std::max(error, system_.residual());
  }
  return error;
}

bool CurveTracer::tryStep(const Knot& from, double h, Knot& to, Piece& piece, double& error) {
  constexpr double kFarOff = 0.3;  // Of the step: the corrector has gone elsewhere.
  constexpr double kLeastCosine = 0.9;
  error = std::numeric_limits<double>::infinity();
  const VectorX predicted = from.y + h * from.direction + 0.5 * h * h * from.bend;
  VectorX y = predicted;
  if (!system_.correct(y) || !(system_.lengthOf(y - predicted) <= kFarOff * h)) return false;
  to = knotAt(y, from.direction);
  // lengthOf() of the sum of two unit vectors is 2 cos(half the angle).
  const double half = 0.5 * system_.lengthOf(from.direction + to.direction);
  if (!(2.0 * half * half - 1.0 >= kLeastCosine)) return false;
  piece = pieceBetween(from, to);
  error = errorOf(piece);
  return error <= tolerance_;
}

/// One step of about h, shorter where need be; h is left as a guess for the next one.
bool CurveTracer::step(const Knot& from, double& h, Knot& to, Piece& piece) {
  constexpr int kMostDodges = 4;
  double error = 0.0;
  for (int dodges = 0; h >= kShortestStep;) {
    if (!tryStep(from, h, to, piece, error)) {
      h *= std::isfinite(error) ? std::clamp(0.8 * std::pow(tolerance_ / error, 1.0 / 6.0), 0.2, 0.8) : 0.4;
      continue;
    }
    if (to.gap < kCrossing && from.gap >= kCrossing && dodges < kMostDodges) {
      ++dodges;
      h *= 0.83;
      continue;
    }
    worst_ = std::max(worst_, error);
    const double growth = 0.8 * std::pow(tolerance_ / std::max(error, 1e-3 * tolerance_), 1.0 / 6.0);
    h = std::min(kLongestStep, h * std::clamp(growth, 0.5, 2.0));
    return true;
  }
  return false;
}

/// Whether a knot at u = goal ends the last piece: where two curves cross there it is cut there instead.
bool CurveTracer::landOn(const Knot& from, const Piece& piece, double x, double goal) {
  VectorX y = valueOf(piece, x);
  y[n_] = goal;
  if (!system_.correctJoints(y) || system_.gap() < kCrossing) return false;
  const Knot to = knotAt(y, from.direction);
  const Piece last = pieceBetween(from, to);
  const double error = errorOf(last);
  if (!(error <= tolerance_) || !(last.length > 0.0)) return false;
  worst_ = std::max(worst_, error);
  append(last);
  return true;
}

bool CurveTracer::arrive(const Knot& from, const Knot& to, const Piece& piece, double sign, double goal,
                         TracedCurve& result) {
  const Polynomial& u = piece.rows.back();
  const bool folds = sign * to.direction[n_] <= 0.0;
  const double end = folds ? crossing(u.derivative(), 0.0, -sign, 1.0) : 1.0;
  const bool reached = sign * (u(end) - goal) >= (folds ? -kTouch : 0.0);
  if (!reached && !folds) return false;
  const double x = reached ? crossing(u, goal, sign, end) : end;
  result.end = reached ? TraceEnd::kGoal : TraceEnd::kFold;
  result.last = valueOf(piece, x);
  if (reached && sign * (u(end) - goal) > kTouch && landOn(from, piece, x, goal)) {
    result.last = valueOf(pieces_.back(), 1.0);
    return true;
  }
  Piece trimmed{x * piece.length, {}};
  for (const Polynomial& row : piece.rows) trimmed.rows.push_back(cut(row, x));
  if (trimmed.length > 0.0) append(trimmed);
  return true;
}

bool CurveTracer::meetsLimit(const Piece& piece, TracedCurve& result) {
  const auto breaks = [&](double x, int i) {
    const double value = piece.rows[static_cast<std::size_t>(i)](x);
    return value < chain_.joint(i).limits.lower - kAtLimit || value > chain_.joint(i).limits.upper + kAtLimit;
  };
  double earliest = 2.0;
  for (int i = 0; i < n_; ++i) {
    if (!breaks(1.0, i) && !breaks(0.5, i)) continue;
    double low = 0.0;
    double high = breaks(0.5, i) ? 0.5 : 1.0;
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (low + high);
      (breaks(middle, i) ? high : low) = middle;
    }
    if (low >= earliest) continue;
    earliest = low;
    result.joint = i;
  }
  if (earliest > 1.0) return false;
  result.end = TraceEnd::kLimit;
  result.last = valueOf(piece, earliest);
  return true;
}

void CurveTracer::finish(TracedCurve& result) const {
  std::vector<double> breaks{0.0};
  for (const Piece& piece : pieces_) breaks.push_back(breaks.back() + piece.length);
  result.deviation = worst_;
  if (pieces_.empty()) return;
  result.curve = PiecewisePolynomial(n_ + 1, 5, breaks, 2);
  for (std::size_t k = 0; k < pieces_.size(); ++k) {
    for (int i = 0; i <= n_; ++i) result.curve.setPiece(k, i, pieces_[k].rows[static_cast<std::size_t>(i)]);
  }
}

TracedCurve CurveTracer::trace(const VectorX& y, double sign, double goal) {
  pieces_.clear();
  worst_ = 0.0;
  TracedCurve result;
  VectorX ahead = VectorX::Zero(n_ + 1);
  ahead[n_] = sign;
  Knot from = knotAt(y, ahead);
  double h = kFirstStep;
  result.end = TraceEnd::kLost;
  result.last = y;
  while (pieces_.size() < kMostPieces) {
    Knot to;
    Piece piece;
    if (!step(from, h, to, piece)) break;
    if (system_.redundant() && meetsLimit(piece, result)) break;
    if (arrive(from, to, piece, sign, goal, result)) break;
    append(piece);
    from = std::move(to);
    result.last = from.y;
  }
  finish(result);
  return result;
}

}  // namespace screwline

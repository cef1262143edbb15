#include "screwline/trajectory/time_law.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "screwline/exception.h"
#include "screwline/spatial/pose.h"
#include "screwline/trajectory/format.h"

namespace screwline {
namespace {

TimeLaw onePiece(const Polynomial& polynomial, int continuity) {
  PiecewisePolynomial pieces(1, polynomial.degree(), {0.0, 1.0}, continuity);
  pieces.setPiece(0, 0, polynomial);
  return TimeLaw(std::move(pieces));
}

double quintic345(double tau) {
  return tau * tau * tau * (10.0 + tau * (-15.0 + 6.0 * tau));
}

JointExtrema cycloidalExtrema() {
  JointExtrema e;
  e.position = {0.0, 1.0};
  e.velocity = 2.0;
  e.acceleration = kTwoPi;
  e.jerk = kTwoPi * kTwoPi;
  e.travel = 1.0;
  e.squared_acceleration = 0.5 * kTwoPi * kTwoPi;
  e.squared_jerk = 0.5 * std::pow(kTwoPi, 4);
  return e;
}

}  // namespace

TimeLaw TimeLaw::rectangular() {
  return onePiece({{0.0, 1.0}}, 0);
}
TimeLaw TimeLaw::cubic() {
  return onePiece({{0.0, 0.0, 3.0, -2.0}}, 1);
}
TimeLaw TimeLaw::polynomial345() {
  return onePiece({{0.0, 0.0, 0.0, 10.0, -15.0, 6.0}}, 2);
}
TimeLaw TimeLaw::polynomial4567() {
  return onePiece({{0.0, 0.0, 0.0, 0.0, 35.0, -84.0, 70.0, -20.0}}, 3);
}

TimeLaw TimeLaw::cycloidal() {
  TimeLaw scaling;
  scaling.cycloidal_ = true;
  scaling.extrema_ = cycloidalExtrema();
  return scaling;
}

TimeLaw TimeLaw::trapezoidal(double blend_fraction) {
  const double b = blend_fraction;
  if (!(b > 0.0 && b <= 0.5)) {
    throw InputError(AnswerCode::kInvalidGoal, "blend_fraction is " + number(b) + ", it must lie in (0, 0.5]");
  }
  const double in_blend = 0.5 * b / (1.0 - b);  // s at the end of the first parabola.
  const bool triangle = b == 0.5;
  std::vector<double> breaks =
      triangle ? std::vector<double>{0.0, 0.5, 1.0} : std::vector<double>{0.0, b, 1.0 - b, 1.0};
  PiecewisePolynomial pieces(1, 2, std::move(breaks), 1);
  const std::size_t last = pieces.segments() - 1;
  pieces.setPiece(0, 0, {{0.0, 0.0, in_blend}});
  if (!triangle) pieces.setPiece(1, 0, {{in_blend, 1.0 - 2.0 * in_blend}});
  pieces.setPiece(last, 0, {{1.0 - in_blend, 2.0 * in_blend, -in_blend}});
  return TimeLaw(std::move(pieces));
}

TimeLaw TimeLaw::via6(double via_s, double via_tau) {
  if (!(via_tau > 0.0 && via_tau < 1.0)) {
    throw InputError(AnswerCode::kInvalidGoal,
                     "the via instant tau is " + number(via_tau) + ", it must lie inside (0, 1)");
  }
  if (!std::isfinite(via_s))
    throw InputError(AnswerCode::kInvalidGoal, "the via value S is " + number(via_s) + ", not finite");
  const double k = (via_s - quintic345(via_tau)) / std::pow(via_tau * (1.0 - via_tau), 3);
  return onePiece({{0.0, 0.0, 0.0, 10.0 + k, -15.0 - 3.0 * k, 6.0 + 3.0 * k, -k}}, 2);
}

TimeLaw::TimeLaw(PiecewisePolynomial pieces)
    : pieces_(std::move(pieces)), extrema_(pieces_.extrema(0)), continuity_(pieces_.continuity) {
  for (std::size_t segment = 0; segment < pieces_.segments(); ++segment) {
    Piece piece;
    piece.start = pieces_.breaks[segment];
    piece.inverse_length = 1.0 / pieces_.length(segment);
    Polynomial derivative = pieces_.piece(segment, 0);
    double rate = 1.0;
    for (std::size_t order = 0; order < 4; ++order) {
      for (std::size_t k = 0; k < piece.rows.size(); ++k) piece.rows[k][order] = derivative.c[k] * rate;
      derivative = derivative.derivative();
      rate *= piece.inverse_length;
    }
    table_.push_back(piece);
  }
}

const TimeLaw::Piece& TimeLaw::find(double tau) const {
  std::size_t k = table_.size() - 1;
  while (k > 0 && tau < table_[k].start) --k;
  return table_[k];
}

ScalingSample TimeLaw::at(double tau) const {
  tau = std::min(std::max(tau, 0.0), 1.0);
  if (cycloidal_) {
    const double sine = std::sin(kTwoPi * tau);
    const double cosine = std::cos(kTwoPi * tau);
    return {tau - sine / kTwoPi, 1.0 - cosine, kTwoPi * sine, kTwoPi * kTwoPi * cosine};
  }
  const Piece& piece = find(tau);
  const double u = (tau - piece.start) * piece.inverse_length;
  const double u2 = u * u;
  const double u4 = u2 * u2;
  const auto& r = piece.rows;
  std::array<double, 4> out;
  // Estrin's scheme: the pairs do not wait for each other, and the four orders share one pass.
  for (std::size_t i = 0; i < 4; ++i) {
    const double low = (r[0][i] + r[1][i] * u) + (r[2][i] + r[3][i] * u) * u2;
    const double high = (r[4][i] + r[5][i] * u) + (r[6][i] + r[7][i] * u) * u2;
    out[i] = low + high * u4;
  }
  return {out[0], out[1], out[2], out[3]};
}

bool TimeLaw::isMonotone() const {
  return extrema_.travel <= 1.0 + 1e-12;
}

std::vector<double> TimeLaw::breaks() const {
  if (cycloidal_ || pieces_.breaks.size() < 3) return {};
  return {pieces_.breaks.begin() + 1, pieces_.breaks.end() - 1};
}

}  // namespace screwline

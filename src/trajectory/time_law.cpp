#include "screwline/trajectory/time_law.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "screwline/exception.h"
#include "screwline/spatial/pose.h"
#include "screwline/spatial/sincos_kernel.h"
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
    : pieces_(std::move(pieces)), table_(pieces_), extrema_(pieces_.extrema(0)), continuity_(pieces_.continuity) {}

ScalingSample TimeLaw::at(double tau) const {
  tau = std::min(std::max(tau, 0.0), 1.0);
  if (cycloidal_) {
    double sine;
    double cosine;
    sincosKernel<std::uint64_t>(kTwoPi * tau, sine, cosine);
    return {tau - sine / kTwoPi, 1.0 - cosine, kTwoPi * sine, kTwoPi * kTwoPi * cosine};
  }
  std::array<double, 4> values;
  sampleKernels().scaling(table_.at(tau), values.data());
  return {values[0], values[1], values[2], values[3]};
}

bool TimeLaw::isMonotone() const {
  return extrema_.travel <= 1.0 + 1e-12;
}

std::vector<double> TimeLaw::breaks() const {
  if (cycloidal_ || pieces_.breaks.size() < 3) return {};
  return {pieces_.breaks.begin() + 1, pieces_.breaks.end() - 1};
}

}  // namespace screwline

#include "screwline/trajectory/path.h"

#include <algorithm>
#include <cmath>

#include "screwline/exception.h"
#include "screwline/trajectory/format.h"
#include "screwline/trajectory/hermite.h"

namespace screwline {
namespace {

constexpr double kSameBend = 1e-6;
constexpr double kSameDirection = 1e-9;  // Of the derivatives beside: below it a difference is rounding.

[[noreturn]] void refuse(const std::string& message) {
  throw InputError(AnswerCode::kInvalidGoal, message);
}

void validate(const PiecewisePolynomial& curve) {
  if (curve.segments() == 0 || curve.joints == 0) refuse("the path has no segment");
  if (curve.breaks.front() != 0.0) refuse("the path starts at " + number(curve.breaks.front()) + ", it must be 0");
  for (std::size_t k = 0; k < curve.segments(); ++k) {
    if (curve.length(k) > kNoTime && std::isfinite(curve.length(k))) continue;
    refuse("breakpoint " + std::to_string(k + 1) + " of the path is at " + number(curve.breaks[k + 1]) +
           ", it must be after " + number(curve.breaks[k]));
  }
  for (double c : curve.coefficients) {
    if (!std::isfinite(c)) refuse("a coefficient of the path is not finite");
  }
}

/// How far derivative `order` steps at breakpoint k, as a fraction of its size there; the largest of all joints.
double stepAt(const PiecewisePolynomial& curve, std::size_t k, int order) {
  double step = 0.0;
  double size = order == 0 ? 1.0 : 0.0;
  for (int j = 0; j < curve.joints; ++j) {
    const double before = curve.atEnd(k - 1, j, order, true);
    const double after = curve.atEnd(k, j, order, false);
    step = std::max(step, std::abs(after - before));
    size = std::max({size, std::abs(after), std::abs(before)});
  }
  return size > 0.0 ? step / size : 0.0;
}

}  // namespace

JointPath::JointPath(PiecewisePolynomial curve)
    : curve_(std::move(curve)), turns_(curve_.breaks.size(), false), bends_(curve_.breaks.size(), false) {
  validate(curve_);
  curve_.continuity = std::min(curve_.continuity, 3);
  curve_.starts_at_rest = curve_.ends_at_rest = false;
  for (std::size_t k = 1; k < curve_.segments(); ++k) {
    const double gap = stepAt(curve_, k, 0);
    if (gap > kSameDirection) refuse("the path has a gap of " + number(gap) + " at breakpoint " + std::to_string(k));
    turns_[k] = stepAt(curve_, k, 1) > kSameDirection;
    bends_[k] = turns_[k] || (curve_.continuity < 2 && stepAt(curve_, k, 2) > kSameBend);
    if (turns_[k]) curve_.continuity = 0;
  }
  starts_ = BreakTable(curve_.breaks);
  for (std::size_t k = 0; k < curve_.segments(); ++k) inverse_lengths_.push_back(1.0 / curve_.length(k));
}

void JointPath::at(double u, double* q, double* first, double* second, double* third) const {
  const double inside = std::min(std::max(u, 0.0), length());
  const std::size_t k = segmentAt(inside);
  const double r = inverse_lengths_[k];
  const double x = inside >= curve_.breaks[k + 1] ? 1.0 : (inside - curve_.breaks[k]) * r;
  sampleKernels().segment(segment(k), x, {r, 0.0, r * r, 0.0, 0.0, r * r * r}, {q, first, second, third});
}

JointPath naturalSplinePath(const std::vector<double>& u, const MatrixX& positions) {
  const MatrixX slopes = naturalSplineSlopes(u, positions);
  PiecewisePolynomial curve = cubicsThrough(u, positions, slopes);
  curve.continuity = 2;
  return JointPath(std::move(curve));
}

JointPath linePath(const std::vector<double>& u, const MatrixX& positions) {
  return JointPath(linesThrough(u, positions));
}

JointPath quinticPath(const std::vector<double>& u, const MatrixX& positions, const MatrixX& first,
                      const MatrixX& second) {
  return JointPath(quinticsThrough(u, positions, first, second));
}

}  // namespace screwline

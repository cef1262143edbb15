#include "screwline/trajectory/bspline.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace screwline {
namespace {

constexpr std::size_t kMostBasis = Polynomial::kMaxDegree + 1;
using SpanBasis = std::array<Polynomial, kMostBasis>;

/// factor_a * a + (shift + slope u) * b, exact to the degree that the recursion reaches.
void addProduct(Polynomial& sum, const Polynomial& p, double shift, double slope) {
  for (std::size_t k = p.c.size(); k-- > 0;) {
    sum.c[k] += shift * p.c[k];
    if (k + 1 < p.c.size()) sum.c[k + 1] += slope * p.c[k];
  }
}

/// The degree + 1 basis functions that live on [knots[span], knots[span + 1]], as polynomials in the span's local u.
SpanBasis basisOnSpan(const std::vector<double>& knots, int degree, std::size_t span) {
  SpanBasis basis{};
  basis[0].c[0] = 1.0;
  const double start = knots[span];
  const double length = knots[span + 1] - start;
  for (std::size_t d = 1; d <= static_cast<std::size_t>(degree); ++d) {
    SpanBasis raised{};
    for (std::size_t i = 0; i < d; ++i) {
      // Basis i of degree d-1 starts at knots[left] and ends at knots[right]: it feeds the falling half of i, the
      // rising of i + 1.
      const double left = knots[span + 1 + i - d];
      const double right = knots[span + 1 + i];
      const double width = right - left;
      addProduct(raised[i], basis[i], (right - start) / width, -length / width);
      addProduct(raised[i + 1], basis[i], (start - left) / width, length / width);
    }
    basis = raised;
  }
  return basis;
}

std::size_t spanAt(const std::vector<double>& knots, int degree, double t) {
  const auto first = knots.begin() + degree;
  const auto last = knots.end() - degree - 1;
  const auto after = std::upper_bound(first, last, t);
  const std::size_t span = static_cast<std::size_t>(after - knots.begin()) - 1;
  return std::min(span, knots.size() - static_cast<std::size_t>(degree) - 2);
}

/// A square banded system with `degree` diagonals on either side, solved in place for all joints. B-spline collocation
/// is totally positive, so elimination needs no pivoting.
class BandedSystem {
 public:
  BandedSystem(Eigen::Index size, int degree, Eigen::Index joints)
      : half_(degree), band_(MatrixX::Zero(2 * degree + 1, size)), right_(MatrixX::Zero(joints, size)) {}

  /// Row: derivative `order` by time of the spline at t equals `value`. By the local time of the span, and scaled by
  /// its largest entry: derivatives are of another magnitude.
  void setRow(Eigen::Index row, const Bspline& spline, double t, int order, const VectorX& value) {
    const std::size_t span = spanAt(spline.knots, spline.degree, t);
    SpanBasis basis = basisOnSpan(spline.knots, spline.degree, span);
    const double length = spline.knots[span + 1] - spline.knots[span];
    const double u = (t - spline.knots[span]) / length;
    std::array<double, kMostBasis> entries{};
    double largest = 0.0;
    for (std::size_t i = 0; i <= static_cast<std::size_t>(spline.degree); ++i) {
      for (int d = 0; d < order; ++d) basis[i] = basis[i].derivative();
      entries[i] = basis[i](u);
      largest = std::max(largest, std::abs(entries[i]));
    }
    for (int i = 0; i <= spline.degree; ++i) {
      const Eigen::Index column = static_cast<Eigen::Index>(span) - spline.degree + i;
      if (std::abs(column - row) <= half_) at(row, column) = entries[static_cast<std::size_t>(i)] / largest;
    }
    right_.col(row) = value * (std::pow(length, order) / largest);
  }

  MatrixX solve() {
    const Eigen::Index size = right_.cols();
    for (Eigen::Index pivot = 0; pivot < size; ++pivot) {
      const Eigen::Index reach = std::min(size - 1, pivot + half_);
      for (Eigen::Index row = pivot + 1; row <= reach; ++row) {
        const double factor = at(row, pivot) / at(pivot, pivot);
        if (factor == 0.0) continue;
        for (Eigen::Index column = pivot; column <= reach; ++column) at(row, column) -= factor * at(pivot, column);
        right_.col(row) -= factor * right_.col(pivot);
      }
    }
    for (Eigen::Index row = size; row-- > 0;) {
      for (Eigen::Index column = row + 1; column <= std::min(size - 1, row + half_); ++column) {
        right_.col(row) -= at(row, column) * right_.col(column);
      }
      right_.col(row) /= at(row, row);
    }
    return right_;
  }

 private:
  double& at(Eigen::Index row, Eigen::Index column) { return band_(column - row + half_, row); }

  Eigen::Index half_;
  MatrixX band_;
  MatrixX right_;
};

std::vector<double> interpolationKnots(int degree, const std::vector<double>& times) {
  const std::size_t count = times.size();
  if (degree == 3 && count == 2) return {times[1] / 3.0, times[1] * 2.0 / 3.0};
  std::vector<double> interior;
  if (degree % 2 == 0) {
    for (std::size_t k = 1; k < count; ++k) interior.push_back(0.5 * (times[k - 1] + times[k]));
    return interior;
  }
  interior.assign(times.begin() + 1, times.end() - 1);
  if (degree == 3) {
    interior.insert(interior.begin(), 0.5 * (times[0] + times[1]));
    interior.push_back(0.5 * (times[count - 2] + times[count - 1]));
  }
  return interior;
}

}  // namespace

std::vector<double> clampedKnots(int degree, const std::vector<double>& interior, double duration) {
  std::vector<double> knots(static_cast<std::size_t>(degree) + 1, 0.0);
  knots.insert(knots.end(), interior.begin(), interior.end());
  knots.insert(knots.end(), static_cast<std::size_t>(degree) + 1, duration);
  return knots;
}

PiecewisePolynomial piecesOf(const Bspline& spline) {
  const std::size_t degree = static_cast<std::size_t>(spline.degree);
  std::vector<std::size_t> spans;
  std::vector<double> breaks{spline.knots.front()};
  for (std::size_t k = degree; k + degree + 1 < spline.knots.size(); ++k) {
    if (spline.knots[k + 1] <= spline.knots[k]) continue;
    spans.push_back(k);
    breaks.push_back(spline.knots[k + 1]);
  }
  PiecewisePolynomial motion(static_cast<int>(spline.control.rows()), spline.degree, std::move(breaks),
                             std::min(3, spline.degree - 1));
  for (std::size_t s = 0; s < spans.size(); ++s) {
    const SpanBasis basis = basisOnSpan(spline.knots, spline.degree, spans[s]);
    for (int joint = 0; joint < motion.joints; ++joint) {
      Polynomial piece;
      for (std::size_t i = 0; i <= degree; ++i) {
        const double point = spline.control(joint, static_cast<Eigen::Index>(spans[s] - degree + i));
        for (std::size_t k = 0; k <= degree; ++k) piece.c[k] += point * basis[i].c[k];
      }
      motion.setPiece(s, joint, piece);
    }
  }
  return motion;
}

void meetEnds(const SplineEnds& ends, int count, Bspline& spline) {
  const Eigen::Index n = spline.control.rows();
  const Eigen::Index size = spline.control.cols();
  const std::size_t last_knot = spline.knots.size() - 1;
  for (const bool at_end : {false, true}) {
    // Derivatives by the time from this end on inwards; knots likewise.
    const double sign = at_end ? -1.0 : 1.0;
    const auto knot = [&](int i) {
      const std::size_t k = static_cast<std::size_t>(i);
      return at_end ? spline.knots[last_knot] - spline.knots[last_knot - k] : spline.knots[k];
    };
    const VectorX& velocity = at_end ? ends.last_velocity : ends.first_velocity;
    const VectorX& acceleration = at_end ? ends.last_acceleration : ends.first_acceleration;
    // row[r]: control point i of derivative r, for the present i; i = 0 are the derivatives themselves.
    std::vector<VectorX> row(static_cast<std::size_t>(count), VectorX::Zero(n));
    row[0] = spline.control.col(at_end ? size - 1 : 0);
    if (velocity.size() > 0) row[1] = sign * velocity;
    if (acceleration.size() > 0) row[2] = acceleration;
    for (int i = 1; i < count; ++i) {
      for (int r = 0; r + i < count; ++r) {
        const double width = knot(i + spline.degree) - knot(i + r);
        row[static_cast<std::size_t>(r)] += row[static_cast<std::size_t>(r) + 1] * width / (spline.degree - r);
      }
      spline.control.col(at_end ? size - 1 - i : i) = row[0];
    }
  }
}

Bspline interpolatingBspline(int degree, const std::vector<double>& times, const MatrixX& positions,
                             const SplineEnds& ends) {
  const int rest_orders = degree < 6 ? 2 : 3;
  const Eigen::Index size = positions.cols() + 2 * rest_orders;
  const VectorX zero = VectorX::Zero(positions.rows());
  const auto orZero = [&](const VectorX& values) -> const VectorX& { return values.size() > 0 ? values : zero; };
  const VectorX first[] = {positions.col(0), orZero(ends.first_velocity), orZero(ends.first_acceleration), zero};
  const VectorX last[] = {positions.col(positions.cols() - 1), orZero(ends.last_velocity),
                          orZero(ends.last_acceleration), zero};
  Bspline spline{degree, clampedKnots(degree, interpolationKnots(degree, times), times.back()), {}};
  BandedSystem system(size, degree, positions.rows());
  for (int order = 0; order <= rest_orders; ++order) {
    system.setRow(order, spline, 0.0, order, first[order]);
    system.setRow(size - 1 - order, spline, times.back(), order, last[order]);
  }
  for (Eigen::Index k = 1; k + 1 < positions.cols(); ++k) {
    system.setRow(k + rest_orders, spline, times[static_cast<std::size_t>(k)], 0, positions.col(k));
  }
  spline.control = system.solve();
  return spline;
}

}  // namespace screwline

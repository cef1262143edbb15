#include "screwline/trajectory/hermite.h"

namespace screwline {
namespace {

Eigen::Index column(std::size_t k) {
  return static_cast<Eigen::Index>(k);
}

PiecewisePolynomial emptyMotion(const std::vector<double>& times, const MatrixX& positions, int degree,
                                int continuity) {
  return PiecewisePolynomial(static_cast<int>(positions.rows()), degree, times, continuity);
}

}  // namespace

Polynomial cubicBetween(const EndState& first, const EndState& last, double length) {
  const double d = last.position - first.position;
  const double v0 = first.velocity * length;
  const double v1 = last.velocity * length;
  return {{first.position, v0, 3.0 * d - (2.0 * v0 + v1), -2.0 * d + (v0 + v1)}};
}

Polynomial quinticBetween(const EndState& first, const EndState& last, double length) {
  const double d = last.position - first.position;
  const double v0 = first.velocity * length;
  const double v1 = last.velocity * length;
  const double a0 = first.acceleration * length * length;
  const double a1 = last.acceleration * length * length;
  return {{first.position, v0, 0.5 * a0, 0.5 * (20.0 * d - (8.0 * v1 + 12.0 * v0) - (3.0 * a0 - a1)),
           0.5 * (-30.0 * d + (14.0 * v1 + 16.0 * v0) + (3.0 * a0 - 2.0 * a1)),
           0.5 * (12.0 * d - 6.0 * (v0 + v1) + (a1 - a0))}};
}

PiecewisePolynomial linesThrough(const std::vector<double>& times, const MatrixX& positions) {
  PiecewisePolynomial motion = emptyMotion(times, positions, 1, 0);
  for (std::size_t k = 0; k < motion.segments(); ++k) {
    for (int j = 0; j < motion.joints; ++j) {
      motion.at(k, 0, j) = positions(j, column(k));
      motion.at(k, 1, j) = positions(j, column(k + 1)) - positions(j, column(k));
    }
  }
  return motion;
}

PiecewisePolynomial cubicsThrough(const std::vector<double>& times, const MatrixX& positions,
                                  const MatrixX& velocities) {
  PiecewisePolynomial motion = emptyMotion(times, positions, 3, 1);
  motion.starts_at_rest = velocities.col(0).isZero(0.0);
  motion.ends_at_rest = velocities.col(velocities.cols() - 1).isZero(0.0);
  for (std::size_t k = 0; k < motion.segments(); ++k) {
    for (int j = 0; j < motion.joints; ++j) {
      const EndState first{positions(j, column(k)), velocities(j, column(k)), 0.0};
      const EndState last{positions(j, column(k + 1)), velocities(j, column(k + 1)), 0.0};
      motion.setPiece(k, j, cubicBetween(first, last, motion.length(k)));
    }
  }
  return motion;
}

PiecewisePolynomial quinticsThrough(const std::vector<double>& times, const MatrixX& positions,
                                    const MatrixX& velocities, const MatrixX& accelerations) {
  PiecewisePolynomial motion = emptyMotion(times, positions, 5, 2);
  const Eigen::Index end = positions.cols() - 1;
  motion.starts_at_rest = velocities.col(0).isZero(0.0) && accelerations.col(0).isZero(0.0);
  motion.ends_at_rest = velocities.col(end).isZero(0.0) && accelerations.col(end).isZero(0.0);
  for (std::size_t k = 0; k < motion.segments(); ++k) {
    for (int j = 0; j < motion.joints; ++j) {
      const EndState first{positions(j, column(k)), velocities(j, column(k)), accelerations(j, column(k))};
      const EndState last{positions(j, column(k + 1)), velocities(j, column(k + 1)), accelerations(j, column(k + 1))};
      motion.setPiece(k, j, quinticBetween(first, last, motion.length(k)));
    }
  }
  return motion;
}

MatrixX splineVelocities(const std::vector<double>& times, const MatrixX& positions, const VectorX& first_velocity,
                         const VectorX& last_velocity) {
  const std::size_t count = times.size();
  MatrixX velocities(positions.rows(), positions.cols());
  velocities.col(0) = first_velocity;
  velocities.col(column(count - 1)) = last_velocity;
  // Thomas: forward elimination leaves v[k] = velocities[k] - upper[k] v[k+1]. Diagonally dominant, so no pivoting.
  std::vector<double> upper(count, 0.0);
  for (std::size_t k = 1; k + 1 < count; ++k) {
    const double before = times[k] - times[k - 1];
    const double after = times[k + 1] - times[k];
    const VectorX right = 3.0 * ((before / after) * (positions.col(column(k + 1)) - positions.col(column(k))) +
                                 (after / before) * (positions.col(column(k)) - positions.col(column(k - 1))));
    const double pivot = 2.0 * (before + after) - after * upper[k - 1];
    upper[k] = before / pivot;
    velocities.col(column(k)) = (right - after * velocities.col(column(k - 1))) / pivot;
  }
  for (std::size_t k = count - 1; k-- > 1;) velocities.col(column(k)) -= upper[k] * velocities.col(column(k + 1));
  return velocities;
}

MatrixX naturalSplineSlopes(const std::vector<double>& times, const MatrixX& positions) {
  const std::size_t count = times.size();
  const Eigen::Index last = column(count - 1);
  MatrixX slopes(positions.rows(), positions.cols());
  const auto chord = [&](std::size_t k) -> VectorX {
    return (positions.col(column(k + 1)) - positions.col(column(k))) / (times[k + 1] - times[k]);
  };
  // Thomas, as above; the end rows say 2 v[0] + v[1] = 3 chord: no acceleration.
  std::vector<double> upper(count, 0.0);
  upper[0] = 0.5;
  slopes.col(0) = 1.5 * chord(0);
  for (std::size_t k = 1; k + 1 < count; ++k) {
    const double before = times[k] - times[k - 1];
    const double after = times[k + 1] - times[k];
    const double pivot = 2.0 * (before + after) - after * upper[k - 1];
    upper[k] = before / pivot;
    slopes.col(column(k)) =
        (3.0 * (before * chord(k) + after * chord(k - 1)) - after * slopes.col(column(k - 1))) / pivot;
  }
  slopes.col(last) = (3.0 * chord(count - 2) - slopes.col(last - 1)) / (2.0 - upper[count - 2]);
  for (std::size_t k = count - 1; k-- > 0;) slopes.col(column(k)) -= upper[k] * slopes.col(column(k + 1));
  return slopes;
}

MatrixX splineAccelerations(const std::vector<double>& times, const MatrixX& positions, const MatrixX& velocities) {
  const std::size_t count = times.size();
  MatrixX accelerations(positions.rows(), positions.cols());
  for (std::size_t k = 0; k + 1 < count; ++k) {
    const double h = times[k + 1] - times[k];
    const VectorX slope = (positions.col(column(k + 1)) - positions.col(column(k))) / h;
    accelerations.col(column(k)) =
        (6.0 * slope - 4.0 * velocities.col(column(k)) - 2.0 * velocities.col(column(k + 1))) / h;
    if (k + 2 < count) continue;
    accelerations.col(column(k + 1)) =
        (-6.0 * slope + 2.0 * velocities.col(column(k)) + 4.0 * velocities.col(column(k + 1))) / h;
  }
  return accelerations;
}

}  // namespace screwline

#ifndef SCREWLINE_SRC_KINEMATICS_FACTOR_ROOTS_H
#define SCREWLINE_SRC_KINEMATICS_FACTOR_ROOTS_H

#include <complex>
#include <functional>
#include <vector>

#include "screwline/spatial/pose.h"

namespace screwline {

/// All zeros of sum c[k] z^k, as eigenvalues of the companion matrix. @pre c.size() > 1, c.back() != 0.
Eigen::VectorXcd companionRoots(const std::vector<std::complex<double>>& c);

/// All real zeros of a trigonometric polynomial of degree at most 7, in (-pi, pi], ascending, each as often as its
/// multiplicity. Found as roots z = e^(i angle) on the unit circle of the polynomial of its Fourier coefficients. Empty
/// also where f is constant.
std::vector<double> circleRoots(const std::function<double(double)>& f);

/// All real zeros of a polynomial of degree at most 6, ascending, each as often as its multiplicity; `length` is where
/// it is sampled: [-length, length].
std::vector<double> lineRoots(const std::function<double(double)>& f, double length);

}  // namespace screwline

#endif  // SCREWLINE_SRC_KINEMATICS_FACTOR_ROOTS_H

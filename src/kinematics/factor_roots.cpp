#include "factor_roots.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include "screwline/spatial/rotation.h"

namespace screwline {
namespace {

using Complex = std::complex<double>;

constexpr int kCircleSamples = 16;
constexpr int kLineSamples = 9;
constexpr int kLineDegree = 6;
constexpr double kNegligible = 1e-11;  ///< Coefficients below this share of the largest value are rounding.
constexpr double kMultiple = 1e-5;     ///< Rounding spreads a multiple zero by so much at most.
constexpr double kZero = 1e-8;         ///< Share of the largest value that still counts as a zero.
constexpr double kSnap = 1e-9;         ///< Zeros so near to a multiple of 15 degrees are it.

/// Replaces values that multiplicity has spread by their mean, which rounding hardly moves.
void mergeMultiples(std::vector<double>& roots, double width) {
  std::sort(roots.begin(), roots.end());
  for (std::size_t first = 0; first < roots.size();) {
    std::size_t last = first + 1;
    double sum = roots[first];
    while (last < roots.size() && roots[last] - roots[last - 1] <= width) sum += roots[last++];
    std::fill(roots.begin() + static_cast<std::ptrdiff_t>(first), roots.begin() + static_cast<std::ptrdiff_t>(last),
              sum / static_cast<double>(last - first));
    first = last;
  }
}

double snapped(double angle) {
  const double step = kPi / 12.0;
  const double nearest = std::round(angle / step) * step;
  return wrapAngle(std::abs(angle - nearest) <= kSnap ? nearest : angle);
}

/// Zeros of A + B cos + C sin.
std::vector<double> firstDegreeRoots(double A, double B, double C) {
  const double r = std::hypot(B, C);
  if (std::abs(A) > r * (1.0 + 1e-12)) return {};
  const double middle = std::atan2(C, B);
  const double half = std::acos(std::clamp(-A / r, -1.0, 1.0));
  return {middle - half, middle + half};
}

std::vector<double> unitCircleRoots(const std::vector<Complex>& coefficients) {
  std::vector<double> angles;
  const Eigen::VectorXcd z = companionRoots(coefficients);
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    if (std::abs(std::abs(z[i]) - 1.0) <= kMultiple) angles.push_back(std::arg(z[i]));
  }
  // The cut at pi must not part a multiple zero.
  for (double& angle : angles) {
    if (angle < -kPi + 2.0 * kMultiple) angle += kTwoPi;
  }
  mergeMultiples(angles, kMultiple);
  return angles;
}

}  // namespace

Eigen::VectorXcd companionRoots(const std::vector<Complex>& c) {
  const Eigen::Index degree = static_cast<Eigen::Index>(c.size()) - 1;
  Eigen::MatrixXcd companion = Eigen::MatrixXcd::Zero(degree, degree);
  companion.diagonal(-1).setOnes();
  for (Eigen::Index k = 0; k < degree; ++k) companion(k, degree - 1) = -c[static_cast<std::size_t>(k)] / c.back();
  return Eigen::ComplexEigenSolver<Eigen::MatrixXcd>(companion, false).eigenvalues();
}

std::vector<double> circleRoots(const std::function<double(double)>& f) {
  std::vector<double> samples(kCircleSamples);
  double largest = 0.0;
  for (int i = 0; i < kCircleSamples; ++i) {
    samples[static_cast<std::size_t>(i)] = f(kTwoPi * i / kCircleSamples);
    largest = std::max(largest, std::abs(samples[static_cast<std::size_t>(i)]));
  }
  std::vector<Complex> c(kCircleSamples / 2);
  std::size_t degree = 0;
  for (std::size_t k = 0; k < c.size(); ++k) {
    for (std::size_t i = 0; i < samples.size(); ++i) {
      c[k] += samples[i] * std::polar(1.0 / kCircleSamples,
                                      -kTwoPi * static_cast<double>((i * k) % kCircleSamples) / kCircleSamples);
    }
    if (std::abs(c[k]) > kNegligible * largest) degree = k;
  }
  if (degree == 0) return {};
  std::vector<double> roots;
  if (degree == 1) {
    roots = firstDegreeRoots(c[0].real(), 2.0 * c[1].real(), -2.0 * c[1].imag());
  } else {
    std::vector<Complex> polynomial(2 * degree + 1);
    for (std::size_t k = 0; k <= degree; ++k) {
      polynomial[degree + k] = c[k];
      polynomial[degree - k] = std::conj(c[k]);
    }
    roots = unitCircleRoots(polynomial);
  }
  for (double& root : roots) root = snapped(root);
  roots.erase(
      std::remove_if(roots.begin(), roots.end(), [&](double root) { return std::abs(f(root)) > kZero * largest; }),
      roots.end());
  std::sort(roots.begin(), roots.end());
  return roots;
}

std::vector<double> lineRoots(const std::function<double(double)>& f, double length) {
  MatrixX powers(kLineSamples, kLineDegree + 1);
  VectorX samples(kLineSamples);
  for (int i = 0; i < kLineSamples; ++i) {
    const double x = std::cos(kPi * (i + 0.5) / kLineSamples);
    for (int k = 0; k <= kLineDegree; ++k) powers(i, k) = std::pow(x, k);
    samples[i] = f(length * x);
  }
  const VectorX fit = powers.householderQr().solve(samples);
  const double largest = samples.cwiseAbs().maxCoeff();
  int degree = kLineDegree;
  while (degree > 0 && std::abs(fit[degree]) <= 100.0 * kNegligible * largest) --degree;
  if (degree == 0) return {};
  std::vector<double> roots;
  if (degree == 1) {
    roots = {-fit[0] / fit[1]};
  } else {
    const std::vector<Complex> coefficients(fit.data(), fit.data() + degree + 1);
    const Eigen::VectorXcd z = companionRoots(coefficients);
    for (Eigen::Index i = 0; i < z.size(); ++i) {
      if (std::abs(z[i].imag()) <= kMultiple * std::max(1.0, std::abs(z[i]))) roots.push_back(z[i].real());
    }
    mergeMultiples(roots, kMultiple);
  }
  for (double& root : roots) root = std::abs(root) <= kSnap ? 0.0 : root * length;
  return roots;
}

}  // namespace screwline

#include "inverse_roots.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "../kinematics/factor_roots.h"
#include "screwline/spatial/rotation.h"

namespace screwline {
namespace {

using Complex = std::complex<double>;

constexpr double kNegligible = 1e-14;  ///< Of the largest coefficient: a leading one below it is rounding.
constexpr double kNearReal = 1e-3;  ///< An eigenvalue's share beside the real line or the circle; polished, it decides.
constexpr double kZero = 1e-12;     ///< Of the terms' sizes: values below it are zero, two roots meet there.
constexpr int kMostSteps = 20;

/// Complex zeros; leading coefficients that are rounding do not count.
std::vector<Complex> zerosOf(std::vector<Complex> c) {
  double largest = 0.0;
  for (const Complex& one : c) largest = std::max(largest, std::abs(one));
  while (!c.empty() && std::abs(c.back()) <= kNegligible * largest) c.pop_back();
  if (c.size() < 2) return {};
  const Eigen::VectorXcd zeros = companionRoots(c);
  return {zeros.data(), zeros.data() + zeros.size()};
}

struct Value {
  double value = 0.0;
  double slope = 0.0;
  double scale = 0.0;  ///< Of the terms.
};

/// Newton's method, where it brings the function nearer to zero. False where that is not reached.
template <typename Function>
bool polish(const Function& function, double& x) {
  Value now = function(x);
  for (int i = 0; i < kMostSteps && now.value != 0.0 && now.slope != 0.0; ++i) {
    const double next = x - now.value / now.slope;
    const Value then = function(next);
    if (!(std::abs(then.value) < std::abs(now.value))) break;
    x = next;
    now = then;
  }
  return std::abs(now.value) <= kZero * now.scale;
}

}  // namespace

std::vector<double> zeroAngles(const std::array<double, 5>& coefficients) {
  const double k = coefficients[0];
  const double a = coefficients[1];
  const double b = coefficients[2];
  const double c = coefficients[3];
  const double d = coefficients[4];
  const auto function = [=](double x) {
    const double c1 = std::cos(x);
    const double s1 = std::sin(x);
    const double c2 = std::cos(2.0 * x);
    const double s2 = std::sin(2.0 * x);
    return Value{k + a * c1 + b * s1 + c * c2 + d * s2, b * c1 - a * s1 + 2.0 * (d * c2 - c * s2),
                 std::abs(k) + std::abs(a) + std::abs(b) + std::abs(c) + std::abs(d)};
  };
  // With z = exp(ix), z^2 times the function.
  const std::vector<Complex> polynomial = {
      {0.5 * c, 0.5 * d}, {0.5 * a, 0.5 * b}, {k, 0.0}, {0.5 * a, -0.5 * b}, {0.5 * c, -0.5 * d}};
  std::vector<double> angles;
  for (const Complex& z : zerosOf(polynomial)) {
    double x = std::arg(z);
    if (std::abs(std::abs(z) - 1.0) <= kNearReal && polish(function, x)) angles.push_back(wrapAngle(x));
  }
  return angles;
}

std::vector<double> realRoots(const std::array<double, 5>& coefficients) {
  const auto function = [&coefficients](double x) {
    Value result;
    for (int i = 4; i >= 0; --i) {
      const double c = coefficients[static_cast<std::size_t>(i)];
      result.slope = result.slope * x + result.value;
      result.value = result.value * x + c;
      result.scale = result.scale * std::abs(x) + std::abs(c);
    }
    return result;
  };
  std::vector<double> roots;
  for (const Complex& z : zerosOf({coefficients.begin(), coefficients.end()})) {
    double x = z.real();
    if (std::abs(z.imag()) <= kNearReal * std::abs(z) && polish(function, x)) roots.push_back(x);
  }
  return roots;
}

}  // namespace screwline

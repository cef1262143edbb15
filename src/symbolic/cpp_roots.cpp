#include "cpp_roots.h"

namespace screwline {

const char* const kCppRoots =
    R"(/// Real roots of c[0] + c[1] x + c[2] x^2 + ..., ascending; where two meet they come once.
inline std::vector<double> realRoots(std::vector<double> c) {
  double largest = 0.0;
  for (const double one : c) largest = std::fmax(largest, std::abs(one));
  while (!c.empty() && std::abs(c.back()) <= 1e-14 * largest) c.pop_back();
  if (c.size() < 2) return {};
  const auto value = [&c](double x, double rounding) {
    double sum = 0.0;
    double scale = 0.0;
    for (std::size_t i = c.size(); i > 0; --i) {
      sum = sum * x + c[i - 1];
      scale = scale * std::abs(x) + std::abs(c[i - 1]);
    }
    return std::abs(sum) <= rounding * scale ? 0.0 : sum;
  };
  std::vector<double> slope;
  double bound = 1.0;
  for (std::size_t i = 1; i < c.size(); ++i) {
    slope.push_back(static_cast<double>(i) * c[i]);
    bound = std::fmax(bound, 1.0 + std::abs(c[i - 1] / c.back()));
  }
  // From one zero of the slope to the next it rises or falls.
  std::vector<double> ends = realRoots(slope);
  ends.insert(ends.begin(), -bound);
  ends.push_back(bound);
  std::vector<double> roots;
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
    double low = ends[k];
    double high = ends[k + 1];
    const double at_low = value(low, 1e-13);
    const double at_high = value(high, 1e-13);
    if ((at_low < 0.0 && at_high > 0.0) || (at_low > 0.0 && at_high < 0.0)) {
      for (int i = 0; i < 200; ++i) {
        const double middle = 0.5 * (low + high);
        ((value(middle, 0.0) < 0.0) == (at_low < 0.0) ? low : high) = middle;
      }
      roots.push_back(0.5 * (low + high));
    }
    if (at_high == 0.0 && k + 2 < ends.size()) roots.push_back(high);
  }
  return roots;
}

/// Angles x where k + a cos x + b sin x + c cos 2x + d sin 2x is zero.
inline std::vector<double> anglesOf(double k, double a, double b, double c, double d) {
  // Counted from opposite to where the sum is far from zero: there the tangent of the half angle is infinite.
  double from = 0.0;
  double largest = -1.0;
  for (int i = 0; i < 8; ++i) {
    const double x = 0.25 * kPi * i;
    const double sum = std::abs(k + a * std::cos(x) + b * std::sin(x) + c * std::cos(2.0 * x) + d * std::sin(2.0 * x));
    if (sum <= largest) continue;
    largest = sum;
    from = x - kPi;
  }
  const double a_from = a * std::cos(from) + b * std::sin(from);
  const double b_from = b * std::cos(from) - a * std::sin(from);
  const double c_from = c * std::cos(2.0 * from) + d * std::sin(2.0 * from);
  const double d_from = d * std::cos(2.0 * from) - c * std::sin(2.0 * from);
  std::vector<double> angles;
  for (const double t : realRoots({k + a_from + c_from, 2.0 * b_from + 4.0 * d_from, 2.0 * k - 6.0 * c_from,
                                   2.0 * b_from - 4.0 * d_from, k - a_from + c_from}))
    angles.push_back(from + 2.0 * std::atan(t));
  return angles;
}

)";

}  // namespace screwline

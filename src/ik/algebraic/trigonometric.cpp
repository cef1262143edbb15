#include "trigonometric.h"

#include <algorithm>
#include <cmath>

#include "screwline/spatial/pose.h"

namespace screwline {
namespace {

constexpr double kNoiseFactor = 300.0;    ///< Noise of a value, over that of a coefficient.
constexpr double kNoiseFloor = 1e-15;     ///< Of a coefficient.
constexpr double kFinestInterval = 1e-7;  ///< [rad] half-width
constexpr int kMaxIntervals = 20000;      ///< Looked at; more are met only where the polynomial is noise.
constexpr int kNewtonSteps = 40;
constexpr double kSameExtremum = 1e-12;  ///< [rad]

/// cos and sin of 2 pi i / 32.
struct Circle {
  Circle() {
    for (int i = 0; i < kTrigonometricSamples; ++i) {
      cosine[static_cast<std::size_t>(i)] = std::cos(kTwoPi * i / kTrigonometricSamples);
      sine[static_cast<std::size_t>(i)] = std::sin(kTwoPi * i / kTrigonometricSamples);
    }
  }
  std::array<double, kTrigonometricSamples> cosine;
  std::array<double, kTrigonometricSamples> sine;
};

const Circle& circle() {
  static const Circle instance;
  return instance;
}

class Subdivision {
 public:
  Subdivision(const TrigonometricPolynomial& f, TrigonometricRoots& roots) : f_(f), roots_(roots) {
    for (int k = 1; k <= f.degree; ++k) {
      const auto i = static_cast<std::size_t>(k);
      fourth_bound_ += std::pow(k, 4) * std::hypot(f.c[i], f.s[i]);
    }
    tolerance_ = kNoiseFactor * std::max(f.noise, kNoiseFloor);
    finest_ = std::max(kFinestInterval, std::sqrt(tolerance_));
  }

  void run() {
    constexpr int kIntervals = 32;
    double low = 0.0;
    const double first = f_.derivatives(0.0)[0];
    double at_low = first;
    for (int i = 1; i <= kIntervals; ++i) {
      const double high = kTwoPi * i / kIntervals;
      const double at_high = i == kIntervals ? first : f_.derivatives(high)[0];
      search(low, high, at_low, at_high);
      low = high;
      at_low = at_high;
    }
  }

 private:
  void search(double low, double high, double at_low, double at_high) {
    if (++looked_at_ > kMaxIntervals || roots_.overflow) {
      roots_.overflow = true;
      return;
    }
    const double x = 0.5 * (low + high);
    const double r = 0.5 * (high - low);
    const std::array<double, 4> d = f_.derivatives(x);
    const double d1 = std::abs(d[1]);
    const double d2 = std::abs(d[2]);
    const double d3 = std::abs(d[3]);
    if (std::abs(d[0]) > tolerance_ + r * (d1 + r / 2.0 * (d2 + r / 3.0 * (d3 + r / 4.0 * fourth_bound_)))) return;
    if (d1 > r * (d2 + r / 2.0 * (d3 + r / 3.0 * fourth_bound_))) {
      addBetween(low, high, at_low, at_high, x);
      return;
    }
    if (d2 > r * (d3 + r / 2.0 * fourth_bound_)) {
      searchBent(low, high, at_low, at_high);
      return;
    }
    if (r < finest_) {
      const double step = d[2] != 0.0 ? -d[1] / d[2] : 0.0;
      addTouching(x + std::clamp(step, -r, r));
      return;
    }
    search(low, x, at_low, d[0]);
    search(x, high, d[0], at_high);
  }

  /// Where the second derivative keeps its sign: a root on each side of the extremum at most, or one that touches in
  /// it.
  void searchBent(double low, double high, double at_low, double at_high) {
    double x = 0.5 * (low + high);
    std::array<double, 4> d{};
    double step = 0.0;
    for (int i = 0; i < kNewtonSteps; ++i) {
      d = f_.derivatives(x);
      step = -d[1] / d[2];
      const double next = std::clamp(x + step, low, high);
      if (std::abs(next - x) < kSameExtremum) break;
      x = next;
    }
    const bool is_inside = std::abs(step) <= finest_;
    if (is_inside && std::abs(d[0]) <= tolerance_ + 0.5 * finest_ * finest_ * std::abs(d[2])) {
      addTouching(x);
      return;
    }
    const double apart = std::sqrt(std::abs(2.0 * d[0] / d[2]));  // Of the parabola's roots from its extremum.
    addBetween(low, x, at_low, d[0], x - apart);
    addBetween(x, high, d[0], at_high, x + apart);
  }

  /// The root of a monotone stretch, where it has one.
  void addBetween(double low, double high, double at_low, double at_high, double start) {
    if ((at_low < 0.0) != (at_high < 0.0)) add({polished(low, high, at_low, start), false});
  }

  /// The one root between, by Newton's method kept inside by bisection.
  double polished(double low, double high, double at_low, double start) const {
    double x = start > low && start < high ? start : 0.5 * (low + high);
    for (int i = 0; i < kNewtonSteps; ++i) {
      const std::array<double, 4> d = f_.derivatives(x);
      ((d[0] < 0.0) == (at_low < 0.0) ? low : high) = x;
      double next = x - d[0] / d[1];
      if (!(next > low && next < high)) next = 0.5 * (low + high);
      const double step = std::abs(next - x);
      x = next;
      if (step < 1e-14) break;
    }
    return x;
  }

  void addTouching(double angle) {
    if (roots_.count > 0) {
      const TrigonometricRoots::Root& last = roots_.roots[static_cast<std::size_t>(roots_.count - 1)];
      if (last.touching && angle - last.angle < 4.0 * finest_) return;
    }
    add({angle, true});
  }

  void add(const TrigonometricRoots::Root& root) {
    if (roots_.count == static_cast<int>(roots_.roots.size())) {
      roots_.overflow = true;
    } else {
      roots_.roots[static_cast<std::size_t>(roots_.count++)] = root;
    }
  }

  const TrigonometricPolynomial& f_;
  TrigonometricRoots& roots_;
  double fourth_bound_ = 0.0;
  double tolerance_ = 0.0;
  double finest_ = 0.0;
  int looked_at_ = 0;
};

}  // namespace

double CircleMap::image(double angle) const {
  const double half = 0.5 * (angle - center);
  return 2.0 * std::atan2(stretch * std::sin(half), std::cos(half));
}

double CircleMap::angle(double image) const {
  if (stretch == 1.0) return center + image;
  return center + 2.0 * std::atan2(std::sin(0.5 * image), stretch * std::cos(0.5 * image));
}

double CircleMap::slope(double image) const {
  const double c = stretch * std::cos(0.5 * image);
  const double s = std::sin(0.5 * image);
  return stretch / (c * c + s * s);
}

TrigonometricPolynomial::TrigonometricPolynomial(const std::array<double, kTrigonometricSamples>& values) {
  const Circle& unit = circle();
  const auto coefficient = [&](std::size_t k, const std::array<double, kTrigonometricSamples>& basis) {
    double sum = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) sum += values[i] * basis[(i * k) % kTrigonometricSamples];
    return sum / (k == 0 ? kTrigonometricSamples : kTrigonometricSamples / 2);
  };
  for (std::size_t k = 0; k <= kTrigonometricDegree; ++k) {
    c[k] = coefficient(k, unit.cosine);
    s[k] = k > 0 ? coefficient(k, unit.sine) : 0.0;
    scale = std::max({scale, std::abs(c[k]), std::abs(s[k])});
  }
  if (!(scale > 0.0) || !std::isfinite(scale)) {
    scale = 0.0;
    return;
  }
  for (std::size_t k = kTrigonometricDegree + 1; k < kTrigonometricSamples / 2; ++k) {
    noise = std::max({noise, std::abs(coefficient(k, unit.cosine)), std::abs(coefficient(k, unit.sine))});
  }
  noise /= scale;
  for (std::size_t k = 0; k <= kTrigonometricDegree; ++k) {
    c[k] /= scale;
    s[k] /= scale;
  }
}

void TrigonometricPolynomial::truncate(int new_degree) {
  for (int k = degree; k > new_degree; --k) {
    const auto i = static_cast<std::size_t>(k);
    noise = std::max({noise, std::abs(c[i]), std::abs(s[i])});
    c[i] = s[i] = 0.0;
  }
  degree = std::min(degree, new_degree);
}

std::array<double, 4> TrigonometricPolynomial::derivatives(double x) const {
  const double cosine = std::cos(x);
  const double sine = std::sin(x);
  double ck = 1.0;
  double sk = 0.0;
  std::array<double, 4> d{{c[0], 0.0, 0.0, 0.0}};
  for (int k = 1; k <= degree; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const double next = ck * cosine - sk * sine;
    sk = sk * cosine + ck * sine;
    ck = next;
    const double even = c[i] * ck + s[i] * sk;
    const double odd = k * (s[i] * ck - c[i] * sk);
    d[0] += even;
    d[1] += odd;
    d[2] -= k * k * even;
    d[3] -= k * k * odd;
  }
  return d;
}

TrigonometricRoots TrigonometricPolynomial::realRoots() const {
  TrigonometricRoots roots;
  if (scale == 0.0) {
    roots.overflow = true;
    return roots;
  }
  Subdivision(*this, roots).run();
  return roots;
}

}  // namespace screwline

#include "trigonometric.h"

#include <algorithm>
#include <cmath>

#include "screwline/spatial/rotation.h"

namespace screwline {
namespace {

constexpr double kNoiseFactor = 1000.0;   ///< Noise of a value, over that of a coefficient.
constexpr double kNoiseFloor = 1e-15;     ///< Of a coefficient.
constexpr double kFinestInterval = 1e-7;  ///< [rad] half-width
constexpr int kMaxIntervals = 20000;      ///< Looked at; more are met only where the polynomial is noise.
constexpr int kNewtonSteps = 40;
constexpr int kMostRoots = 8;         ///< Of a cluster.
constexpr double kLargestDisk = 0.1;  ///< [rad] radius
constexpr double kUnresolved = 0.01;  ///< [rad] radius of what has no such disk.
constexpr double kDiskGrowth = 1.5;   ///< From one radius to the next.

/// Calls visit(k, cos k x, sin k x) for k = 1, ... degree.
template <typename Visit>
void forEachHarmonic(double x, int degree, const Visit& visit) {
  const double cosine = std::cos(x);
  const double sine = std::sin(x);
  double ck = 1.0;
  double sk = 0.0;
  for (int k = 1; k <= degree; ++k) {
    const double next = ck * cosine - sk * sine;
    sk = sk * cosine + ck * sine;
    ck = next;
    visit(k, ck, sk);
  }
}

/// cos and sin of 2 pi i / 32.
struct Circle {
  Circle() {
    // Each by itself, to the last digit: what the recurrence loses would count as the polynomials' noise.
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
  Subdivision(const TrigonometricPolynomial& f, TrigonometricRoots& roots)
      : f_(f), roots_(roots), tolerance_(f.tolerance()), slope_tolerance_(f.degree * tolerance_) {
    for (int k = 1; k <= f.degree; ++k) {
      const auto i = static_cast<std::size_t>(k);
      fourth_bound_ += std::pow(k, 4) * std::hypot(f.c[i], f.s[i]);
    }
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
    if (isCovered(x, r)) return;
    const std::array<double, 4> d = f_.derivatives(x);
    const double d1 = std::abs(d[1]);
    const double d2 = std::abs(d[2]);
    const double d3 = std::abs(d[3]);
    if (std::abs(d[0]) > tolerance_ + r * (d1 + r / 2.0 * (d2 + r / 3.0 * (d3 + r / 4.0 * fourth_bound_)))) return;
    if (d1 > slope_tolerance_ + r * (d2 + r / 2.0 * (d3 + r / 3.0 * fourth_bound_))) {
      if ((at_low < 0.0) != (at_high < 0.0)) add(f_.clusterAt(polished(low, high, at_low)));
      return;
    }
    const bool finest = r < kFinestInterval;
    if (finest || std::abs(d[0]) <= tolerance_) {
      const RootCluster cluster = f_.clusterAt(x);
      if (cluster.radius >= r || finest) return add(cluster);
    }
    search(low, x, at_low, d[0]);
    search(x, high, d[0], at_high);
  }

  /// The one root between, by Newton's method kept inside by bisection.
  double polished(double low, double high, double at_low) const {
    double x = 0.5 * (low + high);
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

  /// Whether a disk that is known holds an interval: its roots are among the disk's.
  bool isCovered(double x, double r) const {
    for (int i = 0; i < roots_.count; ++i) {
      const RootCluster& known = roots_.roots[static_cast<std::size_t>(i)];
      if (known.radius > r && std::abs(withoutTurns(x - known.angle)) + r <= known.radius) return true;
    }
    return false;
  }

  void add(const RootCluster& cluster) {
    for (int i = 0; i < roots_.count; ++i) {
      const RootCluster& known = roots_.roots[static_cast<std::size_t>(i)];
      const double apart = std::abs(withoutTurns(cluster.angle - known.angle));
      if (apart <= 0.5 * known.radius && cluster.multiplicity == known.multiplicity) return;
    }
    if (roots_.count == static_cast<int>(roots_.roots.size())) {
      roots_.overflow = true;
    } else {
      roots_.roots[static_cast<std::size_t>(roots_.count++)] = cluster;
    }
  }

  const TrigonometricPolynomial& f_;
  TrigonometricRoots& roots_;
  double tolerance_;
  double slope_tolerance_;
  double fourth_bound_ = 0.0;
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
  std::array<double, 4> d{{c[0], 0.0, 0.0, 0.0}};
  forEachHarmonic(x, degree, [&](int k, double ck, double sk) {
    const auto i = static_cast<std::size_t>(k);
    const double even = c[i] * ck + s[i] * sk;
    const double odd = k * (s[i] * ck - c[i] * sk);
    d[0] += even;
    d[1] += odd;
    d[2] -= k * k * even;
    d[3] -= k * k * odd;
  });
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

double TrigonometricPolynomial::tolerance() const {
  return kNoiseFactor * std::max(noise, kNoiseFloor);
}

/// f^(j)(x) / j!, and as the last a bound on the remainder's factor in disks up to the largest.
TrigonometricPolynomial::Taylor TrigonometricPolynomial::taylor(double x) const {
  static const double kGrowth = std::exp(kTrigonometricDegree * kLargestDisk);  // Of the remainder off the real axis.
  Taylor terms{{c[0], 0.0}};
  forEachHarmonic(x, degree, [&](int k, double ck, double sk) {
    const auto i = static_cast<std::size_t>(k);
    const double even = c[i] * ck + s[i] * sk;
    const double odd = s[i] * ck - c[i] * sk;
    double power = 1.0;  // k^j, with the derivative's sign.
    for (std::size_t j = 0; j + 2 < terms.size(); j += 2) {
      terms[j] += power * even;
      terms[j + 1] += power * k * odd;
      power *= -k * k;
    }
    terms[terms.size() - 2] += power * even;
    terms.back() += std::abs(power) * k * (std::abs(c[i]) + std::abs(s[i]));
  });
  double factorial = 1.0;
  for (std::size_t j = 2; j < terms.size(); ++j) {
    factorial *= static_cast<double>(j);
    terms[j] /= factorial;
  }
  terms.back() *= kGrowth;
  return terms;
}

/// The degree of the term that outweighs all others and the noise in a disk; 0: none but the constant.
int TrigonometricPolynomial::outweighing(const Taylor& terms, double radius) const {
  double power = 1.0;
  double sum = tolerance();
  double largest = 0.0;
  std::size_t degree_there = 0;
  for (std::size_t j = 0; j < terms.size(); ++j) {
    const double value = std::abs(terms[j]) * power;
    sum += value;
    if (j + 1 < terms.size() && value > largest) {
      largest = value;
      degree_there = j;
    }
    power *= radius;
  }
  return largest > 0.5 * sum ? static_cast<int>(degree_there) : 0;
}

/// Of the smallest disk about x in which a term outweighs all others; with `degree` 0 any but the constant.
RootCluster TrigonometricPolynomial::smallestDisk(const Taylor& terms, double x, int degree_there) const {
  for (double radius = kFinestInterval; radius <= kLargestDisk; radius *= kDiskGrowth) {
    const int multiplicity = outweighing(terms, radius);
    if (degree_there == 0 ? multiplicity > 0 : multiplicity == degree_there) return {x, radius, multiplicity};
  }
  return {x, kUnresolved, 0};
}

RootCluster TrigonometricPolynomial::clusterAt(double x) const {
  constexpr double R = kFinestInterval;
  const std::array<double, 4> d = derivatives(x);
  // All but the fourth term and those behind it, which are nothing then: most roots are simple.
  if (R * (std::abs(d[1]) - R * (std::abs(d[2]) + R * std::abs(d[3]))) > 2.0 * (tolerance() + std::abs(d[0]))) {
    return {x, R, 1};
  }
  const Taylor terms = taylor(x);
  const RootCluster found = smallestDisk(terms, x, 0);
  if (found.multiplicity < 2) return found;
  // The roots' mean is known better than any of them. A disk about it that holds the first one holds no other roots.
  const auto m = static_cast<std::size_t>(found.multiplicity);
  const double center = x - terms[m - 1] / (static_cast<double>(m) * terms[m]);
  const Taylor there = taylor(center);
  const bool same = outweighing(there, std::abs(center - x) + found.radius) == found.multiplicity;
  return same ? smallestDisk(there, center, found.multiplicity) : found;
}

}  // namespace screwline

#ifndef SCREWLINE_SPATIAL_GOLDEN_SECTION_H
#define SCREWLINE_SPATIAL_GOLDEN_SECTION_H

namespace screwline {

/// Where f is least over [from, to], if it has one minimum there: each of the steps leaves 0.618 of the interval, f is
/// evaluated steps + 2 times. Allocates nothing. Source: Kiefer, Sequential minimax search for a maximum, 1953.
template <typename Function>
double goldenMinimum(Function&& f, double from, double to, int steps) {
  constexpr double kGolden = 0.6180339887498949;
  double a = to - kGolden * (to - from);
  double b = from + kGolden * (to - from);
  double at_a = f(a);
  double at_b = f(b);
  for (int i = 0; i < steps; ++i) {
    if (at_a < at_b) {
      to = b;
      b = a;
      at_b = at_a;
      a = to - kGolden * (to - from);
      at_a = f(a);
    } else {
      from = a;
      a = b;
      at_a = at_b;
      b = from + kGolden * (to - from);
      at_b = f(b);
    }
  }
  return at_a < at_b ? a : b;
}

}  // namespace screwline

#endif  // SCREWLINE_SPATIAL_GOLDEN_SECTION_H

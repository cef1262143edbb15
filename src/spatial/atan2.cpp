#include "screwline/spatial/atan2.h"

#include <cstdint>
#include <cstring>

#include "screwline/spatial/atan2_kernel.h"

namespace screwline {
namespace {

using Two = double __attribute__((vector_size(16)));
using TwoBits = std::uint64_t __attribute__((vector_size(16)));

void atan2ByTwo(const double* __restrict y, const double* __restrict x, double* __restrict angle, int count) {
  for (int i = 0; i < count; i += 2) {
    const int second = i + 1 < count ? i + 1 : i;
    const Two ys = {y[i], y[second]};
    const Two xs = {x[i], x[second]};
    Two angles;
    atan2Kernel<TwoBits>(ys, xs, angles);
    angle[i] = angles[0];
    angle[second] = angles[1];
  }
}

#if defined(__x86_64__) && defined(__GNUC__)

using Four = double __attribute__((vector_size(32)));
using FourBits = std::uint64_t __attribute__((vector_size(32)));

/// The last four may overlap those before: an angle is the same in any place.
[[gnu::target("avx2,fma")]] void atan2ByFour(const double* __restrict y, const double* __restrict x,
                                             double* __restrict angle, int count) {
  for (int i = 0; i < count; i += 4) {
    const int first = i + 4 <= count ? i : count - 4;
    Four ys;
    Four xs;
    Four angles;
    std::memcpy(&ys, y + first, sizeof ys);
    std::memcpy(&xs, x + first, sizeof xs);
    atan2Kernel<FourBits>(ys, xs, angles);
    std::memcpy(angle + first, &angles, sizeof angles);
  }
}

// Which one is taken for three or fewer depends on the processor alone too, so that an angle does not depend on what
// it is taken together with.
void atan2OfFew(const double* __restrict y, const double* __restrict x, double* __restrict angle, int count) {
  double ys[4] = {};
  double xs[4] = {};
  double angles[4];
  for (int i = 0; i < count; ++i) {
    ys[i] = y[i];
    xs[i] = x[i];
  }
  atan2ByFour(ys, xs, angles, 4);
  for (int i = 0; i < count; ++i) angle[i] = angles[i];
}

bool hasFour() {
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
}

#endif

}  // namespace

void atan2Many(const double* __restrict y, const double* __restrict x, double* __restrict angle, int count) {
#if defined(__x86_64__) && defined(__GNUC__)
  if (hasFour()) return count >= 4 ? atan2ByFour(y, x, angle, count) : atan2OfFew(y, x, angle, count);
#endif
  atan2ByTwo(y, x, angle, count);
}

}  // namespace screwline

#include "screwline/spatial/atan2.h"

#include <cstdint>

#include "screwline/spatial/atan2_kernel.h"

namespace screwline {
namespace {

using Pair = double __attribute__((vector_size(16)));
using PairBits = std::uint64_t __attribute__((vector_size(16)));

}  // namespace

void atan2Many(const double* __restrict y, const double* __restrict x, double* __restrict angle, int count) {
  for (int i = 0; i < count; i += 2) {
    const int second = i + 1 < count ? i + 1 : i;
    const Pair ys = {y[i], y[second]};
    const Pair xs = {x[i], x[second]};
    Pair angles;
    atan2Kernel<PairBits>(ys, xs, angles);
    angle[i] = angles[0];
    angle[second] = angles[1];
  }
}

}  // namespace screwline

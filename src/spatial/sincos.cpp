#include "screwline/spatial/sincos.h"

#include <cstdint>

#include "screwline/spatial/sincos_kernel.h"

namespace screwline {

void sincosMany(const double* __restrict angle, double* __restrict sine, double* __restrict cosine, int count) {
  for (int i = 0; i < count; ++i) sincosKernel<std::uint64_t>(angle[i], sine[i], cosine[i]);
}

}  // namespace screwline

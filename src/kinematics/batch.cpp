#include "screwline/kinematics/batch.h"

#include "batch_kernel.h"
#include "screwline/kinematics/row_pieces.h"

namespace screwline {
namespace {

constexpr std::size_t kRowsOfPiece = 1024;  // A multiple of every number of lanes: only the last block is filled up.
constexpr std::size_t kLeastPieces = 8;     // A tenth of a millisecond: a thread's start takes about as long.

using Sweep = void (*)(const SerialChain&, const ForwardBatch&, std::size_t, std::size_t);

// The one source, compiled for each kind of processor; which one runs is decided when it runs.
void sweepTwo(const SerialChain& chain, const ForwardBatch& batch, std::size_t first, std::size_t last) {
  sweepRows<2>(chain, batch, first, last);
}

#if defined(__x86_64__) && defined(__GNUC__)

[[gnu::target("avx2,fma")]] void sweepFour(const SerialChain& chain, const ForwardBatch& batch, std::size_t first,
                                           std::size_t last) {
  sweepRows<4>(chain, batch, first, last);
}

[[gnu::target("avx512f,avx512dq,avx512vl")]] void sweepEight(const SerialChain& chain, const ForwardBatch& batch,
                                                             std::size_t first, std::size_t last) {
  sweepRows<8>(chain, batch, first, last);
}

Sweep sweepFor(int most_lanes) {
  if (most_lanes >= 8 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl")) {
    return sweepEight;
  }
  if (most_lanes >= 4 && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return sweepFour;
  return sweepTwo;
}

#else

Sweep sweepFor(int) {
  return sweepTwo;
}

#endif

}  // namespace

bool forwardBatch(const SerialChain& chain, const ForwardBatch& batch, const BatchOptions& options) {
  const Sweep sweep = sweepFor(options.lanes == 0 ? 8 : options.lanes);
  const auto work = [&](std::size_t first, std::size_t last) { sweep(chain, batch, first, last); };
  return forPieces({batch.count, kRowsOfPiece, kLeastPieces, options.threads}, options.cancelled, std::cref(work));
}

}  // namespace screwline

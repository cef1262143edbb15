#include "screwline/symbolic/progress.h"

#include <utility>

namespace screwline {

ProgressWatch::ProgressWatch(Progress progress)
    : progress_(std::move(progress)), start_(std::chrono::steady_clock::now()) {}

void ProgressWatch::begin(const std::string& stage) const {
  poll();
  if (progress_.report) progress_.report(stage);
}

void ProgressWatch::poll() const {
  if (progress_.cancelled && progress_.cancelled()) throw DerivationStopped("the derivation was cancelled");
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start_;
  if (passed.count() > progress_.time_limit) throw DerivationStopped("the derivation took longer than its time limit");
}

}  // namespace screwline

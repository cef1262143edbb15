#ifndef SCREWLINE_SYMBOLIC_PROGRESS_H
#define SCREWLINE_SYMBOLIC_PROGRESS_H

#include <chrono>
#include <functional>
#include <limits>
#include <string>

#include "screwline/exception.h"

namespace screwline {

/// A derivation did not come to its end: it was cancelled, its time was up, or the expressions grew beyond what is
/// handled. The message says which.
class DerivationStopped : public Exception {
 public:
  using Exception::Exception;
};

/// How a derivation tells of its progress and is stopped.
struct Progress {
  std::function<void(const std::string& stage)> report;  ///< Called as each stage begins; may be empty.
  std::function<bool()> cancelled;  ///< Asked every few milliseconds, from the deriving thread; may be empty.
  double time_limit = std::numeric_limits<double>::infinity();  ///< [s] from the call on.
};

/// Watches one derivation. Not shared by threads.
class ProgressWatch {
 public:
  explicit ProgressWatch(Progress progress = {});
  void begin(const std::string& stage) const;
  /// @throws DerivationStopped where the derivation is to end.
  void poll() const;

 private:
  Progress progress_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace screwline

#endif  // SCREWLINE_SYMBOLIC_PROGRESS_H

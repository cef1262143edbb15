#include "screwline/kinematics/row_pieces.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <system_error>
#include <thread>
#include <vector>

namespace screwline {
namespace {

using Stop = std::function<bool()>;
using Work = std::function<void(std::size_t, std::size_t)>;

/// Hands out pieces, in order, until there are none or one of the threads had to stop.
class Dispenser {
 public:
  Dispenser(const RowPieces& pieces, const Work& work) : pieces_(pieces), work_(work) {}

  bool stopped() const { return stopped_; }

  /// Works until nothing is left.
  void take(const Stop& stop) {
    while (!stopped_) {
      const std::size_t first = next_.fetch_add(pieces_.rows);
      if (first >= pieces_.count) return;
      if (stop && stop()) {
        stopped_ = true;
        return;
      }
      work_(first, std::min(first + pieces_.rows, pieces_.count));
    }
  }

  /// The same, keeping what is thrown.
  void take(const Stop& stop, std::exception_ptr& error) {
    try {
      take(stop);
    } catch (...) {
      stopped_ = true;
      error = std::current_exception();
    }
  }

 private:
  const RowPieces& pieces_;
  const Work& work_;
  std::atomic<std::size_t> next_{0};
  std::atomic<bool> stopped_{false};
};

std::size_t helpersFor(const RowPieces& pieces) {
  const std::size_t most =
      pieces.threads > 0 ? static_cast<std::size_t>(pieces.threads) : std::max(1U, std::thread::hardware_concurrency());
  const std::size_t worth = pieces.count / pieces.rows / pieces.least_pieces;
  return std::min(most, std::max<std::size_t>(worth, 1)) - 1;
}

}  // namespace

bool forPieces(const RowPieces& pieces, const Stop& stop, const Work& work) {
  Dispenser dispenser(pieces, work);
  const std::size_t helper_count = helpersFor(pieces);
  if (helper_count == 0) {
    dispenser.take(stop);
    return !dispenser.stopped();
  }
  std::vector<std::exception_ptr> errors(helper_count + 1);
  std::vector<std::thread> helpers;
  helpers.reserve(helper_count);
  try {
    while (helpers.size() < helper_count) {
      std::exception_ptr& error = errors[helpers.size()];
      helpers.emplace_back([&dispenser, &error] { dispenser.take({}, error); });
    }
  } catch (const std::system_error&) {
    // The system has no more threads: those that run suffice.
  }
  dispenser.take(stop, errors.back());
  for (std::thread& helper : helpers) helper.join();
  for (const std::exception_ptr& error : errors)
    if (error) std::rethrow_exception(error);
  return !dispenser.stopped();
}

}  // namespace screwline

#include "screwline/ik/batch.h"

#include <algorithm>
#include <atomic>
#include <chrono>

#include "ik_request_check.h"
#include "screwline/exception.h"
#include "screwline/kinematics/row_pieces.h"

namespace screwline {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kPosesOfPiece = 16;
constexpr double kLongestTime = 1e7;  // s

/// A batch on its way.
class Run {
 public:
  Run(const InverseKinematics& solver, const IkBatchRequest& request)
      : solver_(solver),
        request_(request),
        end_(Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                std::chrono::duration<double>(std::min(request.time, kLongestTime)))),
        pieces_((request.count + kPosesOfPiece - 1) / kPosesOfPiece) {
    result_.counts.resize(request.count);
    result_.complete.resize(request.count);
  }

  IkBatchResult finish() {
    const auto work = [this](std::size_t first, std::size_t last) { solve(first, last); };
    forPieces({request_.count, kPosesOfPiece, 1, request_.threads}, request_.cancelled, work);
    result_.not_begun = request_.count - begun_;
    result_.timed_out = timed_out_;
    result_.without_solution = static_cast<std::size_t>(std::count(result_.counts.begin(), result_.counts.end(), 0U));
    result_.positions.reserve(numbers_);
    for (std::vector<double>& piece : pieces_) {
      result_.positions.insert(result_.positions.end(), piece.begin(), piece.end());
      std::vector<double>().swap(piece);  // No piece is held twice for long: they may be many.
    }
    return std::move(result_);
  }

 private:
  void solve(std::size_t first, std::size_t last) {
    IkRequest question = request_.each;
    std::vector<double>& positions = pieces_[first / kPosesOfPiece];
    for (std::size_t row = first; row < last; ++row) {
      if (Clock::now() >= end_) {
        timed_out_ = true;
        return;
      }
      ++begun_;
      question.target = request_.targets[row];
      const IkResult answer = solver_.solve(question);
      if (answer.timed_out) timed_out_ = true;
      result_.counts[row] = static_cast<std::uint32_t>(answer.solutions.size());
      result_.complete[row] = answer.complete ? 1 : 0;
      for (const IkAnswer& solution : answer.solutions) {
        positions.insert(positions.end(), solution.position.data(),
                         solution.position.data() + solution.position.size());
      }
    }
    numbers_ += positions.size();
    if (numbers_ <= request_.most_numbers) return;
    throw InputError(AnswerCode::kTooLarge, "the solutions have more than " + std::to_string(request_.most_numbers) +
                                                " numbers, the most that an answer may have; ask for fewer poses or "
                                                "set max_solutions");
  }

  const InverseKinematics& solver_;
  const IkBatchRequest& request_;
  const Clock::time_point end_;
  IkBatchResult result_;
  std::vector<std::vector<double>> pieces_;
  std::atomic<std::size_t> begun_{0};
  std::atomic<std::size_t> numbers_{0};
  std::atomic<bool> timed_out_{false};
};

/// All poses before the first is solved: which one is named does not depend on threads, and nothing is done in vain.
void checkTargets(const InverseKinematics& solver, const IkBatchRequest& request) {
  const std::vector<std::string> branches = solver.branches();
  IkRequest question = request.each;
  for (std::size_t row = 0; row < request.count; ++row) {
    question.target = request.targets[row];
    try {
      checkRequest(solver.chain(), solver.task(), question, branches);
    } catch (const InputError& error) {
      throw InputError(error.code(), "row " + std::to_string(row) + ": " + error.what());
    }
  }
}

}  // namespace

IkBatchResult solveBatch(const InverseKinematics& solver, const IkBatchRequest& request) {
  IkBatchRequest checked = request;
  checked.each.find_closest = false;
  checkTargets(solver, checked);
  return Run(solver, checked).finish();
}

}  // namespace screwline

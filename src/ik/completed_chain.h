#ifndef SCREWLINE_SRC_IK_COMPLETED_CHAIN_H
#define SCREWLINE_SRC_IK_COMPLETED_CHAIN_H

#include <optional>
#include <vector>

#include "screwline/model/serial_chain.h"
#include "screwline/model/task.h"

namespace screwline {

/// A chain with joints added, so that a whole pose has as many joints as rows. In front of it those that may take any
/// value: slides along the base's axes whose x y z the task leaves open, and a turn about the one whose rx ry rz it
/// does. Behind it locked ones, which only count at zero, and last a turn of the tool about the axis that a task
/// points, which may take any value. Where the chain's own last joint is that turn (slides along it apart), none is
/// added.
struct CompletedChain {
  SerialChain chain;
  Task rows;       ///< The whole pose, or the whole orientation.
  int first = 0;   ///< Where the chain's own joints begin,
  int own = 0;     ///< and how many they are.
  int locked = 0;  ///< How many of those behind them are locked.
  int turn = -1;   ///< The joint that turns the tool about its pointing axis, counted from `first`; -1: none.

  bool turnsByItself() const { return turn >= 0 && turn < own; }
};

/// The task's x y z, and rx ry rz for what turns.
Task wholeRowsOf(const Task& task);

/// Ways to complete a chain for a task, those first that are likely to give it a closed form: first without locked
/// joints, which leaves more rows than joints; then with as many as are missing, one or two of them placed where they
/// meet the chain's last axes. None where there are joints to spare, where nothing has to be added, or where the task
/// has one of rx ry rz only, or two of them and positions that a turn about the third moves.
std::vector<CompletedChain> completions(const SerialChain& chain, const Task& task);

/// The chain with what the task leaves open added, where that makes one joint more than a whole pose has rows: then the
/// task's solutions are the whole pose's self-motions. Empty elsewhere, and where nothing has to be added.
std::optional<CompletedChain> completionWithOneToSpare(const SerialChain& chain, const Task& task);

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_COMPLETED_CHAIN_H

#ifndef SCREWLINE_SRC_IK_COMPLETED_CHAIN_H
#define SCREWLINE_SRC_IK_COMPLETED_CHAIN_H

#include <vector>

#include "screwline/model/serial_chain.h"
#include "screwline/model/task.h"

namespace screwline {

/// A chain with joints added behind it, so that a whole pose has as many joints as rows: locked ones, which only count
/// at zero, and last a turn of the tool about the axis that a task points, which may take any value. Where the chain's
/// own last joint is that turn (slides along it apart), none is added.
struct CompletedChain {
  SerialChain chain;
  int own = 0;     ///< Joints of the chain itself; those behind are added.
  int locked = 0;  ///< How many of these are locked: own, own + 1, ...
  int turn = -1;   ///< The joint that turns the tool about its pointing axis; -1: the task is whole.

  bool turnsByItself() const { return turn >= 0 && turn < own; }
};

/// The rows of a whole pose (or orientation) that stand for the task: its x y z, and rx ry rz for what turns.
Task wholeRowsOf(const Task& task);

/// Ways to complete a chain for a task, those first that are likely to give it a closed form: first without locked
/// joints, which leaves more rows than joints; then with as many as are missing (two at most), placed where they meet
/// the chain's last axes. None where the task has neither a whole orientation nor a pointing axis, has some of x y z
/// only, where it is whole and nothing has to be added, or where there are joints to spare.
std::vector<CompletedChain> completions(const SerialChain& chain, const Task& task);

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_COMPLETED_CHAIN_H

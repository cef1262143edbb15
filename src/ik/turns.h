#ifndef SCREWLINE_SRC_IK_TURNS_H
#define SCREWLINE_SRC_IK_TURNS_H

#include <vector>

#include "screwline/model/serial_chain.h"

namespace screwline {

/// Turns beyond this many for one solution are refused (all_turns on wide limits).
constexpr std::size_t kMaxTurns = 10000;

/// [rad, m] Members of continua are held against limits no finer than this.
constexpr double kLimitBand = 1e-9;

/// A configuration with its revolute values brought to the turns asked for.
struct Turned {
  VectorX q;
  bool within_limits = false;
};

/// The turn inside the limits nearest to the seed (or, without one, to the value wrapped to (-pi, pi]); where no turn
/// is inside, the nearest of all. Values beyond a limit by at most `band` are put on it: rounding does not decide.
Turned chooseTurns(const SerialChain& chain, const VectorX& q, const VectorX& reference, bool has_seed,
                   bool ignore_limits, double band);

/// Every combination of full turns inside the limits; of a joint without limits (and of any, where limits are ignored)
/// the chosen turn only.
/// @throws InputError (kTooLarge) beyond kMaxTurns.
std::vector<VectorX> allTurns(const SerialChain& chain, const VectorX& chosen, bool ignore_limits, double band);

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_TURNS_H

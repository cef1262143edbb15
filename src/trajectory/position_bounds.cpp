#include "position_bounds.h"

namespace screwline {
void keepPositions(const StateToState&, StateToStateMotion&) {}
}  // namespace screwline

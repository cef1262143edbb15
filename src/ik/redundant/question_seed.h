#ifndef SCREWLINE_SRC_IK_REDUNDANT_QUESTION_SEED_H
#define SCREWLINE_SRC_IK_REDUNDANT_QUESTION_SEED_H

#include "screwline/ik/redundant/self_motion_solver.h"

namespace screwline {

/// The seed, or zero clamped into the limits.
inline VectorX seedOf(const SerialChain& chain, const SelfMotionQuestion& question) {
  return question.seed.size() > 0 ? question.seed : chain.clamped(VectorX::Zero(chain.size()));
}

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_REDUNDANT_QUESTION_SEED_H

#ifndef SCREWLINE_MODEL_URDF_READER_H
#define SCREWLINE_MODEL_URDF_READER_H

#include <string>

#include "screwline/model/serial_chain.h"

namespace screwline {

/// Which chain of a robot to take; empty: found where there is only one.
struct ChainChoice {
  std::string base_link;
  std::string tip_link;
};

/// Reads the chain from base_link to tip_link out of a URDF document. Fixed joints are folded in; a mimic joint in the
/// chain becomes an axis of the joint that it mimics (which must be in the chain too); other links that move rigidly
/// with the chain are kept, so that their poses can be asked for. Acceleration and jerk limits, which URDF has not, are
/// assumed and marked so.
/// @throws ModelError: XML or URDF malformed, no moving joint, several chains and no choice, unknown links, floating or
/// planar joints in the chain, an axis that is zero or not finite, limits missing or the wrong way round.
SerialChain readUrdf(const std::string& urdf_xml, const ChainChoice& choice = {});

/// The same from a file. @throws ModelError also where it cannot be read.
SerialChain readUrdfFile(const std::string& path, const ChainChoice& choice = {});

}  // namespace screwline

#endif  // SCREWLINE_MODEL_URDF_READER_H

#ifndef SCREWLINE_TEST_CALIBRATED_H
#define SCREWLINE_TEST_CALIBRATED_H

#include <random>

#include "screwline/model/serial_chain.h"

namespace screwline {
namespace test {

/// Every axis turned by up to `angle` [rad] about each direction and moved by up to `length` [m].
inline SerialChain calibrated(const SerialChain& chain, double angle, double length, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto vector = [&] { return Vector3(unit(random), unit(random), unit(random)); };
  ChainDescription description;
  description.name = chain.name();
  description.base_link = chain.baseLink();
  description.tip_link = chain.tipLink();
  description.joints = chain.joints();
  description.axes = chain.axes();
  for (Axis& axis : description.axes) {
    axis.direction = (axis.direction + angle * vector().cross(axis.direction)).normalized();
    axis.point += length * vector();
  }
  description.home = chain.home();
  description.links = {{chain.tipLink(), chain.size(), description.home}};
  return SerialChain(description);
}

}  // namespace test
}  // namespace screwline

#endif  // SCREWLINE_TEST_CALIBRATED_H

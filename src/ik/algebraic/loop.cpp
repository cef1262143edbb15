#include "loop.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>
#include <Eigen/QR>

namespace screwline {
namespace {

using Factor = std::array<DualQuaternion, 2>;  ///< A joint's motion: [0] times the cosine plus [1] times the sine.
using Products = std::array<DualQuaternion, 4>;

Factor factorOf(const Loop& loop, int joint, const DualQuaternion& closure) {
  const DualQuaternion& S = loop.screws[static_cast<std::size_t>(joint)];
  if (joint == 0) return {closure, multiply(closure, S)};
  DualQuaternion one = DualQuaternion::Zero();
  one[0] = 1.0;
  return {one, S};
}

Products product(const Factor& a, const Factor& b) {
  return {multiply(a[0], b[0]), multiply(a[0], b[1]), multiply(a[1], b[0]), multiply(a[1], b[1])};
}

}  // namespace

Loop::Loop(const SerialChain& chain) {
  int turns = 0;
  for (const Axis& axis : chain.axes()) {
    if (axis.prismatic) continue;
    origin += axis.point;
    ++turns;
  }
  if (turns > 0) origin /= turns;
  double spread = 0.0;
  for (const Axis& axis : chain.axes()) {
    if (!axis.prismatic) spread = std::max(spread, (axis.point - origin).norm());
  }
  length = std::max(spread, 0.1 * chain.characteristicLength());
  for (std::size_t i = 0; i < 6; ++i) {
    axes[i] = chain.axes()[i];
    axes[i].point = (axes[i].point - origin) / length;
    screws[i] = screwOf(axes[i]);
    multipliers[static_cast<Eigen::Index>(i)] = axes[i].multiplier;
  }
  home_inverse = chain.home().inverse();
}

Pose Loop::motion(const Pose& target) const {
  Pose X = target * home_inverse;
  X.p = (X.p + X.R * origin - origin) / length;
  return X;
}

double Loop::displacement(int joint, const JointParameter& parameter) const {
  if (!axes[static_cast<std::size_t>(joint)].prismatic) return 2.0 * std::atan2(parameter[1], parameter[0]);
  return 2.0 * length * parameter[1] / parameter[0];
}

LoopSystem::LoopSystem(const Loop& loop, const Labelling& labelling, const DualQuaternion& closure) {
  const auto factor = [&](int place) { return factorOf(loop, (labelling.pair_first + place) % 6, closure); };
  const Products pair = product(factor(0), factor(1));
  const Products left = product(factor(2), factor(3));
  const Products right = product(factor(4), factor(5));
  for (int i = 0; i < 4; ++i) pair_products.col(i) = conjugate(pair[static_cast<std::size_t>(i)]);
  for (int i = 0; i < 16; ++i) {
    // The hidden joint's bit goes to the front, the others keep their order.
    const int place = 3 - labelling.hidden_place;
    const int column = (((i >> place) & 1) << 3) | ((i >> (place + 1)) << place) | (i & ((1 << place) - 1));
    products.col(column) = multiply(left[static_cast<std::size_t>(i / 4)], right[static_cast<std::size_t>(i % 4)]);
  }
  const Eigen::HouseholderQR<Eigen::Matrix<double, 8, 4>> factorization(pair_products);
  const Eigen::Matrix<double, 8, 8> Q = factorization.householderQ();
  cosine_part.noalias() = Q.rightCols<4>().transpose() * products.leftCols<8>();
  sine_part.noalias() = Q.rightCols<4>().transpose() * products.rightCols<8>();
}

void LoopSystem::solvePair(const JointParameter& hidden, const std::array<JointParameter, 3>& unknowns,
                           JointParameter& first, JointParameter& second) const {
  DualQuaternion motion = DualQuaternion::Zero();
  for (int i = 0; i < 16; ++i) {
    const double factor = hidden[i >> 3] * unknowns[0][(i >> 2) & 1] * unknowns[1][(i >> 1) & 1] * unknowns[2][i & 1];
    motion += factor * products.col(i);
  }
  const Eigen::Matrix4d normal = pair_products.transpose() * pair_products;
  splitProduct(normal.inverse() * (pair_products.transpose() * motion), first, second);
}

void splitProduct(const Eigen::Vector4d& product, JointParameter& first, JointParameter& second) {
  Eigen::Index largest = 0;
  product.cwiseAbs().maxCoeff(&largest);
  const Eigen::Index row = largest / 2;
  const Eigen::Index column = largest % 2;
  second = JointParameter(product[2 * row], product[2 * row + 1]).normalized();
  first = JointParameter(product[column], product[2 + column]).normalized();
}

}  // namespace screwline

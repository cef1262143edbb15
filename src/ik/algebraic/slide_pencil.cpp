#include "slide_pencil.h"

#include <cmath>

#include <Eigen/LU>
#include <Eigen/SVD>

namespace screwline {
namespace {

double determinantOf(const Vector3& a, const Vector3& b, const Vector3& c) {
  return a.dot(b.cross(c));
}

constexpr int kVanishingSamples = 7;
constexpr double kVanishing = 1e-14;  ///< Determinant over the fourth power of the entries' size.

/// Places of the two slides beside the turn.
constexpr int kSlides[3][2] = {{1, 2}, {0, 2}, {0, 1}};

}  // namespace

Eigen::Matrix4d SlidePencil::minorsAt(double angle, Linear& constant, Linear& slope) const {
  const LoopSystem::Coefficients equations = system_->at({std::cos(0.5 * angle), std::sin(0.5 * angle)});
  const int turn = 4 >> turn_;
  const int first = 4 >> kSlides[turn_][0];
  const int second = 4 >> kSlides[turn_][1];
  constant << equations.col(0), equations.col(first), equations.col(second);
  slope << equations.col(turn), equations.col(turn + first), equations.col(turn + second);
  Eigen::Matrix4d minors;
  for (int left_out = 0; left_out < 4; ++left_out) {
    Matrix3 A;
    Matrix3 B;
    for (int row = 0; row < 3; ++row) {
      A.row(row) = constant.row(row < left_out ? row : row + 1);
      B.row(row) = slope.row(row < left_out ? row : row + 1);
    }
    const Vector3 a = A.col(0), b = A.col(1), c = A.col(2);
    const Vector3 d = B.col(0), e = B.col(1), f = B.col(2);
    minors.row(left_out) << determinantOf(a, b, c),
        determinantOf(d, b, c) + determinantOf(a, e, c) + determinantOf(a, b, f),
        determinantOf(a, e, f) + determinantOf(d, b, f) + determinantOf(d, e, c), determinantOf(d, e, f);
  }
  return minors;
}

bool SlidePencil::vanishes() const {
  Linear constant;
  Linear slope;
  for (int i = 0; i < kVanishingSamples; ++i) {
    const Eigen::Matrix4d minors = minorsAt(0.5 + kTwoPi * i / kVanishingSamples, constant, slope);
    const double scale = minors.norm();
    if (std::abs(minors.determinant()) > kVanishing * scale * scale * scale * scale) return false;
  }
  return true;
}

TrigonometricPolynomial SlidePencil::determinant(const CircleMap&) const {
  std::array<double, kTrigonometricSamples> values;
  Linear constant;
  Linear slope;
  for (int i = 0; i < kTrigonometricSamples; ++i) {
    values[static_cast<std::size_t>(i)] = minorsAt(kTwoPi * i / kTrigonometricSamples, constant, slope).determinant();
  }
  return TrigonometricPolynomial(values);
}

std::array<JointParameter, 3> SlidePencil::unknownsAt(double angle) const {
  Linear constant;
  Linear slope;
  const Eigen::JacobiSVD<Eigen::Matrix4d> svd(minorsAt(angle, constant, slope), Eigen::ComputeFullV);
  const Eigen::Vector4d powers = svd.matrixV().col(3);  // 1, x, x^2, x^3
  const JointParameter x =
      (powers.head<2>().squaredNorm() > powers.tail<2>().squaredNorm() ? powers.head<2>() : powers.tail<2>())
          .normalized();
  const Linear equations = x[0] * constant + x[1] * slope;
  const Eigen::JacobiSVD<Matrix3> linear(equations.transpose() * equations, Eigen::ComputeFullV);
  const Vector3 slides = linear.matrixV().col(2);  // 1, y, z
  std::array<JointParameter, 3> unknowns;
  unknowns[static_cast<std::size_t>(turn_)] = x;
  unknowns[static_cast<std::size_t>(kSlides[turn_][0])] = {slides[0], slides[1]};
  unknowns[static_cast<std::size_t>(kSlides[turn_][1])] = {slides[0], slides[2]};
  return unknowns;
}

std::array<std::array<JointParameter, 3>, 2> SlidePencil::doubleUnknownsAt(double angle,
                                                                           const LoopSystem::Coefficients&) const {
  return {{unknownsAt(angle - 1e-6), unknownsAt(angle + 1e-6)}};
}

}  // namespace screwline

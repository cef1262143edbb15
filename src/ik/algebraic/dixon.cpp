#include "dixon.h"

#include <algorithm>
#include <cmath>

#include <Eigen/SVD>

#include "singular_matrix.h"

namespace screwline {
namespace {

using Bivector = Eigen::Matrix<double, 6, 1>;

/// a ^ b in four dimensions: 01, 02, 03, 12, 13, 23.
Bivector wedge(const Eigen::Vector4d& a, const Eigen::Vector4d& b) {
  Bivector w;
  w << a[0] * b[1] - a[1] * b[0], a[0] * b[2] - a[2] * b[0], a[0] * b[3] - a[3] * b[0], a[1] * b[2] - a[2] * b[1],
      a[1] * b[3] - a[3] * b[1], a[2] * b[3] - a[3] * b[2];
  return w;
}

/// The bivector that gives u ^ v = u . dual(v).
Bivector dual(const Bivector& v) {
  Bivector w;
  w << v[5], -v[4], v[3], v[2], -v[1], v[0];
  return w;
}

constexpr double kLeastCrowded = 0.5;  ///< Below it roots are not spread.
constexpr double kLargestStretch = 20.0;
constexpr double kAround = 0.3;  ///< [rad] beside the center, which may be a root itself.

constexpr double kTwoRoots = 1e-6;  ///< Of the largest singular value: the second smallest where two roots are.
constexpr double kClear = 1e-3;     ///< What rounding does to a double root is less.

using Monomials = Eigen::Matrix<double, 3, 2>;  ///< (1, x, x^2) times (1, y), in the rows and columns.

Monomials monomialsOf(const Vector6& v) {
  Monomials m;
  m << v[0], v[1], v[2], v[3], v[4], v[5];
  return m;
}

/// Of the squares, the larger pair of neighbours.
void splitMonomials(const Monomials& m, JointParameter& square, JointParameter& other) {
  const int first = m.row(0).squaredNorm() >= m.row(2).squaredNorm() ? 0 : 1;
  splitProduct({m(first, 0), m(first, 1), m(first + 1, 0), m(first + 1, 1)}, square, other);
}

/// The real parts of (s : t) with a s^2 + b s t + c t^2 = 0.
std::array<Eigen::Vector2d, 2> binaryRoots(double a, double b, double c) {
  const double root = std::sqrt(std::max(b * b - 4.0 * a * c, 0.0));
  const double q = -0.5 * (b + std::copysign(root, b));
  return {{{q, a}, {c, q}}};
}

/// Of the vectors s u + t v those that are monomials: all that vanishes for these are quadratic forms in s and t, and
/// where there are two such vectors, multiples of one form.
class MonomialPlane {
 public:
  MonomialPlane(const Monomials& u, const Monomials& v) : u_(u), v_(v) {
    Forms forms;
    Eigen::Index count = 0;
    const auto add = [&](Eigen::Index i, Eigen::Index j, Eigen::Index k, Eigen::Index l) {  // m_i m_j - m_k m_l
      const auto at = [](const Monomials& m, Eigen::Index place) { return m(place / 2, place % 2); };
      forms.col(count++) << at(u, i) * at(u, j) - at(u, k) * at(u, l),
          at(u, i) * at(v, j) + at(v, i) * at(u, j) - at(u, k) * at(v, l) - at(v, k) * at(u, l),
          at(v, i) * at(v, j) - at(v, k) * at(v, l);
    };
    add(0, 3, 1, 2);  // Of 1, y, x, x y, x^2, x^2 y: all pairs with the same product.
    add(2, 5, 3, 4);
    add(0, 5, 1, 4);
    add(0, 5, 2, 3);
    add(0, 4, 2, 2);
    add(1, 5, 3, 3);
    Eigen::Index largest = 0;
    const double square = forms.colwise().squaredNorm().maxCoeff(&largest);
    form_ = forms.col(largest);
    clarity_ = std::sqrt(square);
    agree_ = (forms - form_ * (form_.transpose() * forms) / square).norm() < kClear * clarity_;
  }

  /// How well the two are told; 0: the whole plane looks like monomials.
  double clarity() const { return clarity_; }

  bool isClearlyComplex() const {
    const double discriminant = form_[1] * form_[1] - 4.0 * form_[0] * form_[2];
    return agree_ && clarity_ > kClear && discriminant < -kClear * form_.squaredNorm();
  }

  std::array<Monomials, 2> monomials() const {
    const std::array<Eigen::Vector2d, 2> weights = binaryRoots(form_[0], form_[1], form_[2]);
    return {{weights[0][0] * u_ + weights[0][1] * v_, weights[1][0] * u_ + weights[1][1] * v_}};
  }

 private:
  using Forms = Eigen::Matrix<double, 3, 6>;

  Monomials u_;
  Monomials v_;
  Eigen::Vector3d form_;
  double clarity_ = 0.0;
  bool agree_ = false;
};

/// A left null vector, (1, y) times (1, z, z^2), as a right one.
Vector6 transposed(const Vector6& v) {
  Vector6 w;
  w << v[0], v[3], v[1], v[4], v[2], v[5];
  return w;
}

/// z where equations that are linear in it have the common root: two columns that are multiples of each other.
JointParameter commonRoot(const Eigen::Vector4d& constant, const Eigen::Vector4d& linear) {
  const double along = constant.dot(linear);
  return constant.squaredNorm() > linear.squaredNorm() ? JointParameter(-along, constant.squaredNorm()).normalized()
                                                       : JointParameter(linear.squaredNorm(), -along).normalized();
}

constexpr int kVanishingSamples = 7;
constexpr double kVanishing = 1e-12;  ///< Last pivot over the first.

constexpr double kSines[5] = {0.0, 0.951056516295153572, 0.587785252292473129, -0.587785252292473129,
                              -0.951056516295153572};
constexpr double kCosines[5] = {1.0, 0.309016994374947424, -0.809016994374947424, -0.809016994374947424,
                                0.309016994374947424};

}  // namespace

DixonMatrix dixonMatrix(const LoopSystem::Coefficients& m) {
  // The determinant of the equations at (x, y, z), (i, y, z), (i, j, z), (i, j, k), divided by (x-i)(y-j)(z-k), has
  // the columns A(y, z), B(i, z), C(i, j), E(i, j). By Laplace it is (A ^ B) ^ (C ^ E), in monomials.
  std::array<std::array<Bivector, 2>, 6> ab;  // [3 b + k][a] of y^b z^k i^a
  for (auto& row : ab) row = {Bivector::Zero(), Bivector::Zero()};
  for (int z = 0; z < 2; ++z) {
    for (int w = 0; w < 2; ++w) {
      const auto k = static_cast<std::size_t>(z + w);
      ab[k][0] += wedge(m.col(4 + z), m.col(2 + w));
      ab[k][1] += wedge(m.col(4 + z), m.col(6 + w));
      ab[3 + k][0] += wedge(m.col(6 + z), m.col(2 + w));
    }
  }
  std::array<Bivector, 6> ce;  // [2 i + j], dual
  ce.fill(Bivector::Zero());
  for (int c = 0; c < 4; ++c) {
    for (int e = 0; e < 4; ++e) {
      if ((c & e & 1) != 0) continue;  // j^2 cancels.
      const auto place = static_cast<std::size_t>(2 * ((c >> 1) + (e >> 1)) + (c & 1) + (e & 1));
      ce[place] += dual(wedge(m.col(2 * c + 1), m.col(2 * e)));
    }
  }
  DixonMatrix D;
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column) {
      const auto& [constant, linear] = ab[static_cast<std::size_t>(row)];
      double entry = constant.dot(ce[static_cast<std::size_t>(column)]);
      if (column >= 2 && row < 3) entry += linear.dot(ce[static_cast<std::size_t>(column - 2)]);
      D(row, column) = entry;
    }
  }
  return D;
}

DixonPencil::DixonPencil(const LoopSystem& system) {
  for (DixonMatrix& harmonic : harmonics_) harmonic.setZero();
  for (int i = 0; i < 5; ++i) {
    const double half = kPi * i / 5.0;
    const DixonMatrix D = dixonMatrix(system.at({std::cos(half), std::sin(half)}));
    const int twice = (2 * i) % 5;
    harmonics_[0] += 0.2 * D;
    harmonics_[1] += (0.4 * kCosines[i]) * D;
    harmonics_[2] += (0.4 * kSines[i]) * D;
    harmonics_[3] += (0.4 * kCosines[twice]) * D;
    harmonics_[4] += (0.4 * kSines[twice]) * D;
  }
}

DixonMatrix DixonPencil::at(double cosine, double sine) const {
  return harmonics_[0] + cosine * harmonics_[1] + sine * harmonics_[2] +
         ((cosine - sine) * (cosine + sine)) * harmonics_[3] + (2.0 * sine * cosine) * harmonics_[4];
}

TrigonometricPolynomial DixonPencil::determinant(const CircleMap& map) const {
  std::array<double, kTrigonometricSamples> values;
  for (int i = 0; i < kTrigonometricSamples; ++i) {
    const double image = kTwoPi * i / kTrigonometricSamples;
    const double angle = map.angle(image);
    values[static_cast<std::size_t>(i)] =
        determinantOf(at(std::cos(angle), std::sin(angle))) * std::pow(map.slope(image), -8);
  }
  return TrigonometricPolynomial(values);
}

/// Where all roots are about one place, the eighth root of a form of degree 16 is about 1 - b cos(angle - place); with
/// roots at a distance 1 / stretch, it is stretch^2 times as large on the other side.
CircleMap DixonPencil::spread() const {
  constexpr int kSamples = kTrigonometricSamples / 2;
  const auto sizeAt = [this](double angle) {
    return std::sqrt(std::sqrt(std::sqrt(std::abs(determinantOf(at(std::cos(angle), std::sin(angle)))))));
  };
  double mean = 0.0;
  double cosine = 0.0;
  double sine = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    const double angle = kTwoPi * i / kSamples;
    const double size = sizeAt(angle);
    mean += size;
    cosine -= 2.0 * size * std::cos(angle);
    sine -= 2.0 * size * std::sin(angle);
  }
  if (!(std::hypot(cosine, sine) > kLeastCrowded * mean)) return {};
  const double center = std::atan2(sine, cosine);
  const double near = std::max({sizeAt(center - kAround), sizeAt(center), sizeAt(center + kAround)});
  const double stretch = std::sqrt(sizeAt(center + kPi) / std::max(near, 1e-300));
  return {center, std::clamp(stretch, 1.0, kLargestStretch)};
}

bool DixonPencil::vanishes() const {
  for (int i = 0; i < kVanishingSamples; ++i) {
    const double angle = 0.5 + kTwoPi * i / kVanishingSamples;
    if (nullVectorsOf(at(std::cos(angle), std::sin(angle))).pivot_ratio > kVanishing) return false;
  }
  return true;
}

std::array<JointParameter, 3> DixonPencil::unknownsAt(double angle) const {
  const NullVectors null = nullVectorsOf(at(std::cos(angle), std::sin(angle)));
  std::array<JointParameter, 3> unknowns;
  splitMonomials(monomialsOf(transposed(null.left)), unknowns[2], unknowns[1]);
  splitMonomials(monomialsOf(null.right), unknowns[0], unknowns[1]);
  return unknowns;
}

std::optional<std::array<std::array<JointParameter, 3>, 2>> DixonPencil::doubleUnknownsAt(
    double angle, const LoopSystem::Coefficients& equations) const {
  const Eigen::JacobiSVD<DixonMatrix> svd(at(std::cos(angle), std::sin(angle)),
                                          Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vector6 sigma = svd.singularValues();
  const MonomialPlane right(monomialsOf(svd.matrixV().col(4)), monomialsOf(svd.matrixV().col(5)));
  const MonomialPlane left(monomialsOf(transposed(svd.matrixU().col(4))),
                           monomialsOf(transposed(svd.matrixU().col(5))));
  // On one side the two may be the same.
  const bool by_right = right.clarity() >= left.clarity();
  const MonomialPlane& plane = by_right ? right : left;
  if (sigma[4] < kTwoRoots * sigma[0] && sigma[3] > kClear * sigma[0] && plane.isClearlyComplex()) return std::nullopt;
  std::array<std::array<JointParameter, 3>, 2> both;
  const std::array<Monomials, 2> monomials = plane.monomials();
  for (std::size_t i = 0; i < 2; ++i) {
    std::array<JointParameter, 3>& unknowns = both[i];
    const std::size_t known = by_right ? 0 : 2;
    splitMonomials(monomials[i], unknowns[known], unknowns[1]);
    // Columns of x^i y^j z^k at 4 i + 2 j + k.
    const int stride = by_right ? 4 : 1;
    const int other = by_right ? 1 : 4;
    Eigen::Vector4d constant = Eigen::Vector4d::Zero();
    Eigen::Vector4d linear = Eigen::Vector4d::Zero();
    for (int place = 0; place < 4; ++place) {
      const int column = stride * (place / 2) + 2 * (place % 2);
      const double factor = unknowns[known][place / 2] * unknowns[1][place % 2];
      constant += factor * equations.col(column);
      linear += factor * equations.col(column + other);
    }
    unknowns[2 - known] = commonRoot(constant, linear);
  }
  return both;
}

}  // namespace screwline

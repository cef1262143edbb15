#include "pose_curve.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <cmath>

#include "screwline/spatial/rotation.h"
#include "screwline/spatial/screw.h"

namespace screwline {
namespace {

constexpr int kMaxSteps = 12;
constexpr double kRounding = 4e-15;        // Residuals that steps would not lessen, in units of 1 and the length.
constexpr double kLastStep = 1e-11;        // A Newton step that is shorter is the last one.
constexpr double kNoise = 1e-13;           // Of tangents, times the gain.
constexpr double kLeastGain = 1e-9;        // Below it tangents are not asked for.
constexpr double kGoodEnough = 1e-12;      // Where rounding of a large chain or a near singularity stops the steps.
constexpr double kSecondWeakest = 1e-4;    // Gain of the third weakest direction, below which more than two are weak.
constexpr double kSecondOrderStep = 1e-5;  // [rad] Error 1e-10, noise 1e-11.

/// Householder QR of J^T: null vector and least-norm steps of one factorisation.
class Factor {
 public:
  explicit Factor(const Eigen::Matrix<double, 6, kRedundantJoints>& J) : qr_(J.transpose()) {
    const auto& R = qr_.matrixQR();
    tangent_ = Vector7::Unit(6);
    tangent_.applyOnTheLeft(qr_.householderQ());
    // Sign of det [J^T, tangent].
    bool negative = qr_.colsPermutation().determinant() < 0;
    for (int i = 0; i < 6; ++i) {
      if (qr_.hCoeffs()[i] != 0.0) negative = !negative;
      if (R(i, i) < 0.0) negative = !negative;
    }
    if (negative) tangent_ = -tangent_;
  }

  double gain() const { return std::abs(qr_.matrixQR()(5, 5)); }
  const Vector7& tangent() const { return tangent_; }

  /// J x = e, x of least norm; pivots below a share of the first are left out.
  Vector7 step(const Vector6& e, double negligible) const {
    const auto& R = qr_.matrixQR();
    const Vector6 rhs = qr_.colsPermutation().transpose() * e;
    Vector7 y = Vector7::Zero();
    for (int i = 0; i < 6; ++i) {
      double sum = rhs[i];
      for (int k = 0; k < i; ++k) sum -= R(k, i) * y[k];
      if (std::abs(R(i, i)) > negligible * std::abs(R(0, 0))) y[i] = sum / R(i, i);
    }
    y.applyOnTheLeft(qr_.householderQ());
    return y;
  }

 private:
  Eigen::ColPivHouseholderQR<Eigen::Matrix<double, kRedundantJoints, 6>> qr_;
  Vector7 tangent_;
};

}  // namespace

PoseCurve::PoseCurve(const SerialChain& chain, const Pose& target, std::shared_ptr<const ArmPose> arm)
    : chain_(chain), target_(target), arm_(std::move(arm)), J_(6, 7) {
  for (int i = 0; i < kRedundantJoints; ++i) unit_[i] = isRevolute(i) ? 1.0 : chain.characteristicLength();
  weight_ = unit_.cwiseProduct(unit_).cwiseInverse();
}

bool PoseCurve::correctAbove(double share, const Vector7& q, double reach, SelfMotionNode& node) {
  const double length = chain_.characteristicLength();
  node.q = q;
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kMaxSteps; ++i) {
    Vector6 error = poseDifference(target_, geometricJacobian(chain_, node.q, J_));
    error.head<3>() /= length;
    const Factor factor(scaledJacobian());
    node.tangent = factor.tangent().cwiseProduct(unit_);
    node.gain = factor.gain();
    node.noise = kNoise / std::max(node.gain, kLeastGain);
    const double size = error.norm();
    if (size <= kRounding || (size <= kGoodEnough && size > 0.25 * before)) return true;
    node.q += factor.step(error, share).cwiseProduct(unit_);
    if (!(norm(node.q - q) <= reach)) return false;
    // What is left is the square of the step, and the tangent of the point before differs by the step.
    if (size <= kLastStep * node.gain) return true;
    before = size;
  }
  return before <= kGoodEnough;
}

double PoseCurve::errorAt(const Vector7& q) {
  Vector6 error = poseDifference(target_, forwardKinematics(chain_, q));
  error.head<3>() /= chain_.characteristicLength();
  return error.norm();
}

PoseCurve::ScaledJacobian PoseCurve::scaledJacobian() const {
  ScaledJacobian scaled;
  for (int k = 0; k < kRedundantJoints; ++k) scaled.col(k) = unit_[k] * J_.col(k);
  scaled.topRows<3>() /= chain_.characteristicLength();
  return scaled;
}

double PoseCurve::gainAt(const Vector7& q) {
  geometricJacobian(chain_, q, J_);
  return Factor(scaledJacobian()).gain();
}

PoseCurve::SecondOrder PoseCurve::secondOrder(const Vector7& q) {
  geometricJacobian(chain_, q, J_);
  const Eigen::JacobiSVD<ScaledJacobian> svd(scaledJacobian(), Eigen::ComputeFullU | Eigen::ComputeFullV);
  SecondOrder form;
  const Eigen::Matrix<double, kRedundantJoints, 2> plane = svd.matrixV().rightCols<2>();
  form.plane = unit_.asDiagonal() * plane;
  form.gain = svd.singularValues()[5];
  form.next_gain = svd.singularValues()[4];
  if (form.next_gain < kSecondWeakest) return form;
  const Vector6 away = svd.matrixU().col(5);
  Eigen::Matrix2d Q;
  for (int k = 0; k < 2; ++k) {
    const Vector7 step = kSecondOrderStep * unit_.cwiseProduct(plane.col(k));
    geometricJacobian(chain_, q + step, J_);
    const ScaledJacobian ahead = scaledJacobian();
    geometricJacobian(chain_, q - step, J_);
    Q.row(k) = away.transpose() * (ahead - scaledJacobian()) * plane / (2.0 * kSecondOrderStep);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(0.5 * (Q + Q.transpose()));
  const int first = std::abs(eigen.eigenvalues()[0]) <= std::abs(eigen.eigenvalues()[1]) ? 0 : 1;
  for (int k = 0; k < 2; ++k) {
    const int from = (first + k) % 2;
    form.values[k] = eigen.eigenvalues()[from];
    form.slopes[k] = form.gain * eigen.eigenvectors()(0, from);
    form.vectors.col(k) = unit_.asDiagonal() * (plane * eigen.eigenvectors().col(from));
  }
  form.is_known = true;
  return form;
}

bool PoseCurve::between(const SelfMotionNode& a, const SelfMotionNode& b, double share, SelfMotionNode& node) {
  const double span = b.arc - a.arc;
  if (arm_ != nullptr && std::isfinite(a.angle) && std::isfinite(b.angle)) {
    // The arm angle as a cubic of the arc; where the two ways of a group meet, the cubic of the joints decides.
    const double r = 1.0 - share;
    const double angle = r * r * (1.0 + 2.0 * share) * a.angle + share * share * (1.0 + 2.0 * r) * b.angle +
                         span * share * r * (r * a.angle_rate - share * b.angle_rate);
    arm_->at(arm_->elbowOf(a), angle, nullptr, cubicBetween(a, b, share), node);
    node.gain = gainAt(node.q);
    node.arc = a.arc + share * span;
    return true;
  }
  if (!correct(cubicBetween(a, b, share), 0.5 * span + 1e-9, node)) return false;
  if (dot(node.tangent, a.tangent + b.tangent) < 0.0) node.tangent = -node.tangent;
  node.arc = a.arc + share * span;
  return true;
}

Vector7 PoseCurve::difference(const Vector7& a, const Vector7& b) const {
  Vector7 d = b - a;
  for (int i = 0; i < kRedundantJoints; ++i) {
    if (std::abs(d[i]) > kPi && isRevolute(i)) d[i] = std::remainder(d[i], kTwoPi);
  }
  return d;
}

Vector7 cubicBetween(const SelfMotionNode& a, const SelfMotionNode& b, double share) {
  const double h = b.arc - a.arc;
  const double s = share;
  const double r = 1.0 - share;
  return r * r * (1.0 + 2.0 * s) * a.q + s * s * (1.0 + 2.0 * r) * b.q + h * s * r * (r * a.tangent - s * b.tangent);
}

}  // namespace screwline

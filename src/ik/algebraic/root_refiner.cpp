#include "root_refiner.h"

#include <algorithm>
#include <cmath>

#include "screwline/kinematics/kernel_sweep.h"
#include "screwline/spatial/rotation.h"
#include "screwline/spatial/small_svd.h"
#include "screwline/spatial/weak_directions.h"
#include "singular_matrix.h"

namespace screwline {
namespace {

constexpr int kMaxSteps = 60;
constexpr double kAccepted = 1e-11;      ///< Error of a solution.
constexpr double kExact = 2e-15;         ///< Error that is rounding.
constexpr double kNoise = 8.0 * kExact;  ///< Error that steps may fail to lessen.
constexpr double kNearlyExact = 1e-13;   ///< Error that a step of any kind takes to rounding.
constexpr double kHalfWay = 1e-14;       ///< Error above which a solution may stand between two.
constexpr double kLongestStep = 0.5;     ///< [rad], [lengths] of Newton's method.
constexpr double kShortStep = 1e-8;      ///< [rad], [lengths] If it gains nothing, what is left is rounding.
constexpr double kLinear = 0.05;         ///< Of the error: Newton's method leaves less, but where solutions meet.
constexpr double kSame = 1e-6;           ///< [rad], [m] or [lengths]
constexpr double kMaybeSame = 1e-3;      ///< Closer than this, the middle decides.
constexpr double kNearSingular = 1e-3;   ///< Pivot ratio below which a mate is looked for.
constexpr double kFarthestMate = 0.5;    ///< [rad], [lengths]
constexpr double kDouble = 1e-5;         ///< Least over largest singular value: of two that are apart by kSame, or by
                                         ///< what rounding hides, it is below 1e-6.
constexpr double kBent = 1e-3;           ///< Second derivative of the residual at a fold: of more, third ones are less.
constexpr double kSingular = 1e-6;       ///< Singular value below which a continuum is looked for.
constexpr double kContinuumStep = 1e-2;  ///< [rad], [lengths]

Vector3 smallRotationVector(const Matrix3& R) {
  const Vector3 twice(R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1));
  return R.trace() > 2.9 ? Vector3(0.5 * twice) : rotationVector(R);
}

}  // namespace

RootRefiner::RootRefiner(const SerialChain& chain, double length, const Pose& target, AlgebraicSolutions& solutions)
    : chain_(chain), length_(length), target_(target), solutions_(solutions) {
  for (Eigen::Index i = 0; i < 6; ++i) {
    if (chain_.kernel().axes[static_cast<std::size_t>(i)].prismatic) unit_[i] = length_;
  }
}

void RootRefiner::evaluate(const Vector6& q, Point& point) const {
  Eigen::Matrix<double, 3, 6> z;
  Eigen::Matrix<double, 3, 6> p;
  Eigen::Index i = 0;
  const Pose X = sweepKernel(chain_.kernel(), q.data(), [&](const AxisKernel&, const Vector3& axis, const Vector3& at) {
    z.col(i) = axis;
    p.col(i) = at;
    ++i;
  });
  const double unit = 1.0 / length_;
  for (i = 0; i < 6; ++i) {
    const AxisKernel& axis = chain_.kernel().axes[static_cast<std::size_t>(i)];
    // A slide is measured in lengths here, as positions are.
    if (axis.prismatic) {
      point.J.col(i) << axis.multiplier * z.col(i), Vector3::Zero();
    } else {
      point.J.col(i) << (axis.multiplier * unit) * z.col(i).cross(X.p - p.col(i)), axis.multiplier * z.col(i);
    }
  }
  point.residual << unit * (target_.p - X.p), smallRotationVector(target_.R * X.R.transpose());
  point.error = point.residual.norm();
}

/// @param q the point's.
RootRefiner::Fold RootRefiner::foldAt(const Vector6& q, const Point& point) const {
  constexpr double kProbe = 1e-4;
  const WeakDirections weak = weakDirectionsOf(SmallMatrix(point.J), point.J.norm());
  Fold fold;
  fold.u = weak.U.col(1);
  fold.n = weak.V.col(1);
  fold.sigma = weak.sigma[1];
  fold.largest = weak.largest;
  fold.is_only_one = weak.sigma[0] > kNearSingular * weak.largest;
  Point probe;
  evaluate(q + (kProbe * fold.n).cwiseProduct(unit_), probe);
  fold.bend = (probe.J - point.J) * fold.n / kProbe;
  fold.kappa = fold.u.dot(fold.bend);
  return fold;
}

/// To the nearer root of the parabola (where it has none, to its vertex), and to what the other directions ask for.
bool RootRefiner::stepAcross(const Point& point, const Fold& fold, Vector6& step) {
  const double r = fold.u.dot(point.residual);
  const double discriminant = fold.sigma * fold.sigma + 2.0 * fold.kappa * r;
  const double sum = fold.sigma + std::sqrt(std::max(0.0, discriminant));
  const double t = discriminant > 0.0 ? 2.0 * r / sum : -fold.sigma / fold.kappa;
  const Matrix6 regular = point.J + fold.u * fold.n.transpose();
  const Vector6 others = point.residual - (0.5 * t * t) * fold.bend;
  if (!solveLinear(regular, others - fold.u.dot(others) * fold.u, step)) return false;
  step += t * fold.n;
  return step.norm() <= kLongestStep;
}

/// Newton's step; where these are long or gain little, as where two solutions are about to meet, with the second
/// derivative in that direction. False where neither helps.
bool RootRefiner::undampedStep(const Vector6& q, const Point& point, Convergence& so_far, Vector6& step) const {
  so_far.crosses = false;
  if (!so_far.is_slow && !so_far.newton_fails) {
    if (solveLinear(point.J, point.residual, step) && step.norm() <= kLongestStep) return true;
    so_far.newton_fails = true;
  }
  if (so_far.may_cross && point.error > kNearlyExact) {
    const Fold fold = foldAt(q, point);
    so_far.may_cross = fold.is_only_one;
    so_far.crosses = so_far.may_cross && stepAcross(point, fold, step);
    if (so_far.crosses) return true;
  }
  return !so_far.newton_fails && solveLinear(point.J, point.residual, step) && step.norm() <= kLongestStep;
}

/// Undamped steps as long as they gain, then damped ones.
bool RootRefiner::refine(Vector6& q, Point& best) const {
  evaluate(q, best);
  Point point;
  Convergence so_far;
  double damping = 0.0;
  int gained_nothing = 0;
  for (int k = 0; k < kMaxSteps && best.error > kExact; ++k) {
    Vector6 step;
    const bool is_damped = damping > 0.0 || !undampedStep(q, best, so_far, step);
    if (is_damped) {
      if (damping == 0.0) damping = 1e-2 * best.error * best.error + 1e-30;
      const Matrix6 normal = best.J.transpose() * best.J + damping * Matrix6::Identity();
      if (!solveLinear(normal, best.J.transpose() * best.residual, step)) return false;
      if (!(step.norm() <= kLongestStep)) step *= kLongestStep / step.norm();
    }
    if (!step.allFinite()) return false;
    const Vector6 next = q + step.cwiseProduct(unit_);
    evaluate(next, point);
    const double before = best.error;
    if (point.error < before) {
      q = next;
      best = point;
    }
    const double length = step.norm();
    if (length < 1e-16) break;
    if (best.error < 0.9 * before) {
      gained_nothing = 0;
      damping = damping > 1e-20 ? 0.1 * damping : 0.0;
      so_far.newton_fails = false;
      so_far.is_slow = best.error > kLinear * before;
      so_far.may_cross = so_far.may_cross && !(so_far.crosses && so_far.is_slow);
      continue;
    }
    const bool is_rounding = best.error < kNoise || (!is_damped && length < kShortStep);
    if (best.error < kAccepted && (is_rounding || ++gained_nothing > 2)) break;
    if (is_damped) {
      damping = std::max(10.0 * damping, 1e-6 * best.error);
      if (damping > 1e6) break;
    } else if (so_far.crosses) {
      so_far.may_cross = false;
    } else {
      so_far.newton_fails = true;
    }
  }
  return best.error <= kAccepted;
}

Vector6 RootRefiner::difference(const Vector6& to, const Vector6& from) const {
  Vector6 d = to - from;
  for (Eigen::Index i = 0; i < 6; ++i) {
    const AxisKernel& axis = chain_.kernel().axes[static_cast<std::size_t>(i)];
    if (axis.prismatic) {
      d[i] /= length_;
    } else if (!(std::abs(d[i] * axis.multiplier) <= kPi)) {
      d[i] = std::remainder(d[i], kTwoPi / axis.multiplier);
    }
  }
  return d;
}

bool RootRefiner::isSame(const Vector6& a, const Vector6& b) const {
  const Vector6 apart = difference(a, b);
  Vector6 middle = b;
  double distance = 0.0;  // Of slides in m or lengths, whichever is more.
  double farthest = 1.0;  // Rounding grows with the way that slides go.
  for (Eigen::Index i = 0; i < 6; ++i) {
    const bool prismatic = chain_.kernel().axes[static_cast<std::size_t>(i)].prismatic;
    middle[i] += 0.5 * apart[i] * (prismatic ? length_ : 1.0);
    distance = std::max(distance, std::abs(apart[i]) * (prismatic ? std::min(length_, 1.0) : 1.0));
    if (prismatic) farthest = std::max(farthest, std::abs(middle[i]) / length_);
  }
  if (distance <= kSame) return true;
  if (distance > kMaybeSame) return false;
  // Where the middle is a solution as well, rounding leaves open where between the two the solution lies.
  Point point;
  evaluate(middle, point);
  return point.error <= kNoise * farthest;
}

int RootRefiner::multiplicity(int place) const {
  const auto solution = [this](int i) -> Vector6 {
    return Eigen::Map<const Vector6>(solutions_.q[static_cast<std::size_t>(i)].data());
  };
  const Vector6 q = solution(place);
  Point point;
  evaluate(q, point);
  if (nullVectorsOf(point.J).pivot_ratio > kNearSingular) return 1;
  const Fold fold = foldAt(q, point);
  if (fold.sigma > kDouble * fold.largest) return 1;
  if (!fold.is_only_one || std::abs(fold.kappa) < kBent) return 0;
  int beside = 0;
  for (int i = 0; i < solutions_.count; ++i) {
    if (i != place && difference(q, solution(i)).norm() < kMaybeSame) ++beside;
  }
  return beside > 1 ? 0 : 2 - beside;
}

bool RootRefiner::isKnown(const Vector6& q) const {
  return std::any_of(solutions_.begin(), solutions_.end(), [&](const std::array<double, 6>& known) {
    return isSame(q, Eigen::Map<const Vector6>(known.data()));
  });
}

void RootRefiner::insert(const Vector6& q) {
  if (isKnown(q)) return;
  if (solutions_.count == static_cast<int>(solutions_.q.size())) {
    solutions_.degenerate = true;
    return;
  }
  std::array<double, 6>& place = solutions_.q[static_cast<std::size_t>(solutions_.count++)];
  for (std::size_t i = 0; i < 6; ++i) {
    const AxisKernel& axis = chain_.kernel().axes[i];
    const double value = q[static_cast<Eigen::Index>(i)];
    place[i] = axis.prismatic ? value : wrapAngle(value * axis.multiplier) / axis.multiplier;
  }
}

void RootRefiner::add(Vector6 q) {
  if (!q.allFinite() || q.cwiseAbs().maxCoeff() > kMaxMagnitude) return;
  Point point;
  if (!refine(q, point) || isKnown(q)) return;
  if (nullVectorsOf(point.J).pivot_ratio > kNearSingular) {
    insert(q);
  } else {
    addFold(q, point);
  }
}

/// The residual of a fold vanishes twice, once at q; or on both sides of it, where Newton's method has stopped half way
/// between two.
void RootRefiner::addFold(const Vector6& q, const Point& point) {
  const Fold fold = foldAt(q, point);
  const double left = fold.u.dot(point.residual);
  const double root = std::sqrt(fold.sigma * fold.sigma + 2.0 * fold.kappa * left);
  const double sum = fold.sigma + root;
  bool itself = true;
  for (const double t : {2.0 * left / sum, -sum / fold.kappa}) {
    if (!(std::abs(t) > kSame && std::abs(t) < kFarthestMate)) continue;
    Vector6 other = q + (t * fold.n).cwiseProduct(unit_);
    Point there;
    if (!refine(other, there)) continue;
    itself = itself && (point.error <= kHalfWay || there.error > point.error || isSame(other, q));
    insert(other);
  }
  if (itself) insert(q);
}

bool RootRefiner::continues(const Vector6& q, const Vector6& direction) const {
  for (const double side : {kContinuumStep, -kContinuumStep}) {
    Vector6 moved = q + (side * direction).cwiseProduct(unit_);
    Point point;
    if (!refine(moved, point)) return false;
    const double distance = difference(moved, q).norm();
    if (!(distance > 0.5 * kContinuumStep && distance < 2.0 * kContinuumStep)) return false;
    if (weakDirectionsOf(SmallMatrix(point.J), point.J.norm()).sigma[1] > kSingular) return false;
  }
  return true;
}

void RootRefiner::findContinua() {
  for (const std::array<double, 6>& known : solutions_) {
    const Vector6 q = Eigen::Map<const Vector6>(known.data());
    Point point;
    evaluate(q, point);
    if (nullVectorsOf(point.J).pivot_ratio > 10.0 * kSingular) continue;
    const Fold fold = foldAt(q, point);
    if (fold.sigma > kSingular) continue;
    // Other directions make up for the residual across u only: where it is bent along u, the root is a double one.
    if (fold.is_only_one && std::abs(fold.kappa) > kBent) continue;
    if (continues(q, fold.n)) {
      solutions_.degenerate = true;
      return;
    }
  }
}

}  // namespace screwline

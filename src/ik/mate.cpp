#include "mate.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "candidate.h"
#include "numerical/task_residual.h"
#include "screwline/ik/closed_form/roots.h"

namespace screwline {
namespace {

constexpr double kNearSingular = 1e-3;   // Smallest over largest singular value.
constexpr double kTwiceSingular = 1e-4;  // The same for the second smallest.
constexpr double kOnContinuum = 1e-11;   // Below it rounding is the model,
constexpr double kStraight = 1e-5;       // if the residual is not bent either.
constexpr double kProbe = 1e-4;          // [rad, m]
constexpr double kFarthest = 0.05;       // [rad, m]
constexpr double kExact = 1e-13;         // [m, rad]
constexpr double kRounding = 4e-16;      // [m, rad] Residuals that steps would not lessen.
constexpr int kMaxSteps = 20;
constexpr double kNoise = 1e-15;      // Of 1 and the chain's length: residuals of rounding.
constexpr double kFarAlong = 0.05;    // [rad, m] What is told from others at all is told from those so far away.
constexpr double kMisplaced = 1e-4;   // [rad, m] No rounding moves a root of a residual that is bent so far.
constexpr double kRecognised = 0.25;  // Of the way to the next root: what is nearer is this one.

using Plane = Eigen::Vector2d;
using Bordered = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 8, 8>;
using BorderedVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 8, 1>;

/// Residual along the weak directions, r - s t - t^T K t / 2; the second component is that of the weakest.
struct Reduced {
  Plane r;
  Plane s;
  std::array<Eigen::Matrix2d, 2> K;
};

/// The roots of one unknown.
std::vector<Plane> rootsOfOne(const Reduced& reduced) {
  const double r = reduced.r[1];
  const double sigma = reduced.s[1];
  const double kappa = reduced.K[1](1, 1);
  const double discriminant = sigma * sigma + 2.0 * kappa * r;
  if (!(discriminant > 0.0)) return {};
  const double sum = sigma + std::sqrt(discriminant);
  return {{0.0, 2.0 * r / sum}, {0.0, -sum / kappa}};
}

/// k + b y + a y^2 whose coefficients are polynomials in x.
struct Conic {
  Conic(double r, const Plane& slope, const Eigen::Matrix2d& K)
      : k{r, -slope[0], -0.5 * K(0, 0)}, b{-slope[1], -K(0, 1)}, a(-0.5 * K(1, 1)) {}
  std::array<double, 3> k;
  std::array<double, 2> b;
  double a;
};

template <std::size_t M, std::size_t N>
std::array<double, M + N - 1> product(const std::array<double, M>& f, const std::array<double, N>& g) {
  std::array<double, M + N - 1> fg{};
  for (std::size_t i = 0; i < M; ++i) {
    for (std::size_t k = 0; k < N; ++k) fg[i + k] += f[i] * g[k];
  }
  return fg;
}

template <std::size_t N>
std::array<double, N> combination(double a, const std::array<double, N>& f, double b, const std::array<double, N>& g) {
  std::array<double, N> sum{};
  for (std::size_t i = 0; i < N; ++i) sum[i] = a * f[i] + b * g[i];
  return sum;
}

/// The points that two conics share: the resultant that eliminates y is a quartic in x. The axes are turned first, so
/// that points which are mirror images in the old ones do not share an x.
std::vector<Plane> rootsOfTwo(const Reduced& reduced) {
  Eigen::Matrix2d turn;
  turn << 0.8, -0.6, 0.6, 0.8;
  const auto conic = [&](Eigen::Index i) {
    const Plane slope = reduced.s[i] * turn.row(i).transpose();
    return Conic(reduced.r[i], slope, turn.transpose() * reduced.K[static_cast<std::size_t>(i)] * turn);
  };
  const Conic f = conic(0);
  const Conic g = conic(1);
  const std::array<double, 3> ak = combination(f.a, g.k, -g.a, f.k);
  const std::array<double, 2> ab = combination(f.a, g.b, -g.a, f.b);
  const std::array<double, 4> bk = combination(1.0, product(f.b, g.k), -1.0, product(g.b, f.k));
  const std::array<double, 5> resultant = combination(1.0, product(ak, ak), -1.0, product(ab, bk));
  std::vector<Plane> roots;
  for (const RealRoot& root : solvePolynomial(resultant.data(), 4, 0.0)) {
    const double x = root.value;
    const double y = -(ak[0] + x * (ak[1] + x * ak[2])) / (ab[0] + x * ab[1]);
    if (std::isfinite(y)) roots.push_back(turn * Plane(x, y));
  }
  return roots;
}

/// Newton's method from a start to a solution within `reach` of q.
bool refine(TaskResidual& residual, const JointVector& q, double reach, TaskPoint& point) {
  JointVector best = point.q;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < kMaxSteps; ++k) {
    residual.evaluate(point);
    const double size = point.residual.norm();
    if (size < least) {
      least = size;
      best = point.q;
    } else if (least <= kExact) {
      break;
    }
    if (size <= kRounding) break;
    point.q += SmallMatrix(point.J).partialPivLu().solve(point.residual);
    if (!((point.q - q).norm() <= reach)) break;  // Another one's.
  }
  point.q = best;
  return least <= kExact && (best - q).norm() <= reach;
}

Eigen::Index unknownsOf(const WeakDirections& weak) {
  const Eigen::Index count = weak.sigma.size();
  return count > 1 && weak.sigma[count - 2] < kTwiceSingular * weak.largest ? 2 : 1;
}

/// By differences of the Jacobian, which lose fewer digits than those of the residual.
/// @pre unknowns is 1 or 2; with 1 the reduced quantities of the first are left zero.
Reduced reducedAt(TaskResidual& residual, const TaskPoint& here, const WeakDirections& weak, Eigen::Index unknowns) {
  const Eigen::Index first = weak.sigma.size() - unknowns;
  const auto U = weak.U.rightCols(unknowns);
  const auto V = weak.V.rightCols(unknowns);
  Reduced reduced{Plane::Zero(), Plane::Zero(), {Eigen::Matrix2d::Zero(), Eigen::Matrix2d::Zero()}};
  for (Eigen::Index k = 0; k < unknowns; ++k) {
    TaskPoint ahead;
    ahead.q = here.q + kProbe * V.col(k);
    residual.evaluate(ahead);
    const SmallMatrix bend = U.transpose() * SmallMatrix((ahead.J - here.J) / kProbe) * V;
    for (Eigen::Index i = 0; i < unknowns; ++i) {
      Eigen::Matrix2d& K = reduced.K[static_cast<std::size_t>(2 - unknowns + i)];
      K.row(2 - unknowns + k).tail(unknowns) = bend.row(i);
    }
  }
  for (Eigen::Index i = 0; i < unknowns; ++i) {
    reduced.r[2 - unknowns + i] = U.col(i).dot(here.residual);
    reduced.s[2 - unknowns + i] = weak.sigma[first + i];
  }
  for (Eigen::Matrix2d& K : reduced.K) K = (0.5 * (K + K.transpose())).eval();
  return reduced;
}

double noiseOf(const TaskResidual& residual) {
  return kNoise * (1.0 + residual.chain().characteristicLength());
}

/// Whether the pose is met to rounding between two solutions too: it does not tell them apart.
bool areOne(TaskResidual& residual, const JointVector& a, const JointVector& b) {
  TaskPoint middle;
  middle.q = 0.5 * (a + b);
  residual.evaluateResidual(middle);
  return middle.residual.norm() <= noiseOf(residual);
}

/// Whether the pose is met to rounding a good way along a weak direction too: what the strong ones can make up for is
/// taken away, with the Jacobian bordered by the weak vectors, which is regular.
bool isFlatAlong(TaskResidual& residual, const TaskPoint& here, const WeakDirections& weak, Eigen::Index unknowns,
                 const SmallVector& direction) {
  const Eigen::Index n = here.q.size();
  Bordered A = Bordered::Zero(n + unknowns, n + unknowns);
  A.topLeftCorner(n, n) = here.J;
  A.topRightCorner(n, unknowns) = weak.U.rightCols(unknowns);
  A.bottomLeftCorner(unknowns, n) = weak.V.rightCols(unknowns).transpose();
  const Eigen::PartialPivLU<Bordered> across(A);
  TaskPoint point;
  point.q = here.q + kFarAlong * direction;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < kMaxSteps; ++k) {
    residual.evaluateResidual(point);
    const double size = point.residual.norm();
    if (!(size < 0.5 * least)) return false;
    if (size <= noiseOf(residual)) return true;
    least = size;
    BorderedVector right = BorderedVector::Zero(n + unknowns);
    right.head(n) = point.residual;
    point.q += across.solve(right).head(n);
  }
  return false;
}

/// The directions in the plane of two weak ones along which the more bent of the two components of the residual is
/// straight.
std::array<Plane, 2> straightDirections(const Reduced& reduced) {
  const bool first = reduced.K[0].squaredNorm() > reduced.K[1].squaredNorm();
  const Eigen::Matrix2d& K = reduced.K[first ? 0 : 1];
  const double root = std::sqrt(std::max(K(0, 1) * K(0, 1) - K(0, 0) * K(1, 1), 0.0));
  const double sum = -K(0, 1) - std::copysign(root, K(0, 1));
  return {{Plane(sum, K(0, 0)).normalized(), Plane(K(1, 1), sum).normalized()}};
}

/// Whether it is so along the weakest direction, or of two along one in which neither component is bent.
bool isFlat(TaskResidual& residual, const TaskPoint& here, const WeakDirections& weak, Eigen::Index unknowns,
            const Reduced& reduced) {
  const auto isStraight = [&reduced](const Plane& t) {
    return std::hypot(t.dot(reduced.K[0] * t), t.dot(reduced.K[1] * t)) < kStraight;
  };
  if (isStraight(Plane::UnitY())) return isFlatAlong(residual, here, weak, unknowns, weak.V.rightCols<1>());
  if (unknowns == 1) return false;
  const std::array<Plane, 2> straight = straightDirections(reduced);
  return std::any_of(straight.begin(), straight.end(),
                     [&](const Plane& t) { return isStraight(t) && isFlatAlong(residual, here, weak, 2, weak.V * t); });
}

/// How near to a root a solution has to be to be this one: nearer than to the other roots, and than q is.
double recognisedWithin(const std::vector<Plane>& roots, const Plane& root) {
  double nearest = root.norm();
  for (const Plane& other : roots) {
    if (&other != &root) nearest = std::min(nearest, (other - root).norm());
  }
  return kRecognised * nearest;
}

}  // namespace

bool isTold(const SerialChain& chain, const Task& task, const Pose& target, const VectorX& q,
            const WeakDirections& weak) {
  if (weak.sigma[weak.sigma.size() - 1] >= kOnContinuum) return true;
  TaskResidual residual(chain, task, target, 1.0);
  TaskPoint here;
  here.q = q;
  residual.evaluate(here);
  const Eigen::Index unknowns = unknownsOf(weak);
  return !isFlat(residual, here, weak, unknowns, reducedAt(residual, here, weak, unknowns));
}

SolutionsAbout solutionsAbout(const SerialChain& chain, const Task& task, const Pose& target, const VectorX& q,
                              const WeakDirections* known, const IsAtHand& at_hand) {
  TaskResidual residual(chain, task, target, 1.0);
  TaskPoint here;
  here.q = q;
  residual.evaluate(here);
  std::optional<WeakDirections> made;
  const WeakDirections& weak = known != nullptr ? *known : made.emplace(weakDirectionsOf(SmallSvd(here.J)));
  const Eigen::Index last = weak.sigma.size() - 1;
  SolutionsAbout about;
  if (weak.sigma[last] > kNearSingular * weak.largest) return about;
  const Eigen::Index unknowns = unknownsOf(weak);
  const Reduced reduced = reducedAt(residual, here, weak, unknowns);
  if (weak.sigma[last] < kOnContinuum) {
    about.is_told = !isFlat(residual, here, weak, unknowns, reduced);
    if (std::abs(reduced.K[1](1, 1)) < kStraight) return about;
  }
  std::vector<Plane> roots = unknowns == 1 ? rootsOfOne(reduced) : rootsOfTwo(reduced);
  std::sort(roots.begin(), roots.end(), [](const Plane& a, const Plane& b) { return a.norm() < b.norm(); });
  const auto others = std::find_if(roots.begin(), roots.end(), [](const Plane& t) { return t.norm() > kSameSolution; });
  bool itself = others != roots.begin();
  roots.erase(roots.begin(), others);
  for (const Plane& root : roots) {
    if (!(root.norm() < kFarthest)) break;
    TaskPoint point;
    point.q = here.q + root[1] * weak.V.col(last);
    if (unknowns == 2) point.q += root[0] * weak.V.col(last - 1);
    // Where q may be none itself, the root next to it decides; the others need not be found again.
    if (itself && at_hand(point.q, recognisedWithin(roots, root))) continue;
    if (!refine(residual, here.q, 2.0 * root.norm(), point)) continue;
    if (isSameConfiguration(chain, point.q, q) || areOne(residual, here.q, point.q)) {
      itself = true;
    } else {
      about.solutions.push_back(point.q);
    }
  }
  about.is_one = itself || about.solutions.empty() || (about.solutions.front() - q).norm() > kMisplaced;
  return about;
}

}  // namespace screwline

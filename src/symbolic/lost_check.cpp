#include "lost_check.h"

#include <algorithm>
#include <limits>

#include "choices.h"
#include "screwline/kinematics/forward.h"
#include "screwline/kinematics/jacobian.h"

namespace screwline {
namespace {

constexpr double kVanishing = 1e-6;  ///< A direction shorter than this says nothing there.

class LossCheck {
 public:
  explicit LossCheck(const LossPoints& given) : given_(given) {}

  /// The directions' wrenches at the tip in the base's axes as rows, scaled to length 1 (moments by the chain's own
  /// length). No rows where one of them vanishes.
  MatrixX wrenches(const std::vector<LostDirection>& directions, const VectorX& q, bool in_base) const {
    const std::vector<double> values = given_.exact.table.symbols.valuesAt(q);
    MatrixX rows(static_cast<Eigen::Index>(directions.size()), 6);
    for (std::size_t i = 0; i < directions.size(); ++i) {
      const LostDirection& direction = directions[i];
      const bool base = in_base && direction.in_base.rows > 0;
      const Pose X = poseOf(base ? 0 : direction.axes, q);
      const Vector3 f =
          base && direction.isTranslation() ? direction.in_base.evaluate(values) : direction.f.evaluate(values);
      const Vector3 n =
          base && direction.isRotation() ? direction.in_base.evaluate(values) : direction.n.evaluate(values);
      Vector6 wrench;
      wrench << X.R * f, X.R * n + (poseOf(direction.point, q).p - poseOf(given_.exact.size + 1, q).p).cross(X.R * f);
      wrench.tail<3>() /= given_.chain.characteristicLength();
      if (wrench.norm() < kVanishing) return MatrixX(0, 6);
      rows.row(static_cast<Eigen::Index>(i)) = wrench.normalized();
    }
    return rows;
  }

  /// What the directions have that the task's rows have not, and the work they do on the joints' twists.
  double deviationOf(const MatrixX& rows, const VectorX& q) const {
    const double length = given_.chain.characteristicLength();
    Matrix6X J;
    const Matrix3 R_BT = geometricJacobian(given_.chain, q, J).R;
    double worst = 0.0;
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
      const Vector6 row = rows.row(i).transpose();
      worst = std::max(worst, (row - given_.task.spread(given_.task.select(row, R_BT), R_BT)).norm());
    }
    const double size = std::max(J.norm(), length);
    J.bottomRows<3>() *= length;
    return std::max(worst, (rows * J).cwiseAbs().maxCoeff() / size);
  }

  Pose poseOf(int frame, const VectorX& q) const {
    if (frame == 0) return {};
    if (frame == given_.exact.size + 1) return forwardByExponentials(given_.chain, q);
    const TrigPose X = given_.exact.pose(0, frame);
    return {valuesOf(given_.exact, X.R, q), Vector3(valuesOf(given_.exact, X.p, q))};
  }

  /// As lossDeviation().
  double deviationOf(const std::vector<LostDirection>& directions, int lost) const {
    if (directions.empty() || static_cast<int>(directions.size()) != lost)
      return std::numeric_limits<double>::infinity();
    double worst = 0.0;
    int compared = 0;
    for (const VectorX& q : given_.points) {
      for (const bool in_base : {false, true}) {
        if (directions.front().at_rest) {
          worst = std::max(worst, deviationAtRest(directions.front(), q, in_base));
          ++compared;
          continue;
        }
        const MatrixX rows = wrenches(directions, q, in_base);
        if (rows.rows() == 0) continue;
        ++compared;
        if (!hasFullRank(rows)) return std::numeric_limits<double>::infinity();
        worst = std::max(worst, deviationOf(rows, q));
      }
    }
    return compared > 0 ? worst : std::numeric_limits<double>::infinity();
  }

  /// Of the turns that leave the point at rest, which are to be two.
  double deviationAtRest(const LostDirection& direction, const VectorX& q, bool in_base) const {
    const std::vector<double> values = given_.exact.table.symbols.valuesAt(q);
    const bool base = in_base && direction.in_base.rows > 0;
    const Vector3 n = base ? Vector3(direction.in_base.evaluate(values))
                           : Vector3(poseOf(direction.axes, q).R * direction.n.evaluate(values));
    Matrix6X J;
    const Pose X = geometricJacobian(given_.chain, q, J);
    J = movedReference(J, poseOf(direction.point, q).p - X.p);
    MatrixX turns(3, 0);
    for (Eigen::Index j = 0; j < J.cols(); ++j) {
      if (J.col(j).head<3>().norm() > kLossAgreement * given_.chain.characteristicLength()) continue;
      turns.conservativeResize(3, turns.cols() + 1);
      turns.rightCols<1>() = J.col(j).tail<3>();
    }
    if (turns.cols() != 3 || n.norm() < kVanishing) return std::numeric_limits<double>::infinity();
    return (turns.transpose() * n).cwiseAbs().maxCoeff() / n.norm();
  }

  const LossPoints& given_;
};

}  // namespace

double lossDeviation(const LossPoints& given, const std::vector<LostDirection>& directions, int lost) {
  return LossCheck(given).deviationOf(directions, lost);
}

}  // namespace screwline

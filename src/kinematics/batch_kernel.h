#ifndef SCREWLINE_KINEMATICS_BATCH_KERNEL_H
#define SCREWLINE_KINEMATICS_BATCH_KERNEL_H

#include <algorithm>

#include "batch_lanes.h"
#include "screwline/kinematics/batch.h"

namespace screwline {

/// A frame on its way along the axes of a chain in all lanes at once, and the Jacobian's columns that it leaves behind.
template <int kCount>
class LaneSweep {
 public:
  using Real = typename Lanes<kCount>::Real;
  using Bits = typename Lanes<kCount>::Bits;
  using Vector = LaneVector<Real>;

  [[gnu::always_inline]] explicit LaneSweep(const SerialChain& chain)
      : chain_(chain), joints_(chain.size()), axes_(static_cast<int>(chain.kernel().axes.size())) {}

  /// Along the chain; row r of the configurations begins at q + r * n.
  [[gnu::always_inline]] void run(const double* q, bool with_columns) {
    const ChainKernel& kernel = chain_.kernel();
    broadcast(kernel.base.R.data(), X_.x);
    broadcast(kernel.base.R.data() + 3, X_.y);
    broadcast(kernel.base.R.data() + 6, X_.z);
    broadcast(kernel.base.p.data(), X_.p);
    for (int i = 0; i < axes_; ++i) {
      const AxisKernel& axis = kernel.axes[static_cast<std::size_t>(i)];
      Real value;
      Lanes<kCount>::gather(q + axis.source, joints_, value);
      value *= axis.multiplier;
      step(axis, value);
      if (with_columns) keepAxis(i);
      if (axis.prismatic) addScaled(value, X_.z, X_.p);
    }
    attachTool(kernel.tool);
  }

  /// After run() with columns: 6 x n vectors, row-major.
  [[gnu::always_inline]] const Real* jacobian() {
    finishColumns();
    if (!chain_.hasMimic()) return columns_;
    for (int i = 0; i < 6 * joints_; ++i) joined_[i] = Real{};
    for (int i = 0; i < axes_; ++i) {
      const AxisKernel& axis = chain_.kernel().axes[static_cast<std::size_t>(i)];
      for (int row = 0; row < 6; ++row) {
        joined_[row * joints_ + axis.source] += axis.multiplier * columns_[row * axes_ + i];
      }
    }
    return joined_;
  }

  const LaneFrame<Real>& tip() const { return X_; }

 private:
  /// Trans(p) Rx(alpha) Rz(offset + value), see AxisKernel; a prismatic axis is not yet displaced by its value.
  [[gnu::always_inline]] void step(const AxisKernel& axis, const Real& value) {
    combine(axis.p.data(), X_.p);
    if (axis.sin_alpha != 0.0 || axis.cos_alpha != 1.0) turn(axis.cos_alpha, axis.sin_alpha, X_.y, X_.z);
    Real angle;
    broadcast(axis.offset, angle);
    if (!axis.prismatic) angle += value;
    Real sine;
    Real cosine;
    sincosKernel<Bits>(angle, sine, cosine);
    turn(cosine, sine, X_.x, X_.y);
  }

  /// The axis where it now is: its point in the rows of v, its direction in those of w.
  [[gnu::always_inline]] void keepAxis(int i) {
    store(i, 0, X_.p);
    store(i, 3, X_.z);
  }

  [[gnu::always_inline]] void finishColumns() {
    for (int i = 0; i < axes_; ++i) {
      const Vector w = {columns_[3 * axes_ + i], columns_[4 * axes_ + i], columns_[5 * axes_ + i]};
      if (chain_.kernel().axes[static_cast<std::size_t>(i)].prismatic) {
        store(i, 0, w);
        store(i, 3, Vector{});
        continue;
      }
      const Vector arm = {X_.p.x - columns_[i], X_.p.y - columns_[axes_ + i], X_.p.z - columns_[2 * axes_ + i]};
      store(i, 0, Vector{w.y * arm.z - w.z * arm.y, w.z * arm.x - w.x * arm.z, w.x * arm.y - w.y * arm.x});
    }
  }

  [[gnu::always_inline]] void store(int i, int row, const Vector& v) {
    columns_[row * axes_ + i] = v.x;
    columns_[(row + 1) * axes_ + i] = v.y;
    columns_[(row + 2) * axes_ + i] = v.z;
  }

  [[gnu::always_inline]] void attachTool(const Pose& tool) {
    LaneFrame<Real> tip = {{}, {}, {}, X_.p};
    combine(tool.p.data(), tip.p);
    combine(tool.R.data(), tip.x);
    combine(tool.R.data() + 3, tip.y);
    combine(tool.R.data() + 6, tip.z);
    X_ = tip;
  }

  /// sum += the frame's axes, weighted.
  [[gnu::always_inline]] void combine(const double* weights, Vector& sum) {
    addScaled(weights[0], X_.x, sum);
    addScaled(weights[1], X_.y, sum);
    addScaled(weights[2], X_.z, sum);
  }

  const SerialChain& chain_;
  const int joints_;
  const int axes_;
  LaneFrame<Real> X_;
  Real columns_[6 * kMaxJoints];
  Real joined_[6 * kMaxJoints];
};

/// The answers of one block: `rows` rows of the batch from `row` on.
template <int kCount>
[[gnu::always_inline]] inline void writeRows(const ForwardBatch& batch, std::size_t row, int rows, int joints,
                                             LaneSweep<kCount>& sweep) {
  using Real = typename Lanes<kCount>::Real;
  const LaneFrame<Real>& X = sweep.tip();
  if (batch.poses != nullptr) {
    Real pose[kPoseNumbers] = {X.p.x, X.p.y, X.p.z};
    quaternionOf(X, pose + 3);
    scatter<kCount>(pose, kPoseNumbers, rows, batch.poses + row * kPoseNumbers);
  }
  if (batch.frames != nullptr) {
    static_assert(sizeof(Pose) == 12 * sizeof(double), "a pose is R by columns, then p");
    const Real frame[12] = {X.x.x, X.x.y, X.x.z, X.y.x, X.y.y, X.y.z, X.z.x, X.z.y, X.z.z, X.p.x, X.p.y, X.p.z};
    scatter<kCount>(frame, 12, rows, batch.frames[row].R.data());
  }
  if (batch.jacobians == nullptr) return;
  const int numbers = 6 * joints;
  scatter<kCount>(sweep.jacobian(), numbers, rows, batch.jacobians + row * static_cast<std::size_t>(numbers));
}

/// Rows [first, last) of a batch, kCount at a time. The last of them are filled up with copies of the last one, so that
/// each row is computed alike.
template <int kCount>
[[gnu::always_inline]] inline void sweepRows(const SerialChain& chain, const ForwardBatch& batch, std::size_t first,
                                             std::size_t last) {
  LaneSweep<kCount> sweep(chain);
  const auto n = static_cast<std::size_t>(chain.size());
  double filled[kCount * kMaxJoints];
  for (std::size_t row = first; row < last; row += kCount) {
    const double* q = batch.positions + row * n;
    const std::size_t rows = std::min<std::size_t>(kCount, last - row);
    if (rows < kCount) {
      for (std::size_t i = 0; i < kCount; ++i) std::copy_n(q + std::min(i, rows - 1) * n, n, filled + i * n);
      q = filled;
    }
    sweep.run(q, batch.jacobians != nullptr);
    writeRows<kCount>(batch, row, static_cast<int>(rows), chain.size(), sweep);
  }
}

}  // namespace screwline

#endif  // SCREWLINE_KINEMATICS_BATCH_KERNEL_H

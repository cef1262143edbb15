#include "exact_chain.h"

#include <utility>

namespace screwline {
namespace {

RingPointer ringOf(const ExactTable& table, const Progress& progress) {
  std::vector<int> scalars;
  for (const SymbolKind wanted : {SymbolKind::kLength, SymbolKind::kSlide, SymbolKind::kRate, SymbolKind::kInput}) {
    for (int id = 0; id < table.symbols.size(); ++id) {
      if (table.symbols[id].kind == wanted) scalars.push_back(id);
    }
  }
  return std::make_shared<const TrigRing>(scalars, table.angle_groups, ProgressWatch(progress));
}

TrigPose identityPose(const RingPointer& ring) {
  return {TrigMatrix::identity(ring, 3), TrigMatrix(ring, 3, 1)};
}

/// cos and sin of an angle.
struct Circular {
  TrigPolynomial c;
  TrigPolynomial s;
};

Circular circularOf(const RingPointer& ring, const ExactAngle& angle) {
  return {TrigPolynomial::cosine(ring, angle.symbols, angle.steps),
          TrigPolynomial::sine(ring, angle.symbols, angle.steps)};
}

/// Rotation about coordinate axis `axis`.
TrigMatrix rotation(const RingPointer& ring, int axis, const ExactAngle& angle) {
  TrigMatrix R = TrigMatrix::identity(ring, 3);
  const Circular turn = circularOf(ring, angle);
  const int j = (axis + 1) % 3;
  const int k = (axis + 2) % 3;
  R(j, j) = turn.c;
  R(k, k) = turn.c;
  R(j, k) = -turn.s;
  R(k, j) = turn.s;
  return R;
}

}  // namespace

ExactChain::ExactChain(ExactTable known, const SerialChain& chain, const Progress& progress)
    : table(std::move(known)),
      size(static_cast<int>(table.rows.size())),
      joints(chain.size()),
      ring(ringOf(table, progress)),
      base(identityPose(ring)),
      tool(identityPose(ring)),
      reader(ring, table.symbols) {
  for (const Axis& axis : chain.axes()) {
    prismatic.push_back(axis.prismatic);
    drives.emplace_back(axis.source, static_cast<int>(axis.multiplier));
  }
  base = transformPose(table.base);
  tool = transformPose(table.tool);
  for (const ExactDhRow& row : table.rows) steps.push_back(rowPose(row));
  steps.front() = base * steps.front();
  steps.push_back(tool);
}

TrigPolynomial ExactChain::length(const ExactLength& length) const {
  TrigPolynomial sum(ring);
  for (const auto& [symbol, times] : length.symbols) sum += TrigPolynomial::scalar(ring, symbol).scaled(times);
  return sum;
}

TrigPose ExactChain::rowPose(const ExactDhRow& row) const {
  TrigPose about_x = identityPose(ring);
  about_x.R = rotation(ring, 0, row.alpha);
  about_x.p(0, 0) = length(row.a);
  TrigPose about_z = identityPose(ring);
  about_z.R = rotation(ring, 2, row.theta);
  about_z.p(2, 0) = length(row.d);
  return about_x * about_z;
}

TrigPose ExactChain::transformPose(const ExactTransform& transform) const {
  TrigPose X = identityPose(ring);
  X.R = rotation(ring, 2, transform.yaw) * rotation(ring, 1, transform.pitch) * rotation(ring, 0, transform.roll);
  X.p(0, 0) = length(transform.x);
  X.p(1, 0) = length(transform.y);
  X.p(2, 0) = length(transform.z);
  return X;
}

TrigPose ExactChain::pose(int reference, int frame) const {
  if (reference > frame) return pose(frame, reference).inverse();
  TrigPose X = identityPose(ring);
  for (int i = frame; i > reference; --i) X = steps[static_cast<std::size_t>(i - 1)] * X;
  return X;
}

TrigMatrix ExactChain::jacobian(int frame, int point) const {
  TrigMatrix J(ring, 6, joints);
  const TrigMatrix p_point = pose(frame, point).p;
  for (int i = 0; i < size; ++i) {
    const TrigPose X = pose(frame, i + 1);
    const TrigMatrix z = X.R.column(2);
    const bool slides = prismatic[static_cast<std::size_t>(i)];
    const TrigMatrix v = slides ? z : cross(z, p_point - X.p);
    const auto [joint, times] = drives[static_cast<std::size_t>(i)];
    for (int k = 0; k < 3; ++k) {
      J(k, joint) += v(k, 0).scaled(times);
      if (!slides) J(k + 3, joint) += z(k, 0).scaled(times);
    }
  }
  return J;
}

TrigPolynomial ExactChain::rate(int axis) const {
  const auto [joint, times] = drives[static_cast<std::size_t>(axis)];
  for (int id = 0; id < table.symbols.size(); ++id) {
    const Symbol& symbol = table.symbols[id];
    if (symbol.kind == SymbolKind::kRate && symbol.index == joint + 1)
      return TrigPolynomial::scalar(ring, id).scaled(times);
  }
  return TrigPolynomial(ring);
}

FormulaMatrix ExactChain::formula(const TrigMatrix& matrix) const {
  FormulaMatrix result{matrix.rows(), matrix.columns(), {}};
  for (int i = 0; i < matrix.rows(); ++i) {
    for (int j = 0; j < matrix.columns(); ++j) result.entries.push_back(formula(matrix(i, j)));
  }
  return result;
}

}  // namespace screwline

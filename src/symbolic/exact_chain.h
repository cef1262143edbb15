#ifndef SCREWLINE_SRC_SYMBOLIC_EXACT_CHAIN_H
#define SCREWLINE_SRC_SYMBOLIC_EXACT_CHAIN_H

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "readable.h"
#include "screwline/model/task.h"
#include "screwline/symbolic/symbolic_chain.h"
#include "trig_matrix.h"

namespace screwline {

/// An angle: symbols times whole numbers plus steps of 15 degrees.
struct ExactAngle {
  std::vector<std::pair<int, int>> symbols;
  int steps = 0;
};

/// A length: symbols times whole numbers; none: zero.
struct ExactLength {
  std::vector<std::pair<int, int>> symbols;
};

struct ExactDhRow {
  ExactAngle alpha;
  ExactLength a;
  ExactLength d;
  ExactAngle theta;
};

/// A rotation as Rz Ry Rx and a translation.
struct ExactTransform {
  ExactAngle yaw;
  ExactAngle pitch;
  ExactAngle roll;
  ExactLength x;
  ExactLength y;
  ExactLength z;
};

/// What a chain is in symbols, before any ring of polynomials is made for it.
struct ExactTable {
  SymbolTable symbols;
  ExactTransform base;
  std::vector<ExactDhRow> rows;
  ExactTransform tool;
  std::vector<std::vector<int>> angle_groups;
};

/// @throws DerivationStopped for mimic joints that it does not handle.
ExactTable exactTableOf(const SerialChain& chain, const SymbolicOptions& options);

struct ExactDeterminant;

/// The chain's transforms as polynomials.
struct ExactChain {
  ExactChain(const SerialChain& chain, const SymbolicOptions& options, const Progress& progress)
      : ExactChain(exactTableOf(chain, options), chain, progress) {}
  /// Of a table of the chain to which symbols and groups of angles were added.
  ExactChain(ExactTable known, const SerialChain& chain, const Progress& progress);

  ExactTable table;
  int size = 0;    ///< Axes.
  int joints = 0;  ///< Degrees of freedom; fewer than axes where joints mimic others.
  std::vector<bool> prismatic;
  std::vector<std::pair<int, int>> drives;  ///< Of each axis: its joint, and how often its value counts.
  RingPointer ring;
  TrigPose base;
  TrigPose tool;
  std::vector<TrigPose> steps;  ///< steps[i]: frame i + 1 in frame i, i = 0..n; the base in the first.
  mutable Reader reader;
  mutable std::vector<std::pair<Task, std::shared_ptr<const ExactDeterminant>>> determinants;  ///< Worked out so far.

  TrigPose pose(int reference, int frame) const;
  /// Jacobian [v; w], 6 x joints, of the point of the tip's body that is at frame `point`'s origin; components in
  /// `frame`.
  TrigMatrix jacobian(int frame, int point) const;
  TrigPolynomial length(const ExactLength& length) const;
  TrigPolynomial rate(int axis) const;  ///< Of axis 0..size-1.
  Formula formula(const TrigPolynomial& polynomial) const { return reader.formula(polynomial); }
  FormulaMatrix formula(const TrigMatrix& matrix) const;

 private:
  TrigPose rowPose(const ExactDhRow& row) const;
  TrigPose transformPose(const ExactTransform& transform) const;
};

}  // namespace screwline

#endif  // SCREWLINE_SRC_SYMBOLIC_EXACT_CHAIN_H

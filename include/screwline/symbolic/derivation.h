#ifndef SCREWLINE_SYMBOLIC_DERIVATION_H
#define SCREWLINE_SYMBOLIC_DERIVATION_H

#include <functional>
#include <string>
#include <vector>

#include "screwline/symbolic/conditions.h"
#include "screwline/symbolic/document.h"
#include "screwline/symbolic/inverse_formulas.h"
#include "screwline/symbolic/right_angles.h"

namespace screwline {

struct DerivationOptions {
  /// Of drawing, fk, jacobian, propagation, determinant, singularities, statics, ik; empty: all.
  std::vector<std::string> quantities;
  DocumentFormat format = DocumentFormat::kMarkdown;
  /// The inverse kinematics of the chain that the document describes (ik/method_summary.h), asked for `ik` only; empty:
  /// nothing is said of it.
  std::function<InverseMethod(const SerialChain&)> inverse;
  std::string drawing_file;  ///< What a Markdown document calls the drawing; empty: it has none.
  SymbolicOptions symbolic;
  double right_angles = kRightAngleTolerance;  ///< [rad] For withRightAngles(); 0: angles are taken as they are.
  int check_configurations = 100;              ///< Random ones at which each formula is compared with the numeric core.
  Progress progress;
};

/// What was derived of a chain.
struct Derivation {
  std::string document;
  std::string drawing;  ///< SVG, where the drawing was asked for and the format is not text.
  /// Infix, of the task determinant: their product is it. One, the sum of the squares of the minors, where the task is
  /// not square. Empty where the determinant was not asked for.
  std::vector<std::string> factors;
  std::vector<std::string> symbols;   ///< Of lengths and constant angles in the factors and the document.
  std::vector<double> symbol_values;  ///< m, rad.
  std::vector<ConditionFormula> conditions;
  std::string no_inverse;         ///< Why there are no inverse formulas, where they were asked for.
  double right_angle_turn = 0.0;  ///< [rad] Largest turn of an axis into a right angle; 0: none was turned.
  double worst_deviation = 0.0;   ///< Of any derived formula from the numeric core, relative.
};

/// Axes that are a rounded right angle off are put right first (withRightAngles()), and the document says how far that
/// moved the tip; what is derived is compared with the chain so changed.
/// Derives what is asked for, checks it against the numeric core and writes it down. @throws InputError (kInvalidGoal)
/// for an unknown quantity, DerivationStopped where it was cancelled or grew too large.
Derivation deriveDocument(const SerialChain& chain, const Task& task, const DerivationOptions& options);

}  // namespace screwline

#endif  // SCREWLINE_SYMBOLIC_DERIVATION_H

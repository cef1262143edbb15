#include "screwline/symbolic/derivation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <optional>
#include <utility>

#include "numeric_check.h"
#include "screwline/kinematics/jacobian.h"
#include "screwline/kinematics/propagation.h"
#include "screwline/symbolic/inverse_document.h"
#include "sections.h"

namespace screwline {
namespace {

constexpr std::array<const char*, 8> kQuantities = {
    "drawing", "fk", "jacobian", "propagation", "determinant", "singularities", "statics", "ik"};

constexpr double kRounding = 1e-12;  ///< Share of Hadamard's bound below which a determinant is rounding.

std::string numberText(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.10g", value);
  return text;
}

/// A share so small that it is told as a power of ten.
std::string deviationText(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1e", value);
  return text;
}

MatrixX columnOf(const Vector3& v) {
  return v;
}

/// Writes one chain's document and collects what the answer needs beside it.
class Deriver {
 public:
  /// `squared`: where `chain` is one with right angles put in, else null.
  Deriver(const SerialChain& chain, const Task& task, const DerivationOptions& options, const SquaredChain* squared)
      : chain_(chain),
        squared_(squared),
        task_(task),
        options_(options),
        watch_(options.progress),
        symbolic_(chain, options.symbolic, options.progress),
        document_(options.format, symbolic_.symbols()),
        check_(chain, symbolic_.symbols(), options.check_configurations) {}

  Derivation run() {
    for (const std::string& quantity : options_.quantities) requireKnown(quantity);
    writeHead();
    if (wants("drawing")) writeDrawing();
    if (wants("fk")) writeForward();
    if (wants("jacobian")) writeJacobian();
    if (wants("propagation")) writePropagation();
    if (wants("determinant") || wants("singularities")) writeDeterminant();
    if (wants("singularities")) {
      watch_.begin("singularities");
      result_.conditions = writeSingularities(draft());
    }
    if (wants("statics")) {
      watch_.begin("statics");
      writeStatics(draft());
    }
    if (wants("ik")) writeInverse();
    if (options_.quantities != std::vector<std::string>{"ik"}) writeCheck();
    result_.document = document_.finished();
    result_.worst_deviation = check_.worst();
    return std::move(result_);
  }

 private:
  static void requireKnown(const std::string& quantity) {
    if (std::find(kQuantities.begin(), kQuantities.end(), quantity) != kQuantities.end()) return;
    std::string known;
    for (const char* name : kQuantities) known += (known.empty() ? "" : ", ") + std::string(name);
    throw InputError(AnswerCode::kInvalidGoal, "quantities: '" + quantity + "' is unknown; known are " + known);
  }
  bool wants(const std::string& quantity) const {
    return options_.quantities.empty() ||
           std::find(options_.quantities.begin(), options_.quantities.end(), quantity) != options_.quantities.end();
  }
  int tip() const { return symbolic_.size() + 1; }

  void writeHead() {
    document_.heading(1, "Kinematics of " + chain_.name());
    document_.paragraph(
        document_.text("From " + chain_.baseLink() + " to " + chain_.tipLink() +
                       ". s and c with digits are sine and cosine of the sum of the joints' angles with "
                       "these numbers. Twists are [v; w], linear part first."));
    if (squared_ != nullptr) writeSquaring();
    document_.heading(2, "Symbols");
    std::vector<std::vector<std::string>> rows;
    for (int id = 0; id < symbolic_.symbols().size(); ++id) {
      const Symbol& symbol = symbolic_.symbols()[id];
      const bool joint = symbol.kind == SymbolKind::kAngle || symbol.kind == SymbolKind::kSlide;
      const bool constant = symbol.kind == SymbolKind::kLength || symbol.kind == SymbolKind::kConstantAngle;
      if (!joint && !constant) continue;
      if (constant) {
        result_.symbols.push_back(symbol.name);
        result_.symbol_values.push_back(symbol.value);
      }
      rows.push_back({document_.formula(Formula::symbol(id)), document_.text(symbol.name),
                      constant ? numberText(symbol.value) : "-", document_.text(symbol.meaning)});
    }
    document_.table({"symbol", "name", "value", "meaning"}, rows);
    writeTable();
  }

  void writeSquaring() {
    result_.right_angle_turn = squared_->largest_turn;
    document_.paragraph(document_.text(
        "The robot's description has rounded right angles: axes within " + deviationText(options_.right_angles) +
        " rad of one are taken as exact. The largest turn was " + deviationText(squared_->largest_turn) +
        " rad; at 100 configurations the tip so described is at most " + deviationText(squared_->position_error) +
        " m and " + deviationText(squared_->rotation_error) + " rad from the robot's."));
  }

  void writeDrawing() {
    if (options_.format == DocumentFormat::kText) return;
    const Drawing drawing = drawingOf(chain_, symbolic_);
    result_.drawing = svgOf(drawing);
    if (options_.format == DocumentFormat::kMarkdown && options_.drawing_file.empty()) return;
    document_.heading(2, "Frames");
    document_.figure(drawing, "Frames of the modified Denavit-Hartenberg table, at a bent configuration",
                     options_.drawing_file);
  }

  void writeTable() {
    document_.heading(2, "Modified Denavit-Hartenberg table");
    std::vector<std::vector<std::string>> rows;
    for (const SymbolicDhRow& row : symbolic_.dhRows()) {
      rows.push_back({std::to_string(rows.size() + 1), document_.formula(row.alpha), document_.formula(row.a),
                      document_.formula(row.d), document_.formula(row.theta)});
    }
    document_.table({"i", document_.symbol("alpha_{i-1}", "\\alpha_{i-1}"), document_.symbol("a_{i-1}", "a_{i-1}"),
                     document_.symbol("d_i", "d_i"), document_.symbol("theta_i", "\\theta_i")},
                    rows);
  }

  void writePose(const std::string& name, int frame, const std::function<Pose(const VectorX&)>& reference) {
    const SymbolicPose X = symbolic_.pose(0, frame);
    document_.matrix("R_0" + name, "{}^0R_{" + name + "}", X.R);
    document_.matrix("p_0" + name, "{}^0p_{" + name + "}", X.p);
    check_.compare(X.R, [&](const VectorX& q) -> MatrixX { return reference(q).R; });
    check_.compare(
        X.p, [&](const VectorX& q) { return columnOf(reference(q).p); }, chain_.characteristicLength());
  }

  void writeForward() {
    watch_.begin("forward kinematics");
    document_.heading(2, "Forward kinematics");
    for (int frame = 1; frame <= symbolic_.size(); ++frame) {
      writePose(std::to_string(frame), frame, [this, frame](const VectorX& q) { return framePose(frame, q); });
    }
    writePose("T", tip(), [this](const VectorX& q) { return forwardByExponentials(chain_, q); });
  }

  /// Frame `frame` of the table: the product of its rows.
  Pose framePose(int frame, const VectorX& q) const {
    Pose X = chain_.modifiedDh().base_transform;
    for (int i = 1; i <= frame; ++i) {
      const Axis& axis = chain_.axes()[static_cast<std::size_t>(i - 1)];
      X = X * chain_.modifiedDh().link(i, axis.prismatic, axis.multiplier * q[axis.source]);
    }
    return X;
  }

  void writeJacobian() {
    watch_.begin("Jacobian");
    document_.heading(2, "Geometric Jacobian of the tip");
    const auto numeric = [this](const VectorX& q, bool in_tip) -> MatrixX {
      Matrix6X J;
      const Pose X = geometricJacobian(chain_, q, J);
      return in_tip ? expressedIn(J, X.R.transpose()) : J;
    };
    const double least = chain_.characteristicLength();
    const FormulaMatrix in_tip = symbolic_.jacobian(tip());
    document_.matrix("J in the tip's axes", "{}^TJ", in_tip);
    check_.compare(
        in_tip, [&](const VectorX& q) { return numeric(q, true); }, least);
    const FormulaMatrix in_base = symbolic_.jacobian(0);
    document_.matrix("J in the base's axes", "{}^0J", in_base);
    check_.compare(
        in_base, [&](const VectorX& q) { return numeric(q, false); }, least);
  }

  void writePropagation() {
    watch_.begin("propagation");
    document_.heading(2, "Velocities, outward");
    const std::vector<SymbolicLinkVelocity> velocities = symbolic_.velocities();
    for (std::size_t i = 0; i < velocities.size(); ++i) {
      const std::string number = std::to_string(i + 1);
      document_.matrix("w_" + number, "{}^{" + number + "}\\omega_{" + number + "}", velocities[i].w);
      document_.matrix("v_" + number, "{}^{" + number + "}v_{" + number + "}", velocities[i].v);
    }
    document_.heading(2, "Forces, inward");
    document_.paragraph(
        document_.text("f and n are exerted by the tip on the environment, about its origin, in its axes."));
    const std::vector<SymbolicLinkWrench> wrenches = symbolic_.wrenches();
    for (std::size_t i = wrenches.size(); i > 0; --i) {
      const std::string number = std::to_string(i);
      document_.matrix("f_" + number, "{}^{" + number + "}f_{" + number + "}", wrenches[i - 1].f);
      document_.matrix("n_" + number, "{}^{" + number + "}n_{" + number + "}", wrenches[i - 1].n);
    }
    checkPropagation(velocities, wrenches);
  }

  /// Rates and wrench get fixed values of no special kind.
  void checkPropagation(const std::vector<SymbolicLinkVelocity>& velocities,
                        const std::vector<SymbolicLinkWrench>& wrenches) {
    if (chain_.hasMimic()) return;  // The numeric recursions are those of chains without mimic joints.
    VectorX rates(chain_.size());
    for (int i = 0; i < chain_.size(); ++i) rates[i] = 0.3 + 0.17 * i;
    Vector6 wrench;
    wrench << 1.1, -0.7, 0.4, 0.3, -0.2, 0.5;
    const SymbolTable& symbols = symbolic_.symbols();
    std::vector<bool> given(static_cast<std::size_t>(symbols.size()), false);
    SymbolTable filled;
    int input = 0;
    for (int id = 0; id < symbols.size(); ++id) {
      Symbol symbol = symbols[id];
      const bool rate = symbol.kind == SymbolKind::kRate;
      given[static_cast<std::size_t>(id)] = rate || symbol.kind == SymbolKind::kInput;
      if (rate) symbol.value = rates[symbol.index - 1];
      if (symbol.kind == SymbolKind::kInput) symbol.value = wrench[input++];
      filled.add(symbol);
    }
    const auto compare = [&](FormulaMatrix formulas, const std::function<Vector3(const VectorX&)>& reference) {
      for (Formula& entry : formulas.entries) entry = entry.withValues(filled, given);
      check_.compare(formulas, [&](const VectorX& q) { return columnOf(reference(q)); });
    };
    for (std::size_t i = 0; i < velocities.size(); ++i) {
      compare(velocities[i].w, [&](const VectorX& q) { return propagateVelocity(chain_, q, rates)[i].w; });
      compare(velocities[i].v, [&](const VectorX& q) { return propagateVelocity(chain_, q, rates)[i].v; });
      compare(wrenches[i].f, [&](const VectorX& q) { return propagateForce(chain_, q, wrench)[i].f; });
      compare(wrenches[i].n, [&](const VectorX& q) { return propagateForce(chain_, q, wrench)[i].n; });
    }
  }

  void writeDeterminant() {
    watch_.begin("determinant");
    const DeterminantFormula determinant = determinantOf(symbolic_, task_);
    std::string rows;
    for (const std::string& name : task_.names()) rows += (rows.empty() ? "" : " ") + name;
    document_.heading(2, "Determinant of the task " + rows);
    if (determinant.square) {
      document_.equation("det J", "\\det J", determinant.minors.front().product());
      const FactoredFormula& factored = determinant.minors.front();
      if (!factored.coefficient.isNumber(1) || factored.factors.empty()) addFactor(factored.coefficient);
      for (const FormulaFactor& factor : factored.factors) addFactor(Formula::power(factor.base, factor.multiplicity));
    } else {
      const bool wide = task_.size() < chain_.size();
      document_.paragraph(document_.text(std::string(wide ? "det(J J^T)" : "det(J^T J)") +
                                         " is the sum of the squares of these minors, each of the " +
                                         (wide ? "columns" : "rows") + " kept:"));
      for (std::size_t i = 0; i < determinant.minors.size(); ++i) {
        const std::string number = std::to_string(i + 1);
        document_.equation("m_" + number, "m_{" + number + "}", determinant.minors[i].product());
      }
      addFactor(determinant.value());
    }
    checkDeterminant(determinant.value());
  }

  void addFactor(const Formula& factor) {
    result_.factors.push_back(write(factor, symbolic_.symbols(), FormulaStyle::kInfix));
  }

  /// Relative to the largest determinant found; where that is nothing but rounding, to Hadamard's bound.
  void checkDeterminant(const Formula& value) {
    const TaskDeterminant determinant(chain_, task_);
    double largest = 0.0;
    double bound = 0.0;
    for (int k = 0; k < options_.check_configurations; ++k) {
      const VectorX q = sampleConfiguration(chain_, k);
      largest = std::max(largest, std::abs(determinant(q)));
      bound = std::max(bound, determinant.bound(q));
    }
    if (largest <= kRounding * bound) largest = bound;
    check_.compare(
        {1, 1, {value}}, [&](const VectorX& q) -> MatrixX { return MatrixX::Constant(1, 1, determinant(q)); }, largest);
  }

  SectionDraft draft() { return {chain_, task_, symbolic_, document_, check_}; }

  void writeInverse() {
    if (!options_.inverse) return;
    watch_.begin("inverse kinematics");
    const InverseMethod method = options_.inverse(chain_);
    document_.heading(2, "Inverse kinematics");
    std::vector<std::string> lines;
    for (const std::string& line : method.summary) lines.push_back(document_.text(line));
    document_.list(lines);
    const InverseDerivation inverse =
        deriveInverse(chain_, task_, method, options_.check_configurations, options_.symbolic, options_.progress);
    result_.no_inverse = inverse.reason;
    if (!inverse.formulas) return document_.paragraph(document_.text(inverse.reason + "."));
    document_.paragraph(inverseSection(*inverse.formulas, options_.format));
    if (method.solver) document_.paragraph(document_.text(sentenceOf(inverse.check)));
  }

  void writeCheck() {
    document_.heading(2, "Numeric check");
    document_.paragraph(document_.text(
        "Each formula was compared with the numeric kinematics at " + std::to_string(options_.check_configurations) +
        " configurations: the worst relative deviation is " + deviationText(check_.worst()) + "."));
  }

  const SerialChain& chain_;
  const SquaredChain* squared_;
  const Task& task_;
  const DerivationOptions& options_;
  ProgressWatch watch_;
  SymbolicChain symbolic_;
  DocumentWriter document_;
  NumericCheck check_;
  Derivation result_;
};

}  // namespace

Derivation deriveDocument(const SerialChain& chain, const Task& task, const DerivationOptions& options) {
  const std::optional<SquaredChain> squared = withRightAngles(chain, options.right_angles);
  if (squared) return Deriver(squared->chain, task, options, &*squared).run();
  return Deriver(chain, task, options, nullptr).run();
}

}  // namespace screwline

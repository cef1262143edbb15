#include "screwline/symbolic/cpp_header.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <utility>

#include "cpp_roots.h"
#include "cpp_writer.h"

namespace screwline {
namespace {

void collectSymbols(const Formula& formula, std::set<int>& found) {
  if (formula.kind() == Formula::Kind::kSymbol) found.insert(formula.symbolId());
  for (const Formula& part : formula.parts()) collectSymbols(part, found);
}

/// One robot's header.
class HeaderMaker {
 public:
  HeaderMaker(const SerialChain& chain, const std::optional<InverseFormulas>& inverse, const SymbolicOptions& options,
              const Progress& progress)
      : chain_(chain),
        inverse_(inverse),
        symbolic_(chain, options, progress),
        symbols_(inverse ? inverse->symbols : symbolic_.symbols()),
        writer_(symbols_),
        space_(cppIdentifier(chain.name())) {}

  std::string make() {
    writeHead();
    writeTypes();
    writeForward();
    writeJacobian();
    if (inverse_) writeInverse();
    std::string guard = space_ + "_KINEMATICS_H";
    std::transform(guard.begin(), guard.end(), guard.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return head_ + "#ifndef " + guard + "\n#define " + guard + "\n\n" + text_ + "}  // namespace " + space_ +
           "\n\n#endif  // " + guard + "\n";
  }

 private:
  void line(const std::string& content) { text_ += std::string(2 * depth_, ' ') + content + "\n"; }
  void declareCirculars(const Formula& formula) {
    for (const std::string& declaration : writer_.declarations(formula)) line(declaration);
  }

  void writeHead() {
    head_ = "// Kinematics of " + cppIdentifier(chain_.name()) + " from " + cppIdentifier(chain_.baseLink()) + " to " +
            cppIdentifier(chain_.tipLink()) +
            ".\n// Derived by screwline. Units m and rad. Needs a C++17 compiler and its standard library.\n";
    line("#include <array>");
    line("#include <cmath>");
    line(inverse_ ? "#include <vector>\n" : "");
    line("namespace " + space_ + " {\n");
    line("constexpr int kJoints = " + std::to_string(chain_.size()) + ";");
    line("constexpr double kPi = 3.141592653589793;\n");
    bool any = false;
    for (int id = 0; id < symbols_.size(); ++id) {
      const Symbol& symbol = symbols_[id];
      if (symbol.kind != SymbolKind::kLength && symbol.kind != SymbolKind::kConstantAngle) continue;
      line("constexpr double " + writer_.declare(id, symbol.name) + " = " + cppNumber(symbol.value) + ";  // " +
           symbol.meaning);
      any = true;
    }
    if (any) text_ += "\n";
  }

  void writeTypes() {
    std::string names;
    for (const std::string& name : chain_.jointNames()) names += (names.empty() ? "" : ", ") + cppIdentifier(name);
    line("/// " + names + ".");
    line("using Joints = std::array<double, kJoints>;\n");
    line("/// The tip in the base link: R[row][column], p.");
    line("struct Pose {");
    line("  std::array<std::array<double, 3>, 3> R{};");
    line("  std::array<double, 3> p{};");
    line("};\n");
    line("/// J[row][joint]: velocity of the tip's origin (rows 0 to 2) and rotation (3 to 5), axes of the base link.");
    line("using Jacobian = std::array<std::array<double, kJoints>, 6>;\n");
    line("inline double square(double x) {");
    line("  return x * x;");
    line("}\n");
  }

  /// Joints are elements of the argument q.
  void beginOfJoints(const std::string& head, const FormulaMatrix& first, const FormulaMatrix* second) {
    line(head);
    ++depth_;
    writer_.beginFunction();
    for (int i = 0; i < chain_.size(); ++i) writer_.assign(i, "q[" + std::to_string(i) + "]");
    for (const Formula& entry : first.entries) declareCirculars(entry);
    if (second != nullptr) {
      for (const Formula& entry : second->entries) declareCirculars(entry);
    }
  }

  void element(const std::string& place, const Formula& value) {
    if (!value.isZero()) line(place + " = " + writer_.expression(value) + ";");
  }

  static std::string at(int i, int j) { return "[" + std::to_string(i) + "][" + std::to_string(j) + "]"; }

  void writeForward() {
    const SymbolicPose X = symbolic_.pose(0, symbolic_.size() + 1);
    beginOfJoints("inline Pose forward(const Joints& q) {", X.R, &X.p);
    line("Pose X;");
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) element("X.R" + at(i, j), X.R(i, j));
    }
    for (int i = 0; i < 3; ++i) element("X.p[" + std::to_string(i) + "]", X.p(i, 0));
    line("return X;");
    --depth_;
    line("}\n");
  }

  void writeJacobian() {
    const FormulaMatrix J = symbolic_.jacobian(0);
    std::set<int> used;
    for (const Formula& entry : J.entries) collectSymbols(entry, used);
    const bool depends = !used.empty() && *std::lower_bound(used.begin(), used.end(), 0) < chain_.size();
    beginOfJoints(std::string("inline Jacobian jacobian(const Joints&") + (depends ? " q" : "") + ") {", J, nullptr);
    line("Jacobian J{};");
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < chain_.size(); ++j) element("J" + at(i, j), J(i, j));
    }
    line("return J;");
    --depth_;
    line("}\n");
  }

  void writeHelpers() {
    line(
        "/// Where a joint may take any value (its bit of `free` is set) it has the preferred one; others follow from "
        "it.");
    line("struct Solution {");
    line("  Joints q{};");
    line("  unsigned free = 0;");
    line("};\n");
    line("inline double wrapped(double angle) {");
    line("  const double rest = std::remainder(angle, 2.0 * kPi);");
    line("  return rest <= -kPi ? kPi : rest;");
    line("}\n");
    line("/// [m] What is smaller is rounding.");
    line("constexpr double kTiny = " + cppNumber(1e-12 * std::max(1.0, inverse_->length)) + ";\n");
    line("/// Of a sum; 0 where that is rounding, -1 where it is negative.");
    line("inline double squareRoot(std::initializer_list<double> terms) {");
    line("  double sum = 0.0;");
    line("  double scale = 0.0;");
    line("  for (const double term : terms) {");
    line("    sum += term;");
    line("    scale += std::abs(term);");
    line("  }");
    line("  if (!(sum >= -1e-12 * scale - square(kTiny))) return -1.0;");
    line("  return sum <= 1e-14 * scale + square(kTiny) ? 0.0 : std::sqrt(sum);");
    line("}\n");
    line("inline bool isZero(double x) {");
    line("  return std::abs(x) <= kTiny;");
    line("}\n");
    writeAdd();
  }

  void writeAdd() {
    line("inline void add(const Solution& solution, std::vector<Solution>& solutions) {");
    line("  for (const Solution& other : solutions) {");
    line("    double worst = 0.0;");
    std::string turns;
    for (bool revolute : inverse_->revolute) turns += std::string(turns.empty() ? "" : ", ") + (revolute ? "1" : "0");
    line("    constexpr std::array<int, kJoints> turns = {" + turns + "};");
    line("    for (std::size_t i = 0; i < solution.q.size(); ++i) {");
    line("      const double difference = solution.q[i] - other.q[i];");
    line("      worst = std::fmax(worst, std::abs(turns[i] != 0 ? wrapped(difference) : difference));");
    line("    }");
    line("    if (worst <= 1e-6) return;  // Two branches meet.");
    line("  }");
    line("  solutions.push_back(solution);");
    line("}\n");
  }

  void writeInverse() {
    writeHelpers();
    const std::vector<InverseStep>& steps = inverse_->steps;
    if (std::any_of(steps.begin(), steps.end(), [](const InverseStep& step) { return !step.equation.empty(); }))
      text_ += kCppRoots;
    line(
        "/// All solutions for the task's rows of the target, joint limits not looked at; none where it is out of "
        "reach.");
    writer_.beginFunction();
    std::string given;
    if (inverse_->given >= 0) {
      const std::string name = writer_.declare(inverse_->given, symbols_[inverse_->given].brief);
      line("/// Seven joints leave one to be chosen: all solutions that have that value of " + name + ".");
      given = "double " + name + ", ";
    }
    line("inline std::vector<Solution> inverse(const Pose& target, " + given + "const Joints& preferred = {}) {");
    ++depth_;
    line("static_cast<void>(preferred);");
    line("std::vector<Solution> solutions;");
    writeTarget();
    int loops = 0;
    std::vector<std::string> free(static_cast<std::size_t>(chain_.size()));
    for (const InverseStep& step : inverse_->steps) {
      if (!step.before.empty()) line("// " + step.before);
      if (step.sign >= 0 || !step.equation.empty()) {
        step.sign >= 0 ? writeBranches(step, loops > 0) : writeRoots(step, free);
        ++loops;
      } else {
        writeValue(step, free);
      }
    }
    writeSolution(free);
    for (; loops > 0; --loops) {
      --depth_;
      line("}");
    }
    line("return solutions;");
    --depth_;
    line("}\n");
  }

  void writeTarget() {
    std::set<int> used;
    for (const InverseStep& step : inverse_->steps) {
      collectSymbols(step.value, used);
      collectSymbols(step.radicand, used);
      for (const Formula& formula : step.free_if) collectSymbols(formula, used);
      for (const Formula& formula : step.equation) collectSymbols(formula, used);
    }
    for (std::size_t i = 0; i < inverse_->target.size(); ++i) {
      const int id = inverse_->target[i];
      if (used.count(id) == 0) continue;
      const int entry = static_cast<int>(i) - 3;
      const std::string place = entry < 0 ? ".p[" + std::to_string(i) + "]" : ".R" + at(entry / 3, entry % 3);
      line("const double " + writer_.declare(id, symbols_[id].brief) + " = target" + place + ";");
    }
  }

  void writeBranches(const InverseStep& step, bool in_loop) {
    const std::string name = writer_.declare(step.symbol, symbols_[step.symbol].brief);
    if (step.radicand.isNumber(1)) {
      line("for (const double " + name + " : {1.0, -1.0}) {");
      ++depth_;
      return;
    }
    declareCirculars(step.radicand);
    const bool is_sum = step.radicand.kind() == Formula::Kind::kSum;
    std::string terms;
    for (const Formula& term : is_sum ? step.radicand.parts() : std::vector<Formula>{step.radicand})
      terms += (terms.empty() ? "" : ", ") + writer_.expression(term);
    const std::string root = writer_.fresh("root_" + name);
    line("const double " + root + " = squareRoot({" + terms + "});");
    line("if (" + root + " < 0.0) " + (in_loop ? "continue;" : "return solutions;"));
    const std::string sign = writer_.fresh("sign_" + name);
    line("for (const double " + sign + " : {1.0, -1.0}) {");
    ++depth_;
    line("if (" + root + " == 0.0 && " + sign + " < 0.0) continue;");
    line("const double " + name + " = " + sign + " * " + root + ";");
  }

  /// "isZero(a) && isZero(b)"; empty where the line's joint is never free.
  std::string freeIf(const InverseStep& step) {
    std::string condition;
    for (const Formula& formula : step.free_if) {
      if (formula.isZero()) continue;
      declareCirculars(formula);
      condition += (condition.empty() ? "" : " && ") + std::string("isZero(") + writer_.expression(formula) + ")";
    }
    return step.symbol < inverse_->joints ? condition : std::string();
  }

  /// Of the joint; empty without a condition.
  std::string declareFree(const std::string& condition, const InverseStep& step, std::vector<std::string>& free) {
    if (condition.empty()) return condition;
    const std::string is_free = writer_.fresh("free_" + symbols_[step.symbol].brief);
    line("const bool " + is_free + " = " + condition + ";");
    return free[static_cast<std::size_t>(step.symbol)] = is_free;
  }

  void writeRoots(const InverseStep& step, std::vector<std::string>& free) {
    std::string coefficients;
    for (const Formula& formula : step.equation) {
      declareCirculars(formula);
      coefficients += (coefficients.empty() ? "" : ", ") + writer_.expression(formula);
    }
    std::string roots = step.tangent >= 0 ? "anglesOf(" + coefficients + ")" : "realRoots({" + coefficients + "})";
    const std::string is_free = declareFree(freeIf(step), step, free);
    if (!is_free.empty())
      roots = is_free + " ? std::vector<double>{preferred[" + std::to_string(step.symbol) + "]} : " + roots;
    line("for (const double " + writer_.declare(step.symbol, symbols_[step.symbol].brief) + " : " + roots + ") {");
    ++depth_;
  }

  void writeValue(const InverseStep& step, std::vector<std::string>& free) {
    declareCirculars(step.value);
    const std::string value = writer_.expression(step.value);
    const std::string is_free = declareFree(freeIf(step), step, free);
    const std::string name = writer_.declare(step.symbol, symbols_[step.symbol].brief);
    const std::string preferred = "preferred[" + std::to_string(step.symbol) + "]";
    line("const double " + name + " = " + (is_free.empty() ? "" : is_free + " ? " + preferred + " : ") + value + ";");
  }

  void writeSolution(const std::vector<std::string>& free) {
    std::string values;
    std::string bits;
    const auto append = [](std::string& list, const char* between, const std::string& one) {
      list += (list.empty() ? "" : between) + one;
    };
    for (int i = 0; i < chain_.size(); ++i) {
      const auto k = static_cast<std::size_t>(i);
      const std::string bit = std::to_string(1U << k) + "U";
      if (i == inverse_->open_joint) {
        append(values, ", ", "preferred[" + std::to_string(i) + "]");
        append(bits, " | ", bit);
        continue;
      }
      const std::string name = writer_.name(i);
      std::string value = inverse_->revolute[k] ? "wrapped(" + name + ")" : name;
      if (inverse_->revolute[k] && !free[k].empty()) value = free[k] + " ? " + name + " : " + value;
      append(values, ", ", value);
      if (!free[k].empty()) append(bits, " | ", "(" + free[k] + " ? " + bit + " : 0U)");
    }
    line("add({{" + values + "}, " + (bits.empty() ? "0U" : bits) + "}, solutions);");
  }

  const SerialChain& chain_;
  const std::optional<InverseFormulas>& inverse_;
  SymbolicChain symbolic_;
  const SymbolTable& symbols_;
  CppWriter writer_;
  std::string space_;
  std::string head_;
  std::string text_;
  int depth_ = 0;
};

}  // namespace

std::string cppHeaderOf(const SerialChain& chain, const std::optional<InverseFormulas>& inverse,
                        const SymbolicOptions& options, const Progress& progress) {
  return HeaderMaker(chain, inverse, options, progress).make();
}

}  // namespace screwline

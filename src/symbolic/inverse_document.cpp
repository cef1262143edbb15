#include "screwline/symbolic/inverse_document.h"

#include <cstdio>
#include <optional>
#include <string>
#include <vector>

namespace screwline {
namespace {

/// "A2, B2" of the lines' own symbols, "theta1" of joints.
std::string nameIn(const InverseFormulas& formulas, int symbol, DocumentFormat format) {
  const Symbol& known = formulas.symbols[symbol];
  return format == DocumentFormat::kText ? known.brief : known.latex;
}

/// D of 1 - D^2.
std::optional<Formula> ratioOf(const Formula& radicand) {
  if (radicand.kind() != Formula::Kind::kSum || radicand.parts().size() != 2) return std::nullopt;
  const Formula& square = radicand.parts().front();
  if (!radicand.parts().back().isNumber(1) || square.kind() != Formula::Kind::kProduct || square.parts().size() != 2 ||
      !square.parts().front().isNumber(-1) || square.parts().back().kind() != Formula::Kind::kPower ||
      square.parts().back().parts().front().kind() != Formula::Kind::kSymbol)
    return std::nullopt;
  return square.parts().back().parts().front();
}

/// What happens where the line's radicand or the directions that it turns between vanish.
void writeRemarks(const InverseFormulas& formulas, const InverseStep& step, const DocumentWriter& writer,
                  std::vector<std::string>& remarks) {
  if (step.reach) {
    const std::optional<Formula> ratio = ratioOf(step.radicand);
    const auto negative = [&](FormulaStyle style) { return write(step.radicand, formulas.symbols, style) + " < 0"; };
    std::string beyond = writer.symbol(negative(FormulaStyle::kText), negative(FormulaStyle::kLatex));
    if (ratio) {
      const Symbol& D = formulas.symbols[ratio->symbolId()];
      beyond = writer.symbol("|" + D.brief + "| > 1", "|" + D.latex + "| > 1");
    }
    remarks.push_back(writer.text("no solution (out of reach) where ") + beyond +
                      writer.text("; two branches meet where ") +
                      (ratio ? writer.text("it is 1") : writer.text("it is zero")));
  }
  if (!step.equation.empty()) {
    const std::string unknown = writer.formula(Formula::symbol(step.tangent >= 0 ? step.tangent : step.symbol));
    remarks.push_back(writer.text("no solution (out of reach) where the quartic for ") + unknown +
                      writer.text(" has no real root; two branches meet in a double root") +
                      (step.tangent < 0 ? ""
                                        : writer.text("; where its first coefficient is zero, ") +
                                              writer.formula(Formula::symbol(step.symbol)) + writer.text(" = ") +
                                              writer.symbol("pi", "\\pi") + writer.text(" is one")));
  }
  if (step.free_if.empty()) return;
  std::string zeros;
  for (const Formula& formula : step.free_if) {
    if (formula.isZero()) continue;
    zeros += (zeros.empty() ? "" : " = ") + writer.formula(formula);
  }
  remarks.push_back(writer.formula(Formula::symbol(step.symbol)) + writer.text(" may take any value where ") + zeros +
                    " = 0");
}

/// What an equation is a polynomial of, and that polynomial: of tan(x/2), (1 + tan^2)^2 times the sum.
Formula polynomialOf(const InverseStep& step) {
  std::vector<Formula> c = step.equation;
  if (step.tangent >= 0) {
    const Formula k = c[0];
    const Formula two = Formula::number(2);
    const Formula four = Formula::number(4);
    const Formula level = two * k - Formula::number(6) * c[3];
    const Formula sine = two * c[2];
    const Formula twice = four * c[4];
    c = {k + c[1] + c[3], sine + twice, level, sine - twice, k - c[1] + c[3]};
  }
  const Formula unknown = Formula::symbol(step.tangent >= 0 ? step.tangent : step.symbol);
  std::vector<Formula> terms;
  for (int i = 4; i >= 0; --i) {
    const Formula power = i == 0 ? Formula::number(1) : i == 1 ? unknown : Formula::power(unknown, i);
    terms.push_back(c[static_cast<std::size_t>(i)] * power);
  }
  return Formula::sum(terms);
}

/// A quartic, and the joint from its root.
void writeEquation(const InverseFormulas& formulas, const InverseStep& step, DocumentFormat format,
                   DocumentWriter& writer) {
  writer.equation("0", "0", polynomialOf(step));
  if (step.tangent < 0) return;
  const Formula angle =
      Formula::call(FormulaFunction::kArcTangent2, {Formula::symbol(step.tangent), Formula::number(1)});
  writer.equation(formulas.symbols[step.symbol].brief, nameIn(formulas, step.symbol, format),
                  Formula::number(2) * angle);
}

}  // namespace

std::string inverseSection(const InverseFormulas& formulas, DocumentFormat format) {
  DocumentWriter writer(format, formulas.symbols);
  int branches = 1;
  for (const InverseStep& step : formulas.steps) branches *= step.sign >= 0 ? 2 : step.equation.empty() ? 1 : 4;
  std::string intro = "Line by line, for the tip at " + writer.symbol("(px, py, pz)", "(p_x, p_y, p_z)") +
                      writer.text(" with rotation entries ") + writer.symbol("r11 to r33", "r_{11} \\ldots r_{33}") +
                      writer.text(" in the base link; each ") + writer.symbol("+-", "\\pm") +
                      writer.text(" gives two branches, " + std::to_string(branches) + " solutions at most.");
  if (formulas.given >= 0) {
    intro += " " + writer.formula(Formula::symbol(formulas.given)) +
             writer.text(
                 " is given: seven joints leave one to be chosen, and for each of its values the lines give the "
                 "other six.");
  }
  if (formulas.tool_turn >= 0) {
    intro += " " + writer.formula(Formula::symbol(formulas.tool_turn)) +
             writer.text(
                 " is the tool's turn about the direction that the task asks for: as any turn does, so does the "
                 "target's own.");
  }
  writer.paragraph(intro);
  std::vector<std::string> remarks;
  for (const InverseStep& step : formulas.steps) {
    if (!step.before.empty()) writer.paragraph(writer.text(step.before));
    if (step.equation.empty()) {
      writer.equation(formulas.symbols[step.symbol].brief, nameIn(formulas, step.symbol, format), step.value);
    } else {
      writeEquation(formulas, step, format, writer);
    }
    writeRemarks(formulas, step, writer, remarks);
  }
  if (formulas.open_joint >= 0)
    remarks.push_back(writer.formula(Formula::symbol(formulas.open_joint)) +
                      writer.text(" may take any value: it only turns the tool about its direction"));
  if (!remarks.empty()) {
    writer.paragraph(writer.text("Conditions and degenerate cases:"));
    writer.list(remarks);
  }
  const std::string body = writer.body();
  return body.substr(0, body.find_last_not_of('\n') + 1);
}

std::string sentenceOf(const InverseCheck& check) {
  const auto number = [](double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.1e", value);
    return std::string(text);
  };
  return "Worked off at " + std::to_string(check.poses) + " random reachable poses, these lines gave " +
         (check.agrees() ? "the " + std::to_string(check.solutions) + " solutions that the numeric solver finds"
                         : std::to_string(check.extra) + " solutions that the numeric solver does not find, and not " +
                               std::to_string(check.missing) + " of its " + std::to_string(check.solutions)) +
         ": forward kinematics of each returns the pose within " + number(check.worst_task) +
         ", joint values agree within " + number(check.worst_joint) + ".";
}

}  // namespace screwline

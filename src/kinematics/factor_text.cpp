#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>

#include "factor_names.h"

namespace screwline {
namespace {

std::string numberText(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.10g", value);
  return text;
}

/// How a factor is written: marks between symbols, and joint names as the notation has them.
struct Notation {
  std::string times;
  std::string sine;
  std::string cosine;
  std::string close;
  std::vector<std::string> joints;
};

/// "theta3" as "\theta_{3}", "shoulder_pan" as "\mathrm{shoulder\_pan}".
std::string latexName(const std::string& name) {
  static const std::array<const char*, 8> kGreek = {"theta", "alpha", "beta", "gamma", "phi", "psi", "rho", "sigma"};
  const std::size_t digits = name.find_last_not_of("0123456789") + 1;
  const std::string stem = name.substr(0, digits);
  const std::string index = digits < name.size() ? "_{" + name.substr(digits) + "}" : "";
  if (std::find(kGreek.begin(), kGreek.end(), stem) != kGreek.end()) return "\\" + stem + index;
  if (stem.size() == 1) return stem + index;
  std::string escaped;
  for (char c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) escaped += '\\';
    escaped += c;
  }
  return "\\mathrm{" + escaped + "}";
}

/// Appends "a", " + a" or " - a".
void appendSigned(std::string& sum, double sign, const std::string& magnitude) {
  if (sum.empty()) {
    sum = (sign < 0.0 ? "-" : "") + magnitude;
  } else {
    sum += (sign < 0.0 ? " - " : " + ") + magnitude;
  }
}

std::string angleText(const FactorTerm& term, const Notation& notation) {
  std::string sum;
  for (std::size_t i = 0; i < term.turns.size(); ++i) {
    const double turn = term.turns[i];
    if (turn == 0.0) continue;
    const std::string share = std::abs(turn) == 1.0 ? "" : numberText(std::abs(turn)) + notation.times;
    appendSigned(sum, turn, share + notation.joints[i]);
  }
  if (term.phase != 0.0) appendSigned(sum, term.phase, numberText(std::abs(term.phase)));
  return sum;
}

/// The term without its sign.
std::string magnitudeText(const FactorTerm& term, const Notation& notation) {
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < term.powers.size(); ++i) {
    if (term.powers[i] == 0) continue;
    const std::string power = term.powers[i] > 1 ? "^" + std::to_string(term.powers[i]) : "";
    parts.push_back(notation.joints[i] + power);
  }
  if (term.function != FactorTerm::Function::kOne) {
    const std::string& function = term.function == FactorTerm::Function::kSine ? notation.sine : notation.cosine;
    parts.push_back(function + angleText(term, notation) + notation.close);
  }
  const double size = std::abs(term.coefficient);
  std::string text = size == 1.0 && !parts.empty() ? "" : numberText(size);
  for (const std::string& part : parts) text += (text.empty() ? "" : notation.times) + part;
  return text;
}

std::string textOf(const SingularityFactor& factor, const Notation& notation) {
  std::string sum;
  for (const FactorTerm& term : factor.terms) appendSigned(sum, term.coefficient, magnitudeText(term, notation));
  return sum;
}

}  // namespace

std::string infixOf(const SerialChain& chain, const SingularityFactor& factor) {
  Notation notation = {"*", "sin(", "cos(", ")", {}};
  for (int joint : factor.joints) notation.joints.push_back(chain.joint(joint).name);
  return textOf(factor, notation);
}

std::string latexOf(const SerialChain& chain, const SingularityFactor& factor) {
  Notation notation = {" ", "\\sin(", "\\cos(", ")", {}};
  for (int joint : factor.joints) notation.joints.push_back(latexName(chain.joint(joint).name));
  return textOf(factor, notation);
}

}  // namespace screwline

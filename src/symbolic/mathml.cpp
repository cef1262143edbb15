#include "mathml.h"

#include <cctype>
#include <map>
#include <utility>

namespace screwline {
namespace {

bool isLetter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0;
}

bool isDigit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

/// Commands that are one sign.
const std::map<std::string, std::string>& signs() {
  static const std::map<std::string, std::string> kSigns = {
      {"theta", "<mi>&#952;</mi>"}, {"alpha", "<mi>&#945;</mi>"}, {"beta", "<mi>&#946;</mi>"},
      {"gamma", "<mi>&#947;</mi>"}, {"phi", "<mi>&#966;</mi>"},   {"psi", "<mi>&#968;</mi>"},
      {"rho", "<mi>&#961;</mi>"},   {"sigma", "<mi>&#963;</mi>"}, {"delta", "<mi>&#948;</mi>"},
      {"tau", "<mi>&#964;</mi>"},   {"omega", "<mi>&#969;</mi>"}, {"pi", "<mi>&#960;</mi>"},
      {"cdot", "<mo>&#8901;</mo>"}, {"pm", "<mo>&#177;</mo>"},    {"mp", "<mo>&#8723;</mo>"},
      {"le", "<mo>&#8804;</mo>"},   {"ge", "<mo>&#8805;</mo>"},   {"ne", "<mo>&#8800;</mo>"},
      {"times", "<mo>&#215;</mo>"}, {"in", "<mo>&#8712;</mo>"},   {"approx", "<mo>&#8776;</mo>"},
      {"lvert", "<mo>|</mo>"},      {"rvert", "<mo>|</mo>"},      {"quad", "<mspace width=\"1em\"/>"}};
  return kSigns;
}

class Converter {
 public:
  explicit Converter(const std::string& latex) : text_(latex) {}

  std::string all() {
    std::string result;
    while (at_ < text_.size()) {
      result += list();
      if (at_ < text_.size()) ++at_;  // A stray brace or separator.
    }
    return result;
  }

 private:
  bool startsWith(const std::string& word) const { return text_.compare(at_, word.size(), word) == 0; }
  bool take(const std::string& word) {
    if (!startsWith(word)) return false;
    at_ += word.size();
    return true;
  }
  void skipBlanks() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\n' || text_[at_] == '~')) ++at_;
  }
  bool isAtEnd() {
    skipBlanks();
    return at_ >= text_.size() || text_[at_] == '}' || text_[at_] == '&' || startsWith("\\right") ||
           startsWith("\\\\") || startsWith("\\end{");
  }

  /// Atoms up to what closes or separates them.
  std::string list() {
    std::string result;
    while (!isAtEnd()) result += scripted();
    return result;
  }

  std::string scripted() {
    const std::string base = atom();
    std::string low;
    std::string high;
    while (at_ < text_.size() && (text_[at_] == '_' || text_[at_] == '^')) {
      std::string& script = text_[at_] == '_' ? low : high;
      ++at_;
      script = argument();
    }
    if (!low.empty() && !high.empty()) return "<msubsup>" + base + low + high + "</msubsup>";
    if (!low.empty()) return "<msub>" + base + low + "</msub>";
    return high.empty() ? base : "<msup>" + base + high + "</msup>";
  }

  /// A group, a command, or one character.
  std::string argument() {
    skipBlanks();
    if (at_ >= text_.size()) return "<mrow/>";
    if (isDigit(text_[at_])) return "<mn>" + std::string(1, text_[at_++]) + "</mn>";
    return atom();
  }

  std::string atom() {
    const char c = text_[at_];
    if (c == '{') {
      ++at_;
      const std::string inner = list();
      take("}");
      return "<mrow>" + inner + "</mrow>";
    }
    if (c == '\\') return command();
    if (isDigit(c)) {
      std::string number;
      while (at_ < text_.size() && (isDigit(text_[at_]) || text_[at_] == '.')) number += text_[at_++];
      return "<mn>" + number + "</mn>";
    }
    ++at_;
    if (isLetter(c)) return "<mi>" + std::string(1, c) + "</mi>";
    if (c == '-') return "<mo>&#8722;</mo>";
    return "<mo>" + htmlEscaped(std::string(1, c)) + "</mo>";
  }

  std::string command() {
    ++at_;
    std::string name;
    while (at_ < text_.size() && isLetter(text_[at_])) name += text_[at_++];
    if (name.empty()) {  // "\," and the like are space; "\_" is the sign itself.
      const char c = at_ < text_.size() ? text_[at_++] : ' ';
      return std::string(",;:! ").find(c) != std::string::npos ? "<mspace width=\"0.2em\"/>"
                                                               : "<mi>" + htmlEscaped(std::string(1, c)) + "</mi>";
    }
    const auto sign = signs().find(name);
    if (sign != signs().end()) return sign->second;
    if (name == "frac" || name == "tfrac") {
      const std::string above = argument();
      return "<mfrac>" + above + argument() + "</mfrac>";
    }
    if (name == "sqrt") return "<msqrt>" + argument() + "</msqrt>";
    if (name == "dot") return "<mover accent=\"true\">" + argument() + "<mo>&#729;</mo></mover>";
    if (name == "mathrm" || name == "operatorname" || name == "text") return named(plainGroup());
    if (name == "left") return fenced();
    if (name == "begin") return matrix();
    return named(name);  // sin, cos, det, arccos and what is not known
  }

  static std::string named(const std::string& name) {
    return "<mi mathvariant=\"normal\">" + htmlEscaped(name) + "</mi>";
  }

  /// "{a\_b}" as "a_b".
  std::string plainGroup() {
    std::string plain;
    if (!take("{")) return plain;
    while (at_ < text_.size() && text_[at_] != '}') {
      if (text_[at_] != '\\') plain += text_[at_];
      ++at_;
    }
    take("}");
    return plain;
  }

  std::string fence() {
    const std::string sign = at_ < text_.size() ? std::string(1, text_[at_++]) : "";
    return sign == "." ? "" : "<mo>" + htmlEscaped(sign) + "</mo>";
  }

  std::string fenced() {
    const std::string open = fence();
    const std::string inner = list();
    const std::string close = take("\\right") ? fence() : "";
    return "<mrow>" + open + inner + close + "</mrow>";
  }

  std::string matrix() {
    plainGroup();
    std::string rows = "<mtr><mtd>";
    while (at_ < text_.size()) {
      rows += list();
      if (take("\\\\")) {
        rows += "</mtd></mtr><mtr><mtd>";
      } else if (take("&")) {
        rows += "</mtd><mtd>";
      } else if (take("\\end")) {
        plainGroup();
        break;
      } else {
        ++at_;
      }
    }
    return "<mrow><mo>(</mo><mtable>" + rows + "</mtd></mtr></mtable><mo>)</mo></mrow>";
  }

  const std::string& text_;
  std::size_t at_ = 0;
};

}  // namespace

std::string htmlEscaped(const std::string& plain) {
  std::string text;
  for (const char c : plain) {
    if (c == '&') {
      text += "&amp;";
    } else if (c == '<') {
      text += "&lt;";
    } else if (c == '>') {
      text += "&gt;";
    } else {
      text += c;
    }
  }
  return text;
}

std::string mathmlOf(const std::string& latex, bool display) {
  return std::string("<math") + (display ? " display=\"block\"" : "") + "><mrow>" + Converter(latex).all() +
         "</mrow></math>";
}

}  // namespace screwline

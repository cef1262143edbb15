#include "latex_layout.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdio>
#include <limits>

namespace screwline {
namespace {

constexpr double kScript = 0.65;      ///< Width of a script's character.
constexpr double kColumnSpace = 2.5;  ///< Between columns.
constexpr std::size_t kPageRows = 30;

std::string joined(const std::vector<std::string>& parts, const std::string& between) {
  std::string text;
  for (std::size_t i = 0; i < parts.size(); ++i) text += (i == 0 ? "" : between) + parts[i];
  return text;
}

void replaceAll(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
}

/// Widest entry of each column.
std::vector<double> columnWidths(const std::vector<std::vector<std::string>>& rows) {
  std::vector<double> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()), 0.0);
    for (std::size_t j = 0; j < row.size(); ++j) widths[j] = std::max(widths[j], latexWidth(row[j]));
  }
  return widths;
}

std::string pmatrix(const std::vector<std::string>& rows) {
  return "\\begin{pmatrix}\n" + joined(rows, " \\\\\n") + "\n\\end{pmatrix}";
}

/// A place to break before, how deep in brackets.
struct Break {
  std::size_t at;
  int depth;
};

std::vector<Break> breaksOf(const std::string& latex) {
  std::vector<Break> breaks;
  int braces = 0;
  int brackets = 0;
  for (std::size_t i = 0; i < latex.size(); ++i) {
    const char c = latex[i];
    if (c == '{') ++braces;
    if (c == '}') --braces;
    if (c == '(') ++brackets;
    if (c == ')') --brackets;
    const bool sign =
        (c == '+' || c == '-') && i > 0 && latex[i - 1] == ' ' && i + 1 < latex.size() && latex[i + 1] == ' ';
    if (sign && braces == 0) breaks.push_back({i, brackets});
  }
  return breaks;
}

}  // namespace

double latexWidth(const std::string& latex) {
  double width = 0.0;
  int script = 0;
  for (std::size_t i = 0; i < latex.size(); ++i) {
    const char c = latex[i];
    if (c == '\\') {
      std::size_t end = i + 1;
      while (end < latex.size() && std::isalpha(static_cast<unsigned char>(latex[end])) != 0) ++end;
      const std::string name = latex.substr(i + 1, end - i - 1);
      const bool spelled = name == "sin" || name == "cos" || name == "det" || name == "arccos" || name == "arcsin";
      const bool silent = name == "left" || name == "right" || name == "frac" || name == "mathrm" ||
                          name == "operatorname" || name == "bigl" || name == "bigr" || name == "dot";
      width += spelled ? static_cast<double>(name.size()) : silent ? 0.0 : 1.1;
      i = std::max(end, i + 2) - 1;
    } else if (c == '{') {
      script = script > 0 || (i > 0 && (latex[i - 1] == '_' || latex[i - 1] == '^')) ? script + 1 : 0;
    } else if (c == '}') {
      script = std::max(0, script - 1);
    } else if (c == '+' || c == '-' || c == '=') {
      width += script > 0 ? kScript : 2.4;
    } else if (c != ' ' && c != '_' && c != '^' && c != '$' && c != '&') {
      width += script > 0 ? kScript : 1.0;
    }
  }
  return width;
}

std::string withLooseBrackets(std::string latex) {
  replaceAll(latex, "\\left(", "\\bigl(");
  replaceAll(latex, "\\right)", "\\bigr)");
  return latex;
}

std::vector<std::string> latexLines(const std::string& latex, double width) {
  std::vector<std::string> lines;
  std::string rest = latex;
  while (latexWidth(rest) > width) {
    // Of the places in the last two thirds of the line the least deep; of these the last.
    std::size_t best = 0;
    int depth = std::numeric_limits<int>::max();
    for (const Break& place : breaksOf(rest)) {
      const double before = latexWidth(rest.substr(0, place.at));
      if (before > width && best > 0) break;
      if (place.depth > depth && before > width / 3.0 && best > 0) continue;
      if (before <= width / 3.0 && best > 0) continue;
      best = place.at;
      depth = before > width / 3.0 ? place.depth : std::numeric_limits<int>::max();
    }
    if (best == 0) break;
    lines.push_back(rest.substr(0, best));
    rest = rest.substr(best);
  }
  lines.push_back(rest);
  if (lines.size() > 1) std::transform(lines.begin(), lines.end(), lines.begin(), withLooseBrackets);
  return lines;
}

std::string latexEquation(const std::string& left, const std::string& right) {
  const double room = kLatexLine - latexWidth(left) - 4.0;
  const std::vector<std::string> lines = latexLines(right, room);
  if (lines.size() == 1) return "\\[ " + left + " = " + right + " \\]";
  return "\\begin{align*}\n" + left + " ={}& " + joined(lines, " \\\\\n& {}") + "\n\\end{align*}";
}

std::string latexMatrix(const std::string& left, const std::vector<std::vector<std::string>>& rows) {
  const std::vector<double> widths = columnWidths(rows);
  double whole = latexWidth(left) + 4.0;
  for (const double width : widths) whole += width + kColumnSpace;
  if (whole <= kLatexLine) {
    std::vector<std::string> lines;
    for (const auto& row : rows) lines.push_back(joined(row, " & "));
    return "\\[ " + left + " = " + pmatrix(lines) + " \\]";
  }
  std::string text;
  for (std::size_t j = 0; j < widths.size(); ++j) {
    const std::string column = std::to_string(j + 1);
    if (!text.empty()) text += "\n\n";
    if (widths[j] + latexWidth(left) + 16.0 <= kLatexLine) {
      std::vector<std::string> entries;
      for (const auto& row : rows) entries.push_back(row[j]);
      const std::string name = widths.size() > 1 ? "\\text{column " + column + " of } " + left : left;
      text += "\\[ " + name + " = " + pmatrix(entries) + " \\]";
      continue;
    }
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const std::string index = std::to_string(i + 1) + (widths.size() > 1 ? "," + column : "");
      text += (i == 0 ? "" : "\n\n") + latexEquation("\\left(" + left + "\\right)_{" + index + "}", rows[i][j]);
    }
  }
  return text;
}

std::string latexTable(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::vector<std::string>> all = {header};
  all.insert(all.end(), rows.begin(), rows.end());
  const std::vector<double> widths = columnWidths(all);
  double whole = 0.0;
  for (const double width : widths) whole += width + kColumnSpace;
  const std::size_t widest = static_cast<std::size_t>(std::max_element(widths.begin(), widths.end()) - widths.begin());
  std::string columns;
  for (std::size_t j = 0; j < widths.size(); ++j) {
    const double others = (whole - widths[widest] + 4.0) / kLatexLine;
    char share[40];
    std::snprintf(share, sizeof share, "p{%.2f\\textwidth}", std::max(0.3, 0.97 - others));
    columns += j == widest && whole > kLatexLine ? share : "l";
  }
  std::string text;
  for (std::size_t first = 0; first < rows.size() || first == 0; first += kPageRows) {
    text += std::string(first == 0 ? "" : "\n\n") + "\\begin{tabular}{" + columns + "}\n" + joined(header, " & ") +
            " \\\\ \\hline\n";
    for (std::size_t i = first; i < std::min(rows.size(), first + kPageRows); ++i)
      text += joined(rows[i], " & ") + " \\\\\n";
    text += "\\end{tabular}";
  }
  return text;
}

}  // namespace screwline

#include "screwline/symbolic/document.h"

#include <algorithm>
#include <cstddef>

#include "screwline/exception.h"

namespace screwline {
namespace {

std::string latexEscaped(const std::string& plain) {
  std::string text;
  for (const char c : plain) {
    if (c == '\\') {
      text += "\\textbackslash{}";
    } else if (c == '~' || c == '^') {
      text += std::string("\\") + c + "{}";
    } else {
      if (std::string("_%&#${}").find(c) != std::string::npos) text += '\\';
      text += c;
    }
  }
  return text;
}

std::string padded(const std::string& text, std::size_t width) {
  return text + std::string(width - text.size(), ' ');
}

std::string joinedRow(const std::vector<std::string>& cells, const std::string& between) {
  std::string row;
  for (std::size_t i = 0; i < cells.size(); ++i) row += (i == 0 ? "" : between) + cells[i];
  return row;
}

/// Rows of cells under each other, columns aligned.
std::string alignedRows(const std::vector<std::vector<std::string>>& rows, const std::string& before,
                        const std::string& after) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()), 0);
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const auto& row : rows) {
    std::vector<std::string> cells;
    for (std::size_t i = 0; i < row.size(); ++i) cells.push_back(padded(row[i], widths[i]));
    text += (text.empty() ? "" : "\n") + before + joinedRow(cells, "  ") + after;
  }
  return text;
}

}  // namespace

DocumentFormat documentFormatOf(const std::string& name) {
  if (name == "text") return DocumentFormat::kText;
  if (name == "markdown") return DocumentFormat::kMarkdown;
  if (name == "latex") return DocumentFormat::kLatex;
  throw InputError(AnswerCode::kInvalidGoal, "format is '" + name + "', known are text, markdown, latex");
}

std::string DocumentWriter::written(const Formula& formula) const {
  return write(formula, symbols_, format_ == DocumentFormat::kText ? FormulaStyle::kText : FormulaStyle::kLatex);
}

std::string DocumentWriter::formula(const Formula& formula) const {
  return format_ == DocumentFormat::kText ? written(formula) : "$" + written(formula) + "$";
}

std::string DocumentWriter::tuple(const FormulaMatrix& column) const {
  std::string entries;
  for (const Formula& entry : column.entries) entries += (entries.empty() ? "" : ", ") + written(entry);
  return symbol("(" + entries + ")", "\\left(" + entries + "\\right)");
}

std::string DocumentWriter::text(const std::string& plain) const {
  return format_ == DocumentFormat::kLatex ? latexEscaped(plain) : plain;
}

std::string DocumentWriter::symbol(const std::string& in_text, const std::string& in_latex) const {
  return format_ == DocumentFormat::kText ? in_text : "$" + in_latex + "$";
}

void DocumentWriter::heading(int level, const std::string& plain) {
  if (format_ == DocumentFormat::kMarkdown) {
    block(std::string(static_cast<std::size_t>(level), '#') + " " + plain);
  } else if (format_ == DocumentFormat::kLatex) {
    block("\\" + std::string(level == 1 ? "section*" : "subsection*") + "{" + latexEscaped(plain) + "}");
  } else {
    block(plain + "\n" + std::string(plain.size(), level == 1 ? '=' : '-'));
  }
}

void DocumentWriter::paragraph(const std::string& text) {
  block(text);
}

void DocumentWriter::equation(const std::string& left_text, const std::string& left_latex, const Formula& right) {
  if (format_ == DocumentFormat::kText) {
    block("  " + left_text + " = " + written(right));
  } else if (format_ == DocumentFormat::kMarkdown) {
    block("$$" + left_latex + " = " + written(right) + "$$");
  } else {
    block("\\[ " + left_latex + " = " + written(right) + " \\]");
  }
}

void DocumentWriter::matrix(const std::string& left_text, const std::string& left_latex, const FormulaMatrix& right) {
  std::vector<std::vector<std::string>> rows;
  for (int i = 0; i < right.rows; ++i) {
    rows.emplace_back();
    for (int j = 0; j < right.columns; ++j) rows.back().push_back(written(right(i, j)));
  }
  if (format_ == DocumentFormat::kText) {
    block("  " + left_text + " =\n" + alignedRows(rows, "    [ ", " ]"));
    return;
  }
  std::string entries;
  for (const auto& row : rows) entries += (entries.empty() ? "" : " \\\\\n") + joinedRow(row, " & ");
  const bool markdown = format_ == DocumentFormat::kMarkdown;
  const std::string body = left_latex + " = \\begin{pmatrix}\n" + entries + "\n\\end{pmatrix}";
  block((markdown ? "$$" : "\\[ ") + body + (markdown ? "$$" : " \\]"));
}

void DocumentWriter::table(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::vector<std::string>> all = {header};
  all.insert(all.end(), rows.begin(), rows.end());
  if (format_ == DocumentFormat::kText) {
    block(alignedRows(all, "  ", ""));
    return;
  }
  if (format_ == DocumentFormat::kMarkdown) {
    all.insert(all.begin() + 1, std::vector<std::string>(header.size(), "---"));
    std::string text;
    for (const auto& row : all) text += (text.empty() ? "" : "\n") + ("| " + joinedRow(row, " | ")) + " |";
    block(text);
    return;
  }
  std::string text = "\\begin{tabular}{" + std::string(header.size(), 'l') + "}\n";
  for (std::size_t i = 0; i < all.size(); ++i)
    text += joinedRow(all[i], " & ") + " \\\\" + (i == 0 ? " \\hline\n" : "\n");
  block(text + "\\end{tabular}");
}

void DocumentWriter::list(const std::vector<std::string>& items) {
  std::string text;
  const bool latex = format_ == DocumentFormat::kLatex;
  for (const std::string& item : items) text += (text.empty() ? "" : "\n") + ((latex ? "\\item " : "- ") + item);
  block(latex ? "\\begin{itemize}\n" + text + "\n\\end{itemize}" : text);
}

std::string DocumentWriter::finished() const {
  const std::string body = body_.substr(0, body_.find_last_not_of('\n') + 1) + "\n";
  if (format_ != DocumentFormat::kLatex) return body;
  return "\\documentclass{article}\n\\usepackage{amsmath}\n\\usepackage[landscape,margin=1.5cm]{geometry}\n"
         "\\setcounter{MaxMatrixCols}{64}\n\\begin{document}\n\n" +
         body + "\n\\end{document}\n";
}

}  // namespace screwline

#include "screwline/symbolic/document.h"

#include <algorithm>
#include <cstddef>

#include "latex_layout.h"
#include "mathml.h"
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
  if (name == "html") return DocumentFormat::kHtml;
  throw InputError(AnswerCode::kInvalidGoal, "format is '" + name + "', known are text, markdown, latex, html");
}

std::string DocumentWriter::written(const Formula& formula) const {
  return write(formula, symbols_, format_ == DocumentFormat::kText ? FormulaStyle::kText : FormulaStyle::kLatex);
}

std::string DocumentWriter::formula(const Formula& formula) const {
  return symbol(written(formula), written(formula));
}

std::string DocumentWriter::tuple(const FormulaMatrix& column) const {
  std::string entries;
  for (const Formula& entry : column.entries) entries += (entries.empty() ? "" : ", ") + written(entry);
  return symbol("(" + entries + ")", "\\left(" + entries + "\\right)");
}

std::string DocumentWriter::text(const std::string& plain) const {
  if (format_ == DocumentFormat::kHtml) return htmlEscaped(plain);
  return format_ == DocumentFormat::kLatex ? latexEscaped(plain) : plain;
}

std::string DocumentWriter::symbol(const std::string& in_text, const std::string& in_latex) const {
  if (format_ == DocumentFormat::kText) return in_text;
  if (format_ == DocumentFormat::kHtml) return mathmlOf(in_latex, false);
  const bool breaks = format_ == DocumentFormat::kLatex && latexWidth(in_latex) > kLatexLine / 3.0;
  return "$" + (breaks ? withLooseBrackets(in_latex) : in_latex) + "$";
}

void DocumentWriter::heading(int level, const std::string& plain) {
  if (format_ == DocumentFormat::kMarkdown) {
    block(std::string(static_cast<std::size_t>(level), '#') + " " + plain);
  } else if (format_ == DocumentFormat::kLatex) {
    block("\\" + std::string(level == 1 ? "section*" : "subsection*") + "{" + latexEscaped(plain) + "}");
  } else if (format_ == DocumentFormat::kHtml) {
    const std::string tag = "h" + std::to_string(level) + ">";
    block("<" + tag + htmlEscaped(plain) + "</" + tag);
  } else {
    block(plain + "\n" + std::string(plain.size(), level == 1 ? '=' : '-'));
  }
}

void DocumentWriter::paragraph(const std::string& text) {
  block(format_ == DocumentFormat::kHtml ? "<p>" + text + "</p>" : text);
}

std::string DocumentWriter::displayed(const std::string& latex) const {
  return format_ == DocumentFormat::kHtml ? mathmlOf(latex, true) : "$$" + latex + "$$";
}

void DocumentWriter::equation(const std::string& left_text, const std::string& left_latex, const Formula& right) {
  if (format_ == DocumentFormat::kText) {
    block("  " + left_text + " = " + written(right));
  } else if (format_ == DocumentFormat::kLatex) {
    block(latexEquation(left_latex, written(right)));
  } else {
    block(displayed(left_latex + " = " + written(right)));
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
  if (format_ == DocumentFormat::kLatex) {
    block(latexMatrix(left_latex, rows));
    return;
  }
  std::string entries;
  for (const auto& row : rows) entries += (entries.empty() ? "" : " \\\\\n") + joinedRow(row, " & ");
  block(displayed(left_latex + " = \\begin{pmatrix}\n" + entries + "\n\\end{pmatrix}"));
}

void DocumentWriter::table(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::vector<std::string>> all = {header};
  all.insert(all.end(), rows.begin(), rows.end());
  std::string text;
  if (format_ == DocumentFormat::kText) {
    text = alignedRows(all, "  ", "");
  } else if (format_ == DocumentFormat::kLatex) {
    text = latexTable(header, rows);
  } else if (format_ == DocumentFormat::kHtml) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      const std::string tag = i == 0 ? "th" : "td";
      const std::string between = "</" + tag + "><" + tag + ">";
      text += "<tr><" + tag + ">" + joinedRow(all[i], between) + "</" + tag + "></tr>\n";
    }
    text = "<table>\n" + text + "</table>";
  } else {
    all.insert(all.begin() + 1, std::vector<std::string>(header.size(), "---"));
    for (const auto& row : all) text += (text.empty() ? "" : "\n") + ("| " + joinedRow(row, " | ")) + " |";
  }
  block(text);
}

void DocumentWriter::list(const std::vector<std::string>& items) {
  const bool html = format_ == DocumentFormat::kHtml;
  const bool latex = format_ == DocumentFormat::kLatex;
  std::string text;
  for (const std::string& item : items) {
    const std::string marked = html ? "<li>" + item + "</li>" : (latex ? "\\item " : "- ") + item;
    text += (text.empty() ? "" : "\n") + marked;
  }
  if (html) text = "<ul>\n" + text + "\n</ul>";
  block(latex ? "\\begin{itemize}\n" + text + "\n\\end{itemize}" : text);
}

void DocumentWriter::figure(const Drawing& drawing, const std::string& caption, const std::string& file) {
  if (format_ == DocumentFormat::kHtml) {
    block("<figure>\n" + svgOf(drawing) + "<figcaption>" + htmlEscaped(caption) + "</figcaption>\n</figure>");
  } else if (format_ == DocumentFormat::kLatex) {
    block("\\begin{center}\n" + latexPictureOf(drawing) + "\n\n" + latexEscaped(caption) + "\n\\end{center}");
  } else if (format_ == DocumentFormat::kMarkdown && !file.empty()) {
    block("![" + caption + "](" + file + ")");
  }
}

std::string DocumentWriter::finished() const {
  const std::string body = body_.substr(0, body_.find_last_not_of('\n') + 1) + "\n";
  if (format_ == DocumentFormat::kHtml) {
    return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>Kinematics</title>\n<style>\n"
           "body { max-width: 70rem; margin: 2rem auto; padding: 0 1rem; font: 1rem/1.5 sans-serif; color: #1c232e; }\n"
           "h1, h2 { line-height: 1.2; border-bottom: 1px solid #d6dae0; padding-bottom: 0.2rem; }\n"
           "table { border-collapse: collapse; } th, td { padding: 0.25rem 0.8rem; border: 1px solid #d6dae0; "
           "text-align: "
           "left; }\n"
           "math[display=block] { overflow-x: auto; margin: 0.8rem 0; text-align: left; }\n"
           "mtd { padding: 0.15rem 0.6rem; }\nfigure { margin: 1rem 0; } svg { max-width: 100%; height: auto; }\n"
           "</style>\n</head>\n<body>\n\n" +
           body + "\n</body>\n</html>\n";
  }
  if (format_ != DocumentFormat::kLatex) return body;
  return "\\documentclass{article}\n\\usepackage{amsmath}\n\\usepackage[landscape,margin=1.5cm]{geometry}\n"
         "\\setcounter{MaxMatrixCols}{64}\n\\allowdisplaybreaks\n\\setlength{\\parindent}{0pt}\n"
         "\\setlength{\\parskip}{4pt}\n\\sloppy\n\\begin{document}\n\n" +
         body + "\n\\end{document}\n";
}

}  // namespace screwline

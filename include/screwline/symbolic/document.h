#ifndef SCREWLINE_SYMBOLIC_DOCUMENT_H
#define SCREWLINE_SYMBOLIC_DOCUMENT_H

#include <string>
#include <vector>

#include "screwline/symbolic/drawing.h"
#include "screwline/symbolic/formula.h"

namespace screwline {

enum class DocumentFormat { kText, kMarkdown, kLatex, kHtml };

/// "text", "markdown", "latex" or "html". @throws InputError (kInvalidGoal) for another name.
DocumentFormat documentFormatOf(const std::string& name);

/// Writes a document of headings, paragraphs, tables, formulas and drawings in one of four formats. Markdown has its
/// formulas as LaTeX between dollars; LaTeX is a whole file that needs amsmath, with formulas that are wider than the
/// page broken; HTML is a page that needs no other file, its formulas in MathML, its drawings in SVG.
class DocumentWriter {
 public:
  DocumentWriter(DocumentFormat format, const SymbolTable& symbols) : format_(format), symbols_(symbols) {}

  void heading(int level, const std::string& text);
  void paragraph(const std::string& text);
  /// left = right, the left side in text and in LaTeX.
  void equation(const std::string& left_text, const std::string& left_latex, const Formula& right);
  void matrix(const std::string& left_text, const std::string& left_latex, const FormulaMatrix& right);
  /// Cells that are ready: from text() or formula().
  void table(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows);
  /// In LaTeX and HTML the drawing itself; in Markdown a reference to `file`, where that is not empty; none in text.
  void figure(const Drawing& drawing, const std::string& caption, const std::string& file);
  void list(const std::vector<std::string>& items);

  /// A formula, a piece of plain text, within a paragraph, list or table.
  std::string formula(const Formula& formula) const;
  /// "(a, b, c)" of a column.
  std::string tuple(const FormulaMatrix& column) const;
  std::string text(const std::string& plain) const;
  /// The LaTeX form as the format has it (MathML in HTML); in text the other.
  std::string symbol(const std::string& in_text, const std::string& in_latex) const;

  std::string finished() const;
  /// What was written so far, as a part for another document of the same format.
  const std::string& body() const { return body_; }

 private:
  std::string written(const Formula& formula) const;
  std::string displayed(const std::string& latex) const;
  void block(const std::string& text) { body_ += text + "\n\n"; }

  DocumentFormat format_;
  const SymbolTable& symbols_;
  std::string body_;
};

}  // namespace screwline

#endif  // SCREWLINE_SYMBOLIC_DOCUMENT_H

#ifndef SCREWLINE_SRC_SYMBOLIC_LATEX_LAYOUT_H
#define SCREWLINE_SRC_SYMBOLIC_LATEX_LAYOUT_H

#include <string>
#include <vector>

namespace screwline {

constexpr double kLatexLine = 112.0;  ///< Characters that a line of the page holds.

/// About how wide a formula is, in characters of it.
double latexWidth(const std::string& latex);

/// Brackets that may be on different lines.
std::string withLooseBrackets(std::string latex);

/// The formula in pieces no wider than `width` where it has a plus or minus to break before, outside of braces and in
/// as few brackets as possible; brackets are loose where there is more than one piece.
std::vector<std::string> latexLines(const std::string& latex, double width);

/// "\[ left = right \]", or over several lines.
std::string latexEquation(const std::string& left, const std::string& right);

/// A matrix with rows of entries; where the page is too narrow for it column by column, where that is not enough entry
/// by entry.
std::string latexMatrix(const std::string& left, const std::vector<std::vector<std::string>>& rows);

/// A table, in parts no longer than a page; the widest column breaks its lines where the page asks for it.
std::string latexTable(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows);

}  // namespace screwline

#endif  // SCREWLINE_SRC_SYMBOLIC_LATEX_LAYOUT_H

#ifndef SCREWLINE_SRC_TOOLS_PDF_H
#define SCREWLINE_SRC_TOOLS_PDF_H

#include <string>

namespace screwline {

/// The PDF of a LaTeX document, by pdflatex in a folder of its own that is removed again. @throws Exception where
/// pdflatex is not installed, naming it, or where it fails, with its first error.
std::string pdfOf(const std::string& latex);

}  // namespace screwline

#endif  // SCREWLINE_SRC_TOOLS_PDF_H

#ifndef SCREWLINE_SRC_SYMBOLIC_MATHML_H
#define SCREWLINE_SRC_SYMBOLIC_MATHML_H

#include <string>

namespace screwline {

/// The MathML of a formula in LaTeX, of the part of the language that this package writes: scripts, \frac, \sqrt, \dot,
/// \mathrm, \operatorname, \left \right, pmatrix, Greek letters, named functions and operators. A command that is not
/// among them becomes its name. `display`: a formula on a line of its own.
std::string mathmlOf(const std::string& latex, bool display);

/// Plain text in HTML.
std::string htmlEscaped(const std::string& plain);

}  // namespace screwline

#endif  // SCREWLINE_SRC_SYMBOLIC_MATHML_H

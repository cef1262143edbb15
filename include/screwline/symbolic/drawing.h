#ifndef SCREWLINE_SYMBOLIC_DRAWING_H
#define SCREWLINE_SYMBOLIC_DRAWING_H

#include <string>
#include <vector>

#include "screwline/symbolic/symbolic_chain.h"

namespace screwline {

/// A point of a drawing, x to the right and y down.
using DrawingPoint = Eigen::Vector2d;

/// A shape of a drawing: a line or area through points, an ellipse, or a label.
struct DrawingShape {
  enum class Kind { kLine, kArea, kEllipse, kText };
  enum class Colour { kLink, kJoint, kAxisZ, kAxisX, kLength, kGround };

  Kind kind = Kind::kLine;
  Colour colour = Colour::kLink;
  std::vector<DrawingPoint> points;  ///< Of an ellipse its centre, of a label the middle of its text.
  double width = 1.0;                ///< Of its line.
  bool dashed = false;
  double half_major = 0.0;  ///< Of an ellipse.
  double half_minor = 0.0;
  double turn = 0.0;  ///< [rad] from x to the major half axis, clockwise as drawn.
  std::string text;   ///< "z_1": what follows the underscore is a subscript.
};

/// A mechanism with its frames, in the order of painting.
struct Drawing {
  double width = 0.0;
  double height = 0.0;
  std::vector<DrawingShape> shapes;
};

/// The chain's links, its joints as cylinders (revolute) and sleeves (prismatic), and the frames of its modified-DH
/// table with their z and x axes: in parallel projection, at joint values and from a side that keep its parts apart,
/// sizes not to scale between parts and joints. Deterministic; allocates.
Drawing drawingOf(const SerialChain& chain, const SymbolicChain& symbolic);

/// A document of its own that needs no other file. Labels are text.
std::string svgOf(const Drawing& drawing);

/// A LaTeX picture environment, without packages; its lines are PDF operators.
std::string latexPictureOf(const Drawing& drawing);

}  // namespace screwline

#endif  // SCREWLINE_SYMBOLIC_DRAWING_H

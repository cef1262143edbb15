#ifndef SCREWLINE_SRC_SYMBOLIC_DRAWING_SHAPES_H
#define SCREWLINE_SRC_SYMBOLIC_DRAWING_SHAPES_H

#include <string>
#include <vector>

#include "screwline/symbolic/drawing.h"

namespace screwline {

/// A joint in the drawing: axes as seen (right, down, towards the eye).
struct SolidJoint {
  DrawingPoint place;
  Vector3 z;
  Vector3 x;
  double depth = 0.0;
  bool prismatic = false;
};

/// Collects shapes and finds room for labels.
class DrawingSheet {
 public:
  void line(const std::vector<DrawingPoint>& points, DrawingShape::Colour colour, double width);
  void area(const std::vector<DrawingPoint>& points, DrawingShape::Colour colour);
  /// A cylinder about z, or a box along it.
  void joint(const SolidJoint& joint, double radius, double half_height);
  void arrow(const DrawingPoint& from, const DrawingPoint& to, DrawingShape::Colour colour);
  /// Near `at`, first tried on the side `away`.
  void label(const DrawingPoint& at, const DrawingPoint& away, const std::string& text, DrawingShape::Colour colour);
  /// Moved so that all shapes are inside, with a margin.
  Drawing finished(double margin);

 private:
  struct Box {
    DrawingPoint low;
    DrawingPoint high;
  };
  void cylinder(const SolidJoint& joint, double radius, double half_height);
  void box(const SolidJoint& joint, double radius, double half_height);
  double crowding(const Box& box) const;

  std::vector<DrawingShape> shapes_;
  std::vector<Box> labels_;
};

}  // namespace screwline

#endif  // SCREWLINE_SRC_SYMBOLIC_DRAWING_SHAPES_H

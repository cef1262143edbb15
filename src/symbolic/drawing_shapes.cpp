#include "drawing_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace screwline {
namespace {

constexpr double kHead = 9.0;    ///< Length of an arrow's head.
constexpr double kLetter = 7.5;  ///< Width of a label's character.
constexpr double kLabelHeight = 17.0;
constexpr double kOutline = 1.2;

using Kind = DrawingShape::Kind;

}  // namespace

void DrawingSheet::line(const std::vector<DrawingPoint>& points, DrawingShape::Colour colour, double width) {
  DrawingShape shape;
  shape.colour = colour;
  shape.points = points;
  shape.width = width;
  shapes_.push_back(shape);
}

void DrawingSheet::area(const std::vector<DrawingPoint>& points, DrawingShape::Colour colour) {
  DrawingShape shape;
  shape.kind = Kind::kArea;
  shape.colour = colour;
  shape.points = points;
  shape.width = kOutline;
  shapes_.push_back(shape);
}

void DrawingSheet::joint(const SolidJoint& joint, double radius, double half_height) {
  if (joint.prismatic) {
    box(joint, radius, half_height);
  } else {
    cylinder(joint, radius, half_height);
  }
}

void DrawingSheet::cylinder(const SolidJoint& joint, double radius, double half_height) {
  const double towards = joint.z.z() < 0.0 ? -1.0 : 1.0;  // The cap at this end is seen.
  const DrawingPoint along = half_height * towards * joint.z.head<2>();
  const double seen = joint.z.head<2>().norm();
  DrawingShape cap;
  cap.kind = Kind::kEllipse;
  cap.colour = DrawingShape::Colour::kJoint;
  cap.width = kOutline;
  cap.half_major = radius;
  cap.half_minor = std::max(radius * std::abs(joint.z.z()), 0.4);
  cap.turn = seen > 1e-9 ? std::atan2(joint.z.x(), -joint.z.y()) : 0.0;
  cap.points = {joint.place - along};
  shapes_.push_back(cap);
  const DrawingPoint side = radius * DrawingPoint(std::cos(cap.turn), std::sin(cap.turn));
  const DrawingPoint p = joint.place;
  area({p - along + side, p + along + side, p + along - side, p - along - side}, DrawingShape::Colour::kJoint);
  // The outline across the far cap is hidden by what is filled.
  cap.points = {joint.place + along};
  shapes_.push_back(cap);
}

void DrawingSheet::box(const SolidJoint& joint, double radius, double half_height) {
  const std::array<Vector3, 3> halves = {0.8 * radius * joint.x, 0.8 * radius * joint.z.cross(joint.x),
                                         1.2 * half_height * joint.z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Vector3& normal = halves[axis];
    const double sign = normal.z() < 0.0 ? -1.0 : 1.0;
    const DrawingPoint middle = joint.place + sign * normal.head<2>();
    const DrawingPoint u = halves[(axis + 1) % 3].head<2>();
    const DrawingPoint v = halves[(axis + 2) % 3].head<2>();
    area({middle + u + v, middle + u - v, middle - u - v, middle - u + v}, DrawingShape::Colour::kJoint);
  }
}

void DrawingSheet::arrow(const DrawingPoint& from, const DrawingPoint& to, DrawingShape::Colour colour) {
  const double length = (to - from).norm();
  const DrawingPoint along = length > 1e-9 ? DrawingPoint((to - from) / length) : DrawingPoint(1.0, 0.0);
  const double head = std::min(kHead, 0.6 * length);
  const DrawingPoint side(-along.y(), along.x());
  const DrawingPoint neck = to - head * along;
  line({from, neck}, colour, 1.8);
  area({to, neck + 0.38 * head * side, neck - 0.38 * head * side}, colour);
}

/// What a label there would cover: other labels weigh most, then joints and links.
double DrawingSheet::crowding(const Box& box) const {
  double cost = 0.0;
  for (const Box& other : labels_) {
    const DrawingPoint overlap = box.high.cwiseMin(other.high) - box.low.cwiseMax(other.low);
    if (overlap.minCoeff() > 0.0) cost += 100.0 + overlap.prod();
  }
  for (const DrawingShape& shape : shapes_) {
    for (std::size_t k = 0; k < shape.points.size(); ++k) {
      const DrawingPoint& a = shape.points[k];
      const DrawingPoint& b = shape.points[k + 1 < shape.points.size() ? k + 1 : k];
      const int steps = 1 + static_cast<int>((b - a).norm() / 6.0);
      for (int step = 0; step <= steps; ++step) {
        const DrawingPoint p = a + (b - a) * (static_cast<double>(step) / steps);
        if ((p - box.low).minCoeff() > 0.0 && (box.high - p).minCoeff() > 0.0) cost += shape.width > 2.0 ? 6.0 : 3.0;
      }
    }
  }
  return cost;
}

void DrawingSheet::label(const DrawingPoint& at, const DrawingPoint& away, const std::string& text,
                         DrawingShape::Colour colour) {
  const double letters = static_cast<double>(std::count_if(text.begin(), text.end(), [](char c) { return c != '_'; }));
  const DrawingPoint half(0.5 * kLetter * letters, 0.5 * kLabelHeight);
  const double first = std::atan2(away.y(), away.x());
  double least = std::numeric_limits<double>::max();
  DrawingPoint place = at;
  for (const double gap : {4.0, 12.0, 22.0}) {
    for (const double turn : {0.0, 0.6, -0.6, 1.2, -1.2, 1.9, -1.9, 2.5, -2.5, kPi}) {
      const DrawingPoint direction(std::cos(first + turn), std::sin(first + turn));
      const DrawingPoint middle = at + gap * direction + DrawingPoint(direction.cwiseProduct(half));
      const double cost = crowding({middle - half, middle + half}) + 0.6 * gap + 1.5 * std::abs(turn);
      if (cost >= least - 1e-9) continue;
      least = cost;
      place = middle;
    }
  }
  labels_.push_back({place - half, place + half});
  DrawingShape shape;
  shape.kind = Kind::kText;
  shape.colour = colour;
  shape.points = {place};
  shape.text = text;
  shapes_.push_back(shape);
}

Drawing DrawingSheet::finished(double margin) {
  DrawingPoint low = DrawingPoint::Constant(std::numeric_limits<double>::max());
  DrawingPoint high = -low;
  const auto include = [&low, &high](const DrawingPoint& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  };
  for (const DrawingShape& shape : shapes_) {
    for (const DrawingPoint& p : shape.points) include(p);
  }
  for (const Box& box : labels_) {
    include(box.low);
    include(box.high);
  }
  const DrawingPoint shift = DrawingPoint::Constant(0.3 * margin) - low;
  for (DrawingShape& shape : shapes_) {
    for (DrawingPoint& p : shape.points) p += shift;
  }
  const DrawingPoint size = high + shift + DrawingPoint::Constant(0.3 * margin);
  return {std::ceil(size.x()), std::ceil(size.y()), shapes_};
}

}  // namespace screwline

#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "screwline/symbolic/drawing.h"

namespace screwline {
namespace {

using Colour = DrawingShape::Colour;
using Kind = DrawingShape::Kind;

/// Line and fill of each Colour, red, green, blue.
struct Paint {
  std::array<int, 3> line;
  std::array<int, 3> fill;
};
constexpr std::array<Paint, 6> kPaints = {{{{90, 98, 110}, {90, 98, 110}},
                                           {{40, 50, 66}, {232, 223, 200}},
                                           {{29, 78, 216}, {29, 78, 216}},
                                           {{200, 40, 40}, {200, 40, 40}},
                                           {{70, 76, 84}, {70, 76, 84}},
                                           {{120, 128, 138}, {214, 218, 224}}}};

const Paint& paintOf(const DrawingShape& shape) {
  return kPaints[static_cast<std::size_t>(shape.colour)];
}

/// One decimal, and no minus zero: the same on every machine.
std::string number(double value) {
  char text[32];
  const double rounded = std::round(value * 10.0) / 10.0;
  std::snprintf(text, sizeof text, "%.1f", rounded == 0.0 ? 0.0 : rounded);
  return text;
}

std::string hex(const std::array<int, 3>& colour) {
  char text[16];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", static_cast<unsigned>(colour[0]), static_cast<unsigned>(colour[1]),
                static_cast<unsigned>(colour[2]));
  return text;
}

std::string svgPoints(const DrawingShape& shape) {
  std::string text;
  for (const DrawingPoint& p : shape.points) text += (text.empty() ? "" : " ") + number(p.x()) + "," + number(p.y());
  return text;
}

/// "z_1 z_2" with its subscripts lowered.
std::string svgLabel(const std::string& text) {
  std::string result;
  bool low = false;
  for (const char c : text) {
    if (c == '_') {
      result += "<tspan dy=\"4\" font-size=\"10\">";
      low = true;
      continue;
    }
    const bool in_subscript = (c >= '0' && c <= '9') || c == 'T';
    if (low && !in_subscript) {
      result += "</tspan><tspan dy=\"-4\">&#8203;</tspan>";
      low = false;
    }
    result += c;
  }
  return result + (low ? "</tspan>" : "");
}

std::string svgShape(const DrawingShape& shape) {
  const Paint& paint = paintOf(shape);
  const std::string stroke = " stroke=\"" + hex(paint.line) + "\" stroke-width=\"" + number(shape.width) + "\"";
  const DrawingPoint p = shape.points.front();
  switch (shape.kind) {
    case Kind::kLine:
      return "<polyline points=\"" + svgPoints(shape) + "\" fill=\"none\"" + stroke + "/>\n";
    case Kind::kArea:
      return "<polygon points=\"" + svgPoints(shape) + "\" fill=\"" + hex(paint.fill) + "\"" + stroke + "/>\n";
    case Kind::kEllipse:
      return "<ellipse rx=\"" + number(shape.half_major) + "\" ry=\"" + number(shape.half_minor) +
             "\" transform=\"translate(" + number(p.x()) + " " + number(p.y()) + ") rotate(" +
             number(shape.turn * 180.0 / kPi) + ")\" fill=\"" + hex(paint.fill) + "\"" + stroke + "/>\n";
    case Kind::kText:
      break;
  }
  return "<text x=\"" + number(p.x()) + "\" y=\"" + number(p.y() + 5.0) + "\" fill=\"" + hex(paint.fill) + "\">" +
         svgLabel(shape.text) + "</text>\n";
}

std::string pdfColour(const std::array<int, 3>& colour, const char* what) {
  char text[64];
  std::snprintf(text, sizeof text, "%.3f %.3f %.3f %s ", colour[0] / 255.0, colour[1] / 255.0, colour[2] / 255.0, what);
  return text;
}

std::string pdfPoint(const DrawingPoint& p, double height) {
  return number(p.x()) + " " + number(height - p.y()) + " ";
}

/// A closed curve of four cubics, the usual approximation of an ellipse.
std::string pdfEllipse(const DrawingShape& shape, double height) {
  constexpr double kHandle = 0.5522847498;
  const DrawingPoint u = shape.half_major * DrawingPoint(std::cos(shape.turn), std::sin(shape.turn));
  const DrawingPoint v = shape.half_minor * DrawingPoint(-std::sin(shape.turn), std::cos(shape.turn));
  const DrawingPoint c = shape.points.front();
  std::string text = pdfPoint(c + u, height) + "m ";
  std::array<DrawingPoint, 5> ends = {u, v, -u, -v, u};
  for (std::size_t k = 0; k < 4; ++k) {
    text += pdfPoint(c + ends[k] + kHandle * ends[k + 1], height) +
            pdfPoint(c + ends[k + 1] + kHandle * ends[k], height) + pdfPoint(c + ends[k + 1], height) + "c ";
  }
  return text + "b ";
}

std::string pdfShape(const DrawingShape& shape, double height) {
  const Paint& paint = paintOf(shape);
  std::string text = pdfColour(paint.line, "RG") + pdfColour(paint.fill, "rg") + number(shape.width) + " w ";
  if (shape.kind == Kind::kEllipse) return text + pdfEllipse(shape, height);
  for (std::size_t k = 0; k < shape.points.size(); ++k)
    text += pdfPoint(shape.points[k], height) + (k == 0 ? "m " : "l ");
  return text + (shape.kind == Kind::kLine ? "S " : "b ");
}

std::string latexLabel(const std::string& text) {
  std::string result;
  bool low = false;
  for (const char c : text) {
    const bool in_subscript = (c >= '0' && c <= '9') || c == 'T';
    if (low && !in_subscript) {
      result += "}";
      low = false;
    }
    if (c == '_') {
      result += "_{";
      low = true;
    } else {
      result += c == ' ' ? std::string("\\,") : std::string(1, c);
    }
  }
  return result + (low ? "}" : "");
}

}  // namespace

std::string svgOf(const Drawing& drawing) {
  const std::string size = number(drawing.width) + " " + number(drawing.height);
  std::string text = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + size + "\" width=\"" +
                     number(drawing.width) + "\" height=\"" + number(drawing.height) +
                     "\" font-family=\"sans-serif\" font-size=\"14\" text-anchor=\"middle\" stroke-linejoin=\"round\" "
                     "stroke-linecap=\"round\">\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n";
  for (const DrawingShape& shape : drawing.shapes) text += svgShape(shape);
  return text + "</svg>\n";
}

std::string latexPictureOf(const Drawing& drawing) {
  std::string text = "{\\setlength{\\unitlength}{0.7bp}\\begin{picture}(" + number(drawing.width) + "," +
                     number(drawing.height) +
                     ")\n\\ifdefined\\pdfliteral\\put(0,0){\\pdfliteral{q 0.7 0 0 0.7 0 0 cm 1 j 1 J\n";
  for (const DrawingShape& shape : drawing.shapes) {
    if (shape.kind != Kind::kText) text += pdfShape(shape, drawing.height) + "\n";
  }
  text += "Q}}\\fi\n";
  for (const DrawingShape& shape : drawing.shapes) {
    if (shape.kind != Kind::kText) continue;
    const DrawingPoint p = shape.points.front();
    text += "\\put(" + number(p.x()) + "," + number(drawing.height - p.y()) + "){\\makebox(0,0){\\small $" +
            latexLabel(shape.text) + "$}}\n";
  }
  return text + "\\end{picture}}";
}

}  // namespace screwline

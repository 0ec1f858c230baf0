// SPDX-License-Identifier: Apache-2.0
#include "burin/view/canvas.h"

#include <cmath>

#include "burin/base/text.h"
#include "burin/base/utf8.h"
#include "burin/view/encode.h"
#include "burin/view/stroke_font.h"

namespace burin::view {
namespace {

using geom::Point2;

std::string num(double v) {
  return format_fixed(v, 2);
}

std::string colour_text(const Colour& c) {
  static constexpr char kHex[] = "0123456789abcdef";
  std::string out = "#";
  for (const unsigned v : {unsigned{c.r}, unsigned{c.g}, unsigned{c.b}}) {
    out += kHex[v / 16];
    out += kHex[v % 16];
  }
  return out;
}

std::string fill_of(const Colour& c) {
  return " fill=\"" + colour_text(c) + "\"" +
         (c.alpha < 1 ? " fill-opacity=\"" + num(c.alpha) + "\"" : std::string());
}

std::string path_data(const std::vector<Point2>& points) {
  std::string d;
  for (const Point2 p : points) d += (d.empty() ? "M" : "L") + num(p.x) + " " + num(p.y);
  return d;
}

/// Text of a file may hold damaged UTF-8, which no reader of XML takes.
std::string xml_text(std::string_view text) {
  std::string out;
  for (const char32_t c : code_points(text)) append_utf8(out, c);
  return html_text(out);
}

std::vector<Point2> circle_points(Point2 centre, double radius) {
  constexpr int kCorners = 48;
  std::vector<Point2> out;
  for (int i = 0; i <= kCorners; ++i) {
    const double t = 2 * geom::kPi * i / kCorners;
    out.push_back({centre.x + radius * std::cos(t), centre.y + radius * std::sin(t)});
  }
  return out;
}

}  // namespace

void Canvas::circle(Point2 centre, double radius, const Colour& fill) {
  polygon(circle_points(centre, radius), fill);
}
void Canvas::ring(Point2 centre, double radius, const Pen& pen) {
  line(circle_points(centre, radius), pen);
}

double text_width(std::string_view text, double size) {
  return lay_text(text).width * size * kCapitalShare / kCapital;
}

void SvgCanvas::box(double x0, double y0, double x1, double y1, const Colour& fill) {
  body_ += "<rect shape-rendering=\"crispEdges\" x=\"" + num(x0) + "\" y=\"" + num(y0) + "\" width=\"" +
           num(x1 - x0) + "\" height=\"" + num(y1 - y0) + "\"" + fill_of(fill) + "/>\n";
}

void SvgCanvas::polygon(const std::vector<Point2>& corners, const Colour& fill) {
  body_ += "<path d=\"" + path_data(corners) + "Z\"" + fill_of(fill) + "/>\n";
}

void SvgCanvas::line(const std::vector<Point2>& points, const Pen& pen) {
  body_ += "<path d=\"" + path_data(points) + "\" fill=\"none\" stroke=\"" + colour_text(pen.colour) +
           "\" stroke-width=\"" + num(pen.width) + "\"" +
           (pen.colour.alpha < 1 ? " stroke-opacity=\"" + num(pen.colour.alpha) + "\"" : std::string()) +
           " stroke-linecap=\"round\" stroke-linejoin=\"round\"/>\n";
}

void SvgCanvas::text(double x, double y, std::string_view text, const TextStyle& style) {
  static constexpr const char* kAnchors[] = {"start", "middle", "end"};
  body_ += "<text x=\"" + num(x) + "\" y=\"" + num(y) + "\" font-size=\"" + num(style.size) + "\"" +
           fill_of(style.colour) + " text-anchor=\"" + kAnchors[static_cast<int>(style.anchor)] + "\"" +
           (style.bold ? " font-weight=\"600\"" : "") +
           (style.upwards ? " transform=\"rotate(-90 " + num(x) + " " + num(y) + ")\"" : std::string()) +
           (style.halo > 0 ? " stroke=\"#ffffff\" stroke-opacity=\"0.85\" paint-order=\"stroke\" "
                             "stroke-linejoin=\"round\" stroke-width=\"" +
                                 num(2 * style.halo) + "\""
                           : std::string()) +
           ">" + xml_text(text) + "</text>\n";
}

std::string SvgCanvas::svg(std::string_view title) const {
  const std::string w = num(width_), h = num(height_);
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + w + " " + h + "\" width=\"" + w +
         "\" height=\"" + h + "\" font-family=\"system-ui, DejaVu Sans, sans-serif\">\n<title>" +
         xml_text(title) + "</title>\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n" + body_ +
         "</svg>\n";
}

}  // namespace burin::view

// SPDX-License-Identifier: Apache-2.0
#include "burin/io/svg/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "burin/base/text.h"
#include "burin/io/svg/scanner.h"

namespace burin::io::svg {

using geom::Point2;

namespace {

constexpr std::string_view kShapes[] = {"path", "rect", "circle", "ellipse", "line", "polyline", "polygon"};

struct Field {
  std::string_view name;
  Axis axis;
  bool size;  // must not be negative
};

/// Several lengths of one element; `auto` and absent ones are NaN.
template <std::size_t N>
Result<std::array<double, N>> read_fields(const Element& element, const LengthFrame& frame,
                                          const std::array<Field, N>& fields) {
  std::array<double, N> values{};
  for (std::size_t i = 0; i < N; ++i) {
    auto value = frame.read(element, fields[i].name, fields[i].axis, std::nan(""));
    if (!value) return value.error();
    if (fields[i].size && *value < 0) {
      return Error{ErrorCode::range,
                   std::string(fields[i].name) + "=\"" +
                       std::string(element.get(fields[i].name).substr(0, 40)) +
                       "\" is negative (0 or more is accepted)",
                   {}};
    }
    values[i] = *value;
  }
  return values;
}

double or_zero(double value) {
  return std::isnan(value) ? 0 : value;
}

Outline nothing() {
  Outline outline;
  outline.points_dropped = 1;
  return outline;
}

Outline closed_curve(geom::Curve2 curve) {
  Outline outline;
  outline.paths.push_back({{std::move(curve)}, true});
  return outline;
}

/// A radius that is absent takes the other one's value.
void share_radii(double& rx, double& ry) {
  if (std::isnan(rx)) rx = ry;
  if (std::isnan(ry)) ry = rx;
  rx = or_zero(rx);
  ry = or_zero(ry);
}

/// Starts behind the first corner, as the standard says. Precondition: 0 <= rx <= w / 2, 0 <= ry <= h / 2, w,
/// h > 0, both radii zero or none.
Outline rounded_rect(double x, double y, double w, double h, double rx, double ry) {
  const double right = x + w, bottom = y + h;
  // Where a side has no straight part left, both of its corners must meet in the same point.
  const double x1 = x + rx, x2 = rx == w / 2 ? x1 : right - rx;
  const double y1 = y + ry, y2 = ry == h / 2 ? y1 : bottom - ry;
  OutlineBuilder builder;
  const auto corner = [&builder, rx, ry](Point2 p) {
    if (rx > 0) builder.arc_to(rx, ry, 0, false, true, p);
  };
  builder.move_to({x1, y});
  builder.line_to({x2, y});
  corner({right, y1});
  builder.line_to({right, y2});
  corner({x2, bottom});
  builder.line_to({x1, bottom});
  corner({x, y2});
  builder.line_to({x, y1});
  corner({x1, y});
  builder.close();
  return builder.finish();
}

Result<Outline> rect(const Element& element, const LengthFrame& frame) {
  constexpr std::array<Field, 6> kFields{{{"x", Axis::x, false},
                                          {"y", Axis::y, false},
                                          {"width", Axis::x, true},
                                          {"height", Axis::y, true},
                                          {"rx", Axis::x, true},
                                          {"ry", Axis::y, true}}};
  const auto fields = read_fields(element, frame, kFields);
  if (!fields) return fields.error();
  auto [x, y, w, h, rx, ry] = *fields;
  w = or_zero(w);
  h = or_zero(h);
  if (w == 0 || h == 0) return nothing();
  share_radii(rx, ry);
  rx = std::min(rx, w / 2);
  ry = std::min(ry, h / 2);
  if (rx == 0 || ry == 0) rx = ry = 0;
  return rounded_rect(or_zero(x), or_zero(y), w, h, rx, ry);
}

Result<Outline> circle(const Element& element, const LengthFrame& frame) {
  constexpr std::array<Field, 3> kFields{
      {{"cx", Axis::x, false}, {"cy", Axis::y, false}, {"r", Axis::both, true}}};
  const auto fields = read_fields(element, frame, kFields);
  if (!fields) return fields.error();
  const auto [cx, cy, r] = *fields;
  if (or_zero(r) == 0) return nothing();
  return closed_curve(geom::Arc2{{or_zero(cx), or_zero(cy)}, r, 0, 2 * geom::kPi});
}

Result<Outline> ellipse(const Element& element, const LengthFrame& frame) {
  constexpr std::array<Field, 4> kFields{
      {{"cx", Axis::x, false}, {"cy", Axis::y, false}, {"rx", Axis::x, true}, {"ry", Axis::y, true}}};
  const auto fields = read_fields(element, frame, kFields);
  if (!fields) return fields.error();
  auto [cx, cy, rx, ry] = *fields;
  share_radii(rx, ry);
  if (rx == 0 || ry == 0) return nothing();
  const Point2 center{or_zero(cx), or_zero(cy)};
  if (rx == ry) return closed_curve(geom::Arc2{center, rx, 0, 2 * geom::kPi});
  return closed_curve(geom::EllipseArc2{center, {rx, 0}, {0, ry}, 0, 2 * geom::kPi});
}

Result<Outline> line(const Element& element, const LengthFrame& frame) {
  constexpr std::array<Field, 4> kFields{
      {{"x1", Axis::x, false}, {"y1", Axis::y, false}, {"x2", Axis::x, false}, {"y2", Axis::y, false}}};
  const auto fields = read_fields(element, frame, kFields);
  if (!fields) return fields.error();
  const auto [x1, y1, x2, y2] = *fields;
  OutlineBuilder builder;
  builder.move_to({or_zero(x1), or_zero(y1)});
  builder.line_to({or_zero(x2), or_zero(y2)});
  return builder.finish();
}

Result<Outline> polyline(const Element& element, bool closed, std::size_t max_curves) {
  std::vector<double> v;
  const std::string_view points = element.get("points");
  const std::size_t max_numbers = std::min(max_curves, std::size_t{1} << 40) * 2 + 2;
  if (!read_numbers(points, max_numbers, v)) {
    return v.size() >= max_numbers
               ? Error{ErrorCode::range, "more curves than the limit of " + std::to_string(max_curves), {}}
               : Error{ErrorCode::syntax,
                       "points, number " + std::to_string(v.size() + 1) +
                           ": not a number (pairs of numbers are accepted)",
                       {}};
  }
  if (v.size() % 2 != 0) {
    return Error{ErrorCode::syntax, "points holds an odd number of coordinates (pairs are accepted)", {}};
  }
  OutlineBuilder builder;
  for (std::size_t i = 0; i < v.size(); i += 2) {
    const Point2 p{v[i], v[i + 1]};
    i == 0 ? builder.move_to(p) : builder.line_to(p);
  }
  if (closed && !v.empty()) builder.close();
  return builder.finish();
}

}  // namespace

Result<double> LengthFrame::read(const Element& element, std::string_view name, Axis axis,
                                 double fallback) const {
  return read_text(element.get(name), name, axis, fallback);
}

Result<double> LengthFrame::read_text(std::string_view text, std::string_view name, Axis axis,
                                      double fallback) const {
  text = trim(text);
  if (text.empty() || text == "auto") return fallback;
  const std::string shown = std::string(name) + "=\"" + std::string(text.substr(0, 40)) + "\"";
  const auto length = parse_length(text);
  if (!length) return Error{ErrorCode::syntax, shown + " (a length such as 10, 10mm or 50% is accepted)", {}};
  const auto value = length_in_user_units(*length, px_per_inch, viewport, axis);
  if (!value) {
    return Error{ErrorCode::unsupported,
                 shown + " refers to a page size that the file does not give (a length is accepted)",
                 {}};
  }
  return *value;
}

bool is_shape(const Element& element) {
  return element.ns == Namespace::svg &&
         std::find(std::begin(kShapes), std::end(kShapes), element.name) != std::end(kShapes);
}

Result<Outline> outline_of(const Element& element, const LengthFrame& frame, std::size_t max_curves) {
  if (element.name == "rect") return rect(element, frame);
  if (element.name == "circle") return circle(element, frame);
  if (element.name == "ellipse") return ellipse(element, frame);
  if (element.name == "line") return line(element, frame);
  if (element.name == "polyline") return polyline(element, false, max_curves);
  if (element.name == "polygon") return polyline(element, true, max_curves);
  const std::string_view data = trim(element.get("d"));
  return data == "none" ? Outline{} : parse_path_data(element.get("d"), max_curves);
}

}  // namespace burin::io::svg

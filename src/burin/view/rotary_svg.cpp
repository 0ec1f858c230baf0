// SPDX-License-Identifier: Apache-2.0
// The paper's figure 8 b and c for one section: the offset path with the first axes, those that interfere in
// another colour, and beside it the axes chosen.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "burin/base/text.h"
#include "burin/view/encode.h"
#include "burin/view/rotary_html.h"
#include "burin/view/rotary_places.h"
#include "burin/view/rotary_shape.h"

namespace burin::view {
namespace {

using geom::Point2;
using rotary::RotaryPlan;
using rotary::RotaryPoint;

constexpr double kPanel = 460, kMargin = 24, kHead = 34, kFoot = 58;
constexpr std::size_t kSections = 400;
constexpr std::size_t kAxes = 500;  ///< drawn at most

std::string num(double v) {
  return format_fixed(v, 2);
}

/// mm of the section -> picture: y to the right, z up.
struct Frame {
  double left = 0, scale = 1, reach = 1;
  double x(double y) const { return left + (y + reach) * scale; }
  double y(double z) const { return kHead + (reach - z) * scale; }
};

/// How the points of a plan were laid out is seen from its first path: rings stand in planes.
rotary::Pattern pattern_of(const RotaryPlan& plan) {
  const std::size_t paths = plan.points.empty() ? 0 : plan.points.back().path + 1;
  if (paths <= 1) return rotary::Pattern::spiral;
  double x0 = 1e300, x1 = -1e300, all0 = 1e300, all1 = -1e300;
  for (const RotaryPoint& p : plan.points) {
    const double x = p.place.contact.p.x;
    all0 = std::min(all0, x), all1 = std::max(all1, x);
    if (p.path == 0) x0 = std::min(x0, x), x1 = std::max(x1, x);
  }
  return x1 - x0 > 0.5 * (all1 - all0) ? rotary::Pattern::lines : rotary::Pattern::rings;
}

/// The section with the most first axes that interfere; among equals the one nearest to the middle.
struct Chosen {
  SectionPlace place;
  std::vector<std::size_t> points;
};
Chosen choose(const rotary::Part& part, const RotaryPlan& plan) {
  const rotary::Pattern pattern = pattern_of(plan);
  const std::vector<SectionPlace> places = section_places(part, plan, pattern, kSections);
  const double pitch = std::max(plan.quality.side_step_max_mm, 1e-6);
  const double between =
      (part.x_max - part.x_min) / static_cast<double>(std::max<std::size_t>(1, places.size()));
  const double half = (pattern == rotary::Pattern::spiral ? pitch : between) / 2;
  Chosen best;
  double best_rank = -1;
  const double middle = (part.x_min + part.x_max) / 2, length = std::max(part.x_max - part.x_min, 1e-6);
  for (const SectionPlace& place : places) {
    const std::vector<std::size_t> points = section_points(plan, pattern, place, half);
    double rank = 1 - std::abs(place.x - middle) / length;
    for (const std::size_t i : points) rank += plan.points[i].initial_interferes ? 1 : 0;
    if (rank > best_rank) best = {place, points}, best_rank = rank;
  }
  return best;
}

std::string outline_svg(const Outline& outline, const Frame& f) {
  std::string d;
  for (const auto& loop : outline) {
    for (std::size_t i = 0; i < loop.size(); ++i)
      d += (i == 0 ? "M" : "L") + num(f.x(loop[i].x)) + " " + num(f.y(loop[i].y));
    d += "Z";
  }
  return "<path class=\"part\" d=\"" + d + "\"/>\n";
}

std::string offset_svg(const RotaryPlan& plan, const std::vector<std::size_t>& points, const Frame& f,
                       double gap_mm) {
  std::string d;
  const RotaryPoint* before = nullptr;
  for (const std::size_t i : points) {
    const RotaryPoint& p = plan.points[i];
    if (p.place.state == rotary::State::unreachable) {
      before = nullptr;
      continue;
    }
    const bool joined = before && norm(p.place.center - before->place.center) < gap_mm;
    d += (joined ? "L" : "M") + num(f.x(p.place.center.y)) + " " + num(f.y(p.place.center.z));
    before = &p;
  }
  return "<path class=\"offset\" d=\"" + d + "\"/>\n";
}

std::string axes_svg(const RotaryPlan& plan, const std::vector<std::size_t>& points, const Frame& f,
                     double length, bool resolved) {
  const std::size_t every = points.size() / kAxes + 1;
  std::string good, bad;
  for (std::size_t k = 0; k < points.size(); k += every) {
    const RotaryPoint& p = plan.points[points[k]];
    if (resolved && p.place.state == rotary::State::unreachable) continue;
    const double theta = resolved ? p.theta : p.initial;
    const geom::Point3 c = p.place.center;
    std::string& d = !resolved && p.initial_interferes ? bad : good;
    d += "M" + num(f.x(c.y)) + " " + num(f.y(c.z)) + "L" + num(f.x(c.y + length * std::sin(theta))) + " " +
         num(f.y(c.z + length * std::cos(theta)));
  }
  return "<path class=\"axis\" d=\"" + good + "\"/>\n<path class=\"bad\" d=\"" + bad + "\"/>\n";
}

std::string marks_svg(const RotaryPlan& plan, const std::vector<std::size_t>& points, const Frame& f) {
  std::string text;
  for (const std::size_t i : points) {
    const RotaryPoint& p = plan.points[i];
    if (p.place.state != rotary::State::unreachable) continue;
    const geom::Point3 at = p.place.contact.p;
    text +=
        "<circle class=\"left\" cx=\"" + num(f.x(at.y)) + "\" cy=\"" + num(f.y(at.z)) + "\" r=\"2.5\"/>\n";
  }
  return text;
}

/// A length that reads well, about a quarter of the reach.
double round_length(double about) {
  const double ten = std::pow(10.0, std::floor(std::log10(std::max(about, 1e-6))));
  return about / ten < 2 ? ten : about / ten < 5 ? 2 * ten : 5 * ten;
}

std::string key_svg(double x, const char* what, const std::string& name) {
  const double y = kHead + kPanel + 20;
  return "<path class=\"" + std::string(what) + " key\" d=\"M" + num(x) + " " + num(y) + "h22\"/><text x=\"" +
         num(x + 28) + "\" y=\"" + num(y + 4) + "\">" + html_text(name) + "</text>\n";
}

}  // namespace

std::string rotary_svg(const rotary::Part& part, const RotaryPlan& plan, const model::BallTool& tool) {
  const Chosen chosen = choose(part, plan);
  const double axis = std::max(0.28 * part.radius_max, 2 * tool.radius);
  Frame f;
  f.reach = std::max(part.radius_max + tool.radius + axis, 1e-3);
  f.scale = kPanel / (2 * f.reach);
  const std::vector<Outline> drawn = outlines(part, {chosen.place.x}, 2e-4 * std::max(part.radius_max, 1e-3));
  std::size_t interfering = 0, left = 0;
  for (const std::size_t i : chosen.points) {
    interfering += plan.points[i].initial_interferes ? 1 : 0;
    left += plan.points[i].place.state == rotary::State::unreachable ? 1 : 0;
  }
  const double width = 2 * kPanel + 3 * kMargin, height = kHead + kPanel + kFoot;
  std::string svg =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + num(width) + " " + num(height) +
      "\" width=\"" + num(width) + "\" height=\"" + num(height) +
      "\" font-family=\"system-ui, DejaVu Sans, sans-serif\" font-size=\"13\">\n<style>"
      ".bg{fill:#fff}.part{fill:#dfe4ea;stroke:#1b2430;stroke-width:1.2;fill-rule:evenodd}"
      ".offset{fill:none;stroke:#00897b;stroke-width:1}"
      ".axis{fill:none;stroke:#0b62c4;stroke-width:.8}.bad{fill:none;stroke:#c62828;stroke-width:.8}"
      ".key{stroke-width:2}.left{fill:#c62828}.cross{stroke:#8a94a3;stroke-width:1}text{fill:#1b2430}"
      "</style>\n<rect class=\"bg\" width=\"100%\" height=\"100%\"/>\n";
  for (const bool resolved : {false, true}) {
    f.left = resolved ? 2 * kMargin + kPanel : kMargin;
    const std::string title =
        resolved ? "Axes chosen" +
                       (left > 0 ? " (" + std::to_string(left) + " places not reached)" : std::string())
                 : "First axes: " + std::to_string(interfering) + " of " +
                       std::to_string(chosen.points.size()) + " interfere";
    svg += "<text x=\"" + num(f.left) + "\" y=\"22\" font-weight=\"600\">" + html_text(title) + "</text>\n";
    svg += outline_svg(drawn.front(), f) + offset_svg(plan, chosen.points, f, part.radius_max / 2);
    svg += axes_svg(plan, chosen.points, f, axis, resolved) +
           (resolved ? marks_svg(plan, chosen.points, f) : "");
    svg += "<path class=\"cross\" d=\"M" + num(f.x(0) - 6) + " " + num(f.y(0)) + "h12M" + num(f.x(0)) + " " +
           num(f.y(0) - 6) + "v12\"/>\n";
  }
  const double bar = round_length(f.reach / 2), y = kHead + kPanel + 44;
  svg += key_svg(kMargin, "part", "section at x = " + num(chosen.place.x) + " mm");
  svg += key_svg(kMargin + 230, "offset", "centre of the ball") + key_svg(kMargin + 410, "axis", "tool axis");
  svg += key_svg(kMargin + 520, "bad", "tool axis that interferes");
  svg += "<path class=\"cross\" d=\"M" + num(kMargin) + " " + num(y - 4) + "v4h" + num(bar * f.scale) +
         "v-4\" fill=\"none\"/>" + "<text x=\"" + num(kMargin + bar * f.scale + 8) + "\" y=\"" + num(y + 3) +
         "\">" + format_shortest(bar) + " mm; y to the right, z up</text>\n</svg>\n";
  return svg;
}

}  // namespace burin::view

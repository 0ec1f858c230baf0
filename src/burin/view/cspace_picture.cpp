// SPDX-License-Identifier: Apache-2.0
#include "burin/view/cspace_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "burin/base/text.h"
#include "burin/view/canvas.h"
#include "burin/view/cspace_contours.h"

namespace burin::view {
namespace {

using geom::Point2;
using orient::Angles;
using orient::Cause;

constexpr double kWidth = 960, kHeight = 720, kPixels = 1.5;  ///< pixels a point
constexpr double kLeft = 76, kTop = 58, kRight = 706, kBottom = 652, kColumn = 730;
constexpr Colour kInk{27, 36, 48}, kSoft{91, 103, 118}, kLine{176, 184, 194}, kGrid{255, 255, 255, 0.55};
constexpr Colour kContour{27, 36, 48, 0.78}, kChosen{200, 0, 96}, kFirst{11, 98, 196};
/// What the contours keep from each other where they are widest apart.
constexpr double kContourGap = 30;

struct Kind {
  Cause cause;
  const char* name;
  Colour colour;
};
constexpr std::array kKinds{Kind{Cause::none, "feasible", {238, 246, 239}},
                            Kind{Cause::gouge, "gouge", {229, 145, 140}},
                            Kind{Cause::collision, "collision", {246, 200, 118}},
                            Kind{Cause::limit, "machine limit", {186, 174, 222}}};
const Kind& kind_of(Cause cause) {
  const auto found =
      std::find_if(kKinds.begin(), kKinds.end(), [&](const Kind& k) { return k.cause == cause; });
  return found == kKinds.end() ? kKinds.front() : *found;
}

/// Angles -> points of the picture.
struct Frame {
  orient::AngleRange range;
  double x(double alpha) const {
    const double size = range.alpha_hi - range.alpha_lo;
    return kLeft + (size > 0 ? (alpha - range.alpha_lo) / size : 0.5) * (kRight - kLeft);
  }
  double y(double beta) const {
    const double size = range.beta_hi - range.beta_lo;
    return kBottom - (size > 0 ? (beta - range.beta_lo) / size : 0.5) * (kBottom - kTop);
  }
  Point2 at(const Angles& a) const { return {x(a.alpha), y(a.beta)}; }
};

std::string degrees_text(double radians, int decimals) {
  return format_fixed(geom::degrees(radians), decimals) + "\u00b0";
}

// --- cells

/// A node stands for the cell around it, cut at the borders of the range.
double border(double lo, double hi, int k, int count) {
  const double at = (k - 0.5) / (count - 1);
  return lo + (hi - lo) * std::clamp(at, 0.0, 1.0);
}

void draw_cells(Canvas& canvas, const orient::CSpaceMap& map, const Frame& f) {
  const orient::AngleRange& r = map.range;
  const auto x = [&](int i) { return f.x(border(r.alpha_lo, r.alpha_hi, i, map.tilts)); };
  const auto y = [&](int j) { return f.y(border(r.beta_lo, r.beta_hi, j, map.yaws)); };
  for (int j = 0; j < map.yaws; ++j) {
    for (int i = 0; i < map.tilts;) {
      int end = i + 1;
      while (end < map.tilts && map.at(end, j) == map.at(i, j)) ++end;
      canvas.box(x(i), y(j + 1), x(end), y(j), kind_of(map.at(i, j)).colour);
      i = end;
    }
  }
  // Where one cause ends and another begins.
  const Pen pen{{90, 60, 60, 0.55}, 0.9};
  for (int i = 1; i < map.tilts; ++i) {
    for (int j = 0; j < map.yaws; ++j) {
      const int from = j;
      while (j < map.yaws && map.at(i, j) != map.at(i - 1, j)) ++j;
      if (j > from) canvas.line({{x(i), y(from)}, {x(i), y(j)}}, pen);
    }
  }
  for (int j = 1; j < map.yaws; ++j) {
    for (int i = 0; i < map.tilts; ++i) {
      const int from = i;
      while (i < map.tilts && map.at(i, j) != map.at(i, j - 1)) ++i;
      if (i > from) canvas.line({{x(from), y(j)}, {x(i), y(j)}}, pen);
    }
  }
}

// --- axes

/// Round places, in degrees, about `count` of them.
std::vector<double> ticks(double lo, double hi, int count) {
  std::vector<double> out;
  const double span = hi - lo;
  if (!(span > 0) || !std::isfinite(span)) return out;
  const std::array steps{0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 45.0, 90.0};
  double step = steps.back();
  for (auto s = steps.rbegin(); s != steps.rend(); ++s)
    if (span / *s <= count) step = *s;
  constexpr double kSlack = 1e-9;  // a range's end is a tick although it came from radians
  for (double k = std::ceil(lo / step - kSlack); k * step <= hi + kSlack * step; ++k) out.push_back(k * step);
  return out;
}

void draw_grid(Canvas& canvas, const Frame& f) {
  const auto radians = [](double d) { return d * geom::kPi / 180; };
  for (const double t : ticks(geom::degrees(f.range.alpha_lo), geom::degrees(f.range.alpha_hi), 14))
    canvas.line({{f.x(radians(t)), kTop}, {f.x(radians(t)), kBottom}}, {kGrid, 0.8});
  for (const double t : ticks(geom::degrees(f.range.beta_lo), geom::degrees(f.range.beta_hi), 14))
    canvas.line({{kLeft, f.y(radians(t))}, {kRight, f.y(radians(t))}}, {kGrid, 0.8});
}

void draw_axes(Canvas& canvas, const Frame& f) {
  const auto radians = [](double d) { return d * geom::kPi / 180; };
  canvas.line({{kLeft, kTop}, {kRight, kTop}, {kRight, kBottom}, {kLeft, kBottom}, {kLeft, kTop}},
              {kSoft, 1});
  const TextStyle below{12.5, kSoft, Anchor::middle}, left{12.5, kSoft, Anchor::end};
  for (const double t : ticks(geom::degrees(f.range.alpha_lo), geom::degrees(f.range.alpha_hi), 14)) {
    const double x = f.x(radians(t));
    canvas.line({{x, kBottom}, {x, kBottom + 5}}, {kSoft, 1});
    canvas.text(x, kBottom + 19, format_fixed(t, 2), below);
  }
  for (const double t : ticks(geom::degrees(f.range.beta_lo), geom::degrees(f.range.beta_hi), 14)) {
    const double y = f.y(radians(t));
    canvas.line({{kLeft - 5, y}, {kLeft, y}}, {kSoft, 1});
    canvas.text(kLeft - 9, y + 4.5, format_fixed(t, 2), left);
  }
  canvas.text((kLeft + kRight) / 2, kBottom + 43, "tilt \u03b1, degrees", {14, kInk, Anchor::middle});
  TextStyle upwards{14, kInk, Anchor::middle};
  upwards.upwards = true;
  canvas.text(26, (kTop + kBottom) / 2, "yaw \u03b2, degrees", upwards);
}

// --- contours

struct Box {
  double x0, y0, x1, y1;
  bool meets(const Box& o) const { return x0 < o.x1 && o.x0 < x1 && y0 < o.y1 && o.y0 < y1; }
};

/// The place along a contour with the most room for its value, or none.
struct Label {
  bool found = false;
  Box box{};
};
Label place_label(const std::vector<std::vector<std::vector<Point2>>>& all, std::size_t own, double width,
                  const std::vector<Box>& taken) {
  constexpr double kHalf = 8, kEnough = 60;
  Label best;
  double best_room = -1;
  for (const auto& piece : all[own]) {
    for (std::size_t i = 0; i < piece.size(); i += 4) {
      const Point2 p = piece[i];
      const Box box{p.x - width / 2 - 3, p.y - kHalf, p.x + width / 2 + 3, p.y + kHalf};
      if (box.x0 < kLeft + 2 || box.x1 > kRight - 2 || box.y0 < kTop + 2 || box.y1 > kBottom - 2) continue;
      if (std::any_of(taken.begin(), taken.end(), [&](const Box& t) { return box.meets(t); })) continue;
      double room = kEnough;
      for (std::size_t k = 0; k < all.size(); ++k) {
        if (k == own) continue;
        for (const auto& other : all[k]) {
          for (std::size_t n = 0; n < other.size(); n += 6)
            room = std::min(room, std::hypot((other[n].x - p.x) * 0.6, other[n].y - p.y));
        }
      }
      room -= 0.03 * std::abs(p.y - (kTop + kBottom) / 2);  // rather in the middle
      if (room > best_room) best = {true, box}, best_room = room;
    }
  }
  return best;
}

void draw_contours(Canvas& canvas, const CSpacePicture& picture, const Frame& f) {
  const std::vector<double> levels =
      contour_levels(f.range, *picture.mill, (kRight - kLeft), (kBottom - kTop), kContourGap);
  std::vector<std::vector<std::vector<Point2>>> all;
  for (const double level : levels) {
    all.emplace_back();
    for (const auto& piece : contour_of(level, f.range, *picture.mill)) {
      std::vector<Point2> line;
      for (const Angles& a : piece) line.push_back(f.at(a));
      canvas.line(line, {kContour, 1.1});
      all.back().push_back(std::move(line));
    }
  }
  std::vector<Box> taken;
  for (const auto& m : picture.marks) {
    const Point2 p = f.at(m.angles);
    taken.push_back({p.x - 10, p.y - 10, p.x + 10, p.y + 10});
  }
  for (std::size_t k = 0; k < levels.size(); ++k) {
    const std::string text = format_fixed(levels[k], 6);
    TextStyle style{12, kInk, Anchor::middle};
    style.halo = 2.4;
    const Label label = place_label(all, k, text_width(text, style.size), taken);
    if (!label.found) continue;
    taken.push_back(label.box);
    canvas.text((label.box.x0 + label.box.x1) / 2, label.box.y1 - 3.7, text, style);
  }
}

// --- marks and legend

void draw_mark(Canvas& canvas, Point2 p, std::size_t number) {
  if (number == 0) {
    canvas.circle(p, 7, {255, 255, 255});
    canvas.ring(p, 6, {kFirst, 2.4});
    return;
  }
  canvas.circle(p, 7.6, {255, 255, 255});
  canvas.circle(p, 6, number == 1 ? kChosen : kInk);
}

std::string shortened(std::string text, double size, double width) {
  if (text_width(text, size) <= width) return text;
  while (!text.empty() && text_width(text + "...", size) > width) {
    // Whole characters go.
    while (!text.empty() && (static_cast<unsigned char>(text.back()) >> 6) == 2) text.pop_back();
    if (!text.empty()) text.pop_back();
  }
  return text + "...";
}

std::string radius_text(double rho) {
  return std::isfinite(rho) ? format_fixed(rho, rho < 100 ? 2 : 1) + " mm" : "unbounded";
}

std::string mill_text(const model::Mill& mill) {
  const bool bull = mill.kind == model::MillKind::bull && mill.corner_radius > 0;
  return std::string(bull ? "bull nose" : "flat end") + ", R " + format_fixed(mill.radius, 3) +
         (bull ? ", r " + format_fixed(mill.corner_radius, 3) : std::string()) + " mm";
}

void draw_legend(Canvas& canvas, const CSpacePicture& picture) {
  const double room = kWidth - kColumn - 18;
  double y = kTop + 12;
  const TextStyle head{12.5, kSoft, Anchor::start, true}, plain{13, kInk}, soft{12.5, kSoft};
  canvas.text(kColumn, y, "Tool", head);
  canvas.text(kColumn, y += 20, shortened(mill_text(*picture.mill), 13, room), plain);
  canvas.text(kColumn, y += 34, "Angles", head);
  const orient::CSpaceMap& map = *picture.map;
  for (const Kind& kind : kKinds) {
    const auto n = std::count(map.cells.begin(), map.cells.end(), kind.cause);
    if (n == 0) continue;
    y += 22;
    canvas.box(kColumn, y - 11, kColumn + 18, y + 2, kind.colour);
    canvas.line({{kColumn, y - 11},
                 {kColumn + 18, y - 11},
                 {kColumn + 18, y + 2},
                 {kColumn, y + 2},
                 {kColumn, y - 11}},
                {kLine, 0.8});
    canvas.text(kColumn + 27, y, kind.name, plain);
    const double share = 100.0 * static_cast<double>(n) / static_cast<double>(map.cells.size());
    canvas.text(kColumn + room, y, (share < 0.1 ? "<0.1" : format_fixed(share, 1)) + " %",
                {12.5, kSoft, Anchor::end});
  }
  canvas.text(kColumn, y += 22,
              std::to_string(map.tilts) + " x " + std::to_string(map.yaws) + " poses tested", soft);
  canvas.text(kColumn, y += 36, "Effective radius, mm", head);
  y += 22;
  canvas.line({{kColumn, y - 4}, {kColumn + 18, y - 4}}, {kContour, 1.1});
  canvas.text(kColumn + 27, y, "contours, closed form", plain);
  if (!picture.marks.empty()) canvas.text(kColumn, y += 36, "Chosen angles", head);
  for (std::size_t k = 0; k < picture.marks.size() && y < kBottom - 70; ++k) {
    const auto& mark = picture.marks[k];
    y += 24;
    draw_mark(canvas, {kColumn + 9, y - 4.5}, k);
    canvas.text(kColumn + 27, y, shortened(mark.name, 13, room - 27), plain);
    canvas.text(kColumn + 27, y += 18, "tilt " + degrees_text(mark.angles.alpha, 3), soft);
    canvas.text(kColumn + 27, y += 17, "yaw " + degrees_text(mark.angles.beta, 3), soft);
    canvas.text(kColumn + 27, y += 17, "radius " + radius_text(effective_radius(mark.angles, *picture.mill)),
                soft);
  }
}

void draw(Canvas& canvas, const CSpacePicture& picture) {
  canvas.text(kLeft, 36, shortened(picture.title, 17, kWidth - kLeft - 20), {17, kInk, Anchor::start, true});
  const bool drawn = picture.map && picture.mill && picture.map->tilts >= 2 && picture.map->yaws >= 2 &&
                     picture.map->cells.size() == static_cast<std::size_t>(picture.map->tilts) *
                                                      static_cast<std::size_t>(picture.map->yaws);
  if (!drawn) {
    canvas.text(kWidth / 2, kHeight / 2, "no map", {15, kSoft, Anchor::middle});
    return;
  }
  const Frame f{picture.map->range};
  draw_cells(canvas, *picture.map, f);
  draw_grid(canvas, f);
  draw_contours(canvas, picture, f);
  draw_axes(canvas, f);
  for (std::size_t k = 0; k < picture.marks.size(); ++k) {
    const Point2 p = f.at(picture.marks[k].angles);
    const bool inside = p.x > kLeft - 1 && p.x < kRight + 1 && p.y > kTop - 1 && p.y < kBottom + 1;
    if (inside) draw_mark(canvas, p, k);
  }
  draw_legend(canvas, picture);
}

}  // namespace

std::string cspace_png(const CSpacePicture& picture) {
  PixelCanvas canvas(kWidth, kHeight, kPixels);
  draw(canvas, picture);
  return canvas.png();
}

std::string cspace_svg(const CSpacePicture& picture) {
  SvgCanvas canvas(kWidth, kHeight);
  draw(canvas, picture);
  return canvas.svg(picture.title);
}

}  // namespace burin::view

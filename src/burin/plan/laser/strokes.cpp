// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/laser/strokes.h"

#include <algorithm>
#include <cmath>

namespace burin::laser::detail {

using geom::ArcSpline;
using geom::Point2;
using geom::Segment;
using geom::Vec2;

Vec2 towards_waste(Vec2 tangent, Waste waste) {
  switch (waste) {
    case Waste::left:
      return geom::left(tangent);
    case Waste::right:
      return geom::right(tangent);
    case Waste::none:
      break;
  }
  return {};
}

Segment part_of(const Segment& s, double from, double to) {
  Segment part = s;
  if (from > 0) part.a = geom::point_on(s, from);
  if (to < 1) part.b = geom::point_on(s, to);
  return part;
}

ArcSpline started_at(const ArcSpline& spline, std::size_t index, double fraction) {
  const auto& all = spline.segments;
  ArcSpline out;
  out.closed = spline.closed;
  out.segments.reserve(all.size() + 1);
  const bool split = fraction > 0 && fraction < 1;
  out.segments.push_back(split ? part_of(all[index], fraction, 1) : all[index]);
  for (std::size_t k = 1; k < all.size(); ++k) out.segments.push_back(all[(index + k) % all.size()]);
  if (split) {
    out.segments.push_back(part_of(all[index], 0, fraction));
    out.segments.back().b = out.segments.front().a;
  }
  return out;
}

std::vector<double> stations(const std::vector<Stroke>& strokes) {
  std::vector<double> at{0};
  for (const Stroke& s : strokes) at.push_back(at.back() + geom::length_of(s.segment));
  return at;
}

std::vector<Span> normalized(std::vector<Span> spans, double length, bool closed) {
  std::vector<Span> inside;
  for (Span s : spans) {
    if (s.to - s.from >= length) return {{0, length}};
    if (closed && s.from < 0) {
      inside.push_back({s.from + length, length});
    }
    if (closed && s.to > length) inside.push_back({0, s.to - length});
    s = {std::max(s.from, 0.0), std::min(s.to, length)};
    if (s.from < s.to) inside.push_back(s);
  }
  std::sort(inside.begin(), inside.end(),
            [](Span a, Span b) { return a.from != b.from ? a.from < b.from : a.to < b.to; });
  std::vector<Span> out;
  for (const Span s : inside) {
    if (!out.empty() && s.from <= out.back().to) {
      out.back().to = std::max(out.back().to, s.to);
    } else {
      out.push_back(s);
    }
  }
  return out;
}

std::vector<Stroke> first_of(const std::vector<Stroke>& strokes, double length, double point_mm) {
  std::vector<Stroke> out;
  for (const Stroke& s : strokes) {
    if (length <= point_mm) break;
    const double own = geom::length_of(s.segment);
    out.push_back(s);
    if (own > length + point_mm) out.back().segment = part_of(s.segment, 0, length / own);
    length -= own;
  }
  return out;
}

void append_chords(const Segment& s, double sagitta, std::vector<Segment>& out) {
  if (s.is_line()) {
    out.push_back(s);
    return;
  }
  // A chord over the angle 2 h lies r (1 - cos h) = 2 r sin^2(h / 2) off its arc.
  const double r = std::abs(s.radius);
  const double half = 2 * std::asin(std::sqrt(std::min(1.0, sagitta / (2 * r))));
  constexpr double kMost = 1e5;  // chords of one arc: finer is a tolerance by mistake
  const double n = std::clamp(std::ceil(std::abs(geom::sweep_of(s)) / (2 * half)), 1.0, kMost);
  Point2 from = s.a;
  for (double k = 1; k <= n; ++k) {
    const Point2 to = k < n ? geom::point_on(s, k / n) : s.b;
    out.push_back(geom::make_line(from, to, s.source));
    from = to;
  }
}

}  // namespace burin::laser::detail

// SPDX-License-Identifier: Apache-2.0
// Pieces of a beam path with what they are for, between the contour and the records of the program. Internal
// to the laser planner.
#pragma once

#include <cstddef>
#include <vector>

#include "burin/geom/curve/arc_spline.h"
#include "burin/plan/laser/toolpath.h"

namespace burin::laser::detail {

/// Where the waste lies, seen in the direction of travel.
enum class Waste { left, right, none };

/// Unit vector towards the waste for a travel direction.
geom::Vec2 towards_waste(geom::Vec2 tangent, Waste waste);

struct Stroke {
  geom::Segment segment;
  MoveKind kind = MoveKind::cut;
  bool slow = false;  ///< reduced feed (and power)
  bool beam = true;
};

/// Interval of arc length along a path.
struct Span {
  double from = 0, to = 0;
};

/// The part of a segment between two fractions of its length; the whole segment, bit by bit, for 0 and 1.
geom::Segment part_of(const geom::Segment& s, double from, double to);

/// A closed spline that starts at `fraction` of segment `index`; fraction 0 keeps every segment as it is.
geom::ArcSpline started_at(const geom::ArcSpline& spline, std::size_t index, double fraction);

/// Lengths from the start to the start of every stroke, and the whole at the end.
std::vector<double> stations(const std::vector<Stroke>& strokes);

/// Sorted, disjoint spans within [0, length]; what sticks out at the ends is taken in again at the other end
/// when `closed`, else cut off.
std::vector<Span> normalized(std::vector<Span> spans, double length, bool closed);

/// Cuts the strokes at the ends of the spans and calls `mark` for every stroke inside one. Pieces shorter
/// than `point_mm` are not made: the cut moves to the end of the stroke.
template <class Mark>
std::vector<Stroke> marked(const std::vector<Stroke>& strokes, const std::vector<Span>& spans,
                           double point_mm, Mark&& mark) {
  std::vector<Stroke> out;
  double at = 0;
  std::size_t span = 0;
  for (const Stroke& s : strokes) {
    const double length = geom::length_of(s.segment);
    const double end = at + length;
    std::vector<double> cuts{0};
    while (span < spans.size() && spans[span].to < at + point_mm) ++span;
    for (std::size_t k = span; k < spans.size() && spans[k].from < end; ++k) {
      for (const double c : {spans[k].from, spans[k].to}) {
        if (c > at + point_mm && c < end - point_mm) cuts.push_back(c - at);
      }
    }
    cuts.push_back(length);
    std::size_t k = span;
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
      Stroke piece = s;
      const bool last = i + 2 == cuts.size();
      piece.segment = part_of(s.segment, length > 0 ? cuts[i] / length : 0, last ? 1 : cuts[i + 1] / length);
      const double middle = at + (cuts[i] + cuts[i + 1]) / 2;
      while (k < spans.size() && spans[k].to < middle) ++k;
      if (k < spans.size() && spans[k].from <= middle) mark(piece);
      out.push_back(piece);
    }
    at = end;
  }
  return out;
}

/// The first `length` of the strokes (all of them at most).
std::vector<Stroke> first_of(const std::vector<Stroke>& strokes, double length, double point_mm);

/// Lines from the start to the end of a segment, at most `sagitta` from it.
void append_chords(const geom::Segment& s, double sagitta, std::vector<geom::Segment>& out);

}  // namespace burin::laser::detail

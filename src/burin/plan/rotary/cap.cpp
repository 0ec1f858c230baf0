// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/rotary/cap.h"

#include <algorithm>
#include <cmath>

namespace burin::rotary::detail {
namespace {

using geom::Box2;
using geom::Point2;

/// Whether c lies clearly to the left of the way from a to b: points along a straight line, which differ from
/// it by rounding, are no ears.
bool turns_left(Point2 a, Point2 b, Point2 c) {
  constexpr double kStraight = 1e-9;  // radians
  const geom::Vec2 ab = b - a, bc = c - b;
  return cross(ab, bc) > kStraight * std::sqrt(norm2(ab) * norm2(bc));
}

/// Reflex vertices by grid cell; they leave lazily when they become convex or are cut off.
class Grid {
 public:
  Grid(const std::vector<Point2>& points, const std::vector<std::uint8_t>& reflex) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      box_.add(points[i]);
      count += reflex[i];
    }
    side_ = std::clamp<int>(int(std::sqrt(double(count))), 1, 1024);
    cells_.resize(std::size_t(side_) * std::size_t(side_));
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (reflex[i]) cells_[cell(column(points[i].x), row(points[i].y))].push_back(std::uint32_t(i));
    }
  }
  /// visit(i) returns true to forget i, false to keep it; `found` ends the walk.
  template <class Visit>
  bool any(const Box2& area, Visit&& found) {
    for (int r = row(area.lo.y); r <= row(area.hi.y); ++r) {
      for (int c = column(area.lo.x); c <= column(area.hi.x); ++c) {
        for (const std::uint32_t i : cells_[cell(c, r)]) {
          if (found(i)) return true;
        }
      }
    }
    return false;
  }
  void remove(Point2 p, std::uint32_t i) {
    std::vector<std::uint32_t>& cell_of = cells_[cell(column(p.x), row(p.y))];
    cell_of.erase(std::remove(cell_of.begin(), cell_of.end(), i), cell_of.end());
  }

 private:
  int place(double v, double lo, double size) const {
    return size > 0 ? std::clamp(int(side_ * ((v - lo) / size)), 0, side_ - 1) : 0;
  }
  int column(double x) const { return place(x, box_.lo.x, box_.width()); }
  int row(double y) const { return place(y, box_.lo.y, box_.height()); }
  std::size_t cell(int c, int r) const { return std::size_t(r) * std::size_t(side_) + std::size_t(c); }

  Box2 box_;
  int side_ = 1;
  std::vector<std::vector<std::uint32_t>> cells_;
};

class Clipper {
 public:
  explicit Clipper(const std::vector<Point2>& polygon)
      : p_(polygon),
        before_(polygon.size()),
        after_(polygon.size()),
        reflex_(reflex_of(polygon)),
        grid_(polygon, reflex_) {
    const std::size_t n = polygon.size();
    for (std::size_t i = 0; i < n; ++i) {
      before_[i] = std::uint32_t((i + n - 1) % n);
      after_[i] = std::uint32_t((i + 1) % n);
    }
  }

  std::vector<std::array<std::uint32_t, 3>> run() {
    std::vector<std::array<std::uint32_t, 3>> out;
    std::size_t left = p_.size(), idle = 0;
    out.reserve(left - 2);
    std::uint32_t at = 0;
    while (left > 3) {
      // Nothing fits in a whole round (a polygon that touches itself): the vertex is cut all the same.
      if (is_ear(at) || idle > left) {
        out.push_back({before_[at], at, after_[at]});
        const std::uint32_t next = after_[at];
        drop(at);
        --left;
        idle = 0;
        at = after_[next];  // every other vertex: triangles stay compact
      } else {
        ++idle;
        at = after_[at];
      }
    }
    out.push_back({before_[at], at, after_[at]});
    return out;
  }

 private:
  static std::vector<std::uint8_t> reflex_of(const std::vector<Point2>& p) {
    std::vector<std::uint8_t> reflex(p.size());
    for (std::size_t i = 0, n = p.size(); i < n; ++i) {
      reflex[i] = !turns_left(p[(i + n - 1) % n], p[i], p[(i + 1) % n]);
    }
    return reflex;
  }
  bool is_ear(std::uint32_t i) {
    if (reflex_[i]) return false;
    const Point2 a = p_[before_[i]], b = p_[i], c = p_[after_[i]];
    Box2 box;
    box.add(a);
    box.add(b);
    box.add(c);
    return !grid_.any(box, [&](std::uint32_t k) {
      if (k == i || k == before_[i] || k == after_[i]) return false;
      const Point2 q = p_[k];
      if (q == a || q == b || q == c) return false;
      return cross(b - a, q - a) >= 0 && cross(c - b, q - b) >= 0 && cross(a - c, q - c) >= 0;
    });
  }
  void drop(std::uint32_t i) {
    if (reflex_[i]) grid_.remove(p_[i], i);
    const std::uint32_t a = before_[i], b = after_[i];
    after_[a] = b;
    before_[b] = a;
    for (const std::uint32_t k : {a, b}) {
      if (!reflex_[k] || !turns_left(p_[before_[k]], p_[k], p_[after_[k]])) continue;
      reflex_[k] = 0;
      grid_.remove(p_[k], k);
    }
  }

  const std::vector<Point2>& p_;
  std::vector<std::uint32_t> before_, after_;
  std::vector<std::uint8_t> reflex_;
  Grid grid_;
};

}  // namespace

std::vector<std::array<std::uint32_t, 3>> triangulate(const std::vector<geom::Point2>& polygon) {
  if (polygon.size() < 3) return {};
  return Clipper(polygon).run();
}

}  // namespace burin::rotary::detail

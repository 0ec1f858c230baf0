// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/mesh/slice.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "burin/geom/mesh/edges.h"

namespace burin::geom {

namespace {

using CornerNormals = std::vector<std::array<Vec3, 3>>;

/// A triangle that the plane crosses: in over `begin`, out over `end` (half-edges), the outside to the right
/// of its way seen against X.
struct Piece {
  std::uint32_t triangle = 0;
  HalfEdge begin = 0, end = 0;
};

class Slice {
 public:
  Slice(const Mesh& mesh, const CornerNormals& normals, double x) : mesh_(mesh), normals_(normals), x_(x) {}

  void add(std::uint32_t triangle) {
    if (!is_triangle(mesh_, triangle)) return;
    Piece piece{triangle};
    bool begins = false, ends = false;
    for (HalfEdge h = 3 * triangle; h < 3 * triangle + 3; ++h) {
      const bool a = above(from(mesh_, h)), b = above(to(mesh_, h));
      if (a && !b) piece.begin = h, begins = true;
      if (b && !a) piece.end = h, ends = true;
    }
    if (begins && ends) pieces_.push_back(piece);
  }

  std::vector<SliceLoop> loops() {
    join();
    std::vector<std::pair<std::uint32_t, SliceLoop>> found;
    used_.assign(pieces_.size(), false);
    // Open chains from their beginnings, then what is closed from its lowest triangle.
    for (std::uint32_t i = 0; i < pieces_.size(); ++i) {
      if (!used_[i] && !has_before_[i]) found.push_back(follow(i));
    }
    for (std::uint32_t i = 0; i < pieces_.size(); ++i) {
      if (!used_[i]) found.push_back(follow(i));
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<SliceLoop> out;
    for (auto& [lowest, loop] : found) {
      if (loop.points.size() >= (loop.closed ? 3U : 2U)) out.push_back(std::move(loop));
    }
    return out;
  }

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  bool above(std::uint32_t vertex) const { return mesh_.vertices[vertex].x >= x_; }

  /// Finds the piece after each. Where many triangles share an edge they are taken in their order.
  void join() {
    std::sort(pieces_.begin(), pieces_.end(),
              [](const Piece& a, const Piece& b) { return a.triangle < b.triangle; });
    std::vector<std::pair<std::uint64_t, std::uint32_t>> begins;
    for (std::uint32_t i = 0; i < pieces_.size(); ++i)
      begins.emplace_back(edge_key(mesh_, pieces_[i].begin), i);
    std::sort(begins.begin(), begins.end());
    std::vector<bool> taken(begins.size(), false);
    after_.assign(pieces_.size(), kNone);
    has_before_.assign(pieces_.size(), false);
    for (std::uint32_t i = 0; i < pieces_.size(); ++i) {
      const std::uint64_t wanted = edge_key(mesh_, pieces_[i].end);
      auto at = std::lower_bound(begins.begin(), begins.end(), std::pair{wanted, std::uint32_t{0}});
      while (at != begins.end() && at->first == wanted &&
             taken[static_cast<std::size_t>(at - begins.begin())])
        ++at;
      if (at == begins.end() || at->first != wanted) continue;
      taken[static_cast<std::size_t>(at - begins.begin())] = true;
      after_[i] = at->second;
      has_before_[at->second] = true;
    }
  }

  struct Crossing {
    Point3 p;
    Vec3 normal;
  };
  /// Where the plane crosses a side; the same from both sides of the edge.
  Crossing cross_at(HalfEdge h) const {
    HalfEdge lo = h, hi = next_side(h);
    if (from(mesh_, lo) > from(mesh_, hi)) std::swap(lo, hi);
    const Point3 a = mesh_.vertices[from(mesh_, lo)], b = mesh_.vertices[from(mesh_, hi)];
    const Vec3 na = normals_[lo / 3][lo % 3], nb = normals_[hi / 3][hi % 3];
    const double t = std::clamp((x_ - a.x) / (b.x - a.x), 0.0, 1.0);
    const Point3 p = t == 0 ? a : t == 1 ? b : lerp(a, b, t);
    return {{x_, p.y, p.z}, unit(na + t * (nb - na))};
  }

  std::pair<std::uint32_t, SliceLoop> follow(std::uint32_t first) {
    SliceLoop loop;
    std::uint32_t lowest = pieces_[first].triangle, i = first;
    Vec3 before;
    while (true) {
      used_[i] = true;
      const Piece& piece = pieces_[i];
      lowest = std::min(lowest, piece.triangle);
      const Crossing begin = cross_at(piece.begin), end = cross_at(piece.end);
      push(loop, {begin.p, begin.normal, loop.points.empty() ? begin.normal : before, piece.triangle});
      before = end.normal;
      i = after_[i];
      if (i == first) break;
      if (i == kNone) {
        push(loop, {end.p, end.normal, end.normal, piece.triangle});
        return {lowest, std::move(loop)};
      }
    }
    loop.closed = true;
    close(loop, before);
    return {lowest, std::move(loop)};
  }

  /// A piece without length keeps only what is before it and after it.
  static void push(SliceLoop& loop, const SlicePoint& point) {
    if (!loop.points.empty() && loop.points.back().p == point.p) {
      loop.points.back().normal = point.normal;
      loop.points.back().triangle = point.triangle;
    } else {
      loop.points.push_back(point);
    }
  }
  static void close(SliceLoop& loop, Vec3 before) {
    while (loop.points.size() > 1 && loop.points.back().p == loop.points.front().p) {
      before = loop.points.back().normal_before;
      loop.points.pop_back();
    }
    loop.points.front().normal_before = before;
  }

  const Mesh& mesh_;
  const CornerNormals& normals_;
  double x_;
  std::vector<Piece> pieces_;
  std::vector<std::uint32_t> after_;
  std::vector<bool> has_before_, used_;
};

}  // namespace

std::vector<SliceLoop> slice_x(const Mesh& mesh, const CornerNormals& normals, double x) {
  Slice slice(mesh, normals, x);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) slice.add(t);
  return slice.loops();
}

Slicer::Slicer(const Mesh& mesh, const CornerNormals& normals) : mesh_(&mesh), normals_(&normals) {
  // As many bins as there would be if triangles were as long as wide; each triangle may be in many of them,
  // so their lists stay within some times the number of triangles.
  double lo = std::numeric_limits<double>::infinity(), hi = -lo, sum = 0;
  const auto reach = [&](std::uint32_t t) {
    const auto& c = mesh.triangles[t];
    return std::minmax({mesh.vertices[c[0]].x, mesh.vertices[c[1]].x, mesh.vertices[c[2]].x});
  };
  const auto usable = [&](std::uint32_t t) {
    if (!is_triangle(mesh, t)) return false;
    const auto [a, b] = reach(t);
    return std::isfinite(b - a);
  };
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  for (std::uint32_t t = 0; t < count; ++t) {
    if (!usable(t)) continue;
    const auto [a, b] = reach(t);
    lo = std::min(lo, a), hi = std::max(hi, b), sum += b - a;
  }
  if (!(hi > lo)) return;
  constexpr double kFew = 4;
  const double mean = sum / count;
  const double bins = std::clamp(std::floor(mean > 0 ? kFew * (hi - lo) / mean : 1.0), 1.0, 65536.0);
  lo_ = lo, scale_ = bins / (hi - lo);
  if (!std::isfinite(scale_)) scale_ = 0;
  const auto bin = [&](double x) {
    return static_cast<std::size_t>(std::clamp((x - lo_) * scale_, 0.0, bins - 1));
  };
  start_.assign(static_cast<std::size_t>(bins) + 1, 0);
  for (const bool fill : {false, true}) {
    std::vector<std::uint32_t> next(start_);
    for (std::uint32_t t = 0; t < count; ++t) {
      if (!usable(t)) continue;
      const auto [a, b] = reach(t);
      for (std::size_t i = bin(a), end = bin(b); i <= end; ++i) {
        if (fill) {
          list_[next[i]++] = t;
        } else {
          ++start_[i + 1];
        }
      }
    }
    if (fill) break;
    for (std::size_t i = 1; i < start_.size(); ++i) start_[i] += start_[i - 1];
    list_.resize(start_.back());
  }
}

std::vector<SliceLoop> Slicer::at(double x) const {
  if (start_.empty() || std::isnan(x)) return {};
  Slice slice(*mesh_, *normals_, x);
  const auto bins = static_cast<double>(start_.size() - 1);
  const auto i = static_cast<std::size_t>(std::clamp((x - lo_) * scale_, 0.0, bins - 1));
  for (std::uint32_t k = start_[i]; k < start_[i + 1]; ++k) slice.add(list_[k]);
  return slice.loops();
}

}  // namespace burin::geom

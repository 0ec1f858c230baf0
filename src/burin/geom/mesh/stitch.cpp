// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "burin/geom/box_tree.h"
#include "burin/geom/mesh/check.h"
#include "burin/geom/mesh/edges.h"

namespace burin::geom {

namespace {

/// The corners of open edges, found by place (as seen along z).
struct OpenCorners {
  std::vector<std::uint32_t> number;  ///< of the k-th of them in the mesh, ascending
  BoxTree2 tree;                      ///< over them: k

  OpenCorners(const Mesh& mesh, const Edges& edges)
      : number(numbers(mesh, edges)), tree(boxes(mesh, number)) {}

 private:
  static std::vector<std::uint32_t> numbers(const Mesh& mesh, const Edges& edges) {
    std::vector<bool> open(mesh.vertices.size(), false);
    for (HalfEdge h = 0; h < edges.twin.size(); ++h) {
      if (edges.twin[h] == kBoundary) open[from(mesh, h)] = open[to(mesh, h)] = true;
    }
    std::vector<std::uint32_t> out;
    for (std::uint32_t i = 0; i < open.size(); ++i)
      if (open[i]) out.push_back(i);
    return out;
  }
  static std::vector<Box2> boxes(const Mesh& mesh, const std::vector<std::uint32_t>& number) {
    std::vector<Box2> out;
    for (const std::uint32_t i : number) out.push_back(Box2{xy(mesh.vertices[i]), xy(mesh.vertices[i])});
    return out;
  }
};

/// Open corners no farther apart than the tolerance become one.
Mesh corners_joined(const Mesh& mesh, double tolerance) {
  const OpenCorners open(mesh, find_edges(mesh));
  std::vector<std::uint32_t> to_leader(mesh.vertices.size());
  for (std::uint32_t i = 0; i < to_leader.size(); ++i) to_leader[i] = i;
  for (const std::uint32_t i : open.number) {
    const Point3 p = mesh.vertices[i];
    double least = tolerance;
    open.tree.query(Box2{xy(p), xy(p)}.grown(tolerance), [&](std::uint32_t k) {
      const std::uint32_t other = open.number[k];
      // Only to earlier ones that stay themselves: no chains.
      if (other < i && to_leader[other] == other) {
        const double d = distance(mesh.vertices[other], p);
        if (d < least || (d == least && (to_leader[i] == i || other < to_leader[i])))
          least = d, to_leader[i] = other;
      }
      return true;
    });
  }
  Mesh out = mesh;
  for (auto& t : out.triangles) {
    for (std::uint32_t& k : t) k = to_leader[k];
  }
  return welded(out, 0);
}

struct Split {
  double t;  ///< along the edge
  std::uint32_t vertex;
};

/// The open corners that an open edge passes within the tolerance, between its ends.
std::vector<Split> passed(const Mesh& mesh, HalfEdge h, const OpenCorners& open, double tolerance) {
  const Point3 a = mesh.vertices[from(mesh, h)], b = mesh.vertices[to(mesh, h)];
  const std::uint32_t apex = from(mesh, side_before(h));
  const Vec3 e = b - a;
  const double ee = dot(e, e);
  std::vector<Split> out;
  Box2 box;
  box.add(xy(a));
  box.add(xy(b));
  open.tree.query(box.grown(tolerance), [&](std::uint32_t k) {
    const std::uint32_t v = open.number[k];
    if (v == from(mesh, h) || v == to(mesh, h) || v == apex) return true;
    const Point3 p = mesh.vertices[v];
    const double t = ee > 0 ? dot(p - a, e) / ee : 0;
    if (t > 0 && t < 1 && distance(p, a + t * e) <= tolerance) out.push_back({t, v});
    return true;
  });
  std::sort(out.begin(), out.end(),
            [](const Split& s, const Split& r) { return s.t != r.t ? s.t < r.t : s.vertex < r.vertex; });
  return out;
}

/// Triangles whose open edge passes open corners become fans through them. One edge of a triangle at a time.
/// False when there was nothing to do.
bool split_edges(Mesh& mesh, double tolerance) {
  const Edges edges = find_edges(mesh);
  const OpenCorners open(mesh, edges);
  std::vector<std::array<std::uint32_t, 3>> out;
  bool any = false;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    std::vector<Split> splits;
    HalfEdge side = 3 * t;
    for (HalfEdge h = 3 * t; h < 3 * t + 3 && splits.empty(); ++h) {
      if (edges.twin[h] != kBoundary) continue;
      splits = passed(mesh, h, open, tolerance);
      side = h;
    }
    if (splits.empty()) {
      out.push_back(mesh.triangles[t]);
      continue;
    }
    any = true;
    const std::uint32_t apex = from(mesh, side_before(side));
    std::uint32_t last = from(mesh, side);
    for (const Split& s : splits) {
      out.push_back({last, s.vertex, apex});
      last = s.vertex;
    }
    out.push_back({last, to(mesh, side), apex});
  }
  mesh.triangles = std::move(out);
  return any;
}

/// Whether a loop lies along one line within the tolerance: what is left of a seam.
bool is_sliver(const std::vector<Point3>& loop, double tolerance) {
  std::size_t far = 0;  // from the first, and then from that one: nearly the longest distance
  for (int i = 0; i < 2; ++i) {
    const Point3 start = loop[far];
    for (std::size_t k = 0; k < loop.size(); ++k) {
      if (distance(loop[k], start) > distance(loop[far], start)) far = k;
    }
    if (i == 1) {
      const Vec3 e = unit(loop[far] - start);
      return std::all_of(loop.begin(), loop.end(), [&](Point3 p) {
        const Vec3 g = p - start;
        return norm(g - dot(g, e) * e) <= tolerance;
      });
    }
  }
  return false;
}

/// Closes narrow holes with fans. Where two seams have the same corners in another order, their edges cross
/// and leave such holes.
void fill_slivers(Mesh& mesh, double tolerance) {
  std::map<std::tuple<double, double, double>, std::uint32_t> at;
  for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i)
    at.emplace(std::tuple(mesh.vertices[i].x, mesh.vertices[i].y, mesh.vertices[i].z), i);
  for (const MeshHole& hole : examine(mesh).holes) {
    if (hole.points.size() < 3 || !is_sliver(hole.points, tolerance)) continue;
    std::vector<std::uint32_t> loop;
    for (const Point3& p : hole.points) loop.push_back(at.at(std::tuple(p.x, p.y, p.z)));
    // The loop runs as its triangles do; what closes it runs against it.
    for (std::size_t k = 1; k + 1 < loop.size(); ++k)
      mesh.triangles.push_back({loop[0], loop[k + 1], loop[k]});
  }
}

}  // namespace

Mesh stitched(const Mesh& mesh, double tolerance_mm) {
  Mesh out = corners_joined(welded(mesh, 0), tolerance_mm > 0 ? tolerance_mm : 0);
  // A triangle has three sides; a fan's new sides may pass corners again. Few rounds do, more do no good.
  constexpr int kRounds = 6;
  for (int i = 0; i < kRounds && split_edges(out, tolerance_mm); ++i) out = welded(out, 0);
  Mesh filled = out;
  fill_slivers(filled, tolerance_mm);
  return find_edges(filled).shared_by_many > find_edges(out).shared_by_many ? out : filled;
}

}  // namespace burin::geom

// SPDX-License-Identifier: Apache-2.0
// Nearest point, inside, and the touching ball on the tree of mesh_tree.h. See docs/mesh.md.
#include "burin/geom/mesh/mesh_index.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "burin/geom/mesh/mesh_tree.h"
#include "burin/geom/point_tools.h"

namespace burin::geom {

using detail::TreePacket;

namespace {

/// One triangle of a packet, and the place on it that is nearest to a point.
struct Triangle {
  Point3 a;
  Vec3 u, v;
  double base, px, py, side1, side2;

  Triangle(const TreePacket& t, int lane)
      : a{t.a[0][lane], t.a[1][lane], t.a[2][lane]},
        u{t.u[0][lane], t.u[1][lane], t.u[2][lane]},
        v{t.v[0][lane], t.v[1][lane], t.v[2][lane]},
        base(t.base[lane]),
        px(t.px[lane]),
        py(t.py[lane]),
        side1(t.side1[lane]),
        side2(t.side2[lane]) {}

  struct Foot {
    Point3 p;
    double distance2;
  };
  /// The operations of packet_distance2() in tree_kernels.inc, with the place.
  Foot nearest(Point3 c) const {
    const Vec3 g = c - a;
    const double x = dot(g, u), y = dot(g, v), h = dot(g, cross(u, v)), qx = px - base, xl = x - base;
    double fx = x, fy = y, flat = 0;
    if (!(py > 0 && y >= 0 && py * x - px * y >= 0 && qx * y - py * xl >= 0)) {
      fx = std::clamp(x, 0.0, base), fy = 0;
      flat = (x - fx) * (x - fx) + y * y;
      const double t1 = std::clamp((x * px + y * py) * side1, 0.0, 1.0), x1 = t1 * px, y1 = t1 * py;
      const double d1 = (x - x1) * (x - x1) + (y - y1) * (y - y1);
      if (d1 < flat) flat = d1, fx = x1, fy = y1;
      const double t2 = std::clamp((xl * qx + y * py) * side2, 0.0, 1.0), x2 = t2 * qx, y2 = t2 * py;
      const double d2 = (xl - x2) * (xl - x2) + (y - y2) * (y - y2);
      if (d2 < flat) flat = d2, fx = base + x2, fy = y2;
    }
    return {a + (fx * u + fy * v), flat + h * h};
  }
};

/// The last t at which the ball about c + t d still meets the triangle. The distance from it is a convex
/// function of t: Newton's method from a place beyond comes down to the root and does not pass it.
double leaves_at(const Triangle& triangle, Point3 c, Vec3 d, Point3 touched, double radius, double slack) {
  double t = dot(touched - c, d) + triangle.base + radius;
  constexpr int kMost = 60;
  for (int i = 0; i < kMost; ++i) {
    const Point3 at = c + t * d;
    const auto foot = triangle.nearest(at);
    const double distance = std::sqrt(foot.distance2), over = distance - radius;
    const double slope = distance > 0 ? dot(at - foot.p, d) / distance : 0;
    if (!(over > slack) || !(slope > 0)) break;
    t -= over / slope;
  }
  return t;
}

}  // namespace

struct MeshIndex::State {
  detail::MeshTree tree;
  Mesh mesh;  // what the half line of inside() is compared with
  const detail::TreeKernels* kernels = &detail::tree_kernels_avx2();

  detail::TreeView view() const {
    static_assert(sizeof(Point3) == 3 * sizeof(double) && sizeof(mesh.triangles[0]) == 3 * sizeof(unsigned));
    return {tree.nodes.data(), tree.packets.data(), &mesh.vertices.data()->x, mesh.triangles.data()->data()};
  }
  detail::TreeNearest ask(Point3 c, double within2) const {
    detail::TreeNearest best{within2, 0, 0, -1};
    kernels->nearest(view(), detail::place_in(tree, c), best);
    return best;
  }
  Triangle triangle(const detail::TreeNearest& found) const {
    return {tree.packets[found.packet], found.lane};
  }
};

MeshIndex::MeshIndex(const Mesh& mesh) : state_(std::make_unique<State>()) {
  state_->tree = detail::build_tree(mesh);
  state_->mesh = mesh;
}
MeshIndex::~MeshIndex() = default;
MeshIndex::MeshIndex(MeshIndex&&) noexcept = default;
MeshIndex& MeshIndex::operator=(MeshIndex&&) noexcept = default;

Box3 MeshIndex::bounds() const {
  return state_->tree.bounds;
}

std::optional<MeshIndex::Hit> MeshIndex::nearest(Point3 c, double within) const {
  if (state_->tree.nodes.empty() || !is_finite(c) || !(within > 0)) return std::nullopt;
  const auto found = state_->ask(c, within * within);
  if (found.lane < 0) return std::nullopt;
  const double distance = std::sqrt(found.distance2);
  if (!(distance < within)) return std::nullopt;
  return Hit{state_->triangle(found).nearest(c).p, distance, found.triangle};
}

bool MeshIndex::inside(Point3 c) const {
  if (!state_->tree.bounds.contains(c)) return false;
  return state_->kernels->turns_above(state_->view(), detail::place_in(state_->tree, c)) != 0;
}

std::optional<double> MeshIndex::ball_out(Point3 c, Vec3 direction, double radius, double allowed,
                                          double limit, double accuracy_mm) const {
  const double need = radius - allowed;  // distance that the centre must keep
  if (!is_finite(c) || !is_finite(direction) || !std::isfinite(need) || !(limit >= 0)) return std::nullopt;
  if (state_->tree.nodes.empty()) return 0.0;
  // Rounding of places this far out; nothing is decided below it.
  constexpr double kRounding = 1e-14;
  const Box3 box = state_->tree.bounds;
  const double slack =
      kRounding * (norm(c - box.lo) + norm(c - box.hi) + norm(c - Point3{}) + std::abs(need));
  const double least = std::max(accuracy_mm > 0 ? accuracy_mm : 0, slack);
  const double inf = std::numeric_limits<double>::infinity();
  for (double t = 0; t <= limit;) {
    const Point3 at = c + t * direction;
    // Nothing nearer than `need`: only then does it matter on which side the centre is.
    const auto near = need > 0 ? state_->ask(at, need * need) : detail::TreeNearest{0, 0, 0, -1};
    const double distance = near.lane >= 0 ? std::sqrt(near.distance2) : need;
    if (distance >= need - slack) {
      if (!inside(at)) return t;
      // As far from the surface as it is inside, and then the ball's way besides.
      t += std::max(least, std::max(need, 0.0) + std::sqrt(state_->ask(at, inf).distance2));
      continue;
    }
    const Triangle triangle = state_->triangle(near);
    const double out = leaves_at(triangle, c, direction, triangle.nearest(at).p, need, 0.5 * slack);
    t = std::max(std::max(out, t + (need - distance)), t + least);
  }
  return std::nullopt;
}

}  // namespace burin::geom

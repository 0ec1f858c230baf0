// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/rotary/slicer.h"

#include <algorithm>
#include <cmath>

#include "burin/plan/rotary/sweep.h"

namespace burin::rotary::detail {
namespace {

using geom::Mesh;
using geom::Point3;
using geom::SliceLoop;
using geom::SlicePoint;
using geom::Vec3;

constexpr std::size_t kRecent = 4;
/// Triangles that reach over many slabs are kept in each: at most this many entries a triangle on average.
constexpr double kEntries = 3;
constexpr double kFewest = 64;  ///< triangles a slab
/// The ends of the part are looked at this far inside (of its length): a plane through an end face has no
/// section.
constexpr double kInside = 1e-7;

/// From below to above the plane z = 0 beyond the axis, or, for holes, the other way round.
double crosses_start(Point3 a, Point3 b) {
  if ((a.z < 0) == (b.z < 0)) return -1;
  const double f = a.z / (a.z - b.z);
  return a.y + f * (b.y - a.y) > 0 ? f : -1;
}

/// The loop with its start at angle 0: there the outermost crossing; a loop that has none stays.
SliceLoop started(const SliceLoop& loop) {
  if (!loop.closed) return loop;
  const std::size_t n = loop.points.size();
  std::size_t best = n;
  double best_y = 0, best_f = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Point3 a = loop.points[i].p, b = loop.points[(i + 1) % n].p;
    const double f = crosses_start(a, b);
    if (f < 0 || !(a.y + f * (b.y - a.y) > best_y)) continue;
    best = i;
    best_f = f;
    best_y = a.y + f * (b.y - a.y);
  }
  if (best == n) return loop;
  const SlicePoint &a = loop.points[best], &b = loop.points[(best + 1) % n];
  SlicePoint start{lerp(a.p, b.p, best_f), turned(a.normal, b.normal_before, best_f), {}, a.triangle};
  start.normal_before = start.normal;
  SliceLoop out;
  out.closed = true;
  out.points.push_back(start);
  for (std::size_t k = 1; k <= n; ++k) out.points.push_back(loop.points[(best + k) % n]);
  return out;
}

class RingMaker {
 public:
  RingMaker(double radius, double density, double w) : step_(std::sqrt(8 * density / radius)), w_(w) {}

  MeshRing make(const SliceLoop& given) {
    const SliceLoop loop = started(given);
    const std::size_t n = loop.points.size();
    std::vector<double> at{0};
    for (std::size_t i = 0; i < n; ++i) {
      at.push_back(at.back() + distance(loop.points[i].p, loop.points[(i + 1) % n].p));
    }
    MeshRing ring;
    ring.closed = loop.closed;
    ring.length = loop.closed ? at[n] : at[n - 1];
    if (!(ring.length > 0)) return ring;
    for (std::size_t i = 0; i < n; ++i) {
      const SlicePoint& p = loop.points[i];
      const double u = at[i] / ring.length;
      if (i > 0) turn_to(ring.points, contact(p.p, p.normal_before, u), false);
      const bool convex = i == 0 || dot(p.normal - p.normal_before, p.p - loop.points[i - 1].p) > 0;
      turn_to(ring.points, contact(p.p, p.normal, u), !convex);
    }
    // Back to the start: the last piece bends like all others.
    if (ring.closed) {
      turn_to(ring.points, contact(loop.points[0].p, loop.points[0].normal_before, 1), false);
      const Contact &first = ring.points.front(), &last = ring.points.back();
      if (first.p == last.p && angle_between(first.n, last.n) < 1e-9) ring.points.pop_back();
    }
    return ring;
  }

 private:
  Contact contact(Point3 p, Vec3 n, double u) const { return {p, unit(n), u, w_}; }
  /// Goes to `to`; the place straight and the normal evenly, in steps whose arc is flat enough.
  void turn_to(std::vector<Contact>& points, const Contact& to, bool jump) const {
    if (points.empty() || jump) {
      points.push_back(to);
      return;
    }
    const Contact from = points.back();
    const double angle = angle_between(from.n, to.n);
    if (angle < 1e-9 && from.p == to.p) return;
    const int steps = int(std::min(1e4, std::max(1.0, std::ceil(angle / step_))));
    for (int k = 1; k < steps; ++k) {
      const double f = double(k) / steps;
      points.push_back({lerp(from.p, to.p, f), turned(from.n, to.n, f), from.u + f * (to.u - from.u), w_});
    }
    points.push_back(to);
  }

  double step_, w_;
};

}  // namespace

Contact at_u(const MeshRing& ring, double u) {
  const std::vector<Contact>& p = ring.points;
  const auto it = std::upper_bound(p.begin(), p.end(), u, [](double v, const Contact& c) { return v < c.u; });
  if (it == p.begin()) return p.front();
  const Contact& a = *(it - 1);
  if (it == p.end() && !ring.closed) return a;
  Contact b = it == p.end() ? p.front() : *it;
  if (it == p.end()) b.u = 1;
  const double f = b.u > a.u ? std::clamp((u - a.u) / (b.u - a.u), 0.0, 1.0) : 0;
  return {lerp(a.p, b.p, f), turned(a.n, b.n, f), u, a.w};
}

Slicer::Slicer(const Part& part, double ball_radius, double density)
    : part_(part), radius_(ball_radius), density_(density) {
  const Mesh& mesh = part.mesh;
  double lo = part.x_max, hi = part.x_min, spans = 0;
  const auto span = [&](const std::array<std::uint32_t, 3>& t) {
    const double a = mesh.vertices[t[0]].x, b = mesh.vertices[t[1]].x, c = mesh.vertices[t[2]].x;
    return std::pair{std::min({a, b, c}), std::max({a, b, c})};
  };
  for (const auto& t : mesh.triangles) {
    const auto [a, b] = span(t);
    lo = std::min(lo, a);
    hi = std::max(hi, b);
    spans += b - a;
  }
  const double count = double(mesh.triangles.size()), length = std::max(hi - lo, 1e-9);
  const double slabs = spans > 0 ? std::min((kEntries - 1) * count * length / spans, count / kFewest) : 1;
  const std::size_t n = std::size_t(std::clamp(slabs, 1.0, 1e5));
  lo_ = lo;
  width_ = length / double(n);
  triangles_.resize(n);
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto [a, b] = span(mesh.triangles[i]);
    // One more on either side: a plane on the border of a slab sees what touches it.
    const auto first = std::size_t(std::clamp(std::floor((a - lo_) / width_ - 1e-6), 0.0, double(n - 1)));
    const auto last = std::size_t(std::clamp(std::floor((b - lo_) / width_ + 1e-6), 0.0, double(n - 1)));
    for (std::size_t k = first; k <= last; ++k) triangles_[k].push_back(i);
  }
}

const Slicer::Slab& Slicer::slab_at(double x) {
  const std::size_t n = triangles_.size();
  const auto number = std::size_t(std::clamp(std::floor((x - lo_) / width_), 0.0, double(n - 1)));
  const auto found =
      std::find_if(recent_.begin(), recent_.end(), [&](const Slab& s) { return s.number == number; });
  if (found != recent_.end()) {
    recent_.splice(recent_.begin(), recent_, found);
    return recent_.front();
  }
  Slab slab;
  slab.number = number;
  std::vector<std::uint32_t> used;
  for (const std::uint32_t t : triangles_[number]) {
    for (const std::uint32_t v : part_.mesh.triangles[t]) used.push_back(v);
  }
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  for (const std::uint32_t v : used) slab.mesh.vertices.push_back(part_.mesh.vertices[v]);
  for (const std::uint32_t t : triangles_[number]) {
    std::array<std::uint32_t, 3> own{};
    for (std::size_t k = 0; k < 3; ++k) {
      own[k] = std::uint32_t(std::lower_bound(used.begin(), used.end(), part_.mesh.triangles[t][k]) -
                             used.begin());
    }
    slab.mesh.triangles.push_back(own);
    slab.normals.push_back(part_.corner_normals[t]);
  }
  recent_.push_front(std::move(slab));
  if (recent_.size() > kRecent) recent_.pop_back();
  return recent_.front();
}

std::vector<MeshRing> Slicer::rings(double x) {
  const double length = part_.x_max - part_.x_min;
  const double inside = std::clamp(x, part_.x_min + kInside * length, part_.x_max - kInside * length);
  const Slab& slab = slab_at(inside);
  RingMaker maker(radius_, density_, (x - part_.x_min) / length);
  std::vector<MeshRing> rings;
  for (const SliceLoop& loop : slice_x(slab.mesh, slab.normals, inside)) {
    if (loop.points.size() < 3) continue;
    MeshRing ring = maker.make(loop);
    if (!(ring.length > 0)) continue;
    for (Contact& c : ring.points) c.p.x = x;
    rings.push_back(std::move(ring));
  }
  return rings;
}

}  // namespace burin::rotary::detail

// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/surface/second_bounds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "burin/geom/surface/rational.h"

namespace burin::geom::detail {
namespace {

/// Halving ends when it gains less than this on every bound, or after kDepth times.
constexpr double kGain = 0.9;
constexpr int kDepth = 4;

/// (p + 1) x (q + 1) homogeneous points over a rectangle of du x dv.
struct Net {
  int p = 0, q = 0;
  double du = 1, dv = 1;
  std::vector<HPoint> points;
  const HPoint& at(int i, int j) const { return points[static_cast<std::size_t>(i + j * (p + 1))]; }
  HPoint& at(int i, int j) { return points[static_cast<std::size_t>(i + j * (p + 1))]; }
};

/// Largest numerator and largest magnitude of the weight of a net of derivatives.
struct Largest {
  double a = 0, w = 0;
  void add(const HPoint& h) { a = std::max(a, norm(numerator(h))), w = std::max(w, std::abs(h.w)); }
};

/// The net of the derivative, once along u times once along v as asked for.
Net derived(const Net& net, int times_u, int times_v) {
  Net out{net.p - times_u, net.q - times_v, net.du, net.dv, {}};
  if (out.p < 0 || out.q < 0) return {0, 0, net.du, net.dv, {HPoint{0, 0, 0, 0}}};
  Net now = net;
  for (int k = 0; k < times_u; ++k) {
    Net next{now.p - 1, now.q, now.du, now.dv, {}};
    for (int j = 0; j <= now.q; ++j)
      for (int i = 0; i < now.p; ++i) next.points.push_back((now.p / now.du) * (now.at(i + 1, j) - now.at(i, j)));
    now = std::move(next);
  }
  for (int k = 0; k < times_v; ++k) {
    Net next{now.p, now.q - 1, now.du, now.dv, {}};
    for (int j = 0; j < now.q; ++j)
      for (int i = 0; i <= now.p; ++i) next.points.push_back((now.q / now.dv) * (now.at(i, j + 1) - now.at(i, j)));
    now = std::move(next);
  }
  return now;
}

Largest largest(const Net& net) {
  Largest out;
  for (const HPoint& h : net.points) out.add(h);
  return out;
}

/// With the origin in the middle of the piece |S| <= r, and the quotient rule
///   Su = (Au - wu S) / w,  Suu = (Auu - 2 wu Su - wuu S) / w,  Suv = (Auv - wu Sv - wv Su - wuv S) / w
/// bounds each term by the hull of its net. Exact for constant weights; converges with halving otherwise.
SecondBounds bounds_once(const Net& given) {
  Net net = given;
  Box3 box;
  double least = net.points.front().w;
  for (const HPoint& h : net.points) box.add(project(h)), least = std::min(least, h.w);
  const Point3 c = lerp(box.lo, box.hi, 0.5);
  double r = 0;
  for (HPoint& h : net.points) {
    h = {h.x - h.w * c.x, h.y - h.w * c.y, h.z - h.w * c.z, h.w};
    r = std::max(r, norm(numerator(h)) / h.w);
  }
  const Net nu = derived(net, 1, 0), nv = derived(net, 0, 1);
  const Largest u = largest(nu), v = largest(nv);
  const Largest uu = largest(derived(net, 2, 0)), uv = largest(derived(net, 1, 1)),
                vv = largest(derived(net, 0, 2));
  SecondBounds b;
  b.u = (u.a + u.w * r) / least;
  b.v = (v.a + v.w * r) / least;
  b.uu = (uu.a + 2 * u.w * b.u + uu.w * r) / least;
  b.uv = (uv.a + u.w * b.v + v.w * b.u + uv.w * r) / least;
  b.vv = (vv.a + 2 * v.w * b.v + vv.w * r) / least;
  return b;
}

/// De Casteljau at the middle.
std::pair<Net, Net> halved(const Net& net, Direction d) {
  Net lo = net, hi = net;
  const bool along_u = d == Direction::u;
  (along_u ? lo.du : lo.dv) *= 0.5;
  (along_u ? hi.du : hi.dv) *= 0.5;
  const int n = along_u ? net.p : net.q, lines = along_u ? net.q : net.p;
  const auto at = [along_u](Net& m, int line, int i) -> HPoint& { return along_u ? m.at(i, line) : m.at(line, i); };
  for (int line = 0; line <= lines; ++line) {
    for (int k = 1; k <= n; ++k) {
      for (int i = 0; i <= n - k; ++i) at(hi, line, i) = 0.5 * (at(hi, line, i) + at(hi, line, i + 1));
      at(lo, line, k) = at(hi, line, 0);
    }
    // hi now holds the points of the right half from its end: position i is the level n - i.
  }
  return {std::move(lo), std::move(hi)};
}

void keep_larger(SecondBounds& a, const SecondBounds& b) {
  a = {std::max(a.u, b.u), std::max(a.v, b.v), std::max(a.uu, b.uu), std::max(a.uv, b.uv), std::max(a.vv, b.vv)};
}

SecondBounds bounds_of(const Net& net, const SecondBounds& whole, int depth) {
  if (depth == 0) return whole;
  auto [left, right] = halved(net, Direction::u);
  std::array<Net, 4> parts;
  std::tie(parts[0], parts[1]) = halved(left, Direction::v);
  std::tie(parts[2], parts[3]) = halved(right, Direction::v);
  std::array<SecondBounds, 4> each;
  SecondBounds most;
  for (std::size_t k = 0; k < 4; ++k) keep_larger(most, each[k] = bounds_once(parts[k]));
  const bool gained = most.uu < kGain * whole.uu || most.uv < kGain * whole.uv || most.vv < kGain * whole.vv;
  if (gained) {
    most = {};
    for (std::size_t k = 0; k < 4; ++k) keep_larger(most, bounds_of(parts[k], each[k], depth - 1));
  }
  return {std::min(most.u, whole.u), std::min(most.v, whole.v), std::min(most.uu, whole.uu),
          std::min(most.uv, whole.uv), std::min(most.vv, whole.vv)};
}

}  // namespace

SecondBounds second_bounds(const BezierPatch& patch) {
  const Net net{patch.surface.degree_u, patch.surface.degree_v, patch.u.length(), patch.v.length(),
                patch.surface.points};
  return bounds_of(net, bounds_once(net), kDepth);
}

}  // namespace burin::geom::detail

// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/surface/second_bounds.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "burin/geom/surface/rational.h"

namespace burin::geom::detail {
namespace {

/// Parts are halved until the bounds are within this of what the surface really has at the corners of parts:
/// a fifth more makes a tenth more lines.
constexpr double kGoodEnough = 1.2;
/// A derivative that takes less than this share of the deviation need not be known well.
constexpr double kSmallPart = 0.02;

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
      for (int i = 0; i < now.p; ++i)
        next.points.push_back((now.p / now.du) * (now.at(i + 1, j) - now.at(i, j)));
    now = std::move(next);
  }
  for (int k = 0; k < times_v; ++k) {
    Net next{now.p, now.q - 1, now.du, now.dv, {}};
    for (int j = 0; j < now.q; ++j)
      for (int i = 0; i <= now.p; ++i)
        next.points.push_back((now.q / now.dv) * (now.at(i, j + 1) - now.at(i, j)));
    now = std::move(next);
  }
  return now;
}

Largest largest(const Net& net) {
  Largest out;
  for (const HPoint& h : net.points) out.add(h);
  return out;
}

/// The same points, numerator and weight multiplied by the bilinear function that makes the weight 1 at the
/// corners. Without it terms that cancel would be bounded one by one, and halving would not help.
Net evened(const Net& net) {
  const double w = net.points.front().w;
  if (std::all_of(net.points.begin(), net.points.end(), [w](const HPoint& h) { return h.w == w; }))
    return net;
  const int p = net.p, q = net.q;
  const double at_corner[2][2] = {{1 / net.at(0, 0).w, 1 / net.at(0, q).w},
                                  {1 / net.at(p, 0).w, 1 / net.at(p, q).w}};
  Net out{p + 1, q + 1, net.du, net.dv, {}};
  out.points.assign(static_cast<std::size_t>((p + 2) * (q + 2)), HPoint{0, 0, 0, 0});
  for (int j = 0; j <= q; ++j) {
    for (int i = 0; i <= p; ++i) {
      for (int a = 0; a < 2; ++a) {
        for (int b = 0; b < 2; ++b) {
          // Products of Bernstein polynomials: C(p, i) / C(p + 1, i + a).
          const double su = double(a == 0 ? p + 1 - i : i + 1) / (p + 1);
          const double sv = double(b == 0 ? q + 1 - j : j + 1) / (q + 1);
          HPoint& to = out.at(i + a, j + b);
          to = to + (su * sv * at_corner[a][b]) * net.at(i, j);
        }
      }
    }
  }
  return out;
}

/// With the origin in the middle of the piece |S| <= r, and the quotient rule
///   Su = (Au - wu S) / w,  Suu = (Auu - 2 wu Su - wuu S) / w,  Suv = (Auv - wu Sv - wv Su - wuv S) / w
/// bounds each term by the hull of its net.
SecondBounds bounds_once(const Net& given) {
  Net net = evened(given);
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
  const auto at = [along_u](Net& m, int line, int i) -> HPoint& {
    return along_u ? m.at(i, line) : m.at(line, i);
  };
  for (int line = 0; line <= lines; ++line) {
    for (int k = 1; k <= n; ++k) {
      for (int i = 0; i <= n - k; ++i) at(hi, line, i) = 0.5 * (at(hi, line, i) + at(hi, line, i + 1));
      at(lo, line, k) = at(hi, line, 0);
    }
    // hi now holds the points of the right half from its end: position i is the level n - i.
  }
  return {std::move(lo), std::move(hi)};
}

/// A part of the piece: what is proven of it, and what it has at two of its corners.
struct Leaf {
  Net net;
  SecondBounds bound, seen;
};
constexpr double SecondBounds::*kSeconds[] = {&SecondBounds::uu, &SecondBounds::uv, &SecondBounds::vv};
constexpr double SecondBounds::*kAll[] = {&SecondBounds::u, &SecondBounds::v, &SecondBounds::uu,
                                          &SecondBounds::uv, &SecondBounds::vv};

void keep_larger(SecondBounds& a, const SecondBounds& b) {
  for (const auto member : kAll) a.*member = std::max(a.*member, b.*member);
}

/// Magnitudes at the corner (i, j), each 0 or 1.
SecondBounds at_corner(const Net& net, int i, int j) {
  // Differences towards the inside, turned into derivatives; degrees below two have no second ones.
  const auto point = [&](int a, int b) { return net.at(i == 0 ? a : net.p - a, j == 0 ? b : net.q - b); };
  const double su = (i == 0 ? 1 : -1) / net.du, sv = (j == 0 ? 1 : -1) / net.dv;
  const HPoint none{0, 0, 0, 0};
  HSurface a{};
  a.p = point(0, 0);
  a.u = (net.p * su) * (point(1, 0) - a.p);
  a.v = (net.q * sv) * (point(0, 1) - a.p);
  a.uu = net.p < 2 ? none : (net.p * (net.p - 1) * su * su) * (point(2, 0) - 2 * point(1, 0) + a.p);
  a.vv = net.q < 2 ? none : (net.q * (net.q - 1) * sv * sv) * (point(0, 2) - 2 * point(0, 1) + a.p);
  a.uv = (net.p * net.q * su * sv) * (point(1, 1) - point(1, 0) - point(0, 1) + a.p);
  SurfaceDerivatives d;
  rational2(a, d);
  return {norm(d.du), norm(d.dv), norm(d.duu), norm(d.duv), norm(d.dvv)};
}

Leaf leaf(Net net) {
  Leaf out{std::move(net), {}, {}};
  out.bound = bounds_once(out.net);
  out.seen = at_corner(out.net, 0, 0);
  keep_larger(out.seen, at_corner(out.net, 1, 1));
  return out;
}

/// The leaf that keeps the bounds up most, or none when they are good enough.
std::optional<std::size_t> worst_leaf(const std::vector<Leaf>& leaves, const Net& whole) {
  SecondBounds bound, seen;
  for (const Leaf& l : leaves) keep_larger(bound, l.bound), keep_larger(seen, l.seen);
  // What each contributes to the deviation of one cell: parts that hardly matter may be loose.
  const double size[] = {whole.du * whole.du, whole.du * whole.dv, whole.dv * whole.dv};
  const double all = bound.uu * size[0] + bound.uv * size[1] + bound.vv * size[2];
  double most = kGoodEnough;
  double SecondBounds::*which = nullptr;
  for (std::size_t k = 0; k < 3; ++k) {
    const double b = bound.*kSeconds[k], s = seen.*kSeconds[k];
    if (b * size[k] <= kSmallPart * all || b <= most * s) continue;
    which = kSeconds[k];
    if (s > 0) most = b / s;
  }
  if (which == nullptr) return std::nullopt;
  std::size_t at = 0;
  for (std::size_t i = 1; i < leaves.size(); ++i)
    if (leaves[i].bound.*which > leaves[at].bound.*which) at = i;
  return at;
}

}  // namespace

SecondBounds second_bounds(const BezierPatch& patch, int most_halvings) {
  const Net net{patch.surface.degree_u, patch.surface.degree_v, patch.u.length(), patch.v.length(),
                patch.surface.points};
  std::vector<Leaf> leaves{leaf(net)};
  const SecondBounds whole = leaves.front().bound;
  for (int k = 0; k < most_halvings; ++k) {
    const auto at = worst_leaf(leaves, net);
    if (!at) break;
    const auto [left, right] = halved(leaves[*at].net, Direction::u);
    auto [a, b] = halved(left, Direction::v);
    auto [c, d] = halved(right, Direction::v);
    leaves[*at] = leaf(std::move(a));
    for (Net* part : {&b, &c, &d}) leaves.push_back(leaf(std::move(*part)));
  }
  SecondBounds most;
  for (const Leaf& l : leaves) keep_larger(most, l.bound);
  for (const auto member : kAll) most.*member = std::min(most.*member, whole.*member);
  return most;
}

}  // namespace burin::geom::detail

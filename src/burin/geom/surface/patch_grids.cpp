// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/surface/patch_grids.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "burin/geom/surface/evaluate.h"
#include "burin/geom/surface/mesh_cells.h"

namespace burin::geom::detail {
namespace {

/// 1, 2, 3, 4, 6, 8, 12, 16, ...: numbers of neighbours mostly divide each other, so that they share places.
double rounded_up(double n) {
  if (!(n > 4)) return n;
  const double p = std::exp2(std::floor(std::log2(n)));
  return n <= p ? p : n <= 1.5 * p ? 1.5 * p : 2 * p;
}

/// Larger numbers of columns of one piece are counted, but never made.
constexpr double kMostLines = 1e9;
/// Spans shorter than this share of their parameters are not cut: lines would fall together.
constexpr double kShortest = 1e-9;

bool too_short(const Interval& span) {
  return span.length() <= kShortest * std::max(std::abs(span.lo), std::abs(span.hi));
}

struct Choice {
  double u = 1, v = 1, total = std::numeric_limits<double>::infinity();
};

Choice choose(const SecondBounds& m, double du, double dv, double deflection, double max_edge) {
  Choice best, square;
  for (const double share : kShares) {
    for (Choice* to : {&best, &square}) {
      Choice c;
      c.u = rounded_up(columns_for(m, du, share, deflection, max_edge, to == &square));
      c.v = rounded_up(rows_for(m, du / c.u, dv, deflection, max_edge));
      c.total = 2 * c.u * c.v;
      if (c.total < to->total) *to = c;
    }
  }
  Choice out = square.total <= kForShape * best.total ? square : best;
  if (!(out.u <= kMostLines && out.v <= kMostLines)) out.u = out.v = kMostLines;
  return out;
}

/// Places of the two neighbours' lines inside of a side; ids follow each other.
struct Side {
  std::vector<double> t;
  std::uint32_t first = 0;
  std::uint32_t id(double at) const {
    return first + static_cast<std::uint32_t>(std::lower_bound(t.begin(), t.end(), at) - t.begin());
  }
};

double line(const Interval& span, std::uint32_t k, std::uint32_t n) {
  return k == n ? span.hi : span.lo + span.length() * (double(k) / double(n));
}

class Builder {
 public:
  Builder(const NurbsSurface& surface, const Spans& spans, const PatchCounts& counts, bool reversed)
      : surface_(surface),
        spans_(spans),
        counts_(counts),
        reversed_(reversed),
        nu_(spans.u.size()),
        nv_(spans.v.size()) {}

  Mesh build() {
    make_sides();
    interior_.resize(nu_ * nv_);
    for (std::size_t j = 0; j < nv_; ++j)
      for (std::size_t i = 0; i < nu_; ++i) make_interior(i, j);
    mesh_.vertices.resize(places_.size());
    SurfaceEvaluator(surface_).points(places_, mesh_.vertices);
    mesh_.triangles.reserve(static_cast<std::size_t>(counts_.total));
    for (std::size_t j = 0; j < nv_; ++j)
      for (std::size_t i = 0; i < nu_; ++i) make_cells(i, j);
    return std::move(mesh_);
  }

 private:
  std::uint32_t columns(std::size_t i, std::size_t j) const { return counts_.u[i + j * nu_]; }
  std::uint32_t rows(std::size_t i, std::size_t j) const { return counts_.v[i + j * nu_]; }
  std::uint32_t corner(std::size_t i, std::size_t j) const {
    return static_cast<std::uint32_t>(i + j * (nu_ + 1));
  }
  /// Along u at line j of the knots; along v at line i.
  const Side& along_u(std::size_t i, std::size_t j) const { return along_u_[i + j * nu_]; }
  const Side& along_v(std::size_t i, std::size_t j) const { return along_v_[i + j * (nu_ + 1)]; }

  static void add_lines(std::vector<double>& t, const Interval& span, std::uint32_t n) {
    for (std::uint32_t k = 1; k < n; ++k) t.push_back(line(span, k, n));
  }
  static void finish(Side& side) {
    std::sort(side.t.begin(), side.t.end());
    side.t.erase(std::unique(side.t.begin(), side.t.end()), side.t.end());
  }

  void make_sides() {
    const auto u_at = [&](std::size_t i) { return i < nu_ ? spans_.u[i].lo : spans_.u.back().hi; };
    const auto v_at = [&](std::size_t j) { return j < nv_ ? spans_.v[j].lo : spans_.v.back().hi; };
    for (std::size_t j = 0; j <= nv_; ++j)
      for (std::size_t i = 0; i <= nu_; ++i) places_.push_back({u_at(i), v_at(j)});
    for (std::size_t j = 0; j <= nv_; ++j) {
      for (std::size_t i = 0; i < nu_; ++i) {
        Side side;
        if (j > 0) add_lines(side.t, spans_.u[i], columns(i, j - 1));
        if (j < nv_) add_lines(side.t, spans_.u[i], columns(i, j));
        finish(side);
        side.first = static_cast<std::uint32_t>(places_.size());
        for (const double t : side.t) places_.push_back({t, v_at(j)});
        along_u_.push_back(std::move(side));
      }
    }
    for (std::size_t j = 0; j < nv_; ++j) {
      for (std::size_t i = 0; i <= nu_; ++i) {
        Side side;
        if (i > 0) add_lines(side.t, spans_.v[j], rows(i - 1, j));
        if (i < nu_) add_lines(side.t, spans_.v[j], rows(i, j));
        finish(side);
        side.first = static_cast<std::uint32_t>(places_.size());
        for (const double t : side.t) places_.push_back({u_at(i), t});
        along_v_.push_back(std::move(side));
      }
    }
  }

  void make_interior(std::size_t i, std::size_t j) {
    interior_[i + j * nu_] = static_cast<std::uint32_t>(places_.size());
    const std::uint32_t n = columns(i, j), m = rows(i, j);
    for (std::uint32_t l = 1; l < m; ++l)
      for (std::uint32_t k = 1; k < n; ++k)
        places_.push_back({line(spans_.u[i], k, n), line(spans_.v[j], l, m)});
  }

  std::uint32_t node(std::size_t i, std::size_t j, std::uint32_t k, std::uint32_t l) const {
    const std::uint32_t n = columns(i, j), m = rows(i, j);
    const bool u_end = k == 0 || k == n, v_end = l == 0 || l == m;
    const std::size_t ci = k == n ? i + 1 : i, cj = l == m ? j + 1 : j;
    if (u_end && v_end) return corner(ci, cj);
    if (v_end) return along_u(i, cj).id(line(spans_.u[i], k, n));
    if (u_end) return along_v(ci, j).id(line(spans_.v[j], l, m));
    return interior_[i + j * nu_] + (k - 1) + (l - 1) * (n - 1);
  }

  /// Places of the side between the two, in their order; `back`: in the opposite one.
  void add_between(const Side& side, double lo, double hi, bool back) {
    const auto a = std::upper_bound(side.t.begin(), side.t.end(), lo);
    const auto b = std::lower_bound(a, side.t.end(), hi);
    const auto first = static_cast<std::uint32_t>(a - side.t.begin()),
               count = static_cast<std::uint32_t>(b - a);
    for (std::uint32_t k = 0; k < count; ++k)
      ring_.push_back(side.first + (back ? first + count - 1 - k : first + k));
  }

  void make_cells(std::size_t i, std::size_t j) {
    const std::uint32_t n = columns(i, j), m = rows(i, j);
    for (std::uint32_t l = 0; l < m; ++l) {
      const double v0 = line(spans_.v[j], l, m), v1 = line(spans_.v[j], l + 1, m);
      for (std::uint32_t k = 0; k < n; ++k) {
        const double u0 = line(spans_.u[i], k, n), u1 = line(spans_.u[i], k + 1, n);
        const std::array<std::uint32_t, 4> c{node(i, j, k, l), node(i, j, k + 1, l), node(i, j, k + 1, l + 1),
                                             node(i, j, k, l + 1)};
        ring_.clear();
        std::array<std::size_t, 4> more{};
        for (std::size_t side = 0; side < 4; ++side) {
          ring_.push_back(c[side]);
          const std::size_t before = ring_.size();
          if (side == 0 && l == 0) add_between(along_u(i, j), u0, u1, false);
          if (side == 1 && k + 1 == n) add_between(along_v(i + 1, j), v0, v1, false);
          if (side == 2 && l + 1 == m) add_between(along_u(i, j + 1), u0, u1, true);
          if (side == 3 && k == 0) add_between(along_v(i, j), v0, v1, true);
          more[side] = ring_.size() - before;
        }
        if (ring_.size() == 4) {
          add_cell(mesh_, c, reversed_);
        } else {
          add_ring(more, {0.5 * (u0 + u1), 0.5 * (v0 + v1)});
        }
      }
    }
  }

  /// More places on one side: fans of the two opposite corners. On several: a fan about the middle.
  void add_ring(const std::array<std::size_t, 4>& more, Point2 middle) {
    const std::size_t count = ring_.size();
    for (std::size_t side = 0, start = 0; side < 4; start += 1 + more[side], ++side) {
      if (more[side] + 4 != count) continue;
      std::rotate(ring_.begin(), ring_.begin() + static_cast<std::ptrdiff_t>(start), ring_.end());
      const std::uint32_t right = ring_[count - 2], left = ring_[count - 1];
      const std::size_t half = (count - 2) / 2;
      for (std::size_t q = 0; q + 3 < count; ++q)
        add_triangle(mesh_, ring_[q], ring_[q + 1], q < half ? left : right, reversed_);
      add_triangle(mesh_, ring_[half], right, left, reversed_);
      return;
    }
    const auto hub = static_cast<std::uint32_t>(mesh_.vertices.size());
    mesh_.vertices.push_back(point(surface_, middle.x, middle.y));
    for (std::size_t q = 0; q < count; ++q)
      add_triangle(mesh_, ring_[q], ring_[(q + 1) % count], hub, reversed_);
  }

  const NurbsSurface& surface_;
  const Spans& spans_;
  const PatchCounts& counts_;
  bool reversed_;
  std::size_t nu_, nv_;
  std::vector<Point2> places_;
  std::vector<Side> along_u_, along_v_;
  std::vector<std::uint32_t> interior_, ring_;
  Mesh mesh_;
};

}  // namespace

PatchCounts patch_counts(const Spans& spans, double deflection, double max_edge) {
  PatchCounts out;
  const std::size_t nu = spans.u.size();
  for (std::size_t j = 0; j < spans.v.size(); ++j) {
    for (std::size_t i = 0; i < nu; ++i) {
      const SecondBounds& m = spans.at(i, j);
      const double du = spans.u[i].length(), dv = spans.v[j].length();
      Choice c = choose(m, du, dv, deflection, max_edge);
      if (too_short(spans.u[i])) c.u = 1;
      if (too_short(spans.v[j])) c.v = 1;
      out.u.push_back(static_cast<std::uint32_t>(c.u)), out.v.push_back(static_cast<std::uint32_t>(c.v));
      out.total += 2 * c.u * c.v;
      out.deflection_mm = std::max(out.deflection_mm, deviation8(m, du / c.u, dv / c.v) / 8);
      // Places of a neighbour's lines make up to two triangles each.
      const std::size_t at = i + j * nu;
      if (i > 0) out.total += 2 * std::abs(c.v - double(out.v[at - 1]));
      if (j > 0) out.total += 2 * std::abs(c.u - double(out.u[at - nu]));
    }
  }
  return out;
}

Mesh patch_mesh(const NurbsSurface& surface, const Spans& spans, const PatchCounts& counts, bool reversed) {
  return Builder(surface, spans, counts, reversed).build();
}

}  // namespace burin::geom::detail

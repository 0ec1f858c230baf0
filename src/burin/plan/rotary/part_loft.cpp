// SPDX-License-Identifier: Apache-2.0
// Sections joined along X. S(f, x) = sum over the sections of L_k(x) c_k(f), f by length from angle 0 and L_k
// the natural cubic spline that is 1 at section k and 0 at the others. See docs/rotary.md.
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "burin/base/text.h"
#include "burin/geom/mesh/check.h"
#include "burin/plan/rotary/cap.h"
#include "burin/plan/rotary/part.h"
#include "burin/plan/rotary/section_check.h"

namespace burin::rotary {

using geom::ArcSpline;
using geom::Point2;
using geom::Point3;
using geom::Segment;
using geom::Vec2;

namespace {

Error geometry(std::string message) {
  return {ErrorCode::geometry, std::move(message), {}};
}

/// A section that begins at angle 0: places by part of the length.
class Ring {
 public:
  /// Cut where the +Y axis leaves the section for the last time.
  static std::optional<Ring> of(const ArcSpline& section) {
    const auto& segments = section.segments;
    std::size_t best = segments.size();
    double best_y = 0, best_f = 0;
    for (std::size_t i = 0; i < segments.size(); ++i) {
      for (const double f : on_axis(segments[i])) {
        const double y = point_on(segments[i], f).x;
        if (y > best_y) best = i, best_y = y, best_f = f;
      }
    }
    if (best == segments.size()) return std::nullopt;
    Ring out;
    out.start_ = best, out.start_f_ = best_f;
    for (const Segment& s : segments) out.lengths_.push_back(length_of(s)), out.total_ += out.lengths_.back();
    out.segments_ = segments;
    return out;
  }

  /// f in [0, 1].
  Point2 at(double f) const {
    double s = f * total_ + start_f_ * lengths_[start_];
    for (std::size_t i = start_, n = 0;; i = (i + 1) % segments_.size(), ++n) {
      if (s <= lengths_[i] || n > segments_.size())
        return point_on(segments_[i], std::clamp(s / lengths_[i], 0.0, 1.0));
      s -= lengths_[i];
    }
  }

  /// Where segments meet, as parts of the length, without 0 and 1.
  std::vector<double> joints() const {
    std::vector<double> out;
    double s = -start_f_ * lengths_[start_];
    for (std::size_t n = 0; n <= segments_.size(); ++n) {
      const double f = s / total_;
      if (f > kSame && f < 1 - kSame) out.push_back(f);
      s += lengths_[(start_ + n) % segments_.size()];
    }
    return out;
  }

  /// How many straight pieces the stretch from f to g needs, all in one segment.
  double pieces(double f, double g, double deflection) const {
    double s = 0.5 * (f + g) * total_ + start_f_ * lengths_[start_];
    std::size_t i = start_;
    for (std::size_t n = 0; n < segments_.size() && s > lengths_[i]; ++n)
      s -= lengths_[i], i = (i + 1) % segments_.size();
    const double r = std::abs(segments_[i].radius);
    if (r == 0) return 1;
    const double step = deflection < r ? 2 * std::acos(1 - deflection / r) : geom::kPi / 2;
    return std::ceil((g - f) * total_ / r / std::min(step, geom::kPi / 2));
  }

  static constexpr double kSame = 1e-9;  ///< joints nearer than this part of the length are one

 private:
  /// Parts of the segment's length at which it crosses the line z = 0.
  static std::vector<double> on_axis(const Segment& s) {
    std::vector<double> out;
    if (s.is_line()) {
      if ((s.a.y <= 0) != (s.b.y <= 0)) out.push_back(s.a.y / (s.a.y - s.b.y));
      return out;
    }
    const double r = std::abs(s.radius), h = -s.center.y / r;
    if (std::abs(h) > 1) return out;
    const double start = std::atan2(s.a.y - s.center.y, s.a.x - s.center.x), sweep = sweep_of(s);
    for (const double angle : {std::asin(h), geom::kPi - std::asin(h)}) {
      double turn = std::fmod((angle - start) * (sweep > 0 ? 1 : -1), 2 * geom::kPi);
      if (turn < 0) turn += 2 * geom::kPi;
      if (turn <= std::abs(sweep)) out.push_back(turn / std::abs(sweep));
    }
    return out;
  }

  std::vector<Segment> segments_;
  std::vector<double> lengths_;
  double total_ = 0, start_f_ = 0;
  std::size_t start_ = 0;
};

/// Natural cubic spline through points at the sections' x.
class Rail {
 public:
  Rail(const std::vector<double>& x, std::vector<Point2> p) : x_(&x), p_(std::move(p)), m_(x.size()) {
    // Second derivatives: tridiagonal, zero at the ends.
    const std::size_t n = x.size();
    std::vector<double> c(n, 0);
    for (std::size_t i = 1; i + 1 < n; ++i) {
      const double h0 = x[i] - x[i - 1], h1 = x[i + 1] - x[i];
      const Vec2 right = 6.0 * ((p_[i + 1] - p_[i]) / h1 - (p_[i] - p_[i - 1]) / h0);
      const double pivot = 2 * (h0 + h1) - h0 * c[i - 1];
      c[i] = h1 / pivot;
      m_[i] = (right - h0 * m_[i - 1]) / pivot;
    }
    for (std::size_t i = n - 1; i-- > 1;) m_[i] = m_[i] - c[i] * m_[i + 1];
  }
  Point2 at(std::size_t i, double x) const {
    const double h = (*x_)[i + 1] - (*x_)[i], t = (x - (*x_)[i]) / h, s = 1 - t;
    return lerp(p_[i], p_[i + 1], t) + (h * h / 6) * ((s * s * s - s) * m_[i] + (t * t * t - t) * m_[i + 1]);
  }
  /// Straight pieces between section i and the next for a deflection.
  double pieces(std::size_t i, double deflection) const {
    const double h = (*x_)[i + 1] - (*x_)[i], most = std::max(norm(m_[i]), norm(m_[i + 1]));
    return std::max(1.0, std::ceil(h * std::sqrt(most / (8 * deflection))));
  }

 private:
  const std::vector<double>* x_;
  std::vector<Point2> p_;
  std::vector<Vec2> m_;
};

struct Loft {
  std::vector<double> x;
  std::vector<Ring> rings;

  Rail rail(double f) const {
    std::vector<Point2> p;
    for (const Ring& ring : rings) p.push_back(ring.at(f));
    return {x, std::move(p)};
  }
};

Result<Loft> loft_of(const std::vector<LoftSection>& sections, double deflection) {
  if (sections.size() < 2) return geometry("a loft needs at least two sections");
  constexpr double kLargest = 1e6;
  Loft out;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const auto in_section = [&](const Error& e) {
      return Error{e.code, "section " + std::to_string(i + 1) + ": " + e.message, e.where};
    };
    const double x = sections[i].x;
    if (!(std::abs(x) <= kLargest))
      return geometry("section " + std::to_string(i + 1) + " is not within 1e6 mm");
    if (i > 0 && !(x - sections[i - 1].x > deflection)) {
      return geometry("section " + std::to_string(i + 1) + " at x = " + format_shortest(x) +
                      " does not follow that at " + format_shortest(sections[i - 1].x) +
                      " (ascending, by more than the deflection of " + format_shortest(deflection) + " mm)");
    }
    auto checked = detail::checked_section(sections[i].section, deflection);
    if (!checked) return in_section(checked.error());
    const geom::Box2 box = bounds_of(*checked);
    if (!(box.width() <= kLargest && box.height() <= kLargest))
      return in_section(geometry("larger than 1e6 mm"));
    auto ring = Ring::of(*checked);
    if (!ring) return in_section(geometry("does not cross the +Y axis (a closed curve around the X axis)"));
    out.x.push_back(x);
    out.rings.push_back(std::move(*ring));
  }
  return out;
}

/// Shares of the deflection: along the sections (the spline may enlarge it between them), along X, and for
/// quads that are not flat.
struct Steps {
  std::vector<double> f;                             ///< ascending from 0, below 1
  std::vector<std::pair<std::size_t, double>> rows;  ///< interval and x
};

std::vector<double> all_joints(const Loft& loft) {
  std::vector<double> out{0};
  for (const Ring& ring : loft.rings) {
    const auto joints = ring.joints();
    out.insert(out.end(), joints.begin(), joints.end());
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end(), [](double a, double b) { return b - a < Ring::kSame; }),
            out.end());
  return out;
}

/// All counts times `finer`. Nothing when more than `most` triangles would come of it; `wanted` says how
/// many.
std::optional<Steps> steps_for(const Loft& loft, double deflection, double finer, double most,
                               double& wanted) {
  const std::vector<double> joints = all_joints(loft);
  std::vector<double> counts;
  double columns = 0;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const double end = i + 1 < joints.size() ? joints[i + 1] : 1;
    double n = 1;
    for (const Ring& ring : loft.rings) n = std::max(n, ring.pieces(joints[i], end, 0.25 * deflection));
    counts.push_back(finer * n), columns += finer * n;
  }
  wanted = 2 * columns * static_cast<double>(loft.x.size() - 1);
  if (!(wanted <= most)) return std::nullopt;
  Steps out;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const double end = i + 1 < joints.size() ? joints[i + 1] : 1;
    for (double k = 0; k < counts[i]; ++k) out.f.push_back(joints[i] + (end - joints[i]) * k / counts[i]);
  }
  std::vector<double> rows(loft.x.size() - 1, 1);
  for (const double f : out.f) {
    const Rail rail = loft.rail(f);
    for (std::size_t i = 0; i < rows.size(); ++i)
      rows[i] = std::max(rows[i], rail.pieces(i, 0.25 * deflection));
  }
  double all = 0;
  for (double& n : rows) n *= finer, all += n;
  wanted = 2 * columns * (all + 1);
  if (!(wanted <= most)) return std::nullopt;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double a = loft.x[i], b = loft.x[i + 1];
    for (double k = 0; k < rows[i]; ++k) out.rows.emplace_back(i, a + (b - a) * k / rows[i]);
  }
  out.rows.emplace_back(rows.size() - 1, loft.x.back());
  return out;
}

/// The wall: row after row. Diagonals inwards or outwards as the middle of the cell asks for.
geom::Mesh wall(const Loft& loft, const Steps& steps, double& deviation) {
  const std::size_t n = steps.f.size(), rows = steps.rows.size();
  geom::Mesh mesh;
  mesh.vertices.resize(n * rows);
  std::vector<Point3> middles(n * (rows - 1));
  for (std::size_t k = 0; k < n; ++k) {
    const double end = k + 1 < n ? steps.f[k + 1] : 1;
    const Rail rail = loft.rail(steps.f[k]), middle = loft.rail(0.5 * (steps.f[k] + end));
    for (std::size_t r = 0; r < rows; ++r) {
      const auto [i, x] = steps.rows[r];
      const Point2 p = rail.at(i, x);
      mesh.vertices[r * n + k] = {x, p.x, p.y};
      if (r + 1 == rows) continue;
      const double x_mid = 0.5 * (x + steps.rows[r + 1].second);
      const Point2 m = middle.at(i, x_mid);
      middles[r * n + k] = {x_mid, m.x, m.y};
    }
  }
  deviation = 0;
  for (std::size_t r = 0; r + 1 < rows; ++r) {
    for (std::size_t k = 0; k < n; ++k) {
      const auto a = static_cast<std::uint32_t>(r * n + k),
                 b = static_cast<std::uint32_t>(r * n + (k + 1) % n);
      const auto up = static_cast<std::uint32_t>(n);
      const Point3 m = middles[r * n + k];
      const double d0 = distance(m, lerp(mesh.vertices[a], mesh.vertices[b + up], 0.5)),
                   d1 = distance(m, lerp(mesh.vertices[b], mesh.vertices[a + up], 0.5));
      deviation = std::max(deviation, std::min(d0, d1));
      if (d0 <= d1) {
        mesh.triangles.push_back({a, b, b + up});
        mesh.triangles.push_back({a, b + up, a + up});
      } else {
        mesh.triangles.push_back({a, b, a + up});
        mesh.triangles.push_back({b, b + up, a + up});
      }
    }
  }
  return mesh;
}

void close_ends(geom::Mesh& mesh, std::size_t n) {
  for (const bool last : {false, true}) {
    const std::size_t first = last ? mesh.vertices.size() - n : 0;
    std::vector<Point2> polygon;
    for (std::size_t k = 0; k < n; ++k)
      polygon.push_back({mesh.vertices[first + k].y, mesh.vertices[first + k].z});
    for (auto t : detail::triangulate(polygon)) {
      for (std::uint32_t& i : t) i += static_cast<std::uint32_t>(first);
      if (!last) std::swap(t[1], t[2]);
      mesh.triangles.push_back(t);
    }
  }
}

}  // namespace

Result<Part> make_loft(const std::vector<LoftSection>& sections, const PartOptions& options) {
  const double deflection = options.deflection_mm;
  if (!(deflection > 0) || !std::isfinite(deflection))
    return Error{ErrorCode::usage, "the deflection must be above 0 mm", {}};
  auto loft = loft_of(sections, deflection);
  if (!loft) return loft.error();
  geom::Mesh mesh;
  std::size_t columns = 0;
  double deviation = 0;
  // Steps come from bounds that do not know of twist: what is measured in the middles of the cells decides.
  constexpr int kTries = 10;
  double finer = 1;
  for (int i = 0; i < kTries; ++i, finer *= 2) {
    double wanted = 0;
    const auto steps =
        steps_for(*loft, deflection, finer, static_cast<double>(options.max_triangles), wanted);
    if (!steps) {
      return Error{ErrorCode::range,
                   "the part would take " + format_fixed(wanted, 0) + " triangles at a deflection of " +
                       format_shortest(deflection) + " mm (" + std::to_string(options.max_triangles) +
                       " are allowed; a larger tolerance needs fewer)",
                   {}};
    }
    columns = steps->f.size();
    if (columns < 3) return geometry("a section has no inside (one closed curve around the axis)");
    mesh = wall(*loft, *steps, deviation);
    if (deviation <= deflection) break;
  }
  if (deviation > deflection)
    return geometry("the loft turns too sharply to be meshed (sections nearer together)");
  close_ends(mesh, columns);
  Diagnostics unused;
  auto part = make_meshed(std::move(mesh), "loft", options, unused);
  if (!part) return Error{part.error().code, "the loft between the sections: " + part.error().message, {}};
  part->deflection_mm = deflection;
  return part;
}

}  // namespace burin::rotary

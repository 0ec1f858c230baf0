// SPDX-License-Identifier: Apache-2.0
// For tests: parts with a formula (heights over the plane, and blocks), their triangles, their contact
// points, and whether a mill hits them, found from the formula with nothing that the library uses: neither
// triangles, nor trees, nor the places it remembers. mm, radians.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "burin/geom/mesh/mesh.h"
#include "burin/geom/vec.h"
#include "burin/model/tool.h"
#include "burin/plan/orient/tool_angles.h"

namespace burin::orient::cases {

using geom::Mesh;
using geom::Point3;
using geom::Vec3;

/// Height and its derivatives.
struct Height {
  double h = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
};
struct Block {
  Point3 lo, hi;
};
struct Shape {
  std::string name;
  std::function<Height(double, double)> height;
  std::vector<Block> blocks;
  double half_width = 45;  ///< of the square over which the ground exists
};

inline Height flat(double, double) {
  return {};
}
/// sign +1: a bowl, -1: a hill.
inline Height sphere(double radius, double sign, double x, double y) {
  const double w = std::sqrt(radius * radius - x * x - y * y), w3 = w * w * w;
  return {sign * (radius - w),         sign * x / w,      sign * y / w,
          sign * (w * w + x * x) / w3, sign * x * y / w3, sign * (w * w + y * y) / w3};
}
/// Axis through the plane in a direction; sign as above.
inline Height cylinder(double radius, double sign, double direction, double x, double y) {
  const double cx = -std::sin(direction), cy = std::cos(direction), s = cx * x + cy * y;
  const double w = std::sqrt(radius * radius - s * s), d1 = sign * s / w,
               d2 = sign * radius * radius / (w * w * w);
  return {sign * (radius - w), d1 * cx, d1 * cy, d2 * cx * cx, d2 * cx * cy, d2 * cy * cy};
}
/// Torus about an axis parallel to y, tube `tube`, tube's centres on the circle of `radius`. outer +1: top of
/// the outside (a hill); -1: bottom of the hole's wall seen from above: rises in x, falls in y.
inline Height torus(double radius, double tube, double outer, double x, double y) {
  const double v = std::sqrt(tube * tube - y * y), v1 = -y / v, v2 = -(tube * tube) / (v * v * v);
  const double m = radius + outer * v, m1 = outer * v1, m2 = outer * v2;
  const double z = std::sqrt(m * m - x * x), z3 = z * z * z;
  // z(x, y) = sqrt(m(y)^2 - x^2), taken from above for the hill, mirrored for the hole.
  const Height up{
      z - (radius + outer * tube), -x / z,          m * m1 / z,
      -(z * z + x * x) / z3,       x * m * m1 / z3, ((m1 * m1 + m * m2) * z * z - m * m * m1 * m1) / z3};
  if (outer > 0) return up;
  return {-up.h, -up.x, -up.y, -up.xx, -up.xy, -up.yy};
}
/// a x^2 + b x y + c y^2
inline Height quadric(double a, double b, double c, double x, double y) {
  return {a * x * x + b * x * y + c * y * y, 2 * a * x + b * y, b * x + 2 * c * y, 2 * a, b, 2 * c};
}
/// A twisted blade with waves on it.
inline Height blade(double twist, double camber, double wave, double length, double x, double y) {
  Height q = quadric(camber, twist, 0, x, y);
  const double k = 2 * geom::kPi / length, p = k * (x + 0.4 * y), s = std::sin(p), c = std::cos(p);
  q.h += wave * s, q.x += wave * k * c, q.y += 0.4 * wave * k * c;
  q.xx -= wave * k * k * s, q.xy -= 0.4 * wave * k * k * s, q.yy -= 0.16 * wave * k * k * s;
  return q;
}

/// Walls and slots stand on their ground and end below it.
inline Block wall(double y_from, double y_to, double top) {
  return {{-70, std::min(y_from, y_to), -30}, {70, std::max(y_from, y_to), top}};
}

inline std::vector<Shape> shapes() {
  using std::placeholders::_1;
  using std::placeholders::_2;
  std::vector<Shape> all;
  all.push_back({"plane", flat, {}});
  all.push_back({"bowl", [](double x, double y) { return sphere(90, 1, x, y); }, {}});
  all.push_back({"hill", [](double x, double y) { return sphere(120, -1, x, y); }, {}});
  all.push_back({"trough", [](double x, double y) { return cylinder(75, 1, 0.6, x, y); }, {}});
  all.push_back({"ridge", [](double x, double y) { return cylinder(80, -1, -0.3, x, y); }, {}});
  all.push_back({"torus", [](double x, double y) { return torus(80, 90, 1, x, y); }, {}});
  all.push_back({"hole", [](double x, double y) { return torus(190, 80, -1, x, y); }, {}});
  all.push_back({"saddle", [](double x, double y) { return quadric(0.005, 0.002, -0.004, x, y); }, {}});
  all.push_back({"blade", [](double x, double y) { return blade(0.004, 0.003, 0.4, 45, x, y); }, {}});
  all.push_back({"waves", [](double x, double y) { return blade(0, 0, 0.7, 40, x, y); }, {}});
  all.push_back({"wall", flat, {wall(19, 40, 30)}});
  all.push_back({"slot",
                 [](double x, double y) { return cylinder(110, 1, 0, x, y); },
                 {wall(23, 40, 60), wall(-40, -25, 25)}});
  all.push_back({"post",
                 [](double x, double y) { return quadric(0.002, 0, 0.003, x, y); },
                 {{{14, 10, -5}, {24, 22, 18}}, {{-34, -20, -5}, {-22, -4, 45}}}});
  all.push_back({"overhang",
                 [](double x, double y) { return quadric(0.001, 0, 0.004, x, y); },
                 {{{-50, 16, 24}, {50, 44, 40}}}});
  return all;
}

/// Squares of `step` at most, two triangles each; then the blocks. The triangles leave the ground by
/// about step^2 / 8 times its curvature.
inline Mesh triangles(const Shape& shape, double step) {
  Mesh mesh;
  const int n = std::max(1, static_cast<int>(std::ceil(2 * shape.half_width / step)));
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const double x = shape.half_width * (2.0 * i / n - 1), y = shape.half_width * (2.0 * j / n - 1);
      mesh.vertices.push_back({x, y, shape.height(x, y).h});
    }
  const auto node = [n](int i, int j) { return static_cast<std::uint32_t>(i + j * (n + 1)); };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      mesh.triangles.push_back({node(i, j), node(i + 1, j), node(i + 1, j + 1)});
      mesh.triangles.push_back({node(i, j), node(i + 1, j + 1), node(i, j + 1)});
    }
  for (const Block& b : shape.blocks) {
    const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int k = 0; k < 8; ++k)
      mesh.vertices.push_back({k & 1 ? b.hi.x : b.lo.x, k & 2 ? b.hi.y : b.lo.y, k & 4 ? b.hi.z : b.lo.z});
    constexpr std::array<std::array<std::uint32_t, 4>, 6> faces{
        {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
    for (const auto& q : faces) {
      mesh.triangles.push_back({base + q[0], base + q[1], base + q[2]});
      mesh.triangles.push_back({base + q[0], base + q[2], base + q[3]});
    }
  }
  return mesh;
}

inline CcPoint contact(const Shape& shape, double x, double y, double feed) {
  const Height z = shape.height(x, y);
  CcPoint at;
  at.c = {x, y, z.h};
  at.n = geom::unit(Vec3{-z.x, -z.y, 1});
  const double cf = std::cos(feed), sf = std::sin(feed);
  at.f = geom::unit(Vec3{cf, sf, z.x * cf + z.y * sf});
  const Vec3 t = at.t();
  const auto second = [&](Vec3 a, Vec3 b) {
    return (z.xx * a.x * b.x + z.xy * (a.x * b.y + a.y * b.x) + z.yy * a.y * b.y) * at.n.z;
  };
  at.k_ff = second(at.f, at.f);
  at.k_ft = second(at.f, t);
  at.k_tt = second(t, t);
  return at;
}

/// Whether a mill (body less the tolerance, holder grown by the clearance) hits a shape. `ease`: what may
/// stand this much nearer still is free; negative: must stand farther off.
class Referee {
 public:
  Referee(const Shape& shape, const model::Mill& mill, double tolerance, double clearance)
      : shape_(&shape), mill_(mill) {
    const bool bull = mill.kind == model::MillKind::bull && mill.corner_radius > tolerance;
    if (bull) {
      // The corner's tube within, and the side above it.
      pieces_.push_back({mill.radius - mill.corner_radius, mill.corner_radius, mill.corner_radius,
                         mill.corner_radius - tolerance, true});
      pieces_.push_back({mill.radius - tolerance, mill.corner_radius, mill.length, 0, true});
    } else {
      pieces_.push_back({mill.radius - tolerance, tolerance, mill.length, 0, true});
    }
    double height = mill.length;
    for (const model::HolderPiece& piece : mill.holder) {
      pieces_.push_back({piece.radius, height, height + piece.height, clearance, false});
      height += piece.height;
    }
    double steepest = 0;
    for (double x = -shape.half_width; x <= shape.half_width; x += 1)
      for (double y = -shape.half_width; y <= shape.half_width; y += 1) {
        const Height z = shape.height(x, y);
        steepest = std::max(steepest, z.x * z.x + z.y * z.y);
      }
    flatness_ = 1 / std::sqrt(1 + 1.1 * steepest);
  }

  enum class Hit : std::uint8_t { none, gouge, collision };
  Hit hit(const CcPoint& at, const Angles& angles, double ease = 0) {
    const cl::Pose there = tool_at(at, angles);
    Hit worst = Hit::none;
    for (const Piece& piece : pieces_) {
      if (worst != Hit::none) break;
      if (hits_blocks(piece, there, ease) || hits_ground(piece, there, ease))
        worst = piece.cutter ? Hit::gouge : Hit::collision;
    }
    return worst;
  }
  bool free(const CcPoint& at, const Angles& angles, double ease = 0) {
    // What was hit last is looked at first.
    if (last_piece_ < pieces_.size() && last_hits(tool_at(at, angles), ease)) return false;
    return hit(at, angles, ease) == Hit::none;
  }

  /// The greatest effective radius over a fine grid of yaws, tilts by steps and bisection; radii below
  /// `least` do not matter. 0: none above that.
  double exhaustive(const CcPoint& at, const AngleRange& range, double least, double ease, Angles* where) {
    double best = least;
    bool any = false;
    const auto look = [&](double from, double to, double step) {
      for (double beta = from; beta <= to + 1e-12; beta += step)
        any |= best_of_yaw(at, range, std::clamp(beta, range.beta_lo, range.beta_hi), ease, best, where);
    };
    look(range.beta_lo, range.beta_hi, radians_(0.5));
    for (const double middle : {0.0, range.beta_hi, range.beta_lo})
      if (range.beta_lo <= middle && middle <= range.beta_hi)
        any |= best_of_yaw(at, range, middle, ease, best, where);
    for (const double step : {0.05, 0.005}) {
      if (!any) break;
      const double middle = where->beta;
      look(std::max(range.beta_lo, middle - radians_(12 * step)),
           std::min(range.beta_hi, middle + radians_(12 * step)), radians_(step));
    }
    return any ? best : 0;
  }

  double radius(const Angles& a) const {
    const double r = corner(), s = std::sin(a.alpha), c2 = std::pow(std::cos(a.beta), 2);
    return c2 * (mill_.radius - r) / s + r;
  }

 private:
  struct Piece {
    double radius, from, to, grow;
    bool cutter;
  };
  static double radians_(double degrees) { return degrees * geom::kPi / 180; }
  double corner() const { return mill_.kind == model::MillKind::bull ? mill_.corner_radius : 0; }

  cl::Pose tool_at(const CcPoint& at, const Angles& a) const {
    const Vec3 t = cross(at.n, at.f);
    const Vec3 d = std::cos(a.beta) * at.f + std::sin(a.beta) * t;
    const Vec3 u = std::cos(a.alpha) * at.n + std::sin(a.alpha) * d;
    const Vec3 inward = geom::unit(at.n - dot(at.n, u) * u);
    return {at.c + corner() * at.n + (mill_.radius - corner()) * inward - corner() * u, u};
  }

  bool best_of_yaw(const CcPoint& at, const AngleRange& range, double beta, double ease, double& best,
                   Angles* where) {
    const double r = corner(), c2 = std::pow(std::cos(beta), 2);
    // Greater tilts have radii below the best.
    const double sine = best > r ? c2 * (mill_.radius - r) / (best - r) : 1;
    const double end = std::min(range.alpha_hi, sine < 1 ? std::asin(sine) : range.alpha_hi);
    const double step = radians_(0.25);
    double blocked = -1, alpha = range.alpha_lo;
    for (;; alpha = std::min(alpha + step, end)) {
      if (alpha > end) return false;
      if (free(at, {alpha, beta}, ease)) break;
      if (alpha >= end) return false;
      blocked = alpha;
    }
    if (blocked >= 0)
      while (alpha - blocked > 1e-8) {
        const double middle = (alpha + blocked) / 2;
        (free(at, {middle, beta}, ease) ? alpha : blocked) = middle;
      }
    const double value = radius({alpha, beta});
    if (!(value > best)) return false;
    best = value;
    *where = {alpha, beta};
    return true;
  }

  /// Signed distance of a point from the ground, exact where it matters: within `near` of it.
  double above_ground(Point3 p, double near) const {
    const double w = shape_->half_width;
    if (std::abs(p.x) > w || std::abs(p.y) > w) return std::numeric_limits<double>::infinity();
    const double gap = p.z - shape_->height(p.x, p.y).h;
    if (near <= 0 || gap <= 0 || gap * flatness_ > near) return gap > 0 ? gap * flatness_ : gap;
    // Newton's method for the foot of the perpendicular, from where the tangent plane has it.
    double a = p.x, b = p.y;
    for (int k = 0; k < 12; ++k) {
      const Height z = shape_->height(a, b);
      const double d = z.h - p.z, ga = a - p.x + d * z.x, gb = b - p.y + d * z.y;
      double jaa = 1 + z.x * z.x + d * z.xx, jab = z.x * z.y + d * z.xy, jbb = 1 + z.y * z.y + d * z.yy;
      if (k == 0 || jaa * jbb - jab * jab < 0.05) jaa = 1 + z.x * z.x, jab = z.x * z.y, jbb = 1 + z.y * z.y;
      const double det = jaa * jbb - jab * jab;
      const double da = (jbb * ga - jab * gb) / det, db = (jaa * gb - jab * ga) / det;
      a -= da, b -= db;
      if (std::abs(da) + std::abs(db) < 1e-12) break;
    }
    const Height z = shape_->height(a, b);
    return std::sqrt(std::pow(a - p.x, 2) + std::pow(b - p.y, 2) + std::pow(z.h - p.z, 2));
  }

  struct Frame {
    Vec3 e1, e2;
  };
  static Frame frame(Vec3 u) {
    const Vec3 a = std::abs(u.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    const Vec3 e1 = geom::unit(cross(u, a));
    return {e1, cross(u, e1)};
  }
  /// Bottom of a piece at a share of its radius and an angle.
  double depth(const Piece& piece, const cl::Pose& there, double share, double angle) const {
    const Frame f = frame(there.axis);
    const Point3 p = there.tip + piece.from * there.axis +
                     share * piece.radius * (std::cos(angle) * f.e1 + std::sin(angle) * f.e2);
    return above_ground(p, piece.grow + 0.1) - piece.grow;
  }

  bool last_hits(const cl::Pose& there, double ease) const {
    return depth(pieces_[last_piece_], there, last_share_, last_angle_) < -ease;
  }
  bool found(const Piece& piece, double share, double angle) {
    last_piece_ = static_cast<std::size_t>(&piece - pieces_.data());
    last_share_ = share, last_angle_ = angle;
    return true;
  }

  /// The ground rises nowhere as steeply as the tool stands: what it hits of a piece it hits at its bottom.
  bool hits_ground(const Piece& piece, const cl::Pose& there, double ease) {
    constexpr int kAround = 240, kRings = 10;
    constexpr double kTurn = 2 * geom::kPi;
    // The rim: samples, then each hollow among them is followed down.
    std::array<double, kAround> rim{};
    for (int k = 0; k < kAround; ++k) {
      rim[static_cast<std::size_t>(k)] = depth(piece, there, 1, k * kTurn / kAround);
      if (rim[static_cast<std::size_t>(k)] < -ease) return found(piece, 1, k * kTurn / kAround);
    }
    for (int k = 0; k < kAround; ++k) {
      const double here = rim[static_cast<std::size_t>(k)];
      if (here > 0.1 || here > rim[static_cast<std::size_t>((k + 1) % kAround)] ||
          here > rim[static_cast<std::size_t>((k + kAround - 1) % kAround)])
        continue;
      double lo = (k - 1) * kTurn / kAround, hi = (k + 1) * kTurn / kAround;
      for (int i = 0; i < 40; ++i) {
        const double a = lo + (hi - lo) * 0.382, b = lo + (hi - lo) * 0.618;
        (depth(piece, there, 1, a) < depth(piece, there, 1, b) ? hi : lo) =
            depth(piece, there, 1, a) < depth(piece, there, 1, b) ? b : a;
      }
      if (depth(piece, there, 1, (lo + hi) / 2) < -ease) return found(piece, 1, (lo + hi) / 2);
    }
    return hits_inside(piece, there, ease, kRings);
  }

  bool hits_inside(const Piece& piece, const cl::Pose& there, double ease, int rings) {
    constexpr double kTurn = 2 * geom::kPi;
    double low = std::numeric_limits<double>::infinity(), share = 0, angle = 0;
    for (int ring = 0; ring < rings; ++ring) {
      const int around = std::max(1, 6 * ring);
      for (int k = 0; k < around; ++k) {
        const double s = static_cast<double>(ring) / rings, a = k * kTurn / around;
        const double here = depth(piece, there, s, a);
        if (here < -ease) return found(piece, s, a);
        if (here < low) low = here, share = s, angle = a;
      }
    }
    if (low > 0.3) return false;
    // Compass search from the lowest sample, in the plane of the bottom.
    double x = share * std::cos(angle), y = share * std::sin(angle);
    for (double step = 1.0 / rings; step > 1e-4;) {
      bool better = false;
      for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
        const double nx = x + dx * step, ny = y + dy * step, s = std::hypot(nx, ny);
        if (s > 1) continue;
        const double here = depth(piece, there, s, std::atan2(ny, nx));
        if (here < -ease) return found(piece, s, std::atan2(ny, nx));
        if (here < low) low = here, x = nx, y = ny, better = true;
      }
      if (!better) step /= 2;
    }
    return false;
  }

  /// How far a point is outside the piece; negative inside (for pieces that do not grow), else 0 inside.
  static double outside(const Piece& piece, const cl::Pose& there, Point3 q) {
    const Vec3 v = q - there.tip;
    const double h = dot(v, there.axis), rho = norm(v - h * there.axis);
    const double dr = rho - piece.radius, dh = std::max(piece.from - h, h - piece.to);
    if (piece.grow <= 0) return std::max(dr, dh);
    return std::hypot(std::max(0.0, dr), std::max(0.0, dh)) - piece.grow;
  }

  /// Least value of a convex function of one variable.
  template <class F>
  static double least(double lo, double hi, const F& f) {
    constexpr double g = 0.6180339887498949;
    double a = hi - g * (hi - lo), b = lo + g * (hi - lo), fa = f(a), fb = f(b);
    while (hi - lo > 1e-7) {
      if (fa < fb)
        hi = b, b = a, fb = fa, a = hi - g * (hi - lo), fa = f(a);
      else
        lo = a, a = b, fa = fb, b = lo + g * (hi - lo), fb = f(b);
    }
    return std::min(fa, fb);
  }

  bool hits_blocks(const Piece& piece, const cl::Pose& there, double ease) const {
    for (const Block& b : shape_->blocks) {
      const Point3 middle = there.tip + (piece.from + piece.to) / 2 * there.axis;
      const Point3 near{std::clamp(middle.x, b.lo.x, b.hi.x), std::clamp(middle.y, b.lo.y, b.hi.y),
                        std::clamp(middle.z, b.lo.z, b.hi.z)};
      if (geom::distance(middle, near) > std::hypot(piece.radius, (piece.to - piece.from) / 2) + piece.grow)
        continue;
      // Each face: a convex function of two variables.
      for (int axis = 0; axis < 3; ++axis)
        for (const bool high : {false, true}) {
          const std::array<double, 3> lo{b.lo.x, b.lo.y, b.lo.z}, hi{b.hi.x, b.hi.y, b.hi.z};
          const auto i = static_cast<std::size_t>(axis), j = (i + 1) % 3, k = (i + 2) % 3;
          std::array<double, 3> q{};
          q[i] = high ? hi[i] : lo[i];
          const double gap = least(lo[j], hi[j], [&](double s) {
            q[j] = s;
            return least(lo[k], hi[k], [&](double t) {
              q[k] = t;
              return outside(piece, there, {q[0], q[1], q[2]});
            });
          });
          if (gap < -ease) return true;
        }
    }
    return false;
  }

  const Shape* shape_;
  model::Mill mill_;
  std::vector<Piece> pieces_;
  double flatness_ = 1;
  std::size_t last_piece_ = std::numeric_limits<std::size_t>::max();
  double last_share_ = 0, last_angle_ = 0;
};

inline std::vector<model::Mill> mills() {
  using model::MillKind;
  return {{MillKind::flat, 16, 0, 18, {}},
          {MillKind::flat, 14, 0, 12, {{19, 30}, {30, 20}}},
          {MillKind::bull, 16, 3, 15, {{13, 25}, {28, 30}}},
          {MillKind::bull, 10, 5, 20, {}}};
}
inline std::vector<AngleRange> ranges() {
  const auto of = [](double a, double b, double c, double d) {
    return AngleRange{geom::radians(a), geom::radians(b), geom::radians(c), geom::radians(d)};
  };
  return {of(1.5, 20, -90, 90), of(0.5, 35, -60, 80), of(2, 30, 15, 85),   of(3, 3, -90, 90),
          of(1, 40, -90, 90),   of(1, 25, -25, -25),  of(1.5, 20, -80, 10)};
}

}  // namespace burin::orient::cases

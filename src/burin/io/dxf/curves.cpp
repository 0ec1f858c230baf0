// SPDX-License-Identifier: Apache-2.0
#include "burin/io/dxf/curves.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace burin::io::dxf {
namespace {

using geom::Affine2;
using geom::Arc2;
using geom::Box2;
using geom::Curve2;
using geom::EllipseArc2;
using geom::kPi;
using geom::Line2;
using geom::Point2;
using geom::Point3;
using geom::Vec2;
using geom::Vec3;

// Sine of the angle below which a plane counts as parallel (or perpendicular) to XY: rounding of extrusion
// directions written with 10 or more decimals.
constexpr double kParallel = 1e-9;
// A circle made by an ellipse: rounding of products only, not a geometric tolerance.
constexpr double kRound = 1e-12;

class Converter {
 public:
  Converter(const Item& item, const Map3& map) : item_(item), map_(map) {}

  Converted run() {
    for (const std::string& repair : item_.repairs) info("count_mismatch", repair);
    std::visit([this](const auto& shape) { take(shape); }, item_.shape);
    if (!validate()) out_.paths.clear();
    return std::move(out_);
  }

 private:
  void info(std::string code, std::string message) {
    out_.findings.push_back({Severity::info, std::move(code), std::move(message)});
  }
  void left_out(std::string code, std::string message) {
    out_.findings.push_back({Severity::left_out, std::move(code), std::move(message)});
  }

  // Notes the place of a mapped point of the entity, and returns it seen from above.
  Point2 see(Point3 mapped) {
    if (!seen_) {
      out_.at = mapped;
      out_.z_lowest = out_.z_highest = mapped.z;
      seen_ = true;
    }
    out_.z_lowest = std::min(out_.z_lowest, mapped.z);
    out_.z_highest = std::max(out_.z_highest, mapped.z);
    return xy(mapped);
  }

  // False when the plane spanned by two mapped directions stands on edge; a tilted one is reported.
  bool check_plane(Vec3 u, Vec3 v) {
    const Vec3 normal = cross(u, v);
    const double size = norm(u) * norm(v);
    if (!(std::abs(normal.z) > kParallel * size)) {
      left_out("edge_on", "stands on edge to the XY plane and is left out");
      return false;
    }
    if (std::hypot(normal.x, normal.y) > kParallel * size) report_tilt();
    return true;
  }
  void report_tilt() { info("tilted", "is tilted against the XY plane: its projection onto XY is used"); }

  void add(Curve2 curve, bool closed) {
    Path path;
    path.curves.push_back(std::move(curve));
    path.closed = closed;
    out_.paths.push_back(std::move(path));
  }

  void take(const std::monostate&) {}
  void take(const InsertShape&) {}

  void take(const LineShape& line) {
    const Point2 a = see(map_(line.a)), b = see(map_(line.b));
    add(Line2{a, b}, false);
  }

  void take(const ArcShape& arc) {
    const Map3 map = map_ * entity_system(item_.extrusion);
    see(map(arc.center));
    if (!(arc.radius > 0)) {
      if (arc.radius == 0) return info("zero_length", "has radius 0: nothing to cut");
      return left_out("bad_geometry", "has a negative radius and is left out");
    }
    const double sweep = arc.full ? 2 * kPi : geom::radians(span_deg(arc.start_deg, arc.end_deg));
    if (sweep == 0) return info("zero_length", "begins and ends at the same angle: nothing to cut");
    if (!check_plane(map.x, map.y)) return;
    const Arc2 curve{
        {arc.center.x, arc.center.y}, arc.radius, geom::radians(std::fmod(arc.start_deg, 360.0)), sweep};
    add(geom::transformed(seen_from_above(map, arc.center.z), curve), sweep == 2 * kPi);
  }

  // Counter-clockwise from start to end, in (0, 360]; whole turns between them are a full circle, equal
  // angles nothing.
  static double span_deg(double start, double end) {
    // Differences below this are decimals lost in writing: 2e-6 mm at a radius of 100 m.
    constexpr double kSameAngle = 1e-9;
    const double difference = end - start;
    if (std::abs(difference) <= kSameAngle) return 0;
    double span = std::fmod(difference, 360.0);
    if (span < 0) span += 360.0;
    return span <= kSameAngle || span >= 360.0 - kSameAngle ? 360.0 : span;
  }

  void take(const EllipseShape& ellipse) {
    const Vec3 normal = unit(item_.extrusion) == Vec3{} ? Vec3{0, 0, 1} : unit(item_.extrusion);
    const Vec3 major = map_(ellipse.major), minor = map_(ellipse.ratio * cross(normal, ellipse.major));
    const Point2 center = see(map_(ellipse.center));
    if (norm(ellipse.major) == 0) return info("zero_length", "has an axis of length 0: nothing to cut");
    if (ellipse.ratio == 0) return left_out("bad_geometry", "is an ellipse without width and is left out");
    const double sweep = geom::radians(span_deg(geom::degrees(ellipse.start), geom::degrees(ellipse.end)));
    if (sweep == 0) return info("zero_length", "begins and ends at the same angle: nothing to cut");
    if (!check_plane(major, minor)) return;
    const double start = std::fmod(ellipse.start, 2 * kPi);
    add(as_arc_when_round({center, {major.x, major.y}, {minor.x, minor.y}, start, sweep}), sweep == 2 * kPi);
  }

  // Several systems write circles as ellipses.
  static Curve2 as_arc_when_round(const EllipseArc2& e) {
    const double radius = norm(e.major);
    if (std::abs(norm(e.minor) - radius) > kRound * radius) return e;
    if (std::abs(dot(e.major, e.minor)) > kRound * radius * radius) return e;
    const double turn = std::atan2(e.major.y, e.major.x);
    const bool mirrored = cross(e.major, e.minor) < 0;
    return Arc2{e.center, radius, mirrored ? turn - e.start : turn + e.start, mirrored ? -e.sweep : e.sweep};
  }

  void take(const PolylineShape& polyline) {
    if (polyline.vertices.empty()) return info("zero_length", "has no vertices: nothing to cut");
    const Map3 map = polyline.spatial ? map_ : map_ * entity_system(item_.extrusion);
    const bool bent = !polyline.spatial && std::any_of(polyline.vertices.begin(), polyline.vertices.end(),
                                                       [](const Vertex& v) { return v.bulge != 0; });
    std::vector<Point2> seen;
    seen.reserve(polyline.vertices.size());
    for (const Vertex& v : polyline.vertices) {
      const double z = polyline.spatial ? v.at.z : polyline.elevation;
      seen.push_back(see(map(Point3{v.at.x, v.at.y, z})));
    }
    if (seen.size() < 2) return info("zero_length", "has a single vertex: nothing to cut");
    if (!polyline.spatial && !check_polyline_plane(map, bent)) return;
    Path path;
    path.closed = polyline.closed;
    const Affine2 plane = seen_from_above(map, polyline.elevation);
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const std::size_t next = (i + 1) % seen.size();
      if (next == 0 && !closing_piece(polyline)) break;
      const Vertex& from = polyline.vertices[i];
      const Vertex& to = polyline.vertices[next];
      const double bulge = polyline.spatial ? 0 : from.bulge;
      path.curves.push_back(is_flat(bulge, from, to) ? Curve2{Line2{seen[i], seen[next]}}
                                                     : geom::transformed(plane, bulge_arc(from, to)));
    }
    out_.paths.push_back(std::move(path));
  }

  // Lines alone may be seen on edge: they stay lines.
  bool check_polyline_plane(const Map3& map, bool bent) {
    if (bent) return check_plane(map.x, map.y);
    if (std::hypot(map.x.z, map.y.z) > kParallel * std::hypot(norm(map.x), norm(map.y))) report_tilt();
    return true;
  }

  // Closed polylines often repeat their first vertex at the end: nothing lies between the two.
  static bool closing_piece(const PolylineShape& polyline) {
    if (!polyline.closed) return false;
    const Vertex& first = polyline.vertices.front();
    const Vertex& last = polyline.vertices.back();
    return !(last.at.x == first.at.x && last.at.y == first.at.y);
  }

  // bulge = tan(sweep / 4); the arc's height is bulge * chord / 2. Below this bound a line deviates less than
  // 5e-9 chords, while the centre of the arc would lie so far out that rounding there costs as much.
  static bool is_flat(double bulge, const Vertex& from, const Vertex& to) {
    constexpr double kFlatBulge = 1e-8;
    return std::abs(bulge) < kFlatBulge || (from.at.x == to.at.x && from.at.y == to.at.y);
  }

  static Arc2 bulge_arc(const Vertex& from, const Vertex& to) {
    const Point2 a = xy(from.at), b = xy(to.at);
    const Vec2 chord = b - a;
    const double bulge = from.bulge;
    const Point2 center = lerp(a, b, 0.5) + ((1 - bulge * bulge) / (4 * bulge)) * left(chord);
    const double radius = norm(chord) * (1 + bulge * bulge) / (4 * std::abs(bulge));
    const Vec2 out = a - center;
    return {center, radius, std::atan2(out.y, out.x), 4 * std::atan(bulge)};
  }

  void take(const SplineShape& spline) {
    const auto& net = spline.points.empty() ? spline.fit_points : spline.points;
    for (const Point3& p : net) see(map_(p));
    if (net.empty())
      return left_out("bad_spline", "has neither control points nor fit points and is left out");
    const bool one_place =
        std::all_of(net.begin(), net.end(), [&](const Point3& p) { return p == net.front(); });
    if (one_place) return info("zero_length", "is a single point: nothing to cut");
    std::vector<Finding> findings;
    auto curve = spline_curve(spline, findings);
    out_.findings.insert(out_.findings.end(), findings.begin(), findings.end());
    if (!curve) return left_out("bad_spline", "is left out: " + curve.error().message);
    if (norm(Vec3{map_.x.z, map_.y.z, 0}) > kParallel * norm(map_.x)) report_tilt();
    // Control points carry the affine map, each with its own height; a curve through fit points was made in
    // XY.
    const Affine2 plane = seen_from_above(map_, net.front().z);
    for (std::size_t i = 0; i < curve->points.size(); ++i) {
      curve->points[i] = spline.points.empty() ? plane(curve->points[i]) : xy(map_(spline.points[i]));
    }
    add_spline(*curve);
    const bool closed =
        std::all_of(out_.paths.begin(), out_.paths.end(), [](const Path& p) { return p.closed; });
    if (spline.closed() && !closed) info("spline_open", "is marked as closed, but its ends do not meet");
  }

  void add_spline(const geom::Nurbs2& spline) {
    Box2 box;
    for (const Point2& p : spline.points) box.add(p);
    const double size =
        std::max({std::abs(box.lo.x), std::abs(box.hi.x), std::abs(box.lo.y), std::abs(box.hi.y)});
    const auto meet = [&](const Curve2& a, const Curve2& b) {
      return distance(geom::end_point(a), geom::start_point(b)) <= 16 * kRound * size;
    };
    const std::size_t first_path = out_.paths.size();
    for (geom::Nurbs2& piece : drawn_pieces(spline)) {
      Curve2 curve = std::move(piece);
      if (out_.paths.size() == first_path || !meet(out_.paths.back().curves.back(), curve))
        out_.paths.emplace_back();
      out_.paths.back().curves.push_back(std::move(curve));
    }
    if (out_.paths.size() > first_path + 1) info("spline_broken", "falls into pieces that do not meet");
    // Closed in fact, whatever the flags say.
    for (std::size_t i = first_path; i < out_.paths.size(); ++i) {
      Path& path = out_.paths[i];
      path.closed = meet(path.curves.back(), path.curves.front());
    }
  }

  // Without pieces that are a single point: they draw nothing.
  static std::vector<geom::Nurbs2> drawn_pieces(const geom::Nurbs2& spline) {
    if (!geom::validate(spline)) return {spline};  // reported later
    std::vector<geom::Nurbs2> pieces = split_at_breaks(spline);
    std::erase_if(pieces, [](const geom::Nurbs2& piece) {
      return std::all_of(piece.points.begin(), piece.points.end(),
                         [&](Point2 p) { return p == piece.points.front(); });
    });
    return pieces;
  }

  bool validate() {
    for (const Path& path : out_.paths) {
      for (const Curve2& curve : path.curves) {
        if (auto valid = geom::validate(curve); !valid) {
          left_out("bad_geometry", "is left out: " + valid.error().message);
          return false;
        }
      }
    }
    return true;
  }

  const Item& item_;
  const Map3& map_;
  Converted out_;
  bool seen_ = false;
};

}  // namespace

Converted convert(const Item& item, const Map3& map) {
  return Converter(item, map).run();
}

}  // namespace burin::io::dxf

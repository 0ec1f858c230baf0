// SPDX-License-Identifier: Apache-2.0
#include "burin/view/orient_html.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <utility>

#include "burin/view/encode.h"
#include "burin/view/mesh_shape.h"
#include "burin/view/page.h"

namespace burin::view {
namespace {

using nlohmann::json;
using orient::OrientedPoint;

// Together these keep a page below 9 MB: a triangle takes 36 characters, a point 88, a map of 33 x 33 nodes
// 364.
constexpr std::size_t kDesignTriangles = 30'000, kObstacleTriangles = 20'000;
constexpr std::size_t kPoints = 30'000;
constexpr std::size_t kPaths = 4'000;
constexpr std::size_t kMapBytes = 1'500'000;
constexpr std::size_t kMapNodes = 65'536;  ///< of one map
constexpr std::size_t kMapOverhead = 140;  ///< bytes beside the nodes, those of its point included

/// Share of the tool's radius below which an initial solution (yaw 90 degrees) has none to compare with.
constexpr double kNoRadius = 1e-6;
constexpr std::uint8_t kReachable = 1, kInitialFound = 2;
constexpr int kCauseShift = 2;

// --- the part

json mesh_json(const orient::Part& part, std::size_t first, std::size_t end, std::size_t most) {
  return shape_json(shaded(part.mesh, reduced(part.mesh, first, end, most)), end - first);
}

// --- maps that are shown

bool sound(const OrientPicture& picture, const OrientPicture::PointMap& m) {
  const auto& paths = picture.plan->paths;
  if (m.path >= paths.size() || m.point >= paths[m.path].points.size()) return false;
  if (m.map.tilts < 2 || m.map.yaws < 2) return false;
  const auto nodes = static_cast<std::size_t>(m.map.tilts) * static_cast<std::size_t>(m.map.yaws);
  return nodes <= kMapNodes && m.map.cells.size() == nodes;
}

/// All, or every n-th where they are too many.
std::vector<const OrientPicture::PointMap*> shown_maps(const OrientPicture& picture) {
  std::vector<const OrientPicture::PointMap*> all, out;
  std::size_t bytes = 0;
  for (const auto& m : picture.maps) {
    if (!sound(picture, m)) continue;
    all.push_back(&m);
    bytes += m.map.cells.size() / 4 + kMapOverhead;
  }
  const std::size_t every = bytes / kMapBytes + 1;
  for (std::size_t i = 0; i < all.size(); i += every) out.push_back(all[i]);
  return out;
}

// --- contact points

/// Numbers of the points that are on the page, path by path; first and last of a path always are, and those
/// with a map.
struct Kept {
  std::vector<std::vector<std::size_t>> points;    ///< [path]
  std::vector<std::vector<std::uint32_t>> number;  ///< [path][i]: on the page, of the last one kept up to i
};
Kept thinned(const OrientPicture& picture, const std::vector<const OrientPicture::PointMap*>& maps) {
  const auto& paths = picture.plan->paths;
  const std::size_t shown = std::min(paths.size(), kPaths);
  std::vector<std::set<std::size_t>> mapped(shown);
  for (const auto* m : maps)
    if (m->path < shown) mapped[m->path].insert(m->point);
  std::size_t count = 0;
  for (std::size_t i = 0; i < shown; ++i) count += paths[i].points.size();
  const std::size_t every = count / kPoints + 1;
  Kept kept;
  std::uint32_t next = 0;
  for (std::size_t i = 0; i < shown; ++i) {
    kept.points.emplace_back();
    kept.number.emplace_back();
    const std::size_t n = paths[i].points.size();
    for (std::size_t k = 0; k < n; ++k) {
      if (k % every == 0 || k + 1 == n || mapped[i].count(k) > 0) kept.points.back().push_back(k), ++next;
      kept.number.back().push_back(next - 1);
    }
  }
  return kept;
}

struct PointColumns {
  std::vector<float> contact, angles, rho, strip;
  std::vector<std::int16_t> normal, feed;
  std::vector<std::uint8_t> flags;
  std::vector<std::uint16_t> tests;
  std::vector<std::uint32_t> index;

  void add(const OrientedPoint& p, std::size_t number) {
    for (const double v : {p.cc.c.x, p.cc.c.y, p.cc.c.z}) contact.push_back(single(v));
    for (const double v : {p.cc.n.x, p.cc.n.y, p.cc.n.z}) normal.push_back(signed16(v));
    for (const double v : {p.cc.f.x, p.cc.f.y, p.cc.f.z}) feed.push_back(signed16(v));
    for (const double v : {p.angles.alpha, p.angles.beta, p.initial.alpha, p.initial.beta})
      angles.push_back(single(v));
    for (const double v : {p.rho, p.rho_initial})
      rho.push_back(static_cast<float>(v));  // infinite without tilt
    for (const double v : {p.strip.left, p.strip.right}) strip.push_back(single(v));
    flags.push_back(static_cast<std::uint8_t>((p.reachable ? kReachable : 0) |
                                              (p.initial_found ? kInitialFound : 0) |
                                              static_cast<int>(p.cause) << kCauseShift));
    tests.push_back(static_cast<std::uint16_t>(std::min<std::uint32_t>(p.tests, 65'535)));
    index.push_back(static_cast<std::uint32_t>(number));
  }
};

json points_json(const OrientPicture& picture, const Kept& kept) {
  PointColumns c;
  for (std::size_t i = 0; i < kept.points.size(); ++i)
    for (const std::size_t k : kept.points[i]) c.add(picture.plan->paths[i].points[k], k);
  return {{"n", c.flags.size()},      {"contact", base64(c.contact)}, {"normal", base64(c.normal)},
          {"feed", base64(c.feed)},   {"angles", base64(c.angles)},   {"rho", base64(c.rho)},
          {"strip", base64(c.strip)}, {"flags", base64(c.flags)},     {"tests", base64(c.tests)},
          {"index", base64(c.index)}};
}

/// Figures of one path over all its points, not only those on the page.
struct PathFigures {
  std::size_t reached = 0, both = 0;
  double rho = 0, initial = 0, tests = 0, length = 0;  ///< rho: mean over the points that have both
  PathFigures(const orient::OrientedPath& path, double tool_radius) {
    const OrientedPoint* last = nullptr;
    for (const OrientedPoint& p : path.points) {
      tests += p.tests;
      if (last) length += norm(p.cc.c - last->cc.c);
      last = &p;
      if (!p.reachable) continue;
      ++reached;
      if (!p.initial_found || !std::isfinite(p.rho) || !std::isfinite(p.rho_initial)) continue;
      if (p.rho_initial < kNoRadius * tool_radius) continue;
      ++both;
      rho += p.rho, initial += p.rho_initial;
    }
    if (both > 0) rho /= static_cast<double>(both), initial /= static_cast<double>(both);
    if (!path.points.empty()) tests /= static_cast<double>(path.points.size());
  }
};

/// Numbers: path, face, points on the page, points, reached. Figures: place in the family, mean radius
/// initial and optimal, mean gain, tests a point, length, loss of smoothing, shares of speed and
/// acceleration.
json paths_json(const OrientPicture& picture, const Kept& kept) {
  std::vector<std::int32_t> ids;
  std::vector<float> figures;
  for (std::size_t i = 0; i < kept.points.size(); ++i) {
    const orient::OrientedPath& path = picture.plan->paths[i];
    const PathFigures f(path, picture.mill->radius);
    for (const std::size_t v : {kept.points[i].size(), path.points.size(), f.reached, f.both})
      ids.push_back(static_cast<std::int32_t>(v));
    ids.push_back(path.number);
    ids.push_back(path.face);
    const auto& gains = picture.plan->gain_per_path;
    for (const double v : {path.at, f.initial, f.rho, i < gains.size() ? gains[i] : 0.0, f.tests, f.length,
                           path.smooth_loss, path.speed_share, path.acceleration_share})
      figures.push_back(single(v));
  }
  return {{"n", kept.points.size()},
          {"of", picture.plan->paths.size()},
          {"ids", base64(ids)},
          {"figures", base64(figures)}};
}

// --- maps

/// Two bits a node, four nodes a byte, the first in the lowest bits.
std::vector<std::uint8_t> packed(const orient::CSpaceMap& map) {
  std::vector<std::uint8_t> bytes((map.cells.size() + 3) / 4, 0);
  for (std::size_t i = 0; i < map.cells.size(); ++i) {
    const orient::Cause c = map.cells[i] == orient::Cause::bound ? orient::Cause::none : map.cells[i];
    bytes[i / 4] = static_cast<std::uint8_t>(bytes[i / 4] | static_cast<unsigned>(c) << (2 * (i % 4)));
  }
  return bytes;
}

json maps_json(const std::vector<const OrientPicture::PointMap*>& maps, const Kept& kept) {
  json list = json::array();
  for (const auto* m : maps) {
    if (m->path >= kept.number.size()) continue;
    const orient::AngleRange& r = m->map.range;
    const std::vector<float> range{single(r.alpha_lo), single(r.alpha_hi), single(r.beta_lo),
                                   single(r.beta_hi)};
    list.push_back({kept.number[m->path][m->point], m->point, m->map.tilts, m->map.yaws, base64(range),
                    base64(packed(m->map))});
  }
  return list;
}

// --- figures

json tool_json(const model::Mill& mill) {
  json holder = json::array();
  for (const model::HolderPiece& piece : mill.holder) holder.push_back({piece.radius, piece.height});
  const bool bull = mill.kind == model::MillKind::bull;
  return {{"kind", bull ? "bull" : "flat"},
          {"radius", number_or_null(mill.radius)},
          {"corner", number_or_null(bull ? mill.corner_radius : 0)},
          {"length", number_or_null(mill.length)},
          {"holder", holder}};
}

json options_json(const orient::OrientOptions& o) {
  return {{"range", {o.range.alpha_lo, o.range.alpha_hi, o.range.beta_lo, o.range.beta_hi}},
          {"tolerance", o.tolerance_mm},
          {"clearance", o.clearance_mm},
          {"objective", o.objective == orient::Objective::strip ? "strip" : "radius"},
          {"search", o.search == orient::Search::contour ? "contour"
                     : o.search == orient::Search::sturz ? "sturz"
                                                         : "optimal"},
          {"smooth", o.smooth},
          {"scallop", o.scallop_mm},
          {"feed", o.feed_mm_min},
          {"laid", !o.path_count && !o.side_step_mm}};
}

/// The program itself first; {name, possible, tilt, radius, unreachable, paths, cut, minutes}.
json times_json(const orient::OrientPlan& plan, const orient::OrientOptions& options) {
  json list = json::array();
  const double minutes = options.feed_mm_min > 0 ? plan.cut_mm / options.feed_mm_min : 0;
  list.push_back({"orient", true, 0, 0, plan.unreachable, plan.paths.size(), number_or_null(plan.cut_mm),
                  number_or_null(minutes)});
  for (const orient::Comparison& c : plan.comparisons) {
    list.push_back({c.name, c.possible, number_or_null(c.tilt), number_or_null(c.radius_mm), c.unreachable,
                    c.paths, number_or_null(c.cut_mm), number_or_null(c.minutes)});
  }
  return list;
}

json page_json(const OrientPicture& picture) {
  const orient::Part& part = *picture.part;
  const orient::OrientPlan& plan = *picture.plan;
  const auto maps = shown_maps(picture);
  const Kept kept = thinned(picture, maps);
  const std::size_t all = part.mesh.triangles.size(), design = std::min(part.design_triangles, all);
  json data = {{"part", part.name},
               {"tool", tool_json(*picture.mill)},
               {"options", options_json(*picture.options)},
               {"design", mesh_json(part, 0, design, kDesignTriangles)},
               {"obstacles", mesh_json(part, design, all, kObstacleTriangles)},
               {"points", points_json(picture, kept)},
               {"paths", paths_json(picture, kept)},
               {"maps", maps_json(maps, kept)},
               {"times", times_json(plan, *picture.options)},
               {"figures", figures_json(picture.figures)}};
  data["mapCount"] = picture.maps.size();
  data["counts"] = {{"points", plan.contact_points},
                    {"unreachable", plan.unreachable},
                    {"tests", plan.tests},
                    {"gain", number_or_null(plan.gain_mean)},
                    {"step", number_or_null(plan.axis_step_max)},
                    {"cut", number_or_null(plan.cut_mm)}};
  put_texts(data, picture.title, picture.command_line, picture.diagnostics, picture.nc_text);
  return data;
}

}  // namespace

std::string orient_html(const OrientPicture& picture) {
  return make_page("orient.html", picture.title, page_json(picture));
}

}  // namespace burin::view

// SPDX-License-Identifier: Apache-2.0
#include "burin/view/orient_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "burin/base/text.h"
#include "burin/job/orient_check.h"
#include "burin/view/mesh_shape.h"
#include "burin/view/plan_scene.h"
#include "burin/view/verify_scene.h"

namespace burin::view {
namespace {

using orient::OrientedPoint;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr std::size_t kTriangles = 10'000'000;  ///< scene_bytes thins to what a page holds
/// Nodes of all maps together: with their radii about three bytes each.
constexpr std::size_t kMapNodes = 700'000;
constexpr std::size_t kPathRows = 500;
/// Share of the tool's radius below which an initial solution (yaw 90 degrees) has none to compare with.
constexpr double kNoRadius = 1e-6;

SceneMesh mesh_of(const orient::Part& part, std::size_t first, std::size_t end, const char* name,
                  MeshRole role) {
  SceneMesh out;
  out.name = name;
  out.role = role;
  out.mesh = reduced(part.mesh, first, end, kTriangles).mesh;
  return out;
}

class Maker {
 public:
  explicit Maker(const OrientPicture& picture) : in_(picture), plan_(*picture.plan) {}

  Result<Scene> run() {
    scene_.title = in_.title;
    scene_.operation = "orient";
    scene_.command_line = in_.command_line;
    scene_.program_name = in_.title;
    scene_.program_text = in_.nc_text;
    for (std::size_t p = 0; p < plan_.paths.size(); ++p)
      for (std::size_t i = 0; i < plan_.paths[p].points.size(); ++i) points_.push_back({p, i});
    if (auto ok = path(); !ok) return ok.error();
    const std::size_t all = in_.part->mesh.triangles.size(),
                      design = std::min(in_.part->design_triangles, all);
    scene_.meshes.push_back(mesh_of(*in_.part, 0, design, "design", MeshRole::design));
    if (design < all)
      scene_.meshes.push_back(mesh_of(*in_.part, design, all, "obstacles", MeshRole::obstacle));
    series();
    maps();
    figures();
    if (in_.diagnostics) put_warnings(*in_.diagnostics, scene_);
    return std::move(scene_);
  }

 private:
  // --- the path

  Result<void> path() {
    auto nodes = put_plan_path(*in_.program, in_.machine, in_.nc_line_to_record,
                               scene_tool(job::checked_mill(*in_.mill), 0), points_.size(), scene_);
    if (!nodes) return nodes.error();
    nodes_ = *std::move(nodes);
    std::vector<std::string> names;
    for (const orient::OrientedPath& p : plan_.paths)
      names.push_back("path " + std::to_string(p.number) +
                      (p.face >= 0 ? ", face " + std::to_string(p.face) : ""));
    put_plan_groups(
        nodes_, std::move(names), [this](std::size_t i) { return points_[i].path; }, scene_);
    return {};
  }

  template <class Value>
  void add(const char* name, const char* unit, bool diverges, const Value& value) {
    put_plan_series(
        nodes_, name, unit, diverges,
        [&](std::size_t i) { return value(plan_.paths[points_[i].path].points[points_[i].point]); }, scene_);
  }
  bool has_gain(const OrientedPoint& p) const {
    return p.initial_found && p.rho_initial >= kNoRadius * in_.mill->radius && std::isfinite(p.rho_initial) &&
           std::isfinite(p.rho);
  }
  void series() {
    add("effective radius", "mm", false, [](const OrientedPoint& p) { return p.rho; });
    add("initial effective radius", "mm", false,
        [](const OrientedPoint& p) { return p.initial_found ? p.rho_initial : NAN; });
    add("gain", "%", true,
        [this](const OrientedPoint& p) { return has_gain(p) ? 100 * (p.rho / p.rho_initial - 1) : NAN; });
    add("tilt", "deg", false, [](const OrientedPoint& p) { return geom::degrees(p.angles.alpha); });
    add("yaw", "deg", true, [](const OrientedPoint& p) { return geom::degrees(p.angles.beta); });
    add("strip", "mm", false, [](const OrientedPoint& p) { return p.strip.width(); });
    add("feasibility tests", "", false, [](const OrientedPoint& p) { return static_cast<double>(p.tests); });
  }

  // --- C-spaces

  bool sound(const OrientPicture::PointMap& m) const {
    if (m.path >= plan_.paths.size() || m.point >= plan_.paths[m.path].points.size()) return false;
    if (m.map.tilts < 2 || m.map.yaws < 2) return false;
    return m.map.cells.size() == static_cast<std::size_t>(m.map.tilts) * static_cast<std::size_t>(m.map.yaws);
  }
  void maps() {
    scene_.causes = {"free", "gouge", "collision", "machine limit"};
    std::vector<std::size_t> first;  // point over all paths where a path begins
    std::size_t count = 0, nodes = 0;
    for (const orient::OrientedPath& p : plan_.paths) first.push_back(count), count += p.points.size();
    for (const auto& m : in_.maps) nodes += m.map.cells.size();
    const std::size_t every = nodes / kMapNodes + 1;
    for (std::size_t k = 0; k < in_.maps.size(); k += every) {
      const auto& m = in_.maps[k];
      if (!sound(m)) continue;
      const std::size_t node = nodes_.node_of[first[m.path] + m.point];
      if (node != kNoPoint) scene_.cspaces.push_back(cspace(m, static_cast<std::uint32_t>(node)));
    }
  }
  SceneCSpace cspace(const OrientPicture::PointMap& m, std::uint32_t node) const {
    const OrientedPoint& p = plan_.paths[m.path].points[m.point];
    const orient::AngleRange& r = m.map.range;
    SceneCSpace c;
    c.node = node;
    c.label = "path " + std::to_string(plan_.paths[m.path].number) + ", point " + std::to_string(m.point);
    c.tilt_min = geom::degrees(r.alpha_lo), c.tilt_max = geom::degrees(r.alpha_hi);
    c.yaw_min = geom::degrees(r.beta_lo), c.yaw_max = geom::degrees(r.beta_hi);
    c.tilts = static_cast<std::uint32_t>(m.map.tilts), c.yaws = static_cast<std::uint32_t>(m.map.yaws);
    for (int i = 0; i < m.map.tilts; ++i) {
      for (int j = 0; j < m.map.yaws; ++j) {
        const orient::Cause cause =
            m.map.at(i, j) == orient::Cause::bound ? orient::Cause::none : m.map.at(i, j);
        c.cause.push_back(static_cast<std::uint8_t>(cause));
        const double radius = orient::effective_radius(m.map.node(i, j), *in_.mill);
        c.radius_mm.push_back(
            cause == orient::Cause::none && std::isfinite(radius) ? static_cast<float>(radius) : kNaN);
      }
    }
    c.chosen = {geom::degrees(p.angles.alpha), geom::degrees(p.angles.beta)};
    if (p.initial_found) c.initial = {geom::degrees(p.initial.alpha), geom::degrees(p.initial.beta)};
    return c;
  }

  // --- figures

  void figure(const char* group, const std::string& name, std::string value) {
    scene_.figures.push_back({group, name, std::move(value)});
  }
  void figures() {
    for (const auto& f : in_.figures) scene_.figures.push_back({f.group, f.name, f.value});
    const double feed = in_.options->feed_mm_min;
    const char* times = "Machining time at the same scallop";
    if (feed > 0) figure(times, "this program", format_fixed(plan_.cut_mm / feed, 2) + " min");
    for (const orient::Comparison& c : plan_.comparisons) {
      const std::string how = c.name == "sturz" ? ", tilt " + format_fixed(geom::degrees(c.tilt), 2) + " deg"
                                                : ", radius " + format_fixed(c.radius_mm, 2) + " mm";
      figure(times, c.name + how,
             !c.possible
                 ? "not possible"
                 : format_fixed(c.minutes, 2) + " min, " + std::to_string(c.paths) + " paths" +
                       (c.unreachable ? ", " + std::to_string(c.unreachable) + " points not reached" : ""));
    }
    for (std::size_t i = 0; i < std::min({plan_.paths.size(), plan_.gain_per_path.size(), kPathRows}); ++i)
      figure("Gain of effective radius", "path " + std::to_string(plan_.paths[i].number),
             format_fixed(100 * plan_.gain_per_path[i], 1) + " %");
  }

  struct Place {
    std::size_t path = 0, point = 0;
  };
  const OrientPicture& in_;
  const orient::OrientPlan& plan_;
  Scene scene_;
  std::vector<Place> points_;
  PlanNodes nodes_;
};

}  // namespace

Result<Scene> orient_scene(const OrientPicture& picture) {
  return Maker(picture).run();
}

}  // namespace burin::view

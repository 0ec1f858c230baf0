// SPDX-License-Identifier: Apache-2.0
#include "burin/view/verify_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "burin/base/text.h"
#include "burin/geom/mesh/mesh_index.h"
#include "burin/view/mesh_values.h"
#include "burin/view/outline_scene.h"
#include "burin/view/path_scene.h"

namespace burin::view {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr std::size_t kMostFindings = 2'000;
constexpr std::size_t kBins = 101;
/// The colours of the heat map end at so many tolerances: what matters is whether it is kept.
constexpr double kRangeOfTolerance = 3;
/// Places along the outlines that are drawn.
constexpr std::size_t kMostPlaces = 200'000;

std::string mm(double v) {
  return format_fixed(v, 4) + " mm";
}
std::string mm2(double v) {
  return format_fixed(v, 2) + " mm^2";
}
using Level = SceneFinding::Level;

class Maker {
 public:
  Maker(const job::VerifyInput& input, const job::VerifyResult* result, const VerifySceneOptions& options)
      : in_(input), result_(result), options_(options) {}

  Result<Scene> run(const Diagnostics* diagnostics) {
    scene_.title = options_.title;
    scene_.operation = in_.operation.empty() ? "verify" : in_.operation;
    scene_.command_line = options_.command_line;
    scene_.program_name = options_.program_name;
    scene_.program_text = in_.program_text;
    if (auto ok = path(); !ok) return ok.error();
    if (in_.operation == "laser") {
      outlines();
    } else {
      meshes();
    }
    if (result_ && result_->beam) beam(*result_->beam);
    if (result_ && !result_->beam) {
      deviation();
      collisions();
      stock();
    }
    if (diagnostics) put_warnings(*diagnostics, scene_);
    return std::move(scene_);
  }

 private:
  Result<void> path() {
    PathView view;
    view.program = &in_.program;
    view.joints = in_.joints.empty() ? nullptr : &in_.joints;
    view.tip_straight = in_.tip_straight.empty() ? nullptr : &in_.tip_straight;
    view.machine = in_.machine ? &*in_.machine : nullptr;
    view.checked = in_.operation == "laser" ? nullptr : &in_.path;
    view.kerf_mm = in_.kerf_mm;
    if (auto ok = put_path(view, scene_); !ok) return ok;
    node_of_ = nodes_of_moves(scene_.path, in_.program.move_count());
    return {};
  }

  std::optional<std::uint32_t> node(std::uint32_t move) const {
    return move < node_of_.size() && !scene_.path.point.empty() ? std::optional(node_of_[move])
                                                                : std::nullopt;
  }
  std::string place(std::uint32_t move) const {
    const auto at = node(move);
    const std::uint32_t line = at ? scene_.path.line[*at] : 0;
    return "move " + std::to_string(move) + (line ? ", line " + std::to_string(line) : "");
  }
  void find(Level level, std::string title, std::uint32_t move, const geom::Point3& at) {
    if (scene_.findings.size() < kMostFindings)
      scene_.findings.push_back({level, std::move(title), place(move), at, node(move)});
  }
  void figure(const char* group, const char* name, std::string value) {
    scene_.figures.push_back({group, name, std::move(value)});
  }

  // --- milling

  void meshes() {
    SceneMesh design;
    design.name = "design";
    const bool heat = result_ && !result_->surface.samples.empty();
    design.mesh =
        heat ? refined(in_.design, edge_for(in_.design, options_.heat_triangles), 4 * options_.heat_triangles)
             : in_.design;
    if (heat) {
      design.value = vertex_values(design.mesh, result_->surface.samples, result_->deviation.deviation_mm);
      design.value_name = "deviation";
      design.value_unit = "mm";
      design.value_range = kRangeOfTolerance * in_.tolerance_mm;
      at_the_tool(design);
    }
    scene_.meshes.push_back(std::move(design));
    if (in_.obstacles.triangles.empty()) return;
    SceneMesh around;
    around.name = "obstacles";
    around.role = MeshRole::obstacle;
    around.mesh = in_.obstacles;
    scene_.meshes.push_back(std::move(around));
  }

  /// The value of the part's vertex next to the tool at each node: where the tool's rounded end is near it.
  void at_the_tool(const SceneMesh& design) {
    if (design.mesh.triangles.empty()) return;
    SceneSeries series{"deviation", "mm", std::vector<float>(scene_.path.point.size(), kNaN), true};
    const geom::MeshIndex index(design.mesh);
    for (std::size_t i = 0; i < series.value.size(); ++i) {
      if (scene_.path.kind[i] != WayKind::feed || scene_.path.tool[i] >= scene_.tools.size()) continue;
      const SceneTool& tool = scene_.tools[scene_.path.tool[i]];
      if (tool.pieces.empty()) continue;
      const geom::Vec3 axis = scene_.path.axis.empty() ? geom::Vec3{0, 0, 1} : scene_.path.axis[i];
      const double corner = tool.pieces[0].corner;
      const auto hit =
          index.nearest(scene_.path.point[i] + corner * axis, tool.pieces[0].radius + in_.tolerance_mm + 0.5);
      if (!hit) continue;
      double best = std::numeric_limits<double>::infinity();
      for (const std::uint32_t v : design.mesh.triangles[hit->triangle]) {
        const double d = geom::distance(design.mesh.vertices[v], hit->p);
        if (d < best) best = d, series.value[i] = design.value[v];
      }
    }
    scene_.series.push_back(std::move(series));
  }

  void deviation() {
    const verify::DeviationReport& d = result_->deviation;
    const double tolerance = in_.tolerance_mm;
    if (d.gouge.mm > 0)
      find(d.gouge.mm > tolerance ? Level::fault : Level::info, "deepest gouge " + mm(d.gouge.mm),
           d.gouge.move, d.gouge.at);
    if (d.excess.mm > 0)
      find(d.excess.mm > tolerance ? Level::warning : Level::info, "most excess " + mm(d.excess.mm),
           d.excess.move, d.excess.at);
    if (d.unmachined_area_mm2 > 0)
      scene_.findings.push_back(
          {Level::warning, "not machined: " + mm2(d.unmachined_area_mm2), "of " + mm2(d.area_mm2), {}, {}});
    figure("deviation", "deepest gouge", mm(d.gouge.mm));
    figure("deviation", "most excess", mm(d.excess.mm));
    figure("deviation", "mean excess", mm(d.excess_mean_mm));
    figure("deviation", "tolerance", mm(tolerance));
    figure("deviation", "area gouged beyond it", mm2(d.gouge_area_mm2));
    figure("deviation", "area left beyond it", mm2(d.excess_area_mm2));
    figure("deviation", "not machined", mm2(d.unmachined_area_mm2));
    figure("deviation", "area", mm2(d.area_mm2));
    figure("check", "bound of the figures", mm(result_->bound_mm));
    figure("check", "samples", std::to_string(result_->surface.samples.size()));
    figure("check", "their spacing", mm(result_->surface.spacing_mm));
    std::vector<double> weight;
    for (const verify::SurfaceSample& s : result_->surface.samples) weight.push_back(s.area_mm2);
    histogram(d.deviation_mm, weight, "mm");
  }

  /// From -range to +range; what is beyond counts in the last bins.
  void histogram(const std::vector<float>& values, const std::vector<double>& weight, const char* unit) {
    double most = kRangeOfTolerance * in_.tolerance_mm;
    std::vector<float> sizes;
    for (const float v : values)
      if (!std::isnan(v)) sizes.push_back(std::abs(v));
    if (sizes.empty()) return;
    // One place in a thousand does not decide about the picture of all others.
    const auto late = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() * 999 / 1000);
    std::nth_element(sizes.begin(), late, sizes.end());
    most = std::max(most, static_cast<double>(*late));
    SceneHistogram h{
        "deviation",     unit, -most, 2 * most / static_cast<double>(kBins), std::vector<double>(kBins, 0),
        in_.tolerance_mm};
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (std::isnan(values[i])) continue;
      const double bin = std::floor((values[i] - h.from) / h.step);
      h.area[static_cast<std::size_t>(std::clamp(bin, 0.0, static_cast<double>(kBins - 1)))] += weight[i];
    }
    scene_.histograms.push_back(std::move(h));
  }

  void collisions() {
    for (const verify::Collision& c : result_->collisions)
      find(Level::fault,
           std::string(verify::name(c.body)) + " in " + std::string(verify::name(c.against)) + ", " +
               mm(c.depth_mm),
           c.move, c.at);
    figure("check", "collisions", std::to_string(result_->collisions.size()));
  }

  void stock() {
    if (!result_->removal) return;
    const removal::Removal& r = *result_->removal;
    figure("stock", "volume", format_fixed(r.stock_mm3(), 1) + " mm^3");
    figure("stock", "removed", format_fixed(r.removed_mm3(), 1) + " mm^3");
    figure("stock", "resolution", mm(r.resolution_mm()));
    scene_.stock = r.clock(options_.stock_nodes);
  }

  // --- beams

  void outlines() {
    if (result_ && result_->beam) return;
    for (const verify::Outline& o : in_.outlines)
      scene_.outlines.push_back(scene_outline(o.segments, o.closed));
    for (std::size_t k = 0; k < scene_.outlines.size(); ++k)
      scene_.outlines[k].name = "outline " + std::to_string(k + 1);
  }

  void beam(const verify::BeamReport& report) {
    places(report);
    const auto worst = [this](const verify::BeamWorst& w, const char* what, Level level) {
      if (w.mm > 0) find(level, what + mm(w.mm), w.move, geom::at_z(w.at, 0));
    };
    const double tolerance = in_.tolerance_mm;
    worst(report.gouge, "deepest gouge ", report.gouge.mm > tolerance ? Level::fault : Level::info);
    worst(report.excess, "most excess ", report.excess.mm > tolerance ? Level::warning : Level::info);
    worst(report.corner_excess, "left in a corner ", Level::info);
    if (report.uncut_mm > 0)
      scene_.findings.push_back({Level::warning,
                                 "not cut: " + mm(report.uncut_mm),
                                 std::to_string(report.uncut_outlines.size()) + " outlines",
                                 {},
                                 {}});
    figure("deviation", "deepest gouge", mm(report.gouge.mm));
    figure("deviation", "most excess", mm(report.excess.mm));
    figure("deviation", "mean excess", mm(report.excess_mean_mm));
    figure("deviation", "left in corners", mm(report.corner_excess.mm));
    figure("deviation", "area taken from the part", mm2(report.gouge_area_mm2));
    figure("deviation", "area left", mm2(report.excess_area_mm2));
    figure("deviation", "outline", mm(report.outline_mm));
    figure("deviation", "not cut", mm(report.uncut_mm));
    figure("check", "tolerance", mm(tolerance));
    figure("check", "bound of the figures", mm(result_->bound_mm));
    figure("check", "spacing", mm(report.spacing_mm));
    std::vector<float> values;
    std::vector<double> weight;
    for (const verify::BeamPlace& p : report.places) {
      values.push_back(static_cast<float>(p.deviation_mm));
      weight.push_back(p.length_mm);
    }
    histogram(values, weight, "mm");
  }

  /// Of several places next to each other the one farthest from 0 is drawn.
  void places(const verify::BeamReport& report) {
    const std::size_t each = std::max<std::size_t>(1, report.places.size() / kMostPlaces);
    std::size_t together = 0;
    std::uint32_t last = 0xffffffffu;
    for (const verify::BeamPlace& p : report.places) {
      const bool fresh = p.outline != last;
      if (fresh) {
        SceneOutline o;
        o.name = "outline " + std::to_string(p.outline + 1);
        o.closed = p.outline < in_.outlines.size() && in_.outlines[p.outline].closed;
        o.part = o.closed;
        scene_.outlines.push_back(std::move(o));
        last = p.outline;
      }
      SceneOutline& o = scene_.outlines.back();
      const auto value = static_cast<float>(p.deviation_mm);
      if (fresh || together >= each) {
        o.points.push_back(geom::at_z(p.p, 0));
        o.value.push_back(value);
        together = 1;
      } else {
        ++together;
        float& worst = o.value.back();
        if (std::isnan(value) || std::abs(value) > std::abs(worst))
          worst = value, o.points.back() = geom::at_z(p.p, 0);
      }
    }
  }

  const job::VerifyInput& in_;
  const job::VerifyResult* result_;
  const VerifySceneOptions& options_;
  Scene scene_;
  std::vector<std::uint32_t> node_of_;
};

}  // namespace

Result<Scene> verify_scene(const job::VerifyInput& input, const job::VerifyResult* result,
                           const Diagnostics* diagnostics, const VerifySceneOptions& options) {
  return Maker(input, result, options).run(diagnostics);
}

void put_warnings(const Diagnostics& diagnostics, Scene& scene) {
  for (const Warning& w : diagnostics.warnings()) {
    if (scene.findings.size() >= kMostFindings) return;
    SceneFinding f;
    f.level = w.severity == Severity::left_out ? Level::warning : Level::info;
    f.title = w.message;
    f.detail = w.where.to_string();
    if (w.position_mm) f.at = geom::Point3{(*w.position_mm)[0], (*w.position_mm)[1], (*w.position_mm)[2]};
    scene.findings.push_back(std::move(f));
  }
}

}  // namespace burin::view

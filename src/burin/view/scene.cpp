// SPDX-License-Identifier: Apache-2.0
// What a scene must keep, and the page around its bytes.
#include "burin/view/scene.h"

#include <algorithm>
#include <cmath>

#include "burin/base/embedded.h"
#include "burin/view/encode.h"

namespace burin::embedded {
std::vector<File> viewer_pages();
}

namespace burin::view {
namespace {

constexpr std::size_t kMostNodes = 20'000'000;
constexpr std::size_t kMostStockNodes = 200'000'000;
/// Axes are written with 15 bits: what is farther from 1 was no unit vector.
constexpr double kUnit = 1e-3;

Error bad(const std::string& what, const std::string& accepted) {
  return {ErrorCode::range, "scene: " + what + " (" + accepted + ")", {}};
}

/// Beyond it sums and squares of numbers are no numbers any more; nothing that is machined comes near.
constexpr double kLargest = 1e15;

bool finite(double v) {
  return std::abs(v) <= kLargest;  // false for NaN
}
bool finite(const geom::Vec3& v) {
  return finite(v.x) && finite(v.y) && finite(v.z);
}
bool finite(const geom::Point3& p) {
  return finite(p - geom::Point3{});
}
bool finite(const std::array<double, 2>& v) {
  return finite(v[0]) && finite(v[1]);
}
/// Values may be missing (NaN), but not infinite.
bool usable(const std::vector<float>& values) {
  return std::none_of(values.begin(), values.end(),
                      [](float v) { return std::abs(v) > static_cast<float>(kLargest); });
}
template <class T>
bool all_finite(const std::vector<T>& values) {
  return std::all_of(values.begin(), values.end(), [](const T& v) { return finite(v); });
}
/// An index of 0 needs no table: there is only one thing then.
template <class T>
bool within(const std::vector<T>& indices, std::size_t table) {
  return std::all_of(indices.begin(), indices.end(),
                     [table](T i) { return i < std::max<std::size_t>(1, table); });
}

Result<void> check_lengths(const ScenePath& path) {
  const std::size_t n = path.point.size();
  if (n > kMostNodes) return bad("the path has " + std::to_string(n) + " nodes", "at most 20 million");
  const auto column = [n](const char* name, std::size_t have) -> Result<void> {
    if (have == n) return {};
    return bad(std::string("path column ") + name + " has " + std::to_string(have) + " rows",
               std::to_string(n) + ", one for each point");
  };
  for (const auto& [name, have] : {std::pair{"time", path.time_s.size()},
                                   {"kind", path.kind.size()},
                                   {"feed", path.feed_mm_min.size()},
                                   {"move", path.move.size()},
                                   {"line", path.line.size()},
                                   {"tool", path.tool.size()},
                                   {"group", path.group.size()},
                                   {"axis", path.axis.empty() ? n : path.axis.size()},
                                   {"rotary", path.rotary_deg.empty() ? n : path.rotary_deg.size()}}) {
    if (auto ok = column(name, have); !ok) return ok;
  }
  return {};
}

Result<void> check_path(const Scene& scene) {
  const ScenePath& path = scene.path;
  if (auto ok = check_lengths(path); !ok) return ok;
  if (!all_finite(path.point) || !all_finite(path.axis) || !all_finite(path.feed_mm_min) ||
      !all_finite(path.rotary_deg) || !all_finite(path.time_s))
    return bad("a number of the path is not finite", "finite numbers");
  if (!std::is_sorted(path.time_s.begin(), path.time_s.end()))
    return bad("the path's time goes back", "times that do not decrease");
  if (std::any_of(path.axis.begin(), path.axis.end(),
                  [](const geom::Vec3& a) { return std::abs(geom::norm(a) - 1) > kUnit; }))
    return bad("a tool axis has not the length 1", "unit vectors");
  if (!std::all_of(path.kind.begin(), path.kind.end(), [](WayKind k) { return k <= WayKind::dwell; }))
    return bad("a node's kind is unknown", "0 to 3");
  if (!within(path.tool, scene.tools.size()) || !within(path.group, scene.groups.size()))
    return bad("a node names a tool or group that is not there", "indices into the scene's tables");
  if (!path.rotary_deg.empty() && !scene.machine)
    return bad("rotary angles without a machine", "the machine whose axes turn");
  return {};
}

Result<void> check_mesh(const SceneMesh& m) {
  const std::size_t n = m.mesh.vertices.size();
  if (!all_finite(m.mesh.vertices) || !usable(m.value) || !finite(m.value_range))
    return bad("a number of mesh \"" + m.name + "\" is not finite", "finite numbers");
  if (!m.value.empty() && m.value.size() != n)
    return bad("mesh \"" + m.name + "\" has " + std::to_string(m.value.size()) + " values",
               std::to_string(n) + ", one for each vertex");
  for (const auto& t : m.mesh.triangles) {
    if (std::any_of(t.begin(), t.end(), [n](std::uint32_t v) { return v >= n; }))
      return bad("a triangle of mesh \"" + m.name + "\" has a corner that is not there",
                 "indices below " + std::to_string(n));
  }
  return {};
}

Result<void> check_stock(const removal::StockClock& stock) {
  std::size_t nodes = 1;
  for (const std::uint32_t count : stock.count) {
    if (count == 0 || count > kMostStockNodes / nodes)
      return bad("the stock's grid is empty or too large", "at most 200 million nodes");
    nodes *= count;
  }
  if (stock.cut_at.size() != nodes || (!stock.crossing.empty() && stock.crossing.size() != 3 * nodes))
    return bad("the stock's columns do not fit its grid", "one time and three crossings a node");
  if (!(stock.step_mm > 0) || !finite(stock.step_mm) || !finite(stock.origin))
    return bad("the stock's step or origin is no number", "a step above 0");
  return {};
}

Result<void> check_cspace(const SceneCSpace& c, const Scene& scene) {
  const std::size_t cells = static_cast<std::size_t>(c.tilts) * c.yaws;
  if (c.cause.size() != cells || (!c.radius_mm.empty() && c.radius_mm.size() != cells))
    return bad("C-space \"" + c.label + "\" does not fit its grid", "tilts x yaws nodes");
  if (c.node >= scene.path.point.size() || !within(c.cause, scene.causes.size()))
    return bad("C-space \"" + c.label + "\" names a node or cause that is not there",
               "indices into the scene");
  const std::vector<double> numbers{c.tilt_min, c.tilt_max, c.yaw_min, c.yaw_max};
  if (!all_finite(numbers) || !finite(c.chosen) || (c.initial && !finite(*c.initial)) || !usable(c.radius_mm))
    return bad("a number of C-space \"" + c.label + "\" is not finite", "finite numbers");
  return {};
}

Result<void> check_lists(const Scene& scene) {
  for (const SceneSeries& s : scene.series) {
    if (s.value.size() != scene.path.point.size() || !usable(s.value))
      return bad("series \"" + s.name + "\" has a value that is infinite, or not one for each node",
                 "as many values as nodes, NaN for none");
  }
  for (const SceneOutline& o : scene.outlines) {
    if (!all_finite(o.points) || !usable(o.value) || (!o.value.empty() && o.value.size() != o.points.size()))
      return bad("outline \"" + o.name + "\" has a number that is not finite, or values that do not fit",
                 "one value for each point");
  }
  for (const SceneFinding& f : scene.findings) {
    if ((f.node && *f.node >= scene.path.point.size()) || (f.at && !finite(*f.at)))
      return bad("finding \"" + f.title + "\" is at no place", "a node of the path and finite numbers");
  }
  for (const SceneHistogram& h : scene.histograms) {
    if (!all_finite(h.area) || !finite(h.from) || !finite(h.step) || !finite(h.tolerance))
      return bad("a number of histogram \"" + h.name + "\" is not finite", "finite numbers");
  }
  for (const SceneTool& t : scene.tools) {
    for (const ToolPiece& p : t.pieces) {
      if (!finite(p.radius) || !finite(p.low) || !finite(p.high) || !finite(p.corner))
        return bad("a number of tool \"" + t.name + "\" is not finite", "finite numbers");
    }
    if (!finite(t.kerf_mm))
      return bad("the kerf of tool \"" + t.name + "\" is not finite", "a finite number");
  }
  if (!scene.machine) return {};
  if (scene.machine->axes.size() > 2) return bad("the machine has more than two rotary axes", "at most two");
  for (const SceneAxis& a : scene.machine->axes) {
    if (!finite(a.point) || !finite(a.direction))
      return bad("a number of the machine is not finite", "finite numbers");
  }
  return {};
}

std::string filled(const std::string& title, std::string_view scene) {
  const std::string name = html_text(title);
  for (const embedded::File& file : embedded::viewer_pages()) {
    if (file.name == "viewer.html") return fill_template(file.text, {{"@TITLE@", name}, {"@SCENE@", scene}});
  }
  return {};
}

}  // namespace

Result<void> validate(const Scene& scene) {
  if (auto ok = check_path(scene); !ok) return ok;
  for (const SceneMesh& m : scene.meshes) {
    if (auto ok = check_mesh(m); !ok) return ok;
  }
  if (scene.stock) {
    if (auto ok = check_stock(*scene.stock); !ok) return ok;
  }
  for (const SceneCSpace& c : scene.cspaces) {
    if (auto ok = check_cspace(c, scene); !ok) return ok;
  }
  return check_lists(scene);
}

Result<std::string> viewer_page(const Scene& scene, const SceneOptions& options) {
  auto bytes = scene_bytes(scene, options);
  if (!bytes) return bytes.error();
  const std::vector<std::uint8_t> raw(bytes->begin(), bytes->end());
  return filled(scene.title, base64(raw));
}

std::string viewer_shell(const std::string& title) {
  return filled(title, {});
}

}  // namespace burin::view

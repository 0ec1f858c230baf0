// SPDX-License-Identifier: Apache-2.0
// The container of docs/viewer.md: a directory in JSON, columns as differences in four planes, deflated.
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "burin/view/mesh_shape.h"
#include "burin/view/scene.h"

namespace burin::view {
namespace {

using nlohmann::json;

constexpr std::int32_t kNone = 0x7fffffff;
/// Numbers of a column lie from 0 to this, whatever their range: below kNone, with room for rounding.
constexpr double kSteps = 2147483000.0;
constexpr double kAxisScale = 1.0 / 32767, kTimeScale = 1e-4, kFeedScale = 0.01, kRotaryScale = 1e-5;
/// Steps of the values for colours and charts over their range.
constexpr double kValueSteps = 262144;
/// A thinned mesh keeps a few triangles, however large the others are.
constexpr std::size_t kFewTriangles = 500;

/// Little-endian bytes of the file, and the list of what they are.
class Chunks {
 public:
  Result<void> raw(const std::string& name, const char* type, std::size_t components, std::size_t count,
                   std::string_view content) {
    return add(
        {{"name", name}, {"type", type}, {"components", components}, {"count", count}, {"coding", "plain"}},
        content);
  }
  Result<void> text(const std::string& name, std::string_view text) {
    return add({{"name", name}, {"type", "u8"}, {"components", 1}, {"count", 1}, {"coding", "text"}}, text);
  }
  /// Rows of `offset.size()` numbers.
  Result<void> delta(const std::string& name, const std::vector<std::int32_t>& numbers,
                     const std::vector<double>& offset, double scale, bool none = false) {
    const std::size_t components = offset.size();
    std::string planes(4 * numbers.size(), '\0');
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const auto before = i < components ? 0u : static_cast<std::uint32_t>(numbers[i - components]);
      const std::uint32_t d = static_cast<std::uint32_t>(numbers[i]) - before;
      const std::uint32_t zigzag = (d << 1) ^ (d >> 31 ? 0xffffffffu : 0u);
      for (std::size_t k = 0; k < 4; ++k)
        planes[k * numbers.size() + i] = static_cast<char>((zigzag >> (8 * k)) & 0xffu);
    }
    json head = {{"name", name},
                 {"type", "i32"},
                 {"components", components},
                 {"count", numbers.size() / components},
                 {"coding", "delta"},
                 {"scale", scale},
                 {"offset", offset}};
    if (none) head["none"] = true;
    return add(std::move(head), planes);
  }

  json list = json::array();
  std::string bytes;

 private:
  Result<void> add(json head, std::string_view content) {
    uLongf size = compressBound(static_cast<uLong>(content.size()));
    const std::size_t at = bytes.size();
    bytes.resize(at + size);
    const int done =
        compress2(reinterpret_cast<Bytef*>(bytes.data() + at), &size,
                  reinterpret_cast<const Bytef*>(content.data()), static_cast<uLong>(content.size()), 6);
    if (done != Z_OK) return Error{ErrorCode::internal, "the scene cannot be compressed", {}};
    bytes.resize(at + size);
    head["at"] = at;
    head["bytes"] = size;
    list.push_back(std::move(head));
    return {};
  }
};

std::int32_t stored(double value, double offset, double scale) {
  return static_cast<std::int32_t>(std::llround((value - offset) / scale));
}

/// In steps of `step`, coarser when the range would not fit.
Result<void> put_numbers(Chunks& chunks, const std::string& name, const std::vector<double>& values,
                         double step) {
  if (values.empty()) return chunks.delta(name, {}, {0.0}, step);
  const auto [lo, hi] = std::minmax_element(values.begin(), values.end());
  const bool near_zero = std::max(std::abs(*lo), std::abs(*hi)) < kSteps * step;
  const double offset = near_zero ? 0 : *lo, scale = near_zero ? step : std::max(step, (*hi - *lo) / kSteps);
  std::vector<std::int32_t> out;
  out.reserve(values.size());
  for (const double v : values) out.push_back(stored(v, offset, scale));
  return chunks.delta(name, out, {offset}, scale);
}

Result<void> put_points(Chunks& chunks, const std::string& name, const std::vector<geom::Point3>& points,
                        double step) {
  geom::Box3 box;
  for (const geom::Point3& p : points) box.add(p);
  if (box.empty()) box.add(geom::Point3{});
  const geom::Vec3 size = box.hi - box.lo;
  const double scale = std::max({step, size.x / kSteps, size.y / kSteps, size.z / kSteps});
  std::vector<std::int32_t> out;
  out.reserve(3 * points.size());
  for (const geom::Point3& p : points) {
    out.push_back(stored(p.x, box.lo.x, scale));
    out.push_back(stored(p.y, box.lo.y, scale));
    out.push_back(stored(p.z, box.lo.z, scale));
  }
  return chunks.delta(name, out, {box.lo.x, box.lo.y, box.lo.z}, scale);
}

/// NaN: none.
Result<void> put_values(Chunks& chunks, const std::string& name, const std::vector<float>& values) {
  double lo = 0, hi = 0;
  bool any = false;
  for (const float v : values) {
    if (std::isnan(v)) continue;
    lo = any ? std::min<double>(lo, v) : v;
    hi = any ? std::max<double>(hi, v) : v;
    any = true;
  }
  const double scale = hi > lo ? (hi - lo) / kValueSteps : 1;
  std::vector<std::int32_t> out;
  out.reserve(values.size());
  for (const float v : values) out.push_back(std::isnan(v) ? kNone : stored(v, lo, scale));
  return chunks.delta(name, out, {lo}, scale, true);
}

/// Whole numbers as they are, modulo 2^32.
Result<void> put_integers(Chunks& chunks, const std::string& name, const std::vector<std::uint32_t>& values) {
  std::vector<std::int32_t> out;
  out.reserve(values.size());
  for (const std::uint32_t v : values) out.push_back(static_cast<std::int32_t>(v));
  return chunks.delta(name, out, {0.0}, 1);
}

/// First failure of a row of steps, which are not done after it.
class Steps {
 public:
  template <class Step>
  Steps& then(const Step& step) {
    if (state_) state_ = step();
    return *this;
  }
  Result<void> result() const { return state_; }

 private:
  Result<void> state_;
};

Result<void> put_axes(Chunks& chunks, const std::vector<geom::Vec3>& axes) {
  std::vector<std::int32_t> out;
  out.reserve(3 * axes.size());
  for (const geom::Vec3& a : axes) {
    for (const double c : {a.x, a.y, a.z}) out.push_back(stored(c, 0, kAxisScale));
  }
  return chunks.delta("path.axis", out, {0.0, 0.0, 0.0}, kAxisScale);
}

Result<void> put_rotary(Chunks& chunks, const std::vector<std::array<double, 2>>& degrees) {
  double most = 0;
  for (const auto& d : degrees) most = std::max({most, std::abs(d[0]), std::abs(d[1])});
  const double scale = std::max(kRotaryScale, most / kSteps);
  std::vector<std::int32_t> out;
  out.reserve(2 * degrees.size());
  for (const auto& d : degrees) {
    for (const double angle : d) out.push_back(stored(angle, 0, scale));
  }
  return chunks.delta("path.rotary", out, {0.0, 0.0}, scale);
}

Result<void> put_path(Chunks& chunks, const ScenePath& path, double step) {
  const std::size_t n = path.point.size();
  std::string kinds, groups;
  for (const WayKind k : path.kind) kinds += static_cast<char>(k);
  for (const std::uint16_t g : path.group) {
    groups += static_cast<char>(g & 0xff);
    groups += static_cast<char>(g >> 8);
  }
  const std::string tools(path.tool.begin(), path.tool.end());
  Steps steps;
  steps.then([&] { return put_points(chunks, "path.point", path.point, step); })
      .then([&] { return path.axis.empty() ? Result<void>{} : put_axes(chunks, path.axis); })
      .then([&] { return put_numbers(chunks, "path.time", path.time_s, kTimeScale); })
      .then([&] { return chunks.raw("path.kind", "u8", 1, n, kinds); })
      .then([&] { return put_numbers(chunks, "path.feed", path.feed_mm_min, kFeedScale); })
      .then([&] { return put_integers(chunks, "path.move", path.move); })
      .then([&] { return put_integers(chunks, "path.line", path.line); })
      .then([&] { return chunks.raw("path.tool", "u8", 1, n, tools); })
      .then([&] { return chunks.raw("path.group", "u16", 1, n, groups); })
      .then([&] { return path.rotary_deg.empty() ? Result<void>{} : put_rotary(chunks, path.rotary_deg); });
  return steps.result();
}

/// The mesh as it is shown. Of the values that fall together the one farthest from 0 stays: no fault is lost.
struct Thinned {
  geom::Mesh mesh;
  std::vector<float> value;
};
/// Without the vertices that no triangle has.
Thinned used(const SceneMesh& from) {
  constexpr std::uint32_t kUnused = 0xffffffffu;
  std::vector<std::uint32_t> place(from.mesh.vertices.size(), kUnused);
  for (const auto& t : from.mesh.triangles)
    for (const std::uint32_t v : t) place[v] = 0;
  Thinned out;
  for (std::size_t v = 0; v < place.size(); ++v) {
    if (place[v] == kUnused) continue;
    place[v] = static_cast<std::uint32_t>(out.mesh.vertices.size());
    out.mesh.vertices.push_back(from.mesh.vertices[v]);
    if (!from.value.empty()) out.value.push_back(from.value[v]);
  }
  for (const auto& t : from.mesh.triangles)
    out.mesh.triangles.push_back({place[t[0]], place[t[1]], place[t[2]]});
  return out;
}
Thinned thinned(const SceneMesh& from, std::size_t max_triangles) {
  if (from.mesh.triangles.size() <= max_triangles) return used(from);
  ReducedMesh less = reduced(from.mesh, 0, from.mesh.triangles.size(), max_triangles);
  Thinned out{std::move(less.mesh), {}};
  if (from.value.empty()) return out;
  out.value.assign(out.mesh.vertices.size(), std::numeric_limits<float>::quiet_NaN());
  for (std::size_t v = 0; v < from.value.size(); ++v) {
    const std::uint32_t to = less.became[v];
    if (to == ReducedMesh::kGone || std::isnan(from.value[v])) continue;
    float& worst = out.value[to];
    if (std::isnan(worst) || std::abs(from.value[v]) > std::abs(worst)) worst = from.value[v];
  }
  return out;
}

Result<json> put_meshes(Chunks& chunks, const Scene& scene, const SceneOptions& options) {
  std::size_t all = 0;
  for (const SceneMesh& m : scene.meshes) all += m.mesh.triangles.size();
  json list = json::array();
  for (std::size_t k = 0; k < scene.meshes.size(); ++k) {
    const SceneMesh& m = scene.meshes[k];
    const std::size_t of = m.mesh.triangles.size();
    const double share =
        static_cast<double>(options.max_triangles) / static_cast<double>(std::max<std::size_t>(all, 1));
    const auto allowed =
        std::max(kFewTriangles, share >= 1 ? of : static_cast<std::size_t>(share * static_cast<double>(of)));
    const Thinned t = thinned(m, allowed);
    std::vector<std::int32_t> corners;
    corners.reserve(3 * t.mesh.triangles.size());
    for (const auto& triangle : t.mesh.triangles)
      for (const std::uint32_t v : triangle) corners.push_back(static_cast<std::int32_t>(v));
    const std::string name = "mesh." + std::to_string(k);
    Steps steps;
    steps.then([&] { return put_points(chunks, name + ".point", t.mesh.vertices, options.point_step_mm); })
        .then([&] {
          return chunks.delta(name + ".index", corners, {0.0, 0.0, 0.0}, 1);
        })
        .then(
            [&] { return t.value.empty() ? Result<void>{} : put_values(chunks, name + ".value", t.value); });
    if (auto ok = steps.result(); !ok) return ok.error();
    list.push_back({{"name", m.name},
                    {"role", static_cast<int>(m.role)},
                    {"valueName", m.value_name},
                    {"valueUnit", m.value_unit},
                    {"valueRange", m.value_range},
                    {"triangles", t.mesh.triangles.size()},
                    {"of", of}});
  }
  return list;
}

Result<json> put_outlines(Chunks& chunks, const Scene& scene, double step) {
  json list = json::array();
  for (std::size_t k = 0; k < scene.outlines.size(); ++k) {
    const SceneOutline& o = scene.outlines[k];
    const std::string name = "outline." + std::to_string(k);
    Steps steps;
    steps.then([&] { return put_points(chunks, name + ".point", o.points, step); }).then([&] {
      return o.value.empty() ? Result<void>{} : put_values(chunks, name + ".value", o.value);
    });
    if (auto ok = steps.result(); !ok) return ok.error();
    list.push_back({{"name", o.name}, {"part", o.part}, {"closed", o.closed}});
  }
  return list;
}

Result<json> put_cspaces(Chunks& chunks, const Scene& scene) {
  json list = json::array();
  for (std::size_t k = 0; k < scene.cspaces.size(); ++k) {
    const SceneCSpace& c = scene.cspaces[k];
    const std::string name = "cspace." + std::to_string(k);
    const std::string causes(c.cause.begin(), c.cause.end());
    Steps steps;
    steps.then([&] { return chunks.raw(name + ".cause", "u8", 1, c.cause.size(), causes); }).then([&] {
      return c.radius_mm.empty() ? Result<void>{} : put_values(chunks, name + ".radius", c.radius_mm);
    });
    if (auto ok = steps.result(); !ok) return ok.error();
    list.push_back({{"node", c.node},
                    {"label", c.label},
                    {"tilt", {c.tilt_min, c.tilt_max}},
                    {"yaw", {c.yaw_min, c.yaw_max}},
                    {"tilts", c.tilts},
                    {"yaws", c.yaws},
                    {"chosen", c.chosen},
                    {"initial", c.initial ? json(*c.initial) : json(nullptr)}});
  }
  return list;
}

json point_json(const geom::Point3& p) {
  return {p.x, p.y, p.z};
}

Result<json> put_stock(Chunks& chunks, const Scene& scene) {
  if (!scene.stock) return json(nullptr);
  const removal::StockClock& s = *scene.stock;
  if (auto ok = put_integers(chunks, "stock.cut", s.cut_at); !ok) return ok.error();
  std::string crossing(s.crossing.begin(), s.crossing.end());
  crossing.resize(3 * s.cut_at.size(), '\0');
  if (auto ok = chunks.raw("stock.crossing", "u8", 3, s.cut_at.size(), crossing); !ok) return ok.error();
  return json{{"count", s.count}, {"origin", point_json(s.origin)}, {"step", s.step_mm}};
}

Result<json> put_program(Chunks& chunks, const Scene& scene, std::size_t max_bytes) {
  std::string_view text = scene.program_text;
  const auto lines =
      std::count(text.begin(), text.end(), '\n') + (!text.empty() && text.back() != '\n' ? 1 : 0);
  const bool cut = text.size() > max_bytes;
  if (cut) {
    const std::size_t end = text.substr(0, max_bytes).rfind('\n');
    text = text.substr(0, end == std::string_view::npos ? 0 : end + 1);
  }
  if (auto ok = chunks.text("program.text", text); !ok) return ok.error();
  return json{{"name", scene.program_name}, {"lines", lines}, {"cut", cut}};
}

json tools_json(const Scene& scene) {
  json list = json::array();
  for (const SceneTool& t : scene.tools) {
    json pieces = json::array();
    for (const ToolPiece& p : t.pieces) {
      pieces.push_back({{"kind", static_cast<int>(p.kind)},
                        {"radius", p.radius},
                        {"low", p.low},
                        {"high", p.high},
                        {"corner", p.corner}});
    }
    list.push_back({{"number", t.number}, {"name", t.name}, {"kerf", t.kerf_mm}, {"pieces", pieces}});
  }
  return list;
}

json machine_json(const std::optional<SceneMachine>& machine) {
  if (!machine) return nullptr;
  json axes = json::array();
  for (const SceneAxis& a : machine->axes) {
    axes.push_back({{"letter", std::string(1, a.letter)},
                    {"table", a.table},
                    {"direction", {a.direction.x, a.direction.y, a.direction.z}},
                    {"point", point_json(a.point)}});
  }
  return {{"name", machine->name}, {"axes", axes}};
}

void put_texts(json& directory, const Scene& scene) {
  json findings = json::array(), figures = json::array(), histograms = json::array();
  for (const SceneFinding& f : scene.findings) {
    findings.push_back({{"level", static_cast<int>(f.level)},
                        {"title", f.title},
                        {"detail", f.detail},
                        {"at", f.at ? point_json(*f.at) : json(nullptr)},
                        {"node", f.node ? json(*f.node) : json(nullptr)}});
  }
  for (const SceneFigure& f : scene.figures)
    figures.push_back({{"group", f.group}, {"name", f.name}, {"value", f.value}});
  for (const SceneHistogram& h : scene.histograms) {
    histograms.push_back({{"name", h.name},
                          {"unit", h.unit},
                          {"from", h.from},
                          {"step", h.step},
                          {"area", h.area},
                          {"tolerance", h.tolerance}});
  }
  directory["findings"] = std::move(findings);
  directory["figures"] = std::move(figures);
  directory["histograms"] = std::move(histograms);
  directory["title"] = scene.title;
  directory["operation"] = scene.operation;
  directory["command"] = scene.command_line;
  directory["groups"] = scene.groups;
  directory["causes"] = scene.causes;
  directory["tools"] = tools_json(scene);
  directory["machine"] = machine_json(scene.machine);
}

/// Of what the eye looks for: not the rapids, which may begin far away.
json box_json(const Scene& scene) {
  geom::Box3 box;
  for (const SceneMesh& m : scene.meshes)
    for (const geom::Point3& p : m.mesh.vertices) box.add(p);
  for (const SceneOutline& o : scene.outlines)
    for (const geom::Point3& p : o.points) box.add(p);
  for (std::size_t i = 1; i < scene.path.point.size(); ++i) {
    if (scene.path.kind[i] == WayKind::feed || scene.path.kind[i] == WayKind::link)
      box.add(scene.path.point[i]);
  }
  if (box.empty())
    for (const geom::Point3& p : scene.path.point) box.add(p);
  if (box.empty()) box.add(geom::Point3{});
  return {{"lo", point_json(box.lo)}, {"hi", point_json(box.hi)}};
}

void put_u32(std::string& bytes, std::size_t value) {
  for (std::size_t k = 0; k < 4; ++k) bytes += static_cast<char>((value >> (8 * k)) & 0xffu);
}

}  // namespace

Result<std::string> scene_bytes(const Scene& scene, const SceneOptions& options) {
  if (auto ok = validate(scene); !ok) return ok.error();
  if (!(options.point_step_mm > 0) || !std::isfinite(options.point_step_mm))
    return Error{ErrorCode::range, "scene: the step of the points is no length (above 0 mm)", {}};
  Chunks chunks;
  json directory = {{"version", 1}, {"nodes", scene.path.point.size()}, {"box", box_json(scene)}};
  put_texts(directory, scene);
  json series = json::array();
  for (const SceneSeries& s : scene.series)
    series.push_back({{"name", s.name}, {"unit", s.unit}, {"signed", s.signed_scale}});
  directory["series"] = std::move(series);
  Steps steps;
  const auto keep = [&directory](const char* key, Result<json> made) -> Result<void> {
    if (!made) return made.error();
    directory[key] = *std::move(made);
    return {};
  };
  steps.then([&] { return put_path(chunks, scene.path, options.point_step_mm); });
  for (std::size_t k = 0; k < scene.series.size(); ++k)
    steps.then([&] { return put_values(chunks, "series." + std::to_string(k), scene.series[k].value); });
  steps.then([&] { return keep("meshes", put_meshes(chunks, scene, options)); })
      .then([&] { return keep("outlines", put_outlines(chunks, scene, options.point_step_mm)); })
      .then([&] { return keep("stock", put_stock(chunks, scene)); })
      .then([&] { return keep("cspaces", put_cspaces(chunks, scene)); })
      .then([&] { return keep("program", put_program(chunks, scene, options.max_text_bytes)); });
  if (auto ok = steps.result(); !ok) return ok.error();
  directory["chunks"] = std::move(chunks.list);
  // Text from files may hold damaged UTF-8: replaced rather than thrown at.
  const std::string head = directory.dump(-1, ' ', false, json::error_handler_t::replace);
  std::string out = "BURINSC1";
  put_u32(out, head.size());
  return out + head + chunks.bytes;
}

}  // namespace burin::view

// SPDX-License-Identifier: Apache-2.0
#include "burin/view/cycle_html.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "burin/view/cycle_track.h"
#include "burin/view/encode.h"
#include "burin/view/page.h"
#include "burin/view/surface_mesh.h"

namespace burin::view {
namespace {

using nlohmann::json;

// Together these keep a page below 6 MB: a point of a mesh takes 12 characters, of the way 40.
constexpr std::size_t kMeshPoints = 90'000;
constexpr std::size_t kTrackPoints = 80'000;
constexpr std::size_t kRows = 10'000;
/// Surfaces (patches and joined ones) drawn; further ones are only counted.
constexpr std::size_t kMeshes = 4'000;
constexpr std::size_t kUnjoined = 500;

json point_json(geom::Point3 p) {
  return {p.x, p.y, p.z};
}

/// Points as 16 bit numbers in the box of the mesh, normals as 8 bit.
json mesh_json(const SurfaceMesh& mesh) {
  std::vector<std::uint16_t> points;
  std::vector<std::int8_t> normals;
  const geom::Vec3 size = mesh.box.empty() ? geom::Vec3{} : mesh.box.hi - mesh.box.lo;
  for (const geom::Point3 p : mesh.points) {
    points.push_back(scaled(p.x, mesh.box.lo.x, size.x));
    points.push_back(scaled(p.y, mesh.box.lo.y, size.y));
    points.push_back(scaled(p.z, mesh.box.lo.z, size.z));
  }
  for (const geom::Vec3 n : mesh.normals) {
    for (const double c : {n.x, n.y, n.z}) {
      normals.push_back(signed8(c));
    }
  }
  return {{"nu", mesh.u.size()}, {"nv", mesh.v.size()},           {"iu", mesh.iso_u},
          {"iv", mesh.iso_v},    {"lo", point_json(mesh.box.lo)}, {"hi", point_json(mesh.box.hi)},
          {"p", base64(points)}, {"n", base64(normals)}};
}

/// Meshes of the page: those of repeats are shared.
class Meshes {
 public:
  int add(const geom::NurbsSurface* surface) {
    if (surfaces_.size() >= kMeshes) return -1;
    surfaces_.push_back(surface);
    return static_cast<int>(surfaces_.size() - 1);
  }
  void sample() { meshes_ = sample_surfaces(surfaces_, kMeshPoints); }
  const std::vector<SurfaceMesh>& meshes() const { return meshes_; }

 private:
  std::vector<const geom::NurbsSurface*> surfaces_;
  std::vector<SurfaceMesh> meshes_;
};

struct GroupMeshes {
  std::vector<int> patches, surfaces;
};

std::vector<GroupMeshes> collect_meshes(const CyclePicture& picture, Meshes& meshes) {
  std::vector<GroupMeshes> out;
  for (std::size_t g = 0; g < picture.groups.size(); ++g) {
    const CycleGroup& group = picture.groups[g];
    std::size_t same = 0;
    while (same < g && !(group.composite && picture.groups[same].composite == group.composite &&
                         picture.groups[same].patches.size() == group.patches.size())) {
      ++same;
    }
    if (same < g) {
      out.push_back(out[same]);
      continue;
    }
    GroupMeshes one;
    for (const geom::NurbsSurface& s : group.patches) one.patches.push_back(meshes.add(&s));
    if (group.composite) {
      for (const geom::JoinedSurface& s : group.composite->surfaces)
        one.surfaces.push_back(meshes.add(&s.surface));
    }
    out.push_back(std::move(one));
  }
  meshes.sample();
  return out;
}

json surface_json(const CycleGroup& group, const geom::JoinedSurface& s, int mesh, const Meshes& meshes) {
  json blocks = json::array(), joints = json::array();
  for (const geom::Member& m : s.members) {
    blocks.push_back(m.patch < group.patch_names.size() ? group.patch_names[m.patch]
                                                        : std::to_string(m.patch));
  }
  blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
  for (const geom::Joint& j : s.joints) {
    const bool u = j.direction == geom::Direction::u;
    json one = {{"d", u ? "u" : "v"},
                {"at", j.at},
                {"gap", number_or_null(j.gap_mm)},
                {"c", static_cast<int>(j.continuity)}};
    if (mesh >= 0) {
      const SurfaceMesh& m = meshes.meshes()[static_cast<std::size_t>(mesh)];
      one["line"] = nearest_line(u ? m.u : m.v, j.at);
    }
    joints.push_back(std::move(one));
  }
  const auto& n = s.surface;
  return {{"mesh", mesh},
          {"blocks", std::move(blocks)},
          {"joints", std::move(joints)},
          {"deviation", number_or_null(s.deviation_mm)},
          {"degree", {n.degree_u, n.degree_v}},
          {"count", {n.count_u, n.count_v}}};
}

json unjoined_json(const CycleGroup& group, const geom::JoinReport& report) {
  json list = json::array();
  const auto name = [&](std::size_t i) {
    return i < group.patch_names.size() ? group.patch_names[i] : std::to_string(i);
  };
  for (const auto& u : report.unjoined) {
    if (list.size() >= kUnjoined) break;
    list.push_back({name(u.patch_a), name(u.patch_b), u.reason, number_or_null(u.deviation_mm)});
  }
  return list;
}

json group_json(const CyclePicture& picture, const CycleGroup& group, const GroupMeshes& ids,
                const Meshes& meshes) {
  json one = {
      {"title", group.title},
      {"shift", {group.displacement.x, group.displacement.y, group.displacement.z}},
      {"tool", number_or_null(group.tool_diameter_mm)},
      {"stock", number_or_null(group.stock_mm)},
      {"feed", number_or_null(group.feed_mm_min > 0 ? group.feed_mm_min : picture.commanded_feed_mm_min)},
      {"scallop", number_or_null(group.scallop_mm > 0 ? group.scallop_mm : picture.scallop_mm)}};
  one["patches"] = json::array();
  for (std::size_t i = 0; i < group.patches.size(); ++i) {
    one["patches"].push_back(
        {{"name", i < group.patch_names.size() ? group.patch_names[i] : ""}, {"mesh", ids.patches[i]}});
  }
  one["surfaces"] = json::array();
  if (group.composite) {
    for (std::size_t i = 0; i < group.composite->surfaces.size(); ++i) {
      one["surfaces"].push_back(surface_json(group, group.composite->surfaces[i], ids.surfaces[i], meshes));
    }
    one["unjoined"] = unjoined_json(group, group.composite->report);
    one["unjoinedCount"] = group.composite->report.unjoined.size();
    one["gapMax"] = number_or_null(group.composite->report.gap_max_mm);
    one["deviationMax"] = number_or_null(group.composite->report.deviation_max_mm);
  }
  if (group.plan) {
    one["plan"] = {{"along", group.plan->along == cycle::Along::v ? "v" : "u"},
                   {"paths", group.plan->paths},
                   {"lifted", group.plan->lifted},
                   {"lift", number_or_null(group.plan->lift_max_mm)},
                   {"gouge", number_or_null(group.plan->gouge_max_mm)},
                   {"cut", number_or_null(group.plan->cut_mm)},
                   {"link", number_or_null(group.plan->link_mm)},
                   {"rapid", number_or_null(group.plan->rapid_mm)}};
  }
  return one;
}

geom::Box3 scene_box(const CyclePicture& picture, const std::vector<GroupMeshes>& ids, const Meshes& meshes,
                     const Track& track) {
  geom::Box3 box;
  for (std::size_t g = 0; g < ids.size(); ++g) {
    const auto& list = ids[g].surfaces.empty() ? ids[g].patches : ids[g].surfaces;
    for (const int m : list) {
      if (m < 0) continue;
      const geom::Box3& b = meshes.meshes()[static_cast<std::size_t>(m)].box;
      if (b.empty()) continue;
      box.add(b.lo + picture.groups[g].displacement);
      box.add(b.hi + picture.groups[g].displacement);
    }
  }
  if (box.empty()) {
    for (const TrackPoint& p : track.points) box.add(p.p);
  }
  if (box.empty()) box.add(geom::Point3{});
  return box;
}

json track_json(const Track& track, geom::Point3 origin) {
  std::vector<float> xyz;
  std::vector<std::uint32_t> index;
  std::vector<std::uint16_t> feed, axis, lift;
  std::vector<std::int16_t> tangential, normals;
  bool touches = false;
  for (const TrackPoint& p : track.points) {
    const geom::Vec3 d = p.p - origin;
    for (const double c : {d.x, d.y, d.z}) xyz.push_back(static_cast<float>(c));
    index.push_back(p.index);
    for (const double c : {p.normal.x, p.normal.y, p.normal.z}) normals.push_back(signed16(c));
    touches = touches || p.normal.z != 1;
    feed.push_back(scaled(p.feed, 0, track.feed_max));
    axis.push_back(scaled(p.axis, 0, track.axis_max));
    lift.push_back(scaled(p.lift, 0, track.lift_max));
    tangential.push_back(signed16(track.tangential_max > 0 ? p.tangential / track.tangential_max : 0));
  }
  std::vector<std::int32_t> runs;
  for (const TrackRun& r : track.runs) {
    for (const int v : {static_cast<int>(r.first), static_cast<int>(r.label.kind), r.label.group,
                        r.label.surface, r.label.pass, r.row}) {
      runs.push_back(v);
    }
  }
  json t = {{"timed", track.timed},
            {"step", track.step},
            {"samples", track.samples},
            {"n", track.points.size()},
            {"tolerance", {track.position_mm, track.feed_mm_min, track.accel_mm_s2}},
            {"feedMax", track.feed_max},
            {"axisMax", track.axis_max},
            {"tangentialMax", track.tangential_max},
            {"liftMax", track.lift_max},
            {"xyz", base64(xyz)},
            {"index", base64(index)},
            {"runs", base64(runs)}};
  if (track.timed) {
    t["feed"] = base64(feed);
    t["axis"] = base64(axis);
    t["tangential"] = base64(tangential);
  }
  if (touches) t["normal"] = base64(normals);
  if (track.lift_max > 0) t["lift"] = base64(lift);
  return t;
}

/// Columns of the table of paths; the page knows their order.
json rows_json(const Track& track) {
  std::vector<std::int32_t> ids;
  std::vector<float> figures;
  for (const PassRow& r : track.rows) {
    const int flags = (r.last_pass ? 1 : 0) | (r.side_step_binds ? 2 : 0);
    for (const int v : {r.group, r.surface, r.pass, r.pass_last, static_cast<int>(r.first),
                        static_cast<int>(r.last), flags}) {
      ids.push_back(v);
    }
    for (const double v : {r.length, r.seconds, r.feed_min, r.feed_mean, r.feed_max, r.axis_max,
                           r.scallop_min, r.scallop_max, r.side_step, r.lift}) {
      figures.push_back(static_cast<float>(v));
    }
  }
  return {{"n", track.rows.size()}, {"ids", base64(ids)}, {"figures", base64(figures)}};
}

json page_json(const CyclePicture& picture) {
  Meshes meshes;
  const std::vector<GroupMeshes> ids = collect_meshes(picture, meshes);
  const Track track = make_track(picture, {kTrackPoints, kRows});
  const geom::Box3 box = scene_box(picture, ids, meshes, track);
  const geom::Point3 origin = lerp(box.lo, box.hi, 0.5);
  json data = {{"period", picture.period_s},
               {"accelLimit", number_or_null(picture.accel_limit_mm_s2)},
               {"lo", point_json(box.lo)},
               {"hi", point_json(box.hi)},
               {"origin", point_json(origin)}};
  data["groups"] = json::array();
  for (std::size_t g = 0; g < picture.groups.size(); ++g) {
    data["groups"].push_back(group_json(picture, picture.groups[g], ids[g], meshes));
  }
  data["meshes"] = json::array();
  for (const SurfaceMesh& m : meshes.meshes()) data["meshes"].push_back(mesh_json(m));
  data["track"] = track_json(track, origin);
  data["rows"] = rows_json(track);
  data["figures"] = figures_json(picture.figures);
  put_texts(data, picture.title, picture.command_line, picture.diagnostics, picture.nc_text);
  return data;
}

}  // namespace

std::string cycle_html(const CyclePicture& picture) {
  return make_page("cycle.html", picture.title, page_json(picture));
}

}  // namespace burin::view

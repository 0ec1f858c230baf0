// SPDX-License-Identifier: Apache-2.0
#include "burin/view/rotary_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "burin/base/text.h"
#include "burin/job/verify_tools.h"
#include "burin/view/plan_scene.h"
#include "burin/view/rotary_places.h"
#include "burin/view/verify_scene.h"

namespace burin::view {
namespace {

constexpr std::size_t kPlaces = 500;

/// The reachable interval that holds the chosen angle, at the turn where that is; NaN where nothing is
/// reachable or all of it.
struct Reach {
  double lo = std::numeric_limits<double>::quiet_NaN(), hi = lo;
  explicit Reach(const rotary::RotaryPoint& p) {
    constexpr double kTurn = 2 * geom::kPi, kRounding = 1e-9;
    for (const auto& interval : p.reachable) {
      if (interval.hi - interval.lo >= kTurn - kRounding) return;
      const double turns = kTurn * std::floor((p.theta - interval.lo + kRounding) / kTurn);
      if (p.theta > interval.hi + turns + kRounding) continue;
      lo = interval.lo + turns;
      hi = interval.hi + turns;
      return;
    }
  }
};

void put_series(const RotaryPicture& picture, const PlanNodes& nodes, Scene& scene) {
  const auto& points = picture.plan->points;
  const auto add = [&](const char* name, const char* unit,
                       const std::function<double(const rotary::RotaryPoint&)>& value) {
    put_plan_series(
        nodes, name, unit, false, [&](std::size_t i) { return value(points[i]); }, scene);
  };
  const auto degrees = [&add](const char* name,
                              const std::function<double(const rotary::RotaryPoint&)>& angle) {
    add(name, "deg", [&angle](const rotary::RotaryPoint& p) { return geom::degrees(angle(p)); });
  };
  degrees("axis", [](const rotary::RotaryPoint& p) { return p.theta; });
  degrees("first axis", [](const rotary::RotaryPoint& p) { return p.initial; });
  degrees("axis without smoothing",
          [&](const rotary::RotaryPoint& p) { return unsmoothed(p, picture.options->clearance); });
  degrees("reachable from", [](const rotary::RotaryPoint& p) { return Reach(p).lo; });
  degrees("reachable to", [](const rotary::RotaryPoint& p) { return Reach(p).hi; });
  add("left on the part", "mm", [](const rotary::RotaryPoint& p) { return p.place.excess_mm; });
  add("first axis interferes", "",
      [](const rotary::RotaryPoint& p) { return p.initial_interferes ? 1.0 : 0.0; });
}

void put_places(const RotaryPicture& picture, const PlanNodes& nodes, Scene& scene) {
  std::size_t listed = 0;
  for (const LeftPlace& place : left_places(*picture.plan)) {
    if (++listed > kPlaces) return;
    const bool reached = place.state != rotary::State::unreachable;
    const rotary::RotaryPoint& worst = picture.plan->points[place.worst];
    SceneFinding f;
    f.level = reached ? SceneFinding::Level::info : SceneFinding::Level::warning;
    f.title = std::string(reached ? "the ball does not fit" : "not reached") +
              (place.excess_mm > 0 ? ", " + format_fixed(place.excess_mm, 4) + " mm left" : "");
    f.detail = "path " + std::to_string(place.path) + ", points " +
               std::to_string(picture.plan->points[place.first].index) + " to " +
               std::to_string(picture.plan->points[place.last].index);
    f.at = worst.place.contact.p;
    if (nodes.node_of[place.worst] != kNoPoint)
      f.node = static_cast<std::uint32_t>(nodes.node_of[place.worst]);
    scene.findings.push_back(std::move(f));
  }
}

}  // namespace

Result<Scene> rotary_scene(const RotaryPicture& picture) {
  Scene scene;
  scene.title = scene.program_name = picture.title;
  scene.operation = "rotary";
  scene.command_line = picture.command_line;
  scene.program_text = picture.nc_text;
  const auto& points = picture.plan->points;
  auto nodes = put_plan_path(*picture.program, picture.machine, picture.nc_line_to_record,
                             scene_tool(job::checked_mill(*picture.tool), 0), points.size(), scene);
  if (!nodes) return nodes.error();
  std::vector<std::string> names;
  for (const rotary::RotaryPoint& p : points)
    while (names.size() <= p.path) names.push_back("path " + std::to_string(names.size()));
  put_plan_groups(
      *nodes, std::move(names), [&](std::size_t i) { return points[i].path; }, scene);
  SceneMesh design;
  design.name = picture.part->name.empty() ? "part" : picture.part->name;
  design.mesh = picture.part->mesh;
  scene.meshes.push_back(std::move(design));
  put_series(picture, *nodes, scene);
  put_places(picture, *nodes, scene);
  for (const auto& f : picture.figures) scene.figures.push_back({f.group, f.name, f.value});
  if (picture.diagnostics) put_warnings(*picture.diagnostics, scene);
  return scene;
}

}  // namespace burin::view

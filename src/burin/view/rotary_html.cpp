// SPDX-License-Identifier: Apache-2.0
#include "burin/view/rotary_html.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "burin/view/encode.h"
#include "burin/view/page.h"
#include "burin/view/rotary_places.h"
#include "burin/view/rotary_shape.h"

namespace burin::view {
namespace {

using nlohmann::json;

// Together these keep a page below 10 MB: a triangle takes 36 characters, a point 55, a pose 27.
constexpr std::size_t kTriangles = 50'000;
constexpr std::size_t kPoints = 60'000;
constexpr std::size_t kPoses = 80'000;
constexpr std::size_t kSections = 160;
constexpr std::size_t kOutlinePoints = 120'000;
constexpr std::size_t kPlaces = 2'000;
/// Sections are drawn within this share of the part's radius.
constexpr double kOutlineShare = 5e-4;

// --- the part

json sections_json(const RotaryPicture& picture) {
  const std::vector<SectionPlace> places =
      section_places(*picture.part, *picture.plan, picture.options->pattern, kSections);
  std::vector<double> xs;
  for (const SectionPlace& s : places) xs.push_back(s.x);
  const double scale = std::max(picture.part->radius_max, 1e-6);
  const std::vector<Outline> drawn = outlines(*picture.part, xs, kOutlineShare * scale);
  json list = json::array();
  std::size_t spent = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    std::vector<std::int16_t> yz;
    std::vector<std::uint32_t> sizes;
    for (const auto& loop : drawn[i]) {
      spent += loop.size();
      if (spent > kOutlinePoints) break;
      sizes.push_back(static_cast<std::uint32_t>(loop.size()));
      for (const geom::Point2 p : loop)
        for (const double c : {p.x, p.y}) yz.push_back(signed16(c / scale));
    }
    list.push_back({places[i].x, places[i].path, base64(sizes), base64(yz)});
  }
  return {{"scale", scale}, {"list", std::move(list)}};
}

// --- the tool's way

/// Every n-th of the inner poses of a leg; its ends stay.
json poses_json(const rotary::RotaryPlan& plan, const std::vector<std::uint32_t>& kept) {
  std::size_t count = 0;
  for (const rotary::Leg& leg : plan.legs) count += leg.poses.size();
  const std::size_t every = count / kPoses + 1;
  std::vector<float> poses;
  std::vector<std::int32_t> point, legs;
  for (const rotary::Leg& leg : plan.legs) {
    for (const int v :
         {static_cast<int>(point.size()), static_cast<int>(leg.kind), static_cast<int>(leg.path)})
      legs.push_back(v);
    for (std::size_t i = 0; i < leg.poses.size(); ++i) {
      if (i % every != 0 && i + 1 != leg.poses.size()) continue;
      const rotary::AxisPose& p = leg.poses[i];
      for (const double v : {p.center.x, p.center.y, p.center.z, p.theta}) poses.push_back(single(v));
      const bool cut =
          leg.kind == rotary::LegKind::cut && i < leg.points.size() && leg.points[i] < kept.size();
      point.push_back(cut ? static_cast<std::int32_t>(kept[leg.points[i]]) : -1);
    }
  }
  return {{"n", point.size()},
          {"of", count},
          {"xyzt", base64(poses)},
          {"point", base64(point)},
          {"legs", base64(legs)}};
}

/// Numbers of the points on the page, and for each point of the plan the one on the page that stands for it
/// (the last one kept before it).
struct Kept {
  std::vector<std::size_t> points;
  std::vector<std::uint32_t> number;
};
Kept thinned(const rotary::RotaryPlan& plan) {
  const std::size_t every = plan.points.size() / kPoints + 1;
  Kept kept;
  for (std::size_t i = 0; i < plan.points.size(); ++i) {
    const bool first = i == 0 || plan.points[i].path != plan.points[i - 1].path;
    if (first || i % every == 0) kept.points.push_back(i);
    kept.number.push_back(static_cast<std::uint32_t>(kept.points.size() - 1));
  }
  return kept;
}

json points_json(const RotaryPicture& picture, const Kept& kept) {
  const rotary::RotaryPlan& plan = *picture.plan;
  std::vector<float> contact, theta, initial, plain, excess, reach;
  std::vector<std::int16_t> normal;
  std::vector<std::uint8_t> flags, reach_count;
  std::vector<std::uint32_t> paths;  // first point, number of the path
  for (const std::size_t i : kept.points) {
    const rotary::RotaryPoint& p = plan.points[i];
    if (paths.empty() || paths.back() != p.path) {
      paths.push_back(static_cast<std::uint32_t>(theta.size()));
      paths.push_back(static_cast<std::uint32_t>(p.path));
    }
    const rotary::Contact& c = p.place.contact;
    for (const double v : {c.p.x, c.p.y, c.p.z}) contact.push_back(single(v));
    for (const double v : {c.n.x, c.n.y, c.n.z}) normal.push_back(signed16(v));
    theta.push_back(single(p.theta));
    initial.push_back(single(p.initial));
    plain.push_back(single(unsmoothed(p, picture.options->clearance)));
    excess.push_back(single(p.place.excess_mm));
    flags.push_back(
        static_cast<std::uint8_t>(static_cast<int>(p.place.state) | (p.initial_interferes ? 4 : 0)));
    const std::size_t intervals = std::min<std::size_t>(p.reachable.size(), 255);
    reach_count.push_back(static_cast<std::uint8_t>(intervals));
    for (std::size_t k = 0; k < intervals; ++k) {
      reach.push_back(single(p.reachable[k].lo));
      reach.push_back(single(p.reachable[k].hi));
    }
  }
  return {{"n", kept.points.size()},
          {"of", plan.points.size()},
          {"contact", base64(contact)},
          {"normal", base64(normal)},
          {"theta", base64(theta)},
          {"initial", base64(initial)},
          {"plain", base64(plain)},
          {"excess", base64(excess)},
          {"flags", base64(flags)},
          {"reach", base64(reach)},
          {"reachCount", base64(reach_count)},
          {"paths", base64(paths)}};
}

json places_json(const rotary::RotaryPlan& plan, const Kept& kept, std::size_t& count) {
  const std::vector<LeftPlace> places = left_places(plan);
  count = places.size();
  json list = json::array();
  for (const LeftPlace& p : places) {
    if (list.size() >= kPlaces) break;
    list.push_back({p.path, p.first, p.last, static_cast<int>(p.state), number_or_null(p.excess_mm),
                    kept.number[p.worst], plan.points[p.first].index, plan.points[p.last].index});
  }
  return list;
}

// --- figures

json tool_json(const model::BallTool& tool) {
  json holder = json::array();
  for (const model::HolderPiece& piece : tool.holder) holder.push_back({piece.radius, piece.height});
  return {
      {"ball", tool.radius}, {"shank", tool.shank_radius}, {"length", tool.shank_length}, {"holder", holder}};
}

json counts_json(const rotary::RotaryPlan& plan) {
  std::size_t interfering = 0;
  for (const rotary::RotaryPoint& p : plan.points) interfering += p.initial_interferes ? 1 : 0;
  const std::size_t paths = plan.points.empty() ? 0 : plan.points.back().path + 1;
  return {{"points", plan.counts.contact_points},
          {"cl", plan.counts.cl_points},
          {"paths", paths},
          {"moved", plan.counts.moved},
          {"unreachable", plan.counts.unreachable},
          {"interfering", interfering},
          {"cut", number_or_null(plan.lengths_mm.cut)}};
}

json page_json(const RotaryPicture& picture) {
  const Kept kept = thinned(*picture.plan);
  std::size_t places = 0;
  const char* pattern = picture.options->pattern == rotary::Pattern::rings    ? "rings"
                        : picture.options->pattern == rotary::Pattern::spiral ? "spiral"
                                                                              : "lines";
  json data = {
      {"pattern", pattern},
      {"method", picture.options->tai == rotary::Tai::exact ? "exact" : "section"},
      {"clearance", geom::degrees(picture.options->clearance)},
      {"smooth", picture.options->smooth},
      {"tool", tool_json(*picture.tool)},
      {"x", {picture.part->x_min, picture.part->x_max}},
      {"counts", counts_json(*picture.plan)},
      {"shape", shape_json(drawn_shape(*picture.part, kTriangles), picture.part->mesh.triangles.size())},
      {"sections", sections_json(picture)},
      {"poses", poses_json(*picture.plan, kept.number)},
      {"points", points_json(picture, kept)},
      {"places", places_json(*picture.plan, kept, places)}};
  data["placeCount"] = places;
  data["figures"] = figures_json(picture.figures);
  put_texts(data, picture.title, picture.command_line, picture.diagnostics, picture.nc_text);
  return data;
}

}  // namespace

std::string rotary_html(const RotaryPicture& picture) {
  return make_page("rotary.html", picture.title, page_json(picture));
}

}  // namespace burin::view

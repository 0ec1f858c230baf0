// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/laser/leads.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace burin::laser::detail {

using geom::ArcSpline;
using geom::Point2;
using geom::Segment;
using geom::Vec2;

namespace {

/// Lengths tried: the one asked for, and halved so often.
constexpr int kHalvings = 4;
/// Start points tried: so many middles of long segments, and so many places spread evenly.
constexpr std::size_t kLongSegments = 8, kEvenPlaces = 8;
/// A line lead meets the path at this angle, or squarely.
constexpr double kObliqueDegrees = 45;

Vec2 turned(Vec2 v, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * v.x - s * v.y, s * v.x + c * v.y};
}

/// Arc that arrives at `s` along `tangent` from the waste side.
Segment arc_in(Point2 s, Vec2 tangent, Waste waste, double radius, double sweep) {
  const Vec2 to_center = radius * towards_waste(tangent, waste);
  const bool ccw = waste == Waste::left;
  const Point2 center = s + to_center;
  Segment arc;
  arc.a = center + turned(-to_center, ccw ? -sweep : sweep);
  arc.b = s;
  arc.center = center;
  arc.radius = ccw ? radius : -radius;
  return arc;
}

Segment line_in(Point2 s, Vec2 tangent, Waste waste, double length, double angle) {
  const Vec2 back = length * (std::sin(angle) * towards_waste(tangent, waste) - std::cos(angle) * tangent);
  return geom::make_line(s + back, s);
}

/// Radius of a path that is one circle with the waste inside, 0 for others.
double round_hole_radius(const ArcSpline& path, Waste waste, double point_mm) {
  const Segment& first = path.segments.front();
  if (first.is_line() || (first.radius > 0) != (waste == Waste::left)) return 0;
  for (const Segment& s : path.segments) {
    if (s.is_line() || geom::distance(s.center, first.center) > point_mm ||
        std::abs(s.radius - first.radius) > point_mm) {
      return 0;
    }
  }
  return std::abs(first.radius);
}

/// Leads of a length in the order of preference.
std::vector<Segment> leads_in(const Site& site, Vec2 tangent, Waste waste, LeadKind kind, double length,
                              double hole_radius) {
  std::vector<Segment> leads;
  if (kind == LeadKind::arc) {
    // A quarter of a circle. In a round hole its radius is half of the hole's at most: a longer lead goes on
    // turning until it starts in the middle of the hole.
    double radius = 2 * length / geom::kPi;
    double sweep = geom::kPi / 2;
    if (hole_radius > 0 && radius > hole_radius / 2) {
      radius = hole_radius / 2;
      sweep = std::min(geom::kPi, length / radius);
    }
    leads.push_back(arc_in(site.point, tangent, waste, radius, sweep));
  } else {
    if (hole_radius > 0) length = std::min(length, hole_radius);
    const bool from_centre = hole_radius > 0 && length > hole_radius / 2;
    if (!from_centre)
      leads.push_back(line_in(site.point, tangent, waste, length, geom::radians(kObliqueDegrees)));
    leads.push_back(line_in(site.point, tangent, waste, length, geom::kPi / 2));
  }
  return leads;
}

std::vector<Site> candidates(const ArcSpline& path, bool with_lead) {
  const auto& all = path.segments;
  std::vector<std::pair<std::size_t, double>> places;
  if (!with_lead) {
    // Nothing to be said for the middle of a segment: start where two meet and leave every segment whole.
    const std::size_t n = std::min(all.size(), kLongSegments + kEvenPlaces);
    for (std::size_t k = 0; k < n; ++k) places.emplace_back(k * all.size() / n, 0.0);
  } else {
    const double whole = geom::length_of(path);
    std::vector<double> length(all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      // Arcs about corners come last: a start there would cut the corner's treatment in two.
      length[i] = geom::length_of(all[i]) - (all[i].source == geom::kCornerSource ? whole : 0);
    }
    std::vector<std::size_t> longest(all.size());
    std::iota(longest.begin(), longest.end(), std::size_t{0});
    const std::size_t n = std::min(all.size(), kLongSegments);
    std::partial_sort(
        longest.begin(), longest.begin() + static_cast<std::ptrdiff_t>(n), longest.end(),
        [&](std::size_t a, std::size_t b) { return length[a] != length[b] ? length[a] > length[b] : a < b; });
    for (std::size_t k = 0; k < n; ++k) {
      if (k > 0 && all[longest[k]].source == geom::kCornerSource) break;
      places.emplace_back(longest[k], 0.5);
      if (all.size() > kLongSegments / 2) continue;
      places.emplace_back(longest[k], 0.25);
      places.emplace_back(longest[k], 0.75);
    }
    for (std::size_t k = 0; all.size() > n && k < kEvenPlaces; ++k) {
      const std::size_t i = k * all.size() / kEvenPlaces;
      if (all[i].source != geom::kCornerSource) places.emplace_back(i, 0.5);
    }
  }
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  std::vector<Site> sites;
  for (const auto& [index, fraction] : places) {
    const Segment& s = all[index];
    sites.push_back({index, fraction, fraction > 0 ? geom::point_on(s, fraction) : s.a, std::nullopt});
  }
  return sites;
}

/// Whether a lead that ends on path `owner` keeps its distance; `strict`: and does not pierce in another
/// kerf.
bool lead_fits(const Segment& lead, Point2 pierce, std::uint32_t owner, bool strict, const LeadRoom& room) {
  if (strict && room.kerf_mm > 0 &&
      !room.paths->is_free(geom::make_line(pierce, pierce), room.kerf_mm, owner)) {
    return false;
  }
  const bool pierce_first = lead.a == pierce;
  return has_room(lead, !pierce_first, pierce_first, room);
}

Vec2 tangent_at(const ArcSpline& path, const Site& site) {
  const Segment& s = path.segments[site.segment];
  return geom::start_tangent(site.fraction > 0 ? part_of(s, site.fraction, 1) : s);
}

/// At a corner with the waste in the angle between its legs no tangent lead has room: in along the bisector.
std::optional<Segment> bisector_in(const ArcSpline& path, const Site& site, Waste waste, double length) {
  if (site.fraction > 0) return std::nullopt;
  const std::size_t n = path.segments.size();
  const Vec2 in = geom::end_tangent(path.segments[(site.segment + n - 1) % n]);
  const Vec2 out = geom::start_tangent(path.segments[site.segment]);
  const Vec2 away = geom::unit(towards_waste(in, waste) + towards_waste(out, waste));
  if (away == Vec2{}) return std::nullopt;
  return geom::make_line(site.point + length * away, site.point);
}

}  // namespace

bool has_room(const Segment& move, bool touches_start, bool touches_end, const LeadRoom& room) {
  std::vector<Segment> parts;
  if (room.sagitta_mm > 0) {
    append_chords(move, room.sagitta_mm, parts);
  } else {
    parts.push_back(move);
  }
  const bool keep = room.distance_mm > room.point_mm;
  if (!keep) {
    // The path is the outline (or near it) and the move touches it: leave out what is within the tolerance of
    // the end that touches.
    const auto trim = [&](Segment& s, bool at_start) {
      const double length = geom::length_of(s);
      const double f = length > 0 ? std::min(0.5, room.path_mm / length) : 0;
      s = at_start ? part_of(s, f, 1) : part_of(s, 0, 1 - f);
    };
    if (touches_start) trim(parts.front(), true);
    if (touches_end) trim(parts.back(), false);
  }
  const double distance = keep ? room.distance_mm : room.point_mm;
  return std::all_of(parts.begin(), parts.end(),
                     [&](const Segment& s) { return room.outlines->is_free(s, distance); });
}

Sites plan_sites(const ArcSpline& path, std::uint32_t owner, Waste waste, const LeadOptions& options,
                 bool fixed_start, const LeadRoom& room) {
  const bool with_lead =
      options.kind != LeadKind::none && options.length_mm > room.point_mm && waste != Waste::none;
  Sites result;
  const std::vector<Site> all = fixed_start
                                    ? std::vector<Site>{{0, 0.0, path.segments.front().a, std::nullopt}}
                                    : candidates(path, with_lead);
  if (!with_lead) {
    result.sites = all;
    return result;
  }
  const double hole = round_hole_radius(path, waste, room.point_mm);
  const auto collect = [&](double length, bool strict, auto&& leads_of) {
    for (Site site : all) {
      for (const Segment& lead : leads_of(site, length)) {
        if (!lead_fits(lead, lead.a, owner, strict, room)) continue;
        site.lead_in = lead;
        result.sites.push_back(site);
        break;
      }
    }
    result.length_mm = length;
    return !result.sites.empty();
  };
  const auto tangent_leads = [&](const Site& site, double length) {
    return leads_in(site, tangent_at(path, site), waste, options.kind, length, hole);
  };
  const auto corner_leads = [&](const Site& site, double length) {
    const auto lead = bisector_in(path, site, waste, length);
    return lead ? std::vector<Segment>{*lead} : std::vector<Segment>{};
  };
  for (const bool strict : {true, false}) {
    if (!strict && room.kerf_mm <= 0) break;  // the same again
    double length = options.length_mm;
    for (int k = 0; k <= kHalvings; ++k, length /= 2) {
      result.fit = k == 0 ? Fit::full : Fit::shortened;
      if (collect(length, strict, tangent_leads) || collect(length, strict, corner_leads)) return result;
    }
  }
  result.sites = all;
  result.fit = Fit::none;
  result.length_mm = 0;
  return result;
}

std::optional<Segment> plan_lead_out(Point2 point, Vec2 tangent, Waste waste, const LeadOptions& options,
                                     const LeadRoom& room) {
  if (options.kind == LeadKind::none || options.out_mm <= room.point_mm || waste == Waste::none)
    return std::nullopt;
  // A lead-out is the lead-in of the travel back: the waste is then on the other side.
  const Waste other = waste == Waste::left ? Waste::right : Waste::left;
  double length = options.out_mm;
  for (int k = 0; k <= kHalvings; ++k, length /= 2) {
    for (const Segment& lead :
         leads_in({0, 0, point, std::nullopt}, -tangent, other, options.kind, length, 0)) {
      const Segment out = geom::reversed(lead);
      if (has_room(out, true, false, room)) return out;
    }
  }
  return std::nullopt;
}

}  // namespace burin::laser::detail

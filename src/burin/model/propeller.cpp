// SPDX-License-Identifier: Apache-2.0
#include "burin/model/propeller.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "burin/base/text.h"
#include "burin/geom/surface/evaluate.h"
#include "burin/geom/surface/interpolate.h"
#include "burin/model/propeller_tables.h"

namespace burin::model {
namespace {

using geom::Direction;
using geom::NurbsSurface;
using geom::Point2;
using geom::Point3;
using geom::Vec3;

constexpr double kOutermost = 0.975;  ///< r / R: beyond, the chord falls to nothing
constexpr int kStations = 33;         ///< sections of a blade
constexpr double kEdgeShare = 0.1;    ///< edge thickness over the greatest thickness of the section
/// Handles of the cubic that rounds an edge, over the edge's thickness: those of a half circle.
constexpr double kRound = 2.0 / 3;
constexpr double kHubMargin = 1.1;  ///< height of the hub over what the blade's root needs
constexpr double kBladeGap = 1.02;  ///< distance of neighbouring blades at the hub over their thickness

struct Range {
  double lo, hi;
};
constexpr Range kDiameter{1, 20000}, kPitch{0.5, 1.4}, kArea{0.3, 1.05}, kHub{0.15, 0.4};
constexpr Range kRake{-20, 30};  ///< degrees
constexpr int kFewestBlades = 2, kMostBlades = 7;

Result<void> within(double value, Range range, const std::string& name) {
  if (value >= range.lo && value <= range.hi) return {};
  return Error{ErrorCode::range,
               name + " is " + format_shortest(value) + " (" + format_shortest(range.lo) + " to " +
                   format_shortest(range.hi) + ")",
               {}};
}

/// Sections lie on cylinders: place along the chord (towards the trailing edge) and height (towards the back)
/// at radius r. Forward is +Z, then turned about X when the face is to look that way.
struct Placing {
  double radius, cosine, sine, rake;
  bool turned;
  Placing(const PropellerData& data, double r, double pitch)
      : radius(r),
        cosine(2 * geom::kPi * r / std::hypot(2 * geom::kPi * r, pitch)),
        sine(pitch / std::hypot(2 * geom::kPi * r, pitch)),
        rake(r * std::tan(data.rake)),
        turned(data.side == BladeSide::face) {}
  Point3 operator()(Point2 p) const {
    const double angle = (-p.x * cosine - p.y * sine) / radius;
    const double z = -p.x * sine + p.y * cosine - rake;
    const Point3 q{radius * std::cos(angle), radius * std::sin(angle), z};
    return turned ? Point3{q.x, -q.y, -q.z} : q;
  }
};

struct Grids {
  std::vector<double> u, v;
  geom::PointGrid face, back;
  double lowest = 1e300, highest = -1e300;  ///< z of the root
};

/// Radii for t from 0 to 1 in which the chord is nearly linear up to the round tip.
double station(const PropellerData& data, double t) {
  const double a = std::sqrt(1 - data.hub_ratio), b = std::sqrt(1 - kOutermost);
  const double w = a + t * (b - a);
  return 1 - w * w;
}

/// The next blade's section is the same, shifted along the circumference: normal to the chord it must stay
/// farther away than the section is thick.
Result<void> check_gap(const PropellerData& data, const BladeSection& section, double r) {
  double lo = 0, hi = 0;
  for (const Point2 p : section.face) lo = std::min(lo, p.y);
  for (const Point2 p : section.back) hi = std::max(hi, p.y);
  const double sine = section.pitch / std::hypot(2 * geom::kPi * r, section.pitch);
  if (2 * geom::kPi * r / data.blades * sine >= kBladeGap * (hi - lo)) return {};
  return Error{ErrorCode::geometry,
               "the blades touch each other at r = " + format_fixed(r, 1) +
                   " mm (fewer blades, more pitch or a larger hub)",
               {}};
}

/// Lengths along the columns, from 0 to 1, in the mean: the surface is run through evenly.
std::vector<double> mean_lengths(const geom::PointGrid& grid) {
  const auto columns = static_cast<std::size_t>(grid.count_u), rows = static_cast<std::size_t>(grid.count_v);
  std::vector<double> v(rows, 0.0), along(rows, 0.0);
  for (std::size_t i = 0; i < columns; ++i) {
    for (std::size_t j = 1; j < rows; ++j)
      along[j] =
          along[j - 1] + geom::distance(grid.points[i + j * columns], grid.points[i + (j - 1) * columns]);
    for (std::size_t j = 0; j < rows; ++j) v[j] += along[j] / along.back() / double(columns);
  }
  v.back() = 1;
  return v;
}

Result<Grids> grids_of(const PropellerData& data) {
  const std::vector<double>& places = b_series().places();
  Grids out;
  out.u.assign(places.size(), 0.0);
  out.face.count_u = out.back.count_u = static_cast<int>(places.size());
  out.face.count_v = out.back.count_v = kStations;
  for (int j = 0; j < kStations; ++j) {
    const double x = station(data, j / double(kStations - 1)), r = 0.5 * x * data.diameter;
    const BladeSection section = blade_section(data, x);
    if (auto ok = check_gap(data, section, r); !ok) return ok.error();
    const Placing place(data, r, section.pitch);
    for (std::size_t i = 0; i < places.size(); ++i) {
      out.face.points.push_back(place(section.face[i]));
      out.back.points.push_back(place(section.back[i]));
      out.u[i] += (section.face[i].x + section.leading) / section.chord / kStations;
      if (j > 0) continue;
      for (const Point3& p : {out.face.points.back(), out.back.points.back()})
        out.lowest = std::min(out.lowest, p.z), out.highest = std::max(out.highest, p.z);
    }
  }
  out.u.front() = 0, out.u.back() = 1;
  out.v = mean_lengths(out.face);
  return out;
}

/// A cubic from one side to the other at each station that goes on in the direction of both.
Result<NurbsSurface> rounded_edge(const NurbsSurface& from, const NurbsSurface& to, double u,
                                  const std::vector<double>& v) {
  const std::vector<double> s{0, 1.0 / 3, 2.0 / 3, 1};
  geom::PointGrid grid{static_cast<int>(s.size()), static_cast<int>(v.size()), {}};
  const double outward = u == 0 ? -1 : 1;
  for (const double at : v) {
    const auto a = geom::derivatives(from, u, at), b = geom::derivatives(to, u, at);
    const double handle = kRound * geom::distance(a.p, b.p);
    const Point3 p1 = a.p + outward * handle * geom::unit(a.du),
                 p2 = b.p + outward * handle * geom::unit(b.du);
    for (const double t : s) {
      const double m = 1 - t;
      grid.points.push_back(Point3{} + (m * m * m * (a.p - Point3{}) + 3 * m * m * t * (p1 - Point3{}) +
                                        3 * m * t * t * (p2 - Point3{}) + t * t * t * (b.p - Point3{})));
    }
  }
  return geom::interpolate(grid, s, v);
}

}  // namespace

Result<void> validate(const PropellerData& data) {
  if (data.blades < kFewestBlades || data.blades > kMostBlades) {
    return Error{ErrorCode::range,
                 "the number of blades is " + std::to_string(data.blades) + " (" +
                     std::to_string(kFewestBlades) + " to " + std::to_string(kMostBlades) + ")",
                 {}};
  }
  if (auto ok = within(data.diameter, kDiameter, "the diameter of the propeller"); !ok) return ok;
  if (auto ok = within(data.pitch_ratio, kPitch, "the pitch ratio"); !ok) return ok;
  if (auto ok = within(data.area_ratio, kArea, "the expanded area ratio"); !ok) return ok;
  if (auto ok = within(data.hub_ratio, kHub, "the hub ratio"); !ok) return ok;
  return within(geom::degrees(data.rake), kRake, "the rake in degrees");
}

BladeSection blade_section(const PropellerData& data, double radius_ratio) {
  const std::vector<double>& places = b_series().places();
  const SeriesAt at = b_series().at(data.blades, radius_ratio);
  BladeSection out;
  const double unit = data.diameter * data.area_ratio / data.blades;
  out.chord = at.chord * unit;
  out.leading = at.middle * unit + 0.5 * out.chord;
  out.max_thickness = at.thickness * data.diameter;
  out.edge_thickness = kEdgeShare * out.max_thickness;
  out.pitch = at.pitch * data.pitch_ratio * data.diameter;
  const double ahead = at.thickest * out.chord, behind = out.chord - ahead;
  const double thick = out.max_thickness - out.edge_thickness;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double p = places[i], along = -out.leading + ahead - (p > 0 ? p * ahead : p * behind);
    out.face.push_back({along, at.v1[i] * thick});
    out.back.push_back({along, (at.v1[i] + at.v2[i]) * thick + out.edge_thickness});
  }
  return out;
}

Result<Propeller> make_propeller(const PropellerData& data) {
  if (auto ok = validate(data); !ok) return ok.error();
  const auto grids = grids_of(data);
  if (!grids) return grids.error();
  auto face = geom::interpolate(grids->face, grids->u, grids->v);
  if (!face) return face.error();
  auto back = geom::interpolate(grids->back, grids->u, grids->v);
  if (!back) return back.error();
  const bool is_face = data.side == BladeSide::face;
  Propeller out;
  out.side = is_face ? *std::move(face) : *std::move(back);
  out.other_side = is_face ? *std::move(back) : *std::move(face);
  // From the leading to the trailing edge, then outwards: Su x Sv looks forward, out of the back.
  out.reversed = is_face;
  out.other_reversed = !is_face;
  auto leading = rounded_edge(out.side, out.other_side, 0, grids->v);
  if (!leading) return leading.error();
  auto trailing = rounded_edge(out.side, out.other_side, 1, grids->v);
  if (!trailing) return trailing.error();
  out.leading_edge = *std::move(leading), out.trailing_edge = *std::move(trailing);
  out.hub_radius = 0.5 * data.hub_ratio * data.diameter;
  out.tip_radius = 0.5 * kOutermost * data.diameter;
  out.hub_height = kHubMargin * (grids->highest - grids->lowest);
  out.hub_bottom = 0.5 * (grids->highest + grids->lowest - out.hub_height);
  return out;
}

}  // namespace burin::model

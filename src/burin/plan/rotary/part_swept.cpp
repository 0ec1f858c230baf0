// SPDX-License-Identifier: Apache-2.0
// A section swept along X: a grid over section and X, fine enough that the triangles leave the surface by at
// most the deflection, and two caps.
//   On a right triangle of legs h (along the section) and b (turn) linear interpolation is off by at most
//   (k h^2 + 2 h b + r b^2) / 8, since |S_uu| = k, |S_ub| = 1, |S_bb| = r.
#include <algorithm>
#include <cmath>
#include <new>

#include "burin/base/text.h"
#include "burin/plan/rotary/cap.h"
#include "burin/plan/rotary/part.h"
#include "burin/plan/rotary/section_check.h"
#include "burin/plan/rotary/sweep.h"

namespace burin::rotary {
namespace {

using geom::Point2;
using geom::Point3;
using geom::Vec3;

constexpr double kShortestStretch = 1e-6;  ///< mm; stations nearer than this cannot be meant
constexpr double kLargest = 1e6;           ///< mm; coordinates beyond have no micrometres left in products

Error geometry(std::string message) {
  return {ErrorCode::geometry, std::move(message), {}};
}

std::optional<Error> check_stations(const std::vector<Station>& stations) {
  if (stations.size() < 2) return geometry("a swept part needs at least two stations (two places along X)");
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const Station& s = stations[i];
    if (!std::isfinite(s.x) || !std::isfinite(s.turn) || std::abs(s.x) > kLargest ||
        std::abs(s.turn) > kLargest) {
      return geometry("station " + std::to_string(i + 1) + " is out of range (x up to 1e6 mm)");
    }
    if (i > 0 && !(s.x - stations[i - 1].x >= kShortestStretch)) {
      return geometry("stations do not ascend: x " + format_fixed(s.x, 6) + " mm follows " +
                      format_fixed(stations[i - 1].x, 6) + " mm (each must lie further along X)");
    }
  }
  if (stations.front().x != 0) return geometry("the first station must be at x = 0");
  return std::nullopt;
}

/// Steps along each piece of the section, and the largest turn of a row.
struct Grid {
  std::vector<std::size_t> steps;
  double turn_step = 0;
  double columns = 0, rows = 0;  ///< as real numbers: they may be larger than any integer
};

double farthest(const geom::Segment& s) {
  const double ends = std::max(norm(s.a - Point2{}), norm(s.b - Point2{}));
  if (s.is_line()) return ends;
  const Point2 far = s.center + std::abs(s.radius) * unit(s.center - Point2{});
  return in_sweep(s, far) ? std::max(ends, norm(far - Point2{})) : ends;
}

double rows_for(const std::vector<Station>& stations, double turn_step) {
  double rows = 0;
  for (std::size_t i = 1; i < stations.size(); ++i) {
    const double turn = std::abs(stations[i].turn - stations[i - 1].turn);
    rows += turn > 0 ? std::max(1.0, std::ceil(turn / turn_step)) : 1;
  }
  return rows;
}

/// The longest step along s for rows of turn b; 0 when there is none.
double step_along(const geom::Segment& s, double b, double deflection) {
  const double k = s.is_line() ? 0 : 1 / std::abs(s.radius);
  const double rest = 8 * deflection - farthest(s) * b * b;
  if (!(rest > 0)) return 0;
  if (k == 0) return b > 0 ? rest / (2 * b) : std::numeric_limits<double>::infinity();
  return rest / (b + std::sqrt(b * b + k * rest));  // k h^2 + 2 b h = rest
}

/// The normal turns by at most this over a facet along the section (radians): positions alone would allow
/// very long facets on twisted flats.
constexpr double kFacetTurn = 0.25;

double steepest(const SweptSection& swept) {
  double rate = 0;
  for (std::size_t i = 1; i < swept.stations.size(); ++i) {
    const Station &a = swept.stations[i - 1], &b = swept.stations[i];
    rate = std::max(rate, std::abs((b.turn - a.turn) / (b.x - a.x)));
  }
  return rate;
}

Grid grid_for(const SweptSection& swept, double b, double deflection) {
  Grid grid;
  const double rate = steepest(swept);
  grid.turn_step = b;
  grid.rows = rows_for(swept.stations, b);
  for (const geom::Segment& s : swept.section.segments) {
    const double h = step_along(s, b, deflection);
    const double bend = std::abs(sweep_of(s)) + rate * length_of(s);
    const double n = std::max({1.0, std::ceil(bend / kFacetTurn), std::ceil(length_of(s) / h)});
    grid.columns += n;
    grid.steps.push_back(n < 1e9 ? std::size_t(n) : std::size_t(1e9));
  }
  return grid;
}

/// The grid with the fewest triangles among turns of a row from coarse to fine.
Grid best_grid(const SweptSection& swept, double radius, double deflection) {
  bool twisted = false;
  for (const Station& s : swept.stations) twisted = twisted || s.turn != swept.stations.front().turn;
  if (!twisted) return grid_for(swept, 0, deflection);
  Grid best;
  double b = 0.98 * std::sqrt(8 * deflection / radius);
  for (int i = 0; i < 40; ++i, b *= 0.8) {
    Grid grid = grid_for(swept, b, deflection);
    if (i == 0 || grid.columns * grid.rows < best.columns * best.rows) best = std::move(grid);
  }
  return best;
}

/// x and twist of the rows: each stretch has its own, the twist jumps at stations.
struct Row {
  double x = 0, turn = 0;
};
std::vector<Row> rows_of(const std::vector<Station>& stations, double turn_step,
                         std::vector<double>& rate_after) {
  std::vector<Row> rows{{stations.front().x, stations.front().turn}};
  for (std::size_t i = 1; i < stations.size(); ++i) {
    const Station &a = stations[i - 1], &b = stations[i];
    const double turn = std::abs(b.turn - a.turn);
    const std::size_t n = turn > 0 ? std::max<std::size_t>(1, std::size_t(std::ceil(turn / turn_step))) : 1;
    for (std::size_t k = 1; k <= n; ++k) {
      const double f = double(k) / double(n);
      rows.push_back(
          {k == n ? b.x : a.x + f * (b.x - a.x), k == n ? b.turn : a.turn + f * (b.turn - a.turn)});
      rate_after.push_back((b.turn - a.turn) / (b.x - a.x));
    }
  }
  return rows;
}

/// Points along the section, each with the piece that begins there.
struct Column {
  std::size_t piece = 0;
  double from = 0, to = 0;
};

void add_caps(Part& part, const std::vector<Column>& columns, const detail::Sweep& sweep, std::size_t rows) {
  std::vector<Point2> polygon;
  polygon.reserve(columns.size());
  for (const Column& c : columns) polygon.push_back(sweep.at(c.piece, c.from).c);
  const std::uint32_t last = std::uint32_t((rows - 1) * columns.size());
  for (const auto& t : detail::triangulate(polygon)) {
    part.mesh.triangles.push_back({t[0], t[2], t[1]});
    part.corner_normals.push_back({Vec3{-1, 0, 0}, Vec3{-1, 0, 0}, Vec3{-1, 0, 0}});
    part.mesh.triangles.push_back({last + t[0], last + t[1], last + t[2]});
    part.corner_normals.push_back({Vec3{1, 0, 0}, Vec3{1, 0, 0}, Vec3{1, 0, 0}});
  }
}

void add_wall(Part& part, const std::vector<Column>& columns, const detail::Sweep& sweep,
              const std::vector<Row>& rows, const std::vector<double>& rates) {
  const std::size_t n = columns.size();
  const auto vertex = [&](std::size_t row, std::size_t column) {
    return std::uint32_t(row * n + column % n);
  };
  for (const Row& row : rows) {
    for (const Column& c : columns) {
      part.mesh.vertices.push_back(sweep.lift(sweep.at(c.piece, c.from), row.x, row.turn, 0).p);
    }
  }
  for (std::size_t r = 0; r + 1 < rows.size(); ++r) {
    for (std::size_t k = 0; k < n; ++k) {
      const detail::SectionPoint a = sweep.at(columns[k].piece, columns[k].from),
                                 b = sweep.at(columns[k].piece, columns[k].to);
      const auto normal = [&](const detail::SectionPoint& p, std::size_t row) {
        return sweep.lift(p, rows[row].x, rows[row].turn, rates[r]).n;
      };
      const Vec3 a0 = normal(a, r), b0 = normal(b, r), a1 = normal(a, r + 1), b1 = normal(b, r + 1);
      // The shorter diagonal; of equal ones always the same.
      const Point3 p00 = part.mesh.vertices[vertex(r, k)], p10 = part.mesh.vertices[vertex(r, k + 1)],
                   p01 = part.mesh.vertices[vertex(r + 1, k)], p11 = part.mesh.vertices[vertex(r + 1, k + 1)];
      // Counter-clockwise from outside: N = S_u x S_x.
      if (distance(p00, p11) <= distance(p10, p01)) {
        part.mesh.triangles.push_back({vertex(r, k), vertex(r, k + 1), vertex(r + 1, k + 1)});
        part.corner_normals.push_back({a0, b0, b1});
        part.mesh.triangles.push_back({vertex(r, k), vertex(r + 1, k + 1), vertex(r + 1, k)});
        part.corner_normals.push_back({a0, b1, a1});
      } else {
        part.mesh.triangles.push_back({vertex(r, k), vertex(r, k + 1), vertex(r + 1, k)});
        part.corner_normals.push_back({a0, b0, a1});
        part.mesh.triangles.push_back({vertex(r, k + 1), vertex(r + 1, k + 1), vertex(r + 1, k)});
        part.corner_normals.push_back({b0, b1, a1});
      }
    }
  }
}

}  // namespace

Result<Part> make_swept(const SweptSection& given, const PartOptions& options) {
  if (!(options.deflection_mm > 0) || !std::isfinite(options.deflection_mm)) {
    return Error{ErrorCode::usage, "the deflection must be above 0 mm", {}};
  }
  auto section = detail::checked_section(given.section, options.deflection_mm);
  if (!section) return section.error();
  if (auto error = check_stations(given.stations)) return *error;
  Part part;
  part.name = "section";
  part.swept = SweptSection{std::move(*section), given.stations};
  for (const geom::Segment& s : part.swept->section.segments) {
    part.radius_max = std::max(part.radius_max, farthest(s));
  }
  if (!(part.radius_max <= kLargest)) return geometry("the section is larger than 1e6 mm");
  const Grid grid = best_grid(*part.swept, part.radius_max, options.deflection_mm);
  const double triangles = 2 * grid.columns * grid.rows + 2 * grid.columns;
  if (!(triangles <= double(options.max_triangles))) {
    return Error{ErrorCode::range,
                 "the part would take " + format_fixed(triangles, 0) + " triangles at a deflection of " +
                     format_shortest(options.deflection_mm) + " mm (" +
                     std::to_string(options.max_triangles) + " are allowed; a larger tolerance needs fewer)",
                 {}};
  }
  const detail::Sweep sweep(*part.swept);
  std::vector<double> rates;
  const std::vector<Row> rows = rows_of(part.swept->stations, grid.turn_step, rates);
  std::vector<Column> columns;
  for (std::size_t i = 0; i < sweep.pieces(); ++i) {
    const double n = double(grid.steps[i]);
    for (std::size_t k = 0; k < grid.steps[i]; ++k) columns.push_back({i, double(k) / n, double(k + 1) / n});
  }
  if (columns.size() < 3) return geometry("the section has no inside (one closed curve around the axis)");
  part.mesh.vertices.reserve(rows.size() * columns.size());
  part.mesh.triangles.reserve(std::size_t(triangles));
  part.corner_normals.reserve(std::size_t(triangles));
  add_wall(part, columns, sweep, rows, rates);
  add_caps(part, columns, sweep, rows.size());
  part.deflection_mm = options.deflection_mm;
  part.x_min = part.swept->stations.front().x;
  part.x_max = part.swept->stations.back().x;
  return part;
}

}  // namespace burin::rotary

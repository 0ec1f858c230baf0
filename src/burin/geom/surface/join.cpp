// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/surface/join.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "burin/geom/surface/join_assemble.h"
#include "burin/geom/surface/join_edges.h"
#include "burin/geom/surface/join_forced.h"

namespace burin::geom {
namespace {

using namespace detail;

/// Beyond the ends the projective map goes on as its tangent: one to one everywhere.
double bent(double bend, Interval t, double x) {
  if (bend == 1) return x;
  const double f = (x - t.lo) / t.length();
  const double g = f < 0 ? bend * f : f > 1 ? 1 + (f - 1) / bend : moebius(bend, f);
  return t.lo + t.length() * g;
}

Result<void> check_input(const std::vector<NurbsSurface>& patches, const JoinOptions& options) {
  if (patches.empty()) return Error{ErrorCode::geometry, "no patches to join (at least one)", {}};
  if (!(options.tolerance_mm > 0 && std::isfinite(options.tolerance_mm)))
    return Error{ErrorCode::range, "the join tolerance is not a length (more than 0 mm)", {}};
  for (std::size_t i = 0; i < patches.size(); ++i) {
    if (auto ok = validate(patches[i]); !ok) {
      Error error = ok.error();
      error.message = "patch " + std::to_string(i + 1) + ": " + error.message;
      return error;
    }
  }
  return {};
}

std::size_t patch_of(const std::vector<Source>& sources, const CellGraph& graph, int cell) {
  return sources[static_cast<std::size_t>(graph.cells[static_cast<std::size_t>(cell)].source)].patch;
}

void cut_link(CellGraph& graph, int cell, std::size_t side) {
  Link& link = graph.cells[static_cast<std::size_t>(cell)].links[side];
  Link& back = graph.cells[static_cast<std::size_t>(link.cell)].links[static_cast<std::size_t>(link.side)];
  back = {};
  link = {};
}

/// Takes the contacts that only agree in place out of a rectangle which they bend too much together. False
/// when there are none.
bool cut_inexact(const std::vector<Source>& sources, CellGraph& graph, const Rectangle& r,
                 double deviation_mm, JoinReport& report) {
  std::set<int> inside;
  for (const Placed& p : r.cells) inside.insert(p.cell);
  bool any = false;
  for (const int cell : inside) {
    for (std::size_t side = 0; side < 4; ++side) {
      const Link link = graph.cells[static_cast<std::size_t>(cell)].links[side];
      if (link.cell < 0 || link.exact || inside.count(link.cell) == 0) continue;
      report_unjoined(report, patch_of(sources, graph, cell), patch_of(sources, graph, link.cell),
                      "together with other joints the deviation would become too large", deviation_mm);
      cut_link(graph, cell, side);
      any = true;
    }
  }
  return any;
}

/// One surface for each rectangle. Where contacts that only agree in place add up to more than is allowed,
/// they are cut and the cells grouped again: each time at least one contact less.
std::vector<JoinedSurface> assemble_all(const std::vector<Source>& sources, CellGraph& graph,
                                        const JoinOptions& options, JoinReport& report,
                                        std::vector<int>& group_of_cell) {
  const double allowed = std::max(options.max_deviation_mm, options.tolerance_mm);
  while (true) {
    std::vector<JoinedSurface> out;
    bool again = false;
    for (const Rectangle& r : group(graph, options.grouping)) {
      auto surface = assemble(sources, graph, r, options.tolerance_mm);
      const bool bent_too_far = surface && surface->deviation_mm > allowed;
      if (bent_too_far && cut_inexact(sources, graph, r, surface->deviation_mm, report)) {
        again = true;
        continue;
      }
      if (surface) {
        for (const Placed& p : r.cells)
          group_of_cell[static_cast<std::size_t>(p.cell)] = static_cast<int>(out.size());
        out.push_back(std::move(*surface));
        continue;
      }
      // Too large for one net: its cells stay alone.
      for (const Placed& p : r.cells) {
        report_unjoined(report, patch_of(sources, graph, r.cells.front().cell),
                        patch_of(sources, graph, p.cell), surface.error().message);
        for (std::size_t side = 0; side < 4; ++side)
          if (graph.cells[static_cast<std::size_t>(p.cell)].links[side].cell >= 0)
            cut_link(graph, p.cell, side);
      }
      again = again || r.cells.size() > 1;
    }
    if (!again) return out;
  }
}

/// Neighbours that ended in different surfaces, each pair of patches once.
void report_borders(const std::vector<Source>& sources, const CellGraph& graph,
                    const std::vector<int>& group_of_cell, JoinReport& report) {
  std::set<std::pair<std::size_t, std::size_t>> seen;
  for (std::size_t i = 0; i < graph.cells.size(); ++i) {
    for (const Link& link : graph.cells[i].links) {
      if (link.cell < 0 || link.inner) continue;
      if (group_of_cell[i] == group_of_cell[static_cast<std::size_t>(link.cell)]) continue;
      const std::size_t a = patch_of(sources, graph, static_cast<int>(i)),
                        b = patch_of(sources, graph, link.cell);
      if (!seen.insert(std::minmax(a, b)).second) continue;
      report_unjoined(report, a, b, "the rectangles of the grouping end here");
    }
  }
}

}  // namespace

Point2 patch_parameters(const Member& m, Point2 joined) {
  const double u = bent(m.bend_u, m.u, joined.x), v = bent(m.bend_v, m.v, joined.y);
  return {m.pu[0] + m.pu[1] * u + m.pu[2] * v, m.pv[0] + m.pv[1] * u + m.pv[2] * v};
}

Point2 joined_parameters(const Member& m, Point2 patch) {
  const double x = patch.x - m.pu[0], y = patch.y - m.pv[0];
  const double det = m.pu[1] * m.pv[2] - m.pu[2] * m.pv[1];
  const double u = (x * m.pv[2] - y * m.pu[2]) / det, v = (y * m.pu[1] - x * m.pv[1]) / det;
  return {bent(1 / m.bend_u, m.u, u), bent(1 / m.bend_v, m.v, v)};
}

Result<Composite> join(const std::vector<NurbsSurface>& patches, const JoinOptions& options,
                       Diagnostics& diagnostics) {
  if (auto ok = check_input(patches, options); !ok) return std::move(ok).error();
  Composite out;
  std::vector<Source> sources;
  for (std::size_t i = 0; i < patches.size(); ++i)
    sources.push_back(source_of(patches[i], i, options.tolerance_mm));
  force_partial_joins(sources, options, out.report, diagnostics);
  const std::vector<Contact> contacts = find_contacts(sources, options, out.report, diagnostics);
  CellGraph graph = make_cells(sources, contacts, options, out.report);
  std::vector<int> group_of_cell(graph.cells.size(), -1);
  out.surfaces = assemble_all(sources, graph, options, out.report, group_of_cell);
  report_borders(sources, graph, group_of_cell, out.report);
  for (const JoinedSurface& s : out.surfaces) {
    for (const Joint& joint : s.joints) out.report.gap_max_mm = std::max(out.report.gap_max_mm, joint.gap_mm);
    out.report.deviation_max_mm = std::max(out.report.deviation_max_mm, s.deviation_mm);
  }
  return out;
}

}  // namespace burin::geom

// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/surface/join.h"

#include <algorithm>
#include <cmath>
#include <map>

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

/// A surface for each rectangle; cell by cell where the rectangle cannot become one.
void assemble_all(const std::vector<Source>& sources, const CellGraph& graph,
                  const std::vector<Rectangle>& rectangles, const JoinOptions& options, Composite& out,
                  std::vector<int>& group_of_cell) {
  const auto add = [&](JoinedSurface surface, const Rectangle& r) {
    for (const Placed& p : r.cells)
      group_of_cell[static_cast<std::size_t>(p.cell)] = static_cast<int>(out.surfaces.size());
    out.surfaces.push_back(std::move(surface));
  };
  for (const Rectangle& r : rectangles) {
    auto surface = assemble(sources, graph, r, options.tolerance_mm);
    if (surface) {
      add(std::move(*surface), r);
      continue;
    }
    for (const Placed& p : r.cells) {
      const Rectangle one{1, 1, {Placed{p.cell, {}}}};
      auto alone = assemble(sources, graph, one, options.tolerance_mm);
      const auto patch = [&](int cell) {
        return sources[static_cast<std::size_t>(graph.cells[static_cast<std::size_t>(cell)].source)].patch;
      };
      report_unjoined(out.report, patch(r.cells.front().cell), patch(p.cell), surface.error().message);
      if (alone) add(std::move(*alone), one);
    }
  }
}

/// Neighbours that ended in different surfaces, each pair of patches once.
void report_borders(const std::vector<Source>& sources, const CellGraph& graph,
                    const std::vector<int>& group_of_cell, JoinReport& report) {
  std::map<std::pair<std::size_t, std::size_t>, bool> seen;
  for (std::size_t i = 0; i < graph.cells.size(); ++i) {
    for (const Link& link : graph.cells[i].links) {
      if (link.cell < 0 || link.inner) continue;
      if (group_of_cell[i] == group_of_cell[static_cast<std::size_t>(link.cell)]) continue;
      const std::size_t a = sources[static_cast<std::size_t>(graph.cells[i].source)].patch;
      const std::size_t b =
          sources[static_cast<std::size_t>(graph.cells[static_cast<std::size_t>(link.cell)].source)].patch;
      if (!seen.insert({std::minmax(a, b), true}).second) continue;
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
  const CellGraph graph = make_cells(sources, contacts, options, out.report);
  std::vector<int> group_of_cell(graph.cells.size(), -1);
  assemble_all(sources, graph, group(graph, options.grouping), options, out, group_of_cell);
  report_borders(sources, graph, group_of_cell, out.report);
  for (const JoinedSurface& s : out.surfaces) {
    for (const Joint& joint : s.joints) out.report.gap_max_mm = std::max(out.report.gap_max_mm, joint.gap_mm);
    out.report.deviation_max_mm = std::max(out.report.deviation_max_mm, s.deviation_mm);
  }
  return out;
}

}  // namespace burin::geom

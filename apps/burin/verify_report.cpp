// SPDX-License-Identifier: Apache-2.0
#include "verify_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "burin/base/text.h"
#include "table.h"

namespace burin::cli {
namespace {

/// Decimals of millimetres: a tenth of what the check resolves.
constexpr int kDecimals = 4;

Json place(geom::Point3 p) {
  return {p.x, p.y, p.z};
}

/// Line of the CL or NC file, null when nobody knows.
Json line_of(const job::VerifyInput& input, std::uint32_t move) {
  const auto& moves = input.path.moves;
  return move < moves.size() && moves[move].line > 0 ? Json(moves[move].line) : Json(nullptr);
}

/// "move 17, line 42"
std::string where(const job::VerifyInput& input, std::uint32_t move) {
  const Json line = line_of(input, move);
  return "move " + std::to_string(move) + (line.is_null() ? "" : ", line " + line.dump());
}

Json tools_json(const verify::CheckedPath& path) {
  Json tools = Json::array();
  for (const verify::ToolPath& tool : path.tools) {
    Json above = Json::array();
    for (const verify::ToolCylinder& c : tool.tool.cylinders)
      above.push_back({{"kind", c.holder ? "holder" : "shank"},
                       {"radius_mm", c.radius},
                       {"from_mm", c.from},
                       {"to_mm", c.to}});
    tools.push_back({{"number", tool.tool_number},
                     {"radius_mm", tool.tool.radius},
                     {"corner_radius_mm", tool.tool.corner_radius},
                     {"length_mm", tool.tool.length},
                     {"above", std::move(above)}});
  }
  return tools;
}

void worst_json(const char* name, const job::VerifyInput& input, const verify::WorstDeviation& worst,
                Json& quality) {
  const std::string key = name;
  const bool any = worst.mm > 0;
  quality[key + "_max_mm"] = worst.mm;
  quality[key + "_at_mm"] = any ? place(worst.at) : Json(nullptr);
  quality[key + "_move"] = any ? Json(worst.move) : Json(nullptr);
  quality[key + "_line"] = any ? line_of(input, worst.move) : Json(nullptr);
}

Json histogram_json(const verify::Histogram& histogram) {
  // What is empty at both ends says nothing.
  const auto& area = histogram.area_mm2;
  std::size_t first = 0, last = area.size();
  while (first < last && area[first] == 0) ++first;
  while (last > first && area[last - 1] == 0) --last;
  return {{"from_mm", histogram.from_mm + static_cast<double>(first) * histogram.step_mm},
          {"step_mm", histogram.step_mm},
          {"area_mm2", std::vector<double>(area.begin() + static_cast<std::ptrdiff_t>(first),
                                           area.begin() + static_cast<std::ptrdiff_t>(last))}};
}

void fill_mill(const job::VerifyInput& input, const job::VerifyResult& result, Session& session) {
  const verify::DeviationReport& d = result.deviation;
  Json& q = session.report.quality;
  worst_json("gouge", input, d.gouge, q);
  q["gouge_area_mm2"] = d.gouge_area_mm2;
  worst_json("excess", input, d.excess, q);
  q["excess_mean_mm"] = d.excess_mean_mm;
  q["excess_area_mm2"] = d.excess_area_mm2;
  q["unmachined_area_mm2"] = d.unmachined_area_mm2;
  q["area_mm2"] = d.area_mm2;
  Json collisions = Json::array();
  for (const verify::Collision& c : result.collisions)
    collisions.push_back({{"move", c.move},
                          {"line", line_of(input, c.move)},
                          {"body", verify::name(c.body)},
                          {"against", verify::name(c.against)},
                          {"depth_mm", c.depth_mm},
                          {"at_mm", place(c.at)}});
  q["collisions"] = std::move(collisions);
  q["spacing_mm"] = result.surface.spacing_mm;
  q["bound_mm"] = result.bound_mm;
  q["motion_mm"] = input.path.motion_mm;
  q["deflection_mm"] = input.deflection_mm;
  q["histogram"] = histogram_json(result.histogram);
  if (result.removal) {
    q["stock_mm3"] = result.removal->stock_mm3();
    q["removed_mm3"] = result.removal->removed_mm3();
    q["resolution_mm"] = result.removal->resolution_mm();
  }
  session.report.counts["pieces"] = input.path.piece_count();
  session.report.counts["samples"] = result.surface.samples.size();
  session.report.counts["triangles"] = input.design.triangles.size();
  session.report.counts["obstacle_triangles"] = input.obstacles.triangles.size();
  session.report.counts["collisions"] = result.collisions.size();
  session.report.parameters["tools"] = tools_json(input.path);
}

/// The first few by name, for messages.
std::string names_of(const job::VerifyInput& input, const std::vector<std::uint32_t>& outlines) {
  constexpr std::size_t kMost = 8;
  std::string text;
  for (std::size_t i = 0; i < outlines.size() && i < kMost; ++i)
    text += (i > 0 ? ", " : "") + input.outline_names[outlines[i]];
  return outlines.size() <= kMost ? text : text + " and " + std::to_string(outlines.size() - kMost) + " more";
}

void fill_beam(const job::VerifyInput& input, const verify::BeamReport& b, double bound_mm,
               Session& session) {
  Json& q = session.report.quality;
  const auto worst = [&](const char* name, const verify::BeamWorst& w) {
    const std::string key = name;
    const bool any = w.mm > 0;
    q[key + "_max_mm"] = w.mm;
    q[key + "_at_mm"] = any ? Json({w.at.x, w.at.y, 0.0}) : Json(nullptr);
    q[key + "_move"] = any ? Json(w.move) : Json(nullptr);
    q[key + "_line"] = any ? line_of(input, w.move) : Json(nullptr);
  };
  worst("gouge", b.gouge);
  q["gouge_area_mm2"] = b.gouge_area_mm2;
  worst("excess", b.excess);
  q["excess_mean_mm"] = b.excess_mean_mm;
  q["excess_area_mm2"] = b.excess_area_mm2;
  worst("corner_excess", b.corner_excess);
  q["collisions"] = Json::array();
  q["spacing_mm"] = b.spacing_mm;
  q["bound_mm"] = bound_mm;
  session.report.counts["samples"] = b.places.size();
  session.report.counts["outlines"] = input.outlines.size();
  session.report.counts["uncut_outlines"] = b.uncut_outlines.size();
  session.report.lengths_mm["outline"] = b.outline_mm;
  session.report.lengths_mm["uncut"] = b.uncut_mm;
  session.report.parameters["kerf_mm"] = input.kerf_mm;
}

void say_collisions(const job::VerifyInput& input, const job::VerifyResult& result, Session& session) {
  // Deepest first: the messages show a few.
  std::vector<std::size_t> order(result.collisions.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return result.collisions[a].depth_mm > result.collisions[b].depth_mm;
  });
  constexpr std::size_t kSaid = 100;  // all are in quality.collisions
  for (std::size_t k = 0; k < std::min(order.size(), kSaid); ++k) {
    const verify::Collision& c = result.collisions[order[k]];
    session.diagnostics.add({Severity::left_out,
                             "collision",
                             std::string("the ") + std::string(verify::name(c.body)) + " runs " +
                                 format_fixed(c.depth_mm, kDecimals) + " mm into the " +
                                 std::string(verify::name(c.against)) + ": " + where(input, c.move),
                             {},
                             std::array{c.at.x, c.at.y, c.at.z}});
  }
  if (order.size() > kSaid)
    session.diagnostics.left_out("collision",
                                 std::to_string(order.size()) + " collisions in all; --json lists them");
}

struct Worst {
  double mm = 0;
  std::array<double, 3> at{};
  std::uint32_t move = 0;
};
Worst gouge_of(const job::VerifyResult& r) {
  if (r.beam) return {r.beam->gouge.mm, {r.beam->gouge.at.x, r.beam->gouge.at.y, 0}, r.beam->gouge.move};
  const auto& w = r.deviation.gouge;
  return {w.mm, {w.at.x, w.at.y, w.at.z}, w.move};
}
Worst excess_of(const job::VerifyResult& r) {
  if (r.beam) return {r.beam->excess.mm, {r.beam->excess.at.x, r.beam->excess.at.y, 0}, r.beam->excess.move};
  const auto& w = r.deviation.excess;
  return {w.mm, {w.at.x, w.at.y, w.at.z}, w.move};
}

std::string mm(double value) {
  return format_fixed(value, kDecimals) + " mm";
}

/// Nothing where nothing is known, else comma and number.
void add_row(std::string& text, std::initializer_list<double> values, double deviation) {
  for (const double v : values) {
    text += format_fixed(v, 6);
    text += ',';
  }
  if (!std::isnan(deviation)) text += format_fixed(deviation, 6);
  text += '\n';
}

}  // namespace

void fill_verify_report(const job::VerifyOptions& options, const job::VerifyInput& input,
                        const job::VerifyResult& result, Session& session) {
  Report& r = session.report;
  r.parameters = {{"path", options.path},
                  {"path_kind", input.program_is_nc ? "nc" : "cl"},
                  {"design_kind", input.operation.empty() ? Json(nullptr) : Json(input.operation)},
                  {"machine", input.machine ? Json(input.machine->machine().name) : Json(nullptr)},
                  {"tolerance_mm", input.tolerance_mm},
                  {"reach_mm", options.reach_mm}};
  const cl::Totals totals = cl::totals(input.program);
  r.counts["moves"] = totals.moves;
  r.lengths_mm = {{"feed", totals.feed_mm}, {"rapid", totals.rapid_mm}};
  if (result.beam)
    fill_beam(input, *result.beam, result.bound_mm, session);
  else
    fill_mill(input, result, session);
}

void judge_verify(const job::VerifyInput& input, const job::VerifyResult& result, const VerifyLimits& limits,
                  Session& session) {
  const auto say = [&](const char* what, const Worst& worst, double allowed) {
    if (worst.mm <= allowed + result.bound_mm) return;
    session.diagnostics.add({Severity::info,
                             what,
                             std::string(what) + " of " + mm(worst.mm) + ", the tolerance is " + mm(allowed) +
                                 ": " + where(input, worst.move),
                             {},
                             worst.at});
  };
  const Worst gouge = gouge_of(result), excess = excess_of(result);
  say("gouge", gouge, input.tolerance_mm);
  if (limits.gouge_mm && gouge.mm > *limits.gouge_mm)
    session.fall_short("a gouge of " + mm(gouge.mm) + " is more than --max-gouge " +
                       format_shortest(*limits.gouge_mm) + ": " + where(input, gouge.move));
  if (limits.excess_mm && excess.mm > *limits.excess_mm)
    session.fall_short("an excess of " + mm(excess.mm) + " is more than --max-excess " +
                       format_shortest(*limits.excess_mm) + ": " + where(input, excess.move));
  say_collisions(input, result, session);
  if (!result.beam && result.deviation.unmachined_area_mm2 > 0)
    session.diagnostics.left_out("unmachined",
                                 format_fixed(result.deviation.unmachined_area_mm2, 2) + " mm2 of " +
                                     format_fixed(result.deviation.area_mm2, 2) +
                                     " mm2 are not machined: nothing cuts within --reach of them");
  if (result.beam && result.beam->uncut_mm > 0)
    session.diagnostics.left_out("uncut", mm(result.beam->uncut_mm) + " of " + mm(result.beam->outline_mm) +
                                              " of the outlines are not cut (" +
                                              names_of(input, result.beam->uncut_outlines) + ")");
}

std::string verify_csv(const job::VerifyResult& result) {
  std::string text = "x,y,z,nx,ny,nz,deviation_mm\n";
  if (result.beam) {
    for (const verify::BeamPlace& p : result.beam->places)
      add_row(text, {p.p.x, p.p.y, 0.0, p.n.x, p.n.y, 0.0}, p.deviation_mm);
    return text;
  }
  const auto& samples = result.surface.samples;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const verify::SurfaceSample& s = samples[i];
    add_row(text, {s.p.x, s.p.y, s.p.z, s.n.x, s.n.y, s.n.z}, result.deviation.deviation_mm[i]);
  }
  return text;
}

std::string verify_summary(const job::VerifyInput& input, const job::VerifyResult& result) {
  std::vector<std::vector<std::string>> rows = {{"", "worst", "where", "by", "area beyond the tolerance"}};
  const auto row = [&](const char* name, const Worst& w, double area) {
    if (w.mm <= 0) return rows.push_back({name, "none", "", "", ""});
    rows.push_back(
        {name, mm(w.mm),
         format_fixed(w.at[0], 3) + ", " + format_fixed(w.at[1], 3) + ", " + format_fixed(w.at[2], 3),
         where(input, w.move), format_fixed(area, 3) + " mm2"});
  };
  const bool beam = result.beam.has_value();
  row("gouge", gouge_of(result), beam ? result.beam->gouge_area_mm2 : result.deviation.gouge_area_mm2);
  row("excess", excess_of(result), beam ? result.beam->excess_area_mm2 : result.deviation.excess_area_mm2);
  std::string text = table(rows);
  if (!beam) {
    text += "collisions   " + std::to_string(result.collisions.size()) + "\n";
    text += "unmachined   " + format_fixed(result.deviation.unmachined_area_mm2, 2) + " mm2 of " +
            format_fixed(result.deviation.area_mm2, 2) + " mm2\n";
    if (result.removal)
      text += "removed      " + format_fixed(result.removal->removed_mm3() / 1000, 3) + " cm3 of " +
              format_fixed(result.removal->stock_mm3() / 1000, 3) + " cm3\n";
  } else {
    text += "not cut      " + mm(result.beam->uncut_mm) + " of " + mm(result.beam->outline_mm) + "\n";
    if (result.beam->corner_excess.mm > 0)
      text +=
          "corners      " + mm(result.beam->corner_excess.mm) + " at most, where the beam does not fit in\n";
  }
  return text + "the true worst values lie within " + mm(result.bound_mm) + "\n";
}

}  // namespace burin::cli

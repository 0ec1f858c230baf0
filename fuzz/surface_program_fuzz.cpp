// SPDX-License-Identifier: Apache-2.0
// Surface programs: reading never fails badly; --strict accepts no more than reading does; what was read can
// be written, and is read again with the same surfaces.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "burin/nc/surface_program.h"

namespace {

using namespace burin;

void require(bool ok) {
  if (!ok) std::abort();
}

void check_steps(const nc::SurfaceProgram& program) {
  for (const nc::Step& step : program.steps) {
    if (const auto* curve = std::get_if<nc::CurveMove>(&step)) {
      require(geom::validate(curve->curve).ok() && curve->feed > 0);
      continue;
    }
    const auto* group = std::get_if<nc::MachineGroup>(&step);
    if (!group) continue;
    require(!group->blocks.empty() && (group->join || group->blocks.size() == 1));
    for (std::size_t block : group->blocks) require(block < program.blocks.size());
    require(group->tool_diameter > 0 && group->scallop > 0 && group->feed > 0 && group->stock >= 0);
    require(group->scallop < group->tool_diameter / 2);
    require(std::isfinite(group->safety_z) && std::isfinite(norm(group->displacement)));
  }
}

void check_written(const nc::SurfaceProgram& program) {
  constexpr int kDecimals = 6;
  const auto text = nc::write_surface_program(program.blocks, {.decimals = kDecimals});
  if (!text) return;  // different stocks, knots or weights that decimals cannot tell apart
  Diagnostics diagnostics;
  const auto back = nc::read_surface_program(*text, {.strict = true}, diagnostics);
  // Rounded to the decimals, a surface may have lost its area.
  if (!back) return require(back.error().message.find("control points lie") != std::string::npos);
  require(back->blocks.size() == program.blocks.size());
  for (std::size_t i = 0; i < back->blocks.size(); ++i) {
    const auto &a = program.blocks[i].surface, &b = back->blocks[i].surface;
    require(a.points.size() == b.points.size() && a.count_u == b.count_u && a.degree_u == b.degree_u &&
            a.degree_v == b.degree_v);
    for (std::size_t k = 0; k < a.points.size(); ++k)
      require(distance(geom::project(a.points[k]), geom::project(b.points[k])) <= 1e-6);
    require(program.blocks[i].trims.size() == back->blocks[i].trims.size());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  Diagnostics diagnostics, strict_diagnostics;
  const auto program = nc::read_surface_program(text, {.file_name = "fuzz.nc"}, diagnostics);
  const auto strict =
      nc::read_surface_program(text, {.file_name = "fuzz.nc", .strict = true}, strict_diagnostics);
  require(strict.ok() == (program.ok() && diagnostics.empty()));
  if (!program) {
    require(!program.error().message.empty() && program.error().where.line >= 1 &&
            program.error().where.column >= 1);
    return 0;
  }
  std::size_t points = 0;
  for (const nc::SurfaceBlock& block : program->blocks) {
    require(geom::validate(block.surface).ok());
    points += block.surface.points.size();
  }
  check_steps(*program);
  if (!program->blocks.empty() && points < 2000) check_written(*program);
  return 0;
}

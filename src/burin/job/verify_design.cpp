// SPDX-License-Identifier: Apache-2.0
#include "burin/job/verify_design.h"

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <utility>

#include "burin/io/stl/stl.h"
#include "burin/job/face_mesh.h"
#include "burin/job/file_kind.h"
#include "burin/job/verify_tools.h"
#include "burin/nc/surface_program.h"

namespace burin::job {
namespace {

namespace fs = std::filesystem;
using geom::Mesh;

constexpr double kTolerance_mm = 0.01;
// Share of the tolerance by which triangles of rotational parts may leave them.
constexpr double kRotaryShare = 1.0 / 20;

/// The triangles that `chosen` says, with the vertices they use, in the order of first use.
template <class Chosen>
Mesh cut_out(const Mesh& mesh, const Chosen& chosen) {
  constexpr std::uint32_t kNone = 0xffffffffu;
  std::vector<std::uint32_t> place(mesh.vertices.size(), kNone);
  Mesh out;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (!chosen(i)) continue;
    std::array<std::uint32_t, 3> t = mesh.triangles[i];
    for (std::uint32_t& v : t) {
      if (place[v] == kNone) {
        place[v] = static_cast<std::uint32_t>(out.vertices.size());
        out.vertices.push_back(mesh.vertices[v]);
      }
      v = place[v];
    }
    out.triangles.push_back(t);
  }
  return out;
}

// --- jobs

Result<void> load_rotary(const VerifyTables& tables, const FileSource& read, VerifyDesign& out,
                         Diagnostics& diagnostics) {
  RotaryJobFile job;
  job.part = tables.section;
  // The loader takes a share of the tolerance for the triangles; the planner's is too much for a check.
  const double share = std::holds_alternative<SectionPart>(job.part) ? kMeshShare : kFacetShare;
  job.options.tolerance_mm = *out.tolerance_mm * kRotaryShare / share;
  auto part = load_rotary_part(job, out.folder, read, diagnostics);
  if (!part) return part.error();
  // Beside a rim that is cut within the tolerance, an end face has lost much along its own normal: what is
  // not machined is only not to be touched.
  const std::vector<bool> machined = machined_triangles(*part);
  out.deflection_mm = part->deflection_mm;
  out.design = cut_out(part->mesh, [&](std::size_t t) { return machined[t]; });
  out.obstacles = cut_out(part->mesh, [&](std::size_t t) { return !machined[t]; });
  return {};
}

Result<void> load_faces(OrientJobFile job, const FileSource& read, VerifyDesign& out,
                        Diagnostics& diagnostics) {
  job.options.tolerance_mm = *out.tolerance_mm;
  auto part = load_orient_part(job, out.folder, read, diagnostics);
  if (!part) return part.error();
  out.deflection_mm = part->deflection_mm;
  const std::size_t design = part->design_triangles;
  out.design = cut_out(part->mesh, [=](std::size_t t) { return t < design; });
  out.obstacles = cut_out(part->mesh, [=](std::size_t t) { return t >= design; });
  return {};
}

Result<void> load_job(const std::string& text, const std::string& path, const FileSource& read,
                      VerifyDesign& out, Diagnostics& diagnostics) {
  auto tables = read_verify_tables(text, path);
  if (!tables) return tables.error();
  out.operation = tables->rotary ? "rotary" : "orient";
  out.tools = std::move(tables->tools);
  if (!out.tolerance_mm) out.tolerance_mm = tables->tolerance_mm.value_or(kTolerance_mm);
  out.machine = tables->machine;
  out.stock = std::move(tables->stock);
  return tables->rotary ? load_rotary(*tables, read, out, diagnostics)
                        : load_faces(std::move(tables->faces), read, out, diagnostics);
}

// --- surface programs

/// The patches as they stand in the program, not as they were joined.
Result<void> add_group(const nc::SurfaceProgram& program, const nc::MachineGroup& group, double tolerance,
                       VerifyDesign& out) {
  for (const std::size_t b : group.blocks) {
    const nc::SurfaceBlock& block = program.blocks[b];
    orient::DesignFace face{block.surface, false, {}, static_cast<int>(b) + 1};
    for (const nc::TrimLoop& loop : block.trims) face.trims.push_back(loop.points);
    Mesh patch;
    const auto reached = add_faces({face}, kDesignShare * tolerance, kMostDesignTriangles, patch);
    if (!reached) return reached.error();
    out.deflection_mm = std::max(out.deflection_mm, *reached);
    // The tool stands above: the patch as a whole faces +Z.
    double up = 0;
    for (const auto& t : patch.triangles)
      up += cross(patch.vertices[t[1]] - patch.vertices[t[0]], patch.vertices[t[2]] - patch.vertices[t[0]]).z;
    if (up < 0)
      for (auto& t : patch.triangles) std::swap(t[1], t[2]);
    for (geom::Point3& v : patch.vertices) v = v + group.displacement;
    append(out.design, patch);
    if (out.design.triangles.size() > 4 * kMostDesignTriangles)
      return Error{ErrorCode::range, "the surfaces need too many triangles (a coarser --tolerance)", {}};
  }
  return {};
}

/// Two diameters under one number say nothing.
void add_tool(double diameter, int number, VerifyDesign& out) {
  const cl::ToolChange ball{number, diameter, diameter / 2};
  const auto [at, added] = out.described.emplace(number, ball);
  if (!added && at->second != ball) at->second = {number, 0, 0};
}

Result<void> load_surfaces(const std::string& text, const std::string& path, VerifyDesign& out,
                           Diagnostics& diagnostics) {
  auto program = nc::read_surface_program(text, {.file_name = path}, diagnostics);
  if (!program) return program.error();
  out.operation = "cycle";
  if (!out.tolerance_mm) out.tolerance_mm = kTolerance_mm;
  int number = 0;
  bool stock_left = false;
  for (const nc::Step& step : program->steps) {
    if (const auto* plain = std::get_if<nc::Plain>(&step))
      if (const auto* change = std::get_if<cl::ToolChange>(&plain->record)) number = change->number;
    const auto* group = std::get_if<nc::MachineGroup>(&step);
    if (!group) continue;
    add_tool(group->tool_diameter, number, out);
    stock_left = stock_left || group->stock != 0;
    if (auto ok = add_group(*program, *group, *out.tolerance_mm, out); !ok) return ok;
  }
  if (out.design.triangles.empty())
    return Error{ErrorCode::geometry,
                 "the program has no surfaces (G06.23 blocks; or a job file, STEP, IGES, STL)",
                 {.file = path}};
  if (stock_left)
    diagnostics.info("stock_left", "the program leaves stock on its surfaces (L): it counts as excess",
                     {.file = path});
  return {};
}

}  // namespace

Result<Mesh> load_stl(const std::string& path, const FileSource& read, Diagnostics& diagnostics) {
  auto bytes = read(path);
  if (!bytes) return bytes.error();
  return io::read_stl(*bytes, {.file_name = path}, diagnostics);
}

Result<VerifyDesign> load_verify_design(const std::string& path, std::optional<double> tolerance_mm,
                                        const FileSource& read, Diagnostics& diagnostics) {
  auto bytes = read(path);
  if (!bytes) return bytes.error();
  VerifyDesign out;
  out.folder = fs::path(path).parent_path().string();
  out.tolerance_mm = tolerance_mm;
  const std::string name = fs::path(path).filename().string();
  // The loaders read the file by its name again: what was read comes back.
  const FileSource once = [&](const std::string& file) -> Result<std::string> {
    return file == (fs::path(out.folder) / name).string() ? *bytes : read(file);
  };
  Result<void> loaded;
  const FileKind kind = kind_of_file(*bytes, path);
  switch (kind) {
    case FileKind::job:
      loaded = load_job(*bytes, path, read, out, diagnostics);
      break;
    case FileKind::nc:
      loaded = load_surfaces(*bytes, path, out, diagnostics);
      break;
    case FileKind::step:
    case FileKind::iges:
    case FileKind::stl: {
      OrientJobFile job;
      if (kind == FileKind::stl)
        job.part = OrientMesh{name, false};
      else
        job.part = OrientSurface{name, {}, false};
      if (!out.tolerance_mm) out.tolerance_mm = kTolerance_mm;
      loaded = load_faces(std::move(job), once, out, diagnostics);
      break;
    }
    default:
      loaded = Error{ErrorCode::syntax,
                     "no design but " + std::string(describe(kind)) +
                         " (a job file, STEP, IGES, STL, a surface program; DXF or SVG with --kerf)",
                     {}};
  }
  if (!loaded) {
    Error error = loaded.error();
    if (error.where.file.empty()) error.where.file = path;
    return error;
  }
  return out;
}

}  // namespace burin::job

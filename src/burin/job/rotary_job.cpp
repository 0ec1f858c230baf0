// SPDX-License-Identifier: Apache-2.0
#include "burin/job/rotary_job.h"

#include <cmath>
#include <filesystem>

#include "burin/base/text.h"
#include "burin/io/stl/stl.h"
#include "burin/job/cad_part.h"
#include "burin/job/job_tables.h"
#include "burin/job/section_file.h"
#include "burin/model/toml_reader.h"

namespace burin::job {
namespace {

namespace fs = std::filesystem;
using geom::radians;
using model::TomlReader;

constexpr double kMaxLength = 1e5;  ///< mm: parts and tools beyond 100 m are slips
constexpr double kSmallest = 1e-4;  ///< mm: lengths below are slips too
constexpr double kMaxTurns = 1000;

// --- [part]

/// stations = [[x_mm, theta_deg], ...]
std::vector<rotary::Station> read_stations(TomlReader& reader, const toml::node& node) {
  const std::string wanted = " ([[x_mm, theta_deg], ...], at least two, x ascending from 0)";
  std::vector<rotary::Station> stations;
  const toml::array* array = node.as_array();
  if (array == nullptr || array->size() < 2) {
    reader.fail(node, "\"stations\" is not a list of stations" + wanted);
    return stations;
  }
  for (const toml::node& entry : *array) {
    const toml::array* pair = entry.as_array();
    if (pair == nullptr || pair->size() != 2 || !pair->get(0)->is_number() || !pair->get(1)->is_number()) {
      reader.fail(entry, "a station that is not a pair of numbers" + wanted);
      return stations;
    }
    const double x = *pair->get(0)->value<double>(), turn = *pair->get(1)->value<double>();
    const bool ascends = stations.empty() ? x == 0 : x > stations.back().x;
    if (!ascends || !(x <= kMaxLength) || !(std::abs(turn) <= 360 * kMaxTurns)) {
      reader.fail(entry, "station " + std::to_string(stations.size() + 1) + " at x " + format_shortest(x) +
                             ", " + format_shortest(turn) + " degrees" + wanted);
      return stations;
    }
    stations.push_back({x, radians(turn)});
  }
  return stations;
}

SectionPart read_swept(TomlReader& reader, const toml::table& table) {
  SectionPart part;
  part.file = reader.text(table, "section");
  if (const toml::node* stations = table.get("stations")) {
    for (const char* other : {"length", "twist"})
      if (const toml::node* node = table.get(other))
        reader.fail(*node, "\"" + std::string(other) + "\" beside \"stations\" (one or the other)");
    part.stations = read_stations(reader, *stations);
  } else {
    const double length = reader.number(table, "length", kSmallest, kMaxLength);
    const double twist = reader.number(table, "twist", -360 * kMaxTurns, 360 * kMaxTurns, 0.0);
    part.stations = {{0, 0}, {length, radians(twist)}};
  }
  return part;
}

LoftPart read_loft(TomlReader& reader, const toml::table& table) {
  LoftPart part;
  const std::vector<const toml::table*> sections = reader.tables(table, "sections");
  for (const toml::table* section : sections) {
    reader.only_keys(*section, {"file", "x"});
    LoftPart::Section entry{reader.text(*section, "file"),
                            reader.number(*section, "x", -kMaxLength, kMaxLength)};
    if (!part.sections.empty() && !(entry.x > part.sections.back().x))
      reader.fail(*section, "section at x " + format_shortest(entry.x) + " after one at x " +
                                format_shortest(part.sections.back().x) + " (x ascending)");
    part.sections.push_back(std::move(entry));
  }
  if (sections.size() < 2)
    reader.fail(*table.get("sections"), "fewer than two sections ([{file = \"a.dxf\", x = 0.0}, ...])");
  return part;
}

}  // namespace

RotaryPartSource read_rotary_part(TomlReader& reader, const toml::table& table) {
  const std::vector<std::string> kinds = {"section", "sections", "surface", "mesh"};
  std::string kind;
  for (const std::string& key : kinds) {
    if (!table.contains(key)) continue;
    if (!kind.empty())
      reader.fail(*table.get(key),
                  "\"" + key + "\" beside \"" + kind + "\" (one of section, sections, surface, mesh)");
    kind = key;
  }
  if (kind.empty()) reader.fail(table, "[part] has no shape (section, sections, surface or mesh)");
  if (kind == "section") {
    reader.only_keys(table, {"section", "length", "twist", "stations"});
    return read_swept(reader, table);
  }
  if (kind == "sections") {
    reader.only_keys(table, {"sections"});
    return read_loft(reader, table);
  }
  if (kind == "surface") {
    reader.only_keys(table, {"surface"});
    return SurfacePart{reader.text(table, "surface")};
  }
  reader.only_keys(table, {"section", "length", "twist", "stations", "sections", "surface", "mesh", "scale"});
  return MeshPart{reader.text(table, "mesh", ""), reader.number(table, "scale", 1e-6, 1e6, 1.0)};
}

// --- [tool]

namespace {

std::vector<model::HolderPiece> read_holder(TomlReader& reader, const toml::table& table) {
  std::vector<model::HolderPiece> holder;
  for (const toml::table* piece : reader.tables(table, "holder")) {
    reader.only_keys(*piece, {"radius", "height"});
    holder.push_back({reader.number(*piece, "radius", kSmallest, kMaxLength),
                      reader.number(*piece, "height", kSmallest, kMaxLength)});
  }
  return holder;
}

}  // namespace

model::BallTool read_ball_tool(TomlReader& reader, const toml::table& table,
                               const std::vector<std::string>& besides) {
  std::vector<std::string> keys = {"kind", "radius", "shank_radius", "shank_length", "holder"};
  keys.insert(keys.end(), besides.begin(), besides.end());
  reader.only_keys(table, keys);
  reader.choice<int>(table, "kind", {{"ball", 0}}, 0);
  model::BallTool tool;
  tool.radius = reader.number(table, "radius", kSmallest, kMaxLength);
  tool.shank_radius =
      reader.number(table, "shank_radius", kSmallest, kMaxLength, std::max(tool.radius, kSmallest));
  tool.shank_length = reader.number(table, "shank_length", kSmallest, kMaxLength, tool.shank_length);
  tool.holder = read_holder(reader, table);
  if (!reader.error())
    if (auto ok = model::validate(tool); !ok) reader.fail(table, ok.error().message, ok.error().code);
  return tool;
}

// --- [operation]

namespace {

rotary::RotaryOptions read_operation(TomlReader& reader, const toml::table& table) {
  reader.only_keys(table, {"pattern", "tolerance", "scallop", "side_step", "tsi", "tai", "clearance_angle",
                           "lean_angle", "smooth", "feed", "safety", "spindle"});
  rotary::RotaryOptions o;
  o.pattern = reader.choice<rotary::Pattern>(table, "pattern",
                                             {{"rings", rotary::Pattern::rings},
                                              {"spiral", rotary::Pattern::spiral},
                                              {"lines", rotary::Pattern::lines}},
                                             o.pattern);
  o.tolerance_mm = reader.number(table, "tolerance", 1e-4, 10, o.tolerance_mm);
  o.scallop = reader.number(table, "scallop", 1e-6, 1e3, o.scallop);
  if (const toml::node* node = table.get("side_step")) {
    if (table.contains("scallop")) reader.fail(*node, "\"side_step\" beside \"scallop\" (one or the other)");
    o.side_step = reader.number(table, "side_step", kSmallest, kMaxLength);
  }
  o.tsi = reader.choice<rotary::Tsi>(table, "tsi",
                                     {{"surface", rotary::Tsi::surface}, {"path", rotary::Tsi::path}}, o.tsi);
  o.tai = reader.choice<rotary::Tai>(
      table, "tai", {{"exact", rotary::Tai::exact}, {"section", rotary::Tai::section}}, o.tai);
  o.clearance = radians(reader.number(table, "clearance_angle", 0, 90, geom::degrees(o.clearance)));
  o.lean = radians(reader.number(table, "lean_angle", 0, 90, geom::degrees(o.lean)));
  o.smooth = reader.flag(table, "smooth", o.smooth);
  o.feed_mm_min = reader.number(table, "feed", 1e-3, 1e6, o.feed_mm_min);
  o.safety_mm = reader.number(table, "safety", 1e-3, kMaxLength, o.safety_mm);
  return o;
}

Error in(const std::string& file, Error error) {
  if (error.where.file.empty()) error.where.file = file;
  return error;
}

/// Share of the tolerance by which the section's fit may leave the drawing.
constexpr double kFitShare = 0.1;

}  // namespace

Result<RotaryJobFile> read_rotary_job(std::string_view text, const std::string& file_name) {
  TomlReader reader(file_name);
  const toml::table root = reader.parse(text);
  if (reader.error()) return *reader.error();
  reader.only_keys(root, {"part", "tool", "operation", "machine", "stock", "output"});
  RotaryJobFile job;
  job.part = read_rotary_part(reader, reader.subtable(root, "part"));
  job.tool = read_ball_tool(reader, reader.subtable(root, "tool"));
  if (root.contains("operation")) {
    const toml::table& operation = reader.subtable(root, "operation");
    job.options = read_operation(reader, operation);
    job.spindle_rpm = reader.number(operation, "spindle", 0, 1e6, 0.0);
  }
  if (root.contains("machine")) {
    const toml::table& machine = reader.subtable(root, "machine");
    reader.only_keys(machine, {"name"});
    job.machine = reader.text(machine, "name");
  }
  if (root.contains("stock")) {
    const toml::table& stock = reader.subtable(root, "stock");
    // The other keys are those of `burin verify`.
    reader.only_keys(stock, {"radius", "kind", "length", "axis", "base", "margin", "lo", "hi", "file"});
    if (stock.contains("radius"))
      job.options.stock_radius = reader.number(stock, "radius", kSmallest, kMaxLength);
  }
  if (reader.error()) return *reader.error();
  return job;
}

Result<rotary::Part> load_rotary_part(const RotaryJobFile& job, const std::string& folder,
                                      const FileSource& read, Diagnostics& diagnostics) {
  rotary::PartOptions options;
  const bool is_swept = std::holds_alternative<SectionPart>(job.part);
  options.deflection_mm = (is_swept ? kMeshShare : kFacetShare) * job.options.tolerance_mm;
  const auto path_of = [&](const std::string& file) { return (fs::path(folder) / file).string(); };
  const auto section = [&](const std::string& path) -> Result<geom::ArcSpline> {
    auto bytes = read(path);
    if (!bytes) return bytes.error();
    return read_section(*bytes, path, kFitShare * job.options.tolerance_mm, diagnostics);
  };
  if (const auto* swept = std::get_if<SectionPart>(&job.part)) {
    const std::string path = path_of(swept->file);
    auto curve = section(path);
    if (!curve) return in(path, curve.error());
    auto part = rotary::make_swept({std::move(*curve), swept->stations}, options);
    return part ? std::move(part) : in(path, part.error());
  }
  if (const auto* loft = std::get_if<LoftPart>(&job.part)) {
    std::vector<rotary::LoftSection> sections;
    for (const LoftPart::Section& s : loft->sections) {
      auto curve = section(path_of(s.file));
      if (!curve) return in(path_of(s.file), curve.error());
      sections.push_back({std::move(*curve), s.x});
    }
    return rotary::make_loft(sections, options);
  }
  const auto* mesh_part = std::get_if<MeshPart>(&job.part);
  const std::string path = path_of(mesh_part ? mesh_part->file : std::get<SurfacePart>(job.part).file);
  auto bytes = read(path);
  if (!bytes) return bytes.error();
  if (mesh_part == nullptr) {
    auto part = part_from_cad(*bytes, path, options, diagnostics);
    return part ? std::move(part) : in(path, part.error());
  }
  auto mesh = io::read_stl(*bytes, {.file_name = path, .scale = mesh_part->scale}, diagnostics);
  if (!mesh) return in(path, mesh.error());
  auto part = rotary::make_meshed(std::move(*mesh), fs::path(path).stem().string(), options, diagnostics);
  return part ? std::move(part) : in(path, part.error());
}

Result<RotaryJob> make_rotary_job(const RotaryJobFile& file, const kinematics::Kinematics& machine,
                                  const std::string& name, const std::string& folder, const FileSource& read,
                                  Diagnostics& diagnostics, ProgressSink* /*progress*/) {
  const bool fits = machine.rotary_count() == 1 && machine.table_only() &&
                    norm(machine.rotary_axis(0).direction - geom::Vec3{1, 0, 0}) < 1e-9 &&
                    norm(machine.rotary_axis(0).point - geom::Point3{}) < 1e-9;
  if (!fits)
    return Error{ErrorCode::unsupported,
                 "machine " + machine.machine().name +
                     " (one rotary axis in the table, along X through the origin: xyza)",
                 {}};
  RotaryJob job;
  auto part = load_rotary_part(file, folder, read, diagnostics);
  if (!part) return part.error();
  job.part = std::move(*part);
  rotary::RotaryOptions options = file.options;
  options.theta_min = radians(machine.rotary_axis(0).min);
  options.theta_max = radians(machine.rotary_axis(0).max);
  auto plan = rotary::plan(job.part, file.tool, options, diagnostics);
  if (!plan) return plan.error();
  job.plan = std::move(*plan);
  job.cl = rotary::to_cl(job.plan, file.tool, options, name);
  kinematics::JointPathOptions joints;
  joints.tolerance_mm = options.tolerance_mm;
  joints.joint_linear = true;
  auto path = kinematics::make_joint_path(machine, job.cl, joints);
  if (!path) return path.error();
  job.joints = std::move(*path);
  return job;
}

namespace {

/// Faces whose normal leaves the X axis by less are end faces: a ball beside the part cannot finish them.
constexpr double kEndFaceCosine = 0.999;

}  // namespace

std::vector<bool> machined_triangles(const rotary::Part& part) {
  std::vector<bool> machined;
  machined.reserve(part.mesh.triangles.size());
  for (const auto& t : part.mesh.triangles) {
    const geom::Point3 a = part.mesh.vertices[t[0]], b = part.mesh.vertices[t[1]],
                       c = part.mesh.vertices[t[2]];
    const geom::Vec3 n = unit(cross(b - a, c - a));
    const double x = (a.x + b.x + c.x) / 3;
    machined.push_back(std::abs(n.x) < kEndFaceCosine && x >= part.x_min && x <= part.x_max);
  }
  return machined;
}

namespace {

/// Points of the swept section itself, which the mesh only follows within its deflection.
void add_swept(const rotary::SweptSection& swept, double spacing_mm, std::size_t max_samples,
               verify::SampledDesign& design) {
  const double length = swept.stations.back().x;
  double most_turn = 0, radius = 0;
  for (std::size_t i = 1; i < swept.stations.size(); ++i)
    most_turn = std::max(most_turn, std::abs(swept.stations[i].turn - swept.stations[i - 1].turn) /
                                        (swept.stations[i].x - swept.stations[i - 1].x));
  const geom::Box2 box = bounds_of(swept.section);
  radius = std::max({std::hypot(box.lo.x, box.lo.y), std::hypot(box.hi.x, box.hi.y),
                     std::hypot(box.lo.x, box.hi.y), std::hypot(box.hi.x, box.lo.y)});
  const double stretch = std::sqrt(1 + most_turn * most_turn * radius * radius);
  const double area = length * stretch * length_of(swept.section);
  spacing_mm = std::max(spacing_mm, std::sqrt(area / static_cast<double>(max_samples)));
  design.spacing_mm = std::max(design.spacing_mm, spacing_mm);
  const int rows = std::max(1, static_cast<int>(std::ceil(length * stretch / spacing_mm)));
  for (int k = 0; k <= rows; ++k) {
    const double x = length * k / rows, turn = swept.turn_at(x);
    const double c = std::cos(turn), s = std::sin(turn);
    for (const geom::Segment& segment : swept.section.segments) {
      const int parts = std::max(1, static_cast<int>(std::ceil(length_of(segment) / spacing_mm)));
      for (int i = 0; i < parts; ++i) {
        const geom::Point2 p = point_on(segment, static_cast<double>(i) / parts);
        design.samples.push_back({{x, p.x * c - p.y * s, p.x * s + p.y * c}, true});
      }
    }
  }
}

verify::SampledDesign design_samples(const rotary::Part& part, double spacing_mm) {
  constexpr std::size_t kMaxSamples = 3'000'000;
  const std::vector<bool> machined = machined_triangles(part);
  if (!part.swept) return verify::sample_mesh(part.mesh, machined, spacing_mm, kMaxSamples);
  geom::Mesh ends;
  ends.vertices = part.mesh.vertices;
  for (std::size_t t = 0; t < machined.size(); ++t)
    if (!machined[t]) ends.triangles.push_back(part.mesh.triangles[t]);
  verify::SampledDesign design =
      verify::sample_mesh(ends, std::vector<bool>(ends.triangles.size(), false), spacing_mm, kMaxSamples);
  add_swept(*part.swept, spacing_mm, kMaxSamples, design);
  return design;
}

verify::BallEndTool checked_tool(const model::BallTool& tool) {
  verify::BallEndTool checked{tool.radius, {{tool.shank_radius, 0, tool.shank_length, false}}};
  double at = tool.shank_length;
  for (const model::HolderPiece& piece : tool.holder) {
    checked.cylinders.push_back({piece.radius, at, at + piece.height, true});
    at += piece.height;
  }
  return checked;
}

/// Which joint moves cut: those of the records that are no rapids. (Approaches and links at feed touch
/// nothing that the cut does not touch.)
std::vector<verify::CheckedMove> checked_moves(const kinematics::JointPath& path) {
  std::vector<verify::CheckedMove> moves;
  moves.reserve(path.moves.size());
  for (const kinematics::JointMove& move : path.moves) moves.push_back({move.to, !move.rapid});
  return moves;
}

}  // namespace

RotaryCheck check_rotary_moves(const rotary::Part& part, const model::BallTool& tool,
                               const std::vector<verify::CheckedMove>& moves,
                               const kinematics::Kinematics& machine, double tolerance_mm) {
  // Samples so close that what lies between them adds a tenth of the tolerance.
  const double least = std::min(tool.radius, tool.shank_radius);
  RotaryCheck check;
  check.design = design_samples(part, std::sqrt(4 * least * 0.1 * tolerance_mm));
  verify::MotionCheckOptions options;
  options.motion_mm = 0.02 * tolerance_mm;
  check.report = verify::check_motion(check.design, moves, machine, checked_tool(tool), options);
  check.bound_mm = check.report.bound_mm + (part.swept ? 0 : part.deflection_mm);
  return check;
}

RotaryCheck check_rotary_job(const RotaryJobFile& file, const RotaryJob& job,
                             const kinematics::Kinematics& machine) {
  return check_rotary_moves(job.part, file.tool, checked_moves(job.joints), machine,
                            file.options.tolerance_mm);
}

}  // namespace burin::job

// SPDX-License-Identifier: Apache-2.0
// burin surfaces: faces of a STEP or IGES part -> a program of surface blocks and one cycle.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>

#include "burin/base/text.h"
#include "burin/geom/point_tools.h"
#include "burin/geom/surface/evaluate.h"
#include "burin/io/step/read_step.h"
#include "burin/nc/surface_program.h"
#include "cli.h"
#include "commands.h"
#include "table.h"

namespace burin::cli {
namespace {

namespace fs = std::filesystem;
using geom::Point3;
using geom::Vec3;

enum class Up { px, mx, py, my, pz, mz };

struct SurfacesArgs {
  std::string part;
  std::vector<std::string> faces;
  bool all = false, list = false;
  Up up = Up::pz;
  std::string origin = "part";
  double stock_mm = 0;
  std::optional<double> safety_mm;
  nc::SurfaceWriteOptions write;
};

Error usage(std::string message) {
  return {ErrorCode::usage, std::move(message), {}};
}

// --- which faces, where ------------------------------------------------------------------------------------

/// "1,3,5-9", several times; ascending, without repetitions.
Result<std::vector<int>> parse_faces(const std::vector<std::string>& lists) {
  constexpr long long kMost = 1'000'000;
  std::vector<int> faces;
  for (const std::string& list : lists) {
    for (std::size_t from = 0; from <= list.size();) {
      const std::size_t comma = std::min(list.find(',', from), list.size());
      const std::string_view item = trim(std::string_view(list).substr(from, comma - from));
      from = comma + 1;
      const std::size_t dash = item.find('-');
      const auto first = parse_integer(item.substr(0, dash));
      const auto last = dash == std::string_view::npos ? first : parse_integer(item.substr(dash + 1));
      if (!first || !last || *first < 1 || *last < *first || *last > kMost) {
        return usage("--faces: " + (item.empty() ? std::string("an empty number") : std::string(item)) +
                     " is not understood (numbers of faces from 1 and ranges, such as 1,3,5-9)");
      }
      for (long long i = *first; i <= *last; ++i) faces.push_back(static_cast<int>(i));
      if (faces.size() > static_cast<std::size_t>(kMost))
        return usage("--faces: too many (at most a million)");
    }
  }
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  return faces;
}

/// Axes of the part as the tool sees them: the turn that brings the upward axis to +Z, then a shift.
struct Setup {
  Up up = Up::pz;
  Vec3 shift;

  Vec3 turned(Vec3 v) const {
    switch (up) {
      case Up::px:
        return {-v.z, v.y, v.x};
      case Up::mx:
        return {v.z, v.y, -v.x};
      case Up::py:
        return {v.x, -v.z, v.y};
      case Up::my:
        return {v.x, v.z, -v.y};
      case Up::pz:
        return v;
      case Up::mz:
        return {v.x, -v.y, -v.z};
    }
    return v;
  }
  Point3 operator()(Point3 p) const { return Point3{} + turned(p - Point3{}) + shift; }
  geom::Box3 operator()(const geom::Box3& b) const {
    geom::Box3 out;
    if (b.empty()) return out;
    out.add((*this)(b.lo));
    out.add((*this)(b.hi));  // turns by right angles keep boxes boxes
    return out;
  }
  geom::NurbsSurface operator()(geom::NurbsSurface s) const {
    for (geom::HPoint& h : s.points) h = homogeneous((*this)(project(h)), h.w);
    return s;
  }
};

/// A zero farther off than any machine reaches is a mistake.
constexpr double kMostOrigin_mm = 1e6;

/// "part", "top", "corner" or X,Y,Z in the axes of the program.
Result<Vec3> shift_of(const std::string& origin, const geom::Box3& box) {
  const std::string word = to_lower(origin);
  if (word == "part") return Vec3{};
  if (word == "top") return Vec3{-0.5 * (box.lo.x + box.hi.x), -0.5 * (box.lo.y + box.hi.y), -box.hi.z};
  if (word == "corner") return Vec3{-box.lo.x, -box.lo.y, -box.hi.z};
  const Error not_understood =
      usage("--origin: " + origin + " is not understood (part, top, corner, or a point X,Y,Z in mm)");
  std::vector<double> values;
  for (std::size_t from = 0; from <= origin.size();) {
    const std::size_t comma = std::min(origin.find(',', from), origin.size());
    const auto value = parse_double(std::string_view(origin).substr(from, comma - from));
    from = comma + 1;
    if (!value || std::abs(*value) > kMostOrigin_mm) return not_understood;
    values.push_back(*value);
  }
  if (values.size() != 3) return not_understood;
  return Vec3{-values[0], -values[1], -values[2]};
}

// --- which of them a tool from above can reach -------------------------------------------------------------

bool inside(const std::vector<io::TrimLoop>& loops, geom::Point2 q) {
  bool in = loops.empty();
  for (const io::TrimLoop& loop : loops) in ^= geom::inside_polygon(loop.points, q);
  return in;
}

struct Reach {
  double up = -1;    ///< largest upward part of the outward normal
  double down = -1;  ///< largest downward part
};
/// Over a grid of the face (and its boundary where the grid misses it). The normal of a sheet counts with
/// both sides.
Reach reach_of(const io::CadFace& face, const Setup& setup) {
  constexpr int kGrid = 16;
  Reach reach;
  const auto look = [&](double u, double v) {
    Vec3 n = setup.turned(geom::normal(face.surface, u, v));
    if (face.reversed) n = -n;
    if (!face.of_solid) n.z = std::abs(n.z);
    reach.up = std::max(reach.up, n.z);
    reach.down = std::max(reach.down, -n.z);
  };
  const geom::Interval u = face.surface.domain(geom::Direction::u),
                       v = face.surface.domain(geom::Direction::v);
  for (int j = 0; j <= kGrid; ++j) {
    for (int i = 0; i <= kGrid; ++i) {
      const geom::Point2 q{u.lo + u.length() * i / kGrid, v.lo + v.length() * j / kGrid};
      if (inside(face.loops, q)) look(q.x, q.y);
    }
  }
  for (const io::TrimLoop& loop : face.loops) {
    for (const geom::Point2 q : loop.points) look(q.x, q.y);
  }
  return reach;
}

/// Normals that rise less above the horizontal (0.06 degrees) are those of walls, whatever rounding says.
constexpr double kUpward = 1e-3;

struct Chosen {
  const io::CadFace* face = nullptr;
  bool taken = false;
  std::string why_not;
};

std::vector<Chosen> choose_faces(const io::CadModel& model, const SurfacesArgs& args, const Setup& setup,
                                 Diagnostics& diagnostics) {
  std::vector<Chosen> list;
  for (const io::CadFace& face : model.faces) {
    Chosen chosen{&face, true, ""};
    const Reach reach = reach_of(face, setup);
    const bool reachable = reach.up > kUpward;
    if (!reachable) chosen.why_not = reach.down > kUpward ? "faces downwards" : "is an upright wall";
    if (!reachable && args.faces.empty() && !args.all) chosen.taken = false;
    const std::string name = "face " + std::to_string(face.number) + " (" + face.kind + ")";
    if (!chosen.taken) {
      diagnostics.left_out("face_unreachable", name + " " + chosen.why_not +
                                                   ": no tool from above reaches it (--up for another side, "
                                                   "--faces or --all to take it nevertheless)");
    } else if (!reachable) {
      diagnostics.info("face_unreachable", name + " " + chosen.why_not + ", taken because it was asked for");
    } else if (reach.down > kUpward) {
      diagnostics.info("face_partly_down",
                       name + " faces downwards in part: only what the tool reaches from above is cut");
    }
    list.push_back(std::move(chosen));
  }
  return list;
}

// --- blocks and report -------------------------------------------------------------------------------------

nc::SurfaceBlock block_of(const io::CadFace& face, const SurfacesArgs& args, const Setup& setup) {
  nc::SurfaceBlock block;
  block.surface = setup(face.surface);
  block.tool_diameter = args.write.tool_diameter;
  block.stock = args.stock_mm;
  block.feed = args.write.feed;
  block.scallop = args.write.scallop;
  for (const io::TrimLoop& loop : face.loops) block.trims.push_back({loop.points});
  return block;
}

Json box_json(const geom::Box3& b) {
  return {{"min", {b.lo.x, b.lo.y, b.lo.z}}, {"max", {b.hi.x, b.hi.y, b.hi.z}}};
}

std::string by(int a, int b) {
  return std::to_string(a) + "x" + std::to_string(b);
}

std::string faces_table(const std::vector<Chosen>& chosen, const Setup& setup) {
  std::vector<std::vector<std::string>> rows{
      {"face", "kind", "name", "degrees", "points", "trimmed", "from", "to", "taken"}};
  const auto xyz = [](Point3 p) {
    return format_fixed(p.x, 2) + " " + format_fixed(p.y, 2) + " " + format_fixed(p.z, 2);
  };
  for (const Chosen& c : chosen) {
    const io::CadFace& f = *c.face;
    const geom::Box3 box = setup(f.box);
    rows.push_back(
        {std::to_string(f.number), f.kind, f.name.empty() ? "-" : f.name,
         by(f.surface.degree_u, f.surface.degree_v), by(f.surface.count_u, f.surface.count_v),
         f.trimmed ? std::to_string(f.loops.size()) + (f.loops.size() == 1 ? " loop" : " loops") : "no",
         xyz(box.lo), xyz(box.hi), c.taken ? "yes" : "no: " + c.why_not});
  }
  return table(rows);
}

Json faces_json(const std::vector<Chosen>& chosen, const Setup& setup) {
  Json list = Json::array();
  for (const Chosen& c : chosen) {
    const io::CadFace& f = *c.face;
    list.push_back({{"number", f.number},
                    {"kind", f.kind},
                    {"name", f.name},
                    {"degree_u", f.surface.degree_u},
                    {"degree_v", f.surface.degree_v},
                    {"count_u", f.surface.count_u},
                    {"count_v", f.surface.count_v},
                    {"trimmed", f.trimmed},
                    {"loops", f.loops.size()},
                    {"of_solid", f.of_solid},
                    {"box_mm", box_json(setup(f.box))},
                    {"taken", c.taken},
                    {"reason", c.why_not}});
  }
  return list;
}

const char* up_word(Up up) {
  switch (up) {
    case Up::px:
      return "+X";
    case Up::mx:
      return "-X";
    case Up::py:
      return "+Y";
    case Up::my:
      return "-Y";
    case Up::pz:
      return "+Z";
    case Up::mz:
      return "-Z";
  }
  return "";
}

void fill_report(const SurfacesArgs& args, const nc::SurfaceWriteOptions& write, const io::CadModel& model,
                 const Setup& setup, const std::vector<Chosen>& chosen, Session& session) {
  session.report.parameters = {{"unit", model.unit},
                               {"up", up_word(args.up)},
                               {"origin_mm", {-setup.shift.x, -setup.shift.y, -setup.shift.z}},
                               {"group", "E" + std::to_string(static_cast<int>(write.grouping))},
                               {"method", "I" + std::to_string(static_cast<int>(write.method))},
                               {"tool_diameter_mm", write.tool_diameter},
                               {"scallop_mm", write.scallop},
                               {"side_step_mm", write.side_step ? Json(*write.side_step) : Json(nullptr)},
                               {"stock_mm", args.stock_mm},
                               {"feed_mm_min", write.feed},
                               {"safety_z_mm", write.safety_z},
                               {"tolerance_mm", session.common.tolerance_mm}};
  std::size_t taken = 0, trimmed = 0, points = 0, loops = 0;
  for (const Chosen& c : chosen) {
    if (!c.taken) continue;
    ++taken;
    trimmed += c.face->trimmed;
    points += c.face->surface.points.size();
    for (const io::TrimLoop& loop : c.face->loops) loops += loop.points.size();
  }
  session.report.counts = {
      {"faces", chosen.size()}, {"blocks", taken},          {"left_out", chosen.size() - taken},
      {"trimmed", trimmed},     {"control_points", points}, {"trim_points", loops}};
  session.report.extra["name"] = model.name;
  session.report.extra["box_mm"] = box_json(setup(model.bounds));
  session.report.extra["faces"] = faces_json(chosen, setup);
}

// --- the run -----------------------------------------------------------------------------------------------

/// Room above the part for rapid moves when --safety is not given, mm.
constexpr double kClearance = 10;

Result<std::string> program_text(const std::vector<Chosen>& chosen, const SurfacesArgs& args,
                                 const Setup& setup, const nc::SurfaceWriteOptions& write) {
  std::vector<nc::SurfaceBlock> blocks;
  for (const Chosen& c : chosen) {
    if (c.taken) blocks.push_back(block_of(*c.face, args, setup));
  }
  if (blocks.empty()) {
    return Error{
        ErrorCode::geometry,
        "none of its faces can be reached from above (--up for another side, --faces or --all to take "
        "them nevertheless)",
        {}};
  }
  return nc::write_surface_program(blocks, write);
}

/// The part turned upright, and the safety height above it.
Result<Setup> setup_of(const SurfacesArgs& args, const io::CadModel& model, nc::SurfaceWriteOptions& write) {
  Setup setup;
  setup.up = args.up;
  auto shift = shift_of(args.origin, setup(model.bounds));
  if (!shift) return shift.error();
  setup.shift = *shift;
  const double top = setup(model.bounds).hi.z;
  // Rounded up to 0.1 mm: a number that can be read.
  write.safety_z = args.safety_mm ? *args.safety_mm : std::ceil((top + args.stock_mm + kClearance) * 10) / 10;
  if (args.safety_mm && *args.safety_mm <= top + args.stock_mm) {
    return usage("--safety: " + format_fixed(*args.safety_mm, 4) +
                 " is not above the part, whose top lies at Z" + format_fixed(top + args.stock_mm, 4) +
                 " (a height above it)");
  }
  return setup;
}

Result<void> run_surfaces(const SurfacesArgs& args, Session& session) {
  const bool writes = !args.list || !session.common.output.empty();
  const std::string nc_path = session.common.output.empty()
                                  ? fs::path(args.part).replace_extension(".nc").string()
                                  : session.common.output;
  io::ReadCadOptions read;
  read.file_name = args.part;
  // Half of the tolerance; the other half is for the path.
  read.trim_tolerance_mm = 0.5 * session.common.tolerance_mm;
  auto wanted = parse_faces(args.faces);
  if (!wanted) return wanted.error();
  read.faces = *wanted;
  nc::SurfaceWriteOptions write = args.write;
  write.name = fs::path(args.part).stem().string();
  if (auto ok = shift_of(args.origin, {}); !ok && ok.error().code == ErrorCode::usage) return ok.error();

  auto bytes = session.read_input(args.part);
  if (!bytes) return bytes.error();
  if (writes && session.common.output.empty()) {
    if (auto ok = session.reserve_output(nc_path); !ok) return ok;
  }
  auto model = io::read_cad(*bytes, read, session.diagnostics);
  if (!model) return model.error();
  auto setup = setup_of(args, *model, write);
  if (!setup) return setup.error();
  const std::vector<Chosen> chosen = choose_faces(*model, args, *setup, session.diagnostics);
  session.diagnostics.locate(args.part);
  fill_report(args, write, *model, *setup, chosen, session);
  if (args.list) session.print(faces_table(chosen, *setup));
  if (!writes) return {};
  auto text = program_text(chosen, args, *setup, write);
  if (!text) return in_file(text.error(), args.part);
  return session.put(nc_path, std::move(*text));
}

void add_part_options(CLI::App& app, SurfacesArgs& a) {
  app.add_option("--faces", a.faces,
                 "numbers of faces as --list shows them, such as 1,3,5-9 (default: all that face upwards)")
      ->type_name("LIST");
  app.add_flag("--all", a.all, "also faces that no tool from above reaches");
  app.add_flag("--list", a.list, "print a table of the faces; no program unless -o is given");
  add_choice<Up>(app, "--up", a.up,
                 {{"+Z", Up::pz},
                  {"-Z", Up::mz},
                  {"+X", Up::px},
                  {"-X", Up::mx},
                  {"+Y", Up::py},
                  {"-Y", Up::my},
                  {"Z", Up::pz},
                  {"X", Up::px},
                  {"Y", Up::py}},
                 "axis of the part that points at the tool (default +Z)");
  add_text(app, "--origin", a.origin, "part|top|corner|X,Y,Z",
           "zero of the program: the part's own, the middle or the corner of its top, or a point");
}

void add_cycle_options(CLI::App& app, SurfacesArgs& a) {
  nc::SurfaceWriteOptions& w = a.write;
  add_number(app, "--tool-diameter", w.tool_diameter, kPositiveLength, "ball-end mill (default 6)");
  add_number(app, "--scallop", w.scallop, kPositiveLength, "largest scallop height (default 0.01)");
  add_number(app, "--feed", w.feed, kSpeed, "feed (default 1000)");
  add_choice<geom::Grouping>(
      app, "--group", w.grouping,
      {{"E1", geom::Grouping::largest},
       {"E2", geom::Grouping::first_block},
       {"E3", geom::Grouping::u_first},
       {"E4", geom::Grouping::v_first}},
      "how surfaces are joined: largest, from the first, along u, along v (default E1)");
  add_choice<nc::PathMethod>(app, "--method", w.method,
                             {{"I1", nc::PathMethod::iso_parametric}, {"I2", nc::PathMethod::iso_scallop}},
                             "iso-parametric or iso-scallop paths (default I2)");
  add_number(app, "--side-step", w.side_step, kPositiveLength, "largest distance of neighbouring paths");
  add_number(app, "--stock", a.stock_mm, kLength, "stock left on the surfaces (default 0)");
  add_number(app, "--safety", a.safety_mm, kSignedLength, "Z of rapid moves (default: 10 above the part)");
}

}  // namespace

void add_surfaces(Cli& cli) {
  auto args = std::make_shared<SurfacesArgs>();
  CLI::App& app = cli.add_command(
      "surfaces", "turn faces of a STEP or IGES part into a surface program for burin cycle",
      "  burin surfaces blade.step --list\n"
      "  burin surfaces blade.step --tool-diameter 8 --scallop 0.005 --feed 2000 -o blade.nc\n"
      "  burin surfaces die.igs --faces 12,14-19 --group E3 --method I1 -o cavity.nc\n"
      "  burin surfaces hull.igs --up=-Y --origin top --safety 25 -o hull.nc\n",
      [args](Session& session) { return run_surfaces(*args, session); });
  app.add_option("part", args->part, "part, STEP or IGES (by content)")->required()->type_name("PART");
  add_part_options(app, *args);
  add_cycle_options(app, *args);
  cli.add_tolerance(app);
  cli.add_output(app, "surface program (default: the part's name with .nc)");
  cli.add_json(app);
}

}  // namespace burin::cli

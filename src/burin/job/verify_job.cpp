// SPDX-License-Identifier: Apache-2.0
#include "burin/job/verify_job.h"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <utility>

#include "burin/base/text.h"
#include "burin/job/file_kind.h"
#include "burin/job/machine_file.h"
#include "burin/job/program_file.h"
#include "burin/job/verify_design.h"
#include "burin/job/verify_tools.h"
#include "burin/kinematics/joint_path.h"
#include "burin/verify/slivers.h"

namespace burin::job {
namespace {

using kinematics::Kinematics;

double least_radius(const verify::CheckedPath& path) {
  double least = 0;
  for (const verify::ToolPath& tool : path.tools) {
    const double radius = tool.tool.corner_radius > 0 ? tool.tool.corner_radius : tool.tool.radius;
    least = least > 0 ? std::min(least, radius) : radius;
  }
  return least;
}

class Reader {
 public:
  Reader(const VerifyOptions& options, const FileSource& read, Diagnostics& diagnostics)
      : options_(options), read_(read), diagnostics_(diagnostics) {}

  Result<VerifyInput> run() {
    if (is_drawing(options_.design)) return laser();
    auto design = load_verify_design(options_.design, options_.tolerance_mm, read_, diagnostics_);
    if (!design) return design.error();
    design_ = std::move(*design);
    if (auto ok = machine(); !ok) return ok.error();
    if (auto ok = program(); !ok) return ok.error();
    if (auto ok = path(); !ok) return ok.error();
    if (auto ok = stock(); !ok) return ok.error();
    in_.operation = design_.operation;
    in_.obstacles = std::move(design_.obstacles);
    in_.deflection_mm = design_.deflection_mm;
    in_.tolerance_mm = *design_.tolerance_mm;
    // Designs of many faces are meshed in slivers; a spacing that --samples asks for is not known yet.
    in_.design = verify::cut_slivers(
        design_.design, options_.spacing_mm.value_or(verify::usual_spacing(least_radius(in_.path))));
    return std::move(in_);
  }

 private:
  Result<VerifyInput> laser() {
    if (!options_.kerf_mm)
      return Error{ErrorCode::usage, "a drawing needs the width of the cut (--kerf MM)", {}};
    auto bytes = read_(options_.design);
    if (!bytes) return bytes.error();
    auto outlines = read_laser_outlines(*bytes, options_.design, options_.laser, diagnostics_);
    if (!outlines) return outlines.error();
    auto text = read_(options_.path);
    if (!text) return text.error();
    auto program = read_laser_program(*text, options_.path, diagnostics_);
    if (!program) return program.error();
    in_.operation = "laser";
    in_.outlines = std::move(outlines->outlines);
    in_.outline_names = std::move(outlines->names);
    in_.deflection_mm = outlines->bound_mm;
    in_.kerf_mm = *options_.kerf_mm;
    in_.tolerance_mm = options_.tolerance_mm.value_or(in_.tolerance_mm);
    in_.program = std::move(*program);
    in_.program_is_nc = kind_of_file(*text, options_.path) == FileKind::nc;
    in_.program_text = std::move(*text);
    for (std::uint32_t r = 0; r < in_.program.records.size(); ++r)
      if (cl::is_motion(in_.program.records[r])) in_.path.moves.push_back(origin_of(r));
    return std::move(in_);
  }

  /// A machine file of the command line stands where that says, one of the job beside the job.
  Result<void> machine() {
    auto machine = options_.machine ? load_machine(*options_.machine, "", read_)
                                    : load_machine(design_.machine, design_.folder, read_);
    if (!machine) return machine.error();
    in_.machine = std::move(*machine);
    const bool rotary = in_.machine && in_.machine->rotary_count() > 0;
    if (options_.joints && !rotary)
      return Error{ErrorCode::usage, "--joints needs a machine with rotary axes (--machine)", {}};
    return {};
  }

  Result<void> program() {
    auto text = read_(options_.path);
    if (!text) return text.error();
    const bool rotary = in_.machine && in_.machine->rotary_count() > 0;
    auto file = read_program(*text, options_.path, rotary ? &*in_.machine : nullptr, diagnostics_);
    if (!file) {
      Error error = file.error();
      if (!in_.machine && error.message.find("the axis ") == 0)
        error.message += "; --machine says which axes there are";
      return error;
    }
    in_.program = std::move(file->program);
    in_.program_is_nc = file->is_nc;
    in_.joints = std::move(file->joints);
    in_.tip_straight = std::move(file->tip_straight);
    moving_.unknown = std::move(file->unknown);
    // Programs begin at an origin that is made up: the way of a first rapid is the machine's.
    const auto& records = in_.program.records;
    const auto first = std::find_if(records.begin(), records.end(), cl::is_motion);
    if (std::holds_alternative<cl::Rapid>(*first)) in_.program.from.reset();
    design_.described.merge(file->described);
    in_.program_text = std::move(*text);
    return {};
  }

  Result<void> path() {
    geom::Box3 box;
    for (const geom::Point3& v : design_.design.vertices) box.add(v);
    ToolFinder tools(std::move(design_.tools),
                     {options_.tool_diameter, options_.tool_corner, options_.tool_length},
                     std::move(design_.described), box.diagonal(), diagnostics_);
    tools.program(in_.program);
    const verify::ToolSource source = [&tools](const cl::ToolChange& change) { return tools(change); };
    auto path = !in_.joints.empty() ? verify::make_checked_path(in_.program, in_.joints, in_.tip_straight,
                                                                *in_.machine, source, moving_)
                : as_joints()       ? posted(source)
                                    : verify::make_checked_path(in_.program, source, moving_);
    if (!path) {
      Error error = path.error();
      if (error.where.line > 0) error.where.file = options_.path;
      return error;
    }
    in_.path = std::move(*path);
    return {};
  }

  /// CL data of the rotary planner mean moves of the joints; others only when asked for.
  bool as_joints() const {
    const bool rotary = in_.machine && in_.machine->rotary_count() > 0;
    return rotary && !in_.program_is_nc && !options_.tcp &&
           (options_.joints || design_.operation == "rotary");
  }

  verify::MoveOrigin origin_of(std::uint32_t record) const {
    const std::uint32_t line = in_.program.source[record];
    return {record, line == cl::Program::kNoSource ? 0 : line,
            std::holds_alternative<cl::Rapid>(in_.program.records[record])};
  }

  /// The moves as a control without tool-centre-point control gets them; what is found is said of the CL
  /// data.
  Result<verify::CheckedPath> posted(const verify::ToolSource& source) {
    kinematics::JointPathOptions post;
    post.tolerance_mm = *design_.tolerance_mm;
    post.joint_linear = design_.operation == "rotary";
    auto joints = kinematics::make_joint_path(*in_.machine, in_.program, post);
    if (!joints) return joints.error();
    const auto& moves = joints->moves;
    cl::Program program;
    std::vector<std::uint32_t> move_of, record_of;
    std::vector<verify::MoveOrigin> origins;
    std::size_t next = 0;
    for (std::uint32_t r = 0; r < in_.program.records.size(); ++r) {
      const cl::Record& record = in_.program.records[r];
      if (std::holds_alternative<cl::ToolChange>(record)) program.add(record);
      if (!cl::is_motion(record)) continue;
      for (; next < moves.size() && moves[next].record == r; ++next) {
        const cl::Pose to = in_.machine->forward(moves[next].to);
        if (moves[next].rapid)
          program.add(cl::Rapid{to}, in_.program.source[r]);
        else
          program.add(cl::Feed{to}, in_.program.source[r]);
        in_.joints.push_back(moves[next].to);
        move_of.push_back(static_cast<std::uint32_t>(origins.size()));
      }
      origins.push_back(origin_of(r));
    }
    auto path = verify::make_checked_path(program, in_.joints, {}, *in_.machine, source, moving_);
    in_.joints.clear();  // they do not belong to the motions of the program one by one
    if (!path) return path;
    for (verify::ToolPath& tool : path->tools)
      for (verify::PathPiece& piece : tool.pieces) piece.move = move_of[piece.move];
    path->moves = std::move(origins);
    return path;
  }

  Result<void> stock() {
    std::optional<StockTable> table = std::move(design_.stock);
    std::string folder = design_.folder;
    if (options_.stock) {
      folder.clear();
      if (*options_.stock == "block") {
        constexpr double m = kStockMargin_mm;
        table = BlockTable{{}, {}, {m, m, m}};
      } else if (*options_.stock == "cylinder") {
        CylinderTable cylinder;
        if (design_.operation == "rotary") cylinder.axis = {1, 0, 0};
        cylinder.margin = kStockMargin_mm;
        table = cylinder;
      } else {
        table = StockFile{*options_.stock};
      }
    }
    if (!table) return {};
    geom::Mesh mesh;
    std::string file;
    if (const auto* from = std::get_if<StockFile>(&*table)) {
      file = (std::filesystem::path(folder) / from->path).string();
      auto read = load_stl(file, read_, diagnostics_);
      if (!read) return read.error();
      mesh = std::move(*read);
    }
    auto stock = make_stock(*table, design_.design, std::move(mesh));
    if (!stock) {
      Error error = stock.error();
      error.message = "stock: " + error.message;
      if (error.where.file.empty()) error.where.file = file;
      return error;
    }
    in_.stock = std::move(*stock);
    return {};
  }

  const VerifyOptions& options_;
  const FileSource& read_;
  Diagnostics& diagnostics_;
  VerifyDesign design_;
  VerifyInput in_;
  verify::PathOptions moving_;
};

// --- running

constexpr std::size_t kBins = 200;

Result<void> run_beam(const VerifyInput& input, const VerifyOptions& options, VerifyResult& result) {
  verify::BeamCheckOptions beam;
  beam.kerf_mm = input.kerf_mm;
  beam.reach_mm = options.reach_mm;
  beam.tolerance_mm = input.tolerance_mm;
  beam.spacing_mm = options.spacing_mm.value_or(0);
  beam.threads = options.threads;
  auto report = verify::check_beam(input.outlines, input.program, beam);
  if (!report) return report.error();
  result.bound_mm = report->bound_mm + input.deflection_mm;
  result.beam = std::move(*report);
  return {};
}

Result<void> run_deviation(const VerifyInput& input, const VerifyOptions& options, VerifyResult& result,
                           ProgressSink* progress) {
  verify::SampleOptions sampling;
  sampling.spacing_mm = options.spacing_mm;
  sampling.count = options.samples;
  sampling.least_radius_mm = least_radius(input.path);
  auto surface = verify::sample_surface(input.design, input.machined, input.normals, sampling);
  if (!surface) return surface.error();
  result.surface = std::move(*surface);
  verify::DeviationOptions measuring;
  measuring.reach_mm = options.reach_mm;
  measuring.tolerance_mm = input.tolerance_mm;
  measuring.threads = options.threads;
  auto deviation = verify::measure_deviation(input.design, result.surface, input.path, measuring, progress);
  if (!deviation) return deviation.error();
  result.deviation = std::move(*deviation);
  result.histogram = verify::histogram(result.surface, result.deviation, kBins);
  result.bound_mm = result.deviation.bound_mm + input.deflection_mm;
  return {};
}

Result<void> run_collisions(const VerifyInput& input, const VerifyOptions& options, VerifyResult& result,
                            Diagnostics& diagnostics, ProgressSink* progress) {
  verify::CollisionOptions colliding;
  colliding.tolerance_mm = input.tolerance_mm;
  colliding.threads = options.threads;
  auto report = verify::find_collisions(input.design, input.obstacles, input.path, colliding, progress);
  if (!report) return report.error();
  if (report->count > report->collisions.size())
    diagnostics.info("collisions_not_listed", "of " + std::to_string(report->count) + " collisions the " +
                                                  std::to_string(report->collisions.size()) +
                                                  " deepest are listed");
  result.collisions = std::move(report->collisions);
  return {};
}

Result<void> run_removal(const VerifyInput& input, const VerifyOptions& options, VerifyResult& result,
                         ProgressSink* progress) {
  if (!input.stock) return {};
  removal::RemovalOptions removing;
  removing.resolution_mm = options.resolution_mm;
  removing.threads = options.threads;
  removing.keep_times = options.keep_times;
  auto removal = removal::remove_material(*input.stock, input.path, removing, progress);
  if (!removal) return removal.error();
  for (const removal::StockContact& c : removal->contacts())
    result.collisions.push_back({c.move, c.body, verify::Against::stock, c.depth_mm, c.at});
  std::stable_sort(result.collisions.begin(), result.collisions.end(),
                   [](const verify::Collision& a, const verify::Collision& b) { return a.move < b.move; });
  result.removal = std::move(*removal);
  return {};
}

Result<VerifyResult> run(const VerifyInput& input, const VerifyOptions& options, Diagnostics& diagnostics,
                         ProgressSink* progress) {
  VerifyResult result;
  if (input.operation == "laser") {
    if (auto ok = run_beam(input, options, result); !ok) return ok.error();
    return result;
  }
  if (auto ok = run_deviation(input, options, result, progress); !ok) return ok.error();
  if (auto ok = run_collisions(input, options, result, diagnostics, progress); !ok) return ok.error();
  if (auto ok = run_removal(input, options, result, progress); !ok) return ok.error();
  return result;
}

/// What libraries throw (no memory above all) becomes an error.
template <class Work>
auto guarded(const Work& work) -> decltype(work()) {
  try {
    return work();
  } catch (const std::bad_alloc&) {
    return Error{ErrorCode::range, "not enough memory (fewer --samples, a wider --spacing)", {}};
  } catch (const std::exception& problem) {
    return Error{ErrorCode::internal, problem.what(), {}};
  }
}

}  // namespace

bool VerifyResult::clean() const {
  if (beam) return beam->uncut_mm == 0;
  return collisions.empty() && deviation.unmachined_area_mm2 == 0;
}

Result<VerifyInput> read_verify_input(const VerifyOptions& options, const FileSource& read,
                                      Diagnostics& diagnostics, ProgressSink*) {
  return guarded([&] { return Reader(options, read, diagnostics).run(); });
}

Result<VerifyResult> run_verify(const VerifyInput& input, const VerifyOptions& options,
                                Diagnostics& diagnostics, ProgressSink* progress) {
  return guarded([&] { return run(input, options, diagnostics, progress); });
}

}  // namespace burin::job

// SPDX-License-Identifier: Apache-2.0
#include "view_files.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "burin/base/text.h"
#include "burin/io/dxf/read_dxf.h"
#include "burin/io/svg/read_svg.h"
#include "burin/job/file_kind.h"
#include "burin/job/machine_file.h"
#include "burin/job/program_file.h"
#include "burin/job/verify_design.h"
#include "burin/view/outline_scene.h"
#include "burin/view/path_scene.h"
#include "burin/view/verify_scene.h"

namespace burin::cli {
namespace {

using job::FileKind;

/// Triangles of parts that are only shown leave them by a fortieth of it.
constexpr double kTolerance_mm = 0.5;
/// Places of the surface that are measured when nobody says how many.
constexpr std::size_t kSamples = 200'000;
/// Ends of arcs may lie so far off their circle.
constexpr double kArcEnds_mm = 0.05;
constexpr std::size_t kMostRows = 20'000;  ///< of a report

struct Input {
  std::string path, bytes;
  FileKind kind = FileKind::unknown;
  bool surfaces = false;  ///< NC of surface blocks
  bool taken = false;     ///< stands in the scene
};

Error usage(std::string message) {
  return {ErrorCode::usage, std::move(message), {}};
}
std::string base_name(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

/// A surface program is a design: what machines it is planned, not read.
bool has_surfaces(std::string_view text) {
  for (const char* word : {"G06.23", "G6.23", "g06.23", "g6.23"})
    if (text.find(word) != std::string_view::npos) return true;
  return false;
}

/// The work on the files, one after the other.
class SceneReader {
 public:
  SceneReader(const ViewOptions& options, Session& session) : options_(options), session_(session) {}

  Result<view::Scene> run(const std::vector<std::string>& files) {
    if (auto ok = read_all(files); !ok) return ok.error();
    if (auto ok = checked() ? add_checked() : add_plain(); !ok) return ok.error();
    for (const Input& input : inputs_) {
      if (input.taken) continue;
      if (auto ok = add(input); !ok) return in_file(ok.error(), input.path);
    }
    if (scene_.title.empty()) scene_.title = title();
    scene_.command_line = session_.command_line;
    if (scene_.operation.empty()) scene_.operation = "view";
    return std::move(scene_);
  }

 private:
  Result<void> read_all(const std::vector<std::string>& files) {
    for (const std::string& path : files) {
      auto bytes = session_.read_input(path);
      if (!bytes) return bytes.error();
      const FileKind kind = job::kind_of_file(*bytes, path);
      const bool surfaces = kind == FileKind::nc && has_surfaces(*bytes);
      inputs_.push_back({path, *std::move(bytes), kind, surfaces, false});
    }
    for (Input& input : inputs_) {
      const bool program = (input.kind == FileKind::cl || input.kind == FileKind::nc) && !input.surfaces;
      if (program && path_) return usage("two tool paths are too many (one CL or NC file)");
      if (program) path_ = &input;
      // A job knows more about the part than its bare shape.
      if (is_design(input) && (!design_ || input.kind == FileKind::job)) design_ = &input;
      if (is_drawing(input) && !drawing_) drawing_ = &input;
    }
    return {};
  }

  static bool is_design(const Input& input) {
    return input.surfaces || input.kind == FileKind::job || input.kind == FileKind::step ||
           input.kind == FileKind::iges || input.kind == FileKind::stl;
  }
  static bool is_drawing(const Input& input) {
    return input.kind == FileKind::dxf || input.kind == FileKind::svg;
  }
  std::string title() const {
    std::string out;
    for (const Input& input : inputs_) out += (out.empty() ? "" : ", ") + base_name(input.path);
    return out;
  }
  /// What was read is not read again.
  job::FileSource source() const {
    return [this](const std::string& path) -> Result<std::string> {
      for (const Input& input : inputs_)
        if (input.path == path) return input.bytes;
      return session_.read_input(path);
    };
  }

  // --- design and path together

  bool beam_checked() const {
    return drawing_ && path_ && !design_ && options_.check.kerf_mm && options_.verify;
  }
  bool checked() const {
    if (beam_checked()) return true;
    return design_ && path_ && (design_->kind == FileKind::job || options_.verify || !options_.stock.empty());
  }

  Result<void> add_checked() {
    job::VerifyOptions check = options_.check;
    Input& design = beam_checked() ? *drawing_ : *design_;
    check.design = design.path;
    check.path = path_->path;
    if (!options_.machine.empty()) check.machine = options_.machine;
    if (!options_.stock.empty()) check.stock = options_.stock;
    if (!check.samples && !check.spacing_mm) check.samples = kSamples;
    check.threads = static_cast<unsigned>(session_.common.threads);
    check.keep_times = true;
    auto input = job::read_verify_input(check, source(), session_.diagnostics, session_.progress());
    if (!input) return input.error();
    std::optional<job::VerifyResult> result;
    if (options_.verify) {
      auto run = job::run_verify(*input, check, session_.diagnostics, session_.progress());
      if (!run) return run.error();
      result = *std::move(run);
    } else if (input->stock) {
      if (auto ok = cut_stock(*input, check, result); !ok) return ok;
    }
    session_.end_progress();
    view::VerifySceneOptions options;
    options.title = title();
    options.program_name = base_name(path_->path);
    auto scene = view::verify_scene(*input, result ? &*result : nullptr, nullptr, options);
    if (!scene) return scene.error();
    scene_ = *std::move(scene);
    design.taken = path_->taken = true;
    return {};
  }

  Result<void> cut_stock(const job::VerifyInput& input, const job::VerifyOptions& check,
                         std::optional<job::VerifyResult>& result) {
    removal::RemovalOptions removing;
    removing.resolution_mm = check.resolution_mm;
    removing.threads = check.threads;
    removing.keep_times = true;
    auto removal = removal::remove_material(*input.stock, input.path, removing, session_.progress());
    if (!removal) return removal.error();
    result.emplace().removal = *std::move(removal);
    return {};
  }

  // --- one by one

  Result<void> add_plain() {
    if (!path_) return {};
    path_->taken = true;
    auto ok = add_path(*path_);
    return ok ? ok : in_file(ok.error(), path_->path);
  }

  Result<void> add(const Input& input) {
    switch (input.kind) {
      case FileKind::job:
      case FileKind::step:
      case FileKind::iges:
      case FileKind::stl:
        return add_part(input);
      case FileKind::dxf:
      case FileKind::svg:
        return add_drawing(input);
      case FileKind::json:
        return add_report(input);
      case FileKind::cl:
      case FileKind::nc:
        if (input.surfaces) return add_part(input);
        break;
      case FileKind::csv:
      case FileKind::unknown:
        break;
    }
    return Error{ErrorCode::syntax,
                 "is " + std::string(job::describe(input.kind)) +
                     " (CL, NC, a job, STEP, IGES, STL, DXF, SVG, a JSON report of burin)",
                 {}};
  }

  Result<void> add_path(const Input& input) {
    auto machine = job::load_machine(options_.machine.empty() ? "none" : options_.machine, "", source());
    if (!machine) return machine.error();
    const kinematics::Kinematics* rotary = *machine && (*machine)->rotary_count() > 0 ? &**machine : nullptr;
    auto file = job::read_program(input.bytes, input.path, rotary, session_.diagnostics);
    if (!file) return file.error();
    if (file->is_nc && !rotary && (options_.check.kerf_mm || drawing_ || is_flat_beam(file->program))) {
      Diagnostics again;  // the messages are those of the first time
      if (auto beam = job::read_laser_program(input.bytes, input.path, again))
        file->program = *std::move(beam);
    }
    if (auto ok = cl::validate(file->program, kArcEnds_mm); !ok) return ok.error();
    view::PathView path;
    path.program = &file->program;
    path.joints = file->joints.empty() ? nullptr : &file->joints;
    path.tip_straight = file->tip_straight.empty() ? nullptr : &file->tip_straight;
    path.machine = *machine ? &**machine : nullptr;
    path.kerf_mm = options_.check.kerf_mm.value_or(0);
    if (auto ok = view::put_path(path, scene_); !ok) return ok;
    scene_.program_name = base_name(input.path);
    scene_.program_text = input.bytes;
    path_figures(cl::totals(file->program));
    return {};
  }
  void path_figures(const cl::Totals& totals) {
    const auto figure = [this](const char* name, const std::string& value) {
      scene_.figures.push_back({"path", name, value});
    };
    figure("moves", std::to_string(totals.moves));
    figure("feed", format_fixed(totals.feed_mm, 1) + " mm");
    figure("rapid", format_fixed(totals.rapid_mm, 1) + " mm");
    figure("time", format_fixed(scene_.path.time_s.back(), 1) + " s");
  }

  /// A program that switches something on and off again and never leaves its plane cuts with a beam.
  static bool is_flat_beam(const cl::Program& program) {
    int on = 0, off = 0;
    std::optional<double> height;
    for (const cl::Record& record : program.records) {
      if (const auto* spindle = std::get_if<cl::Spindle>(&record)) {
        ++(spindle->rotation == cl::Rotation::off ? off : on);
      } else if (const cl::Pose* pose = cl::pose_of(record)) {
        if (height && *height != pose->tip.z) return false;
        height = pose->tip.z;
      }
    }
    return on > 0 && off > 0;
  }

  Result<void> add_part(const Input& input) {
    auto design = job::load_verify_design(input.path, kTolerance_mm, source(), session_.diagnostics);
    if (!design) return design.error();
    view::SceneMesh out;
    out.name = base_name(input.path);
    out.mesh = std::move(design->design);
    scene_.meshes.push_back(std::move(out));
    if (design->obstacles.triangles.empty()) return {};
    view::SceneMesh around;
    around.name = "obstacles";
    around.role = view::MeshRole::obstacle;
    around.mesh = std::move(design->obstacles);
    scene_.meshes.push_back(std::move(around));
    return {};
  }
  Result<void> add_drawing(const Input& input) {
    io::ReadOptions options;
    options.file_name = input.path;
    auto drawing = input.kind == FileKind::dxf ? io::read_dxf(input.bytes, options, session_.diagnostics)
                                               : io::read_svg(input.bytes, options, session_.diagnostics);
    if (!drawing) return drawing.error();
    auto outlines = view::scene_outlines(*drawing);
    std::move(outlines.begin(), outlines.end(), std::back_inserter(scene_.outlines));
    return {};
  }

  // --- reports

  Result<void> add_report(const Input& input) {
    const Json report = Json::parse(input.bytes, nullptr, false);
    if (report.is_discarded() || !report.is_object())
      return Error{ErrorCode::syntax, "is no JSON object (a report that burin wrote with --json)", {}};
    for (const auto& [group, values] : report.items()) {
      if (group == "warnings") {
        add_warnings(values);
      } else {
        add_figures(group, "", values, 0);
      }
    }
    if (report.contains("operation") && report["operation"].is_string())
      scene_.operation = report["operation"];
    return {};
  }
  void add_figures(const std::string& group, const std::string& name, const Json& value, int depth) {
    constexpr int kDeepest = 4;
    if (scene_.figures.size() >= kMostRows) return;
    if (value.is_object() && depth < kDeepest) {
      for (const auto& [key, inner] : value.items())
        add_figures(group, name.empty() ? key : name + "." + key, inner, depth + 1);
      return;
    }
    const std::string text = value.is_string() ? value.get<std::string>()
                                               : value.dump(-1, ' ', false, Json::error_handler_t::replace);
    constexpr std::size_t kLongest = 300;
    scene_.figures.push_back({group, name.empty() ? group : name,
                              text.size() > kLongest ? text.substr(0, kLongest) + "..." : text});
  }
  void add_warnings(const Json& warnings) {
    if (!warnings.is_array()) return;
    for (const Json& w : warnings) {
      if (!w.is_object() || scene_.findings.size() >= kMostRows) continue;
      const auto text = [&w](const char* key) {
        return w.contains(key) && w[key].is_string() ? w[key].get<std::string>() : std::string();
      };
      view::SceneFinding f;
      f.level = text("severity") == "left_out" ? view::SceneFinding::Level::warning
                                               : view::SceneFinding::Level::info;
      f.title = text("message");
      f.detail = text("code");
      const Json at = w.value("position_mm", Json());
      if (at.is_array() && at.size() == 3 && at[0].is_number() && at[1].is_number() && at[2].is_number())
        f.at = geom::Point3{at[0], at[1], at[2]};
      scene_.findings.push_back(std::move(f));
    }
  }

  const ViewOptions& options_;
  Session& session_;
  std::vector<Input> inputs_;
  Input *path_ = nullptr, *design_ = nullptr, *drawing_ = nullptr;
  view::Scene scene_;
};

}  // namespace

Result<view::Scene> scene_of_files(const std::vector<std::string>& files, const ViewOptions& options,
                                   Session& session) {
  return SceneReader(options, session).run(files);
}

}  // namespace burin::cli

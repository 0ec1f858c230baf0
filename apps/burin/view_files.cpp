// SPDX-License-Identifier: Apache-2.0
#include "view_files.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "burin/base/text.h"
#include "burin/cl/apt.h"
#include "burin/io/dxf/read_dxf.h"
#include "burin/io/step/read_step.h"
#include "burin/io/stl/stl.h"
#include "burin/io/svg/read_svg.h"
#include "burin/job/file_kind.h"
#include "burin/model/machine.h"
#include "burin/nc/program.h"
#include "burin/view/outline_scene.h"
#include "burin/view/path_scene.h"

namespace burin::cli {
namespace {

using job::FileKind;

/// Faces are drawn within this, and with neighbours bent by at most this angle.
constexpr double kDeflection_mm = 0.02, kAngle = 0.2;
constexpr std::size_t kMostRows = 20'000;  ///< of a report

struct Input {
  std::string path, bytes;
  FileKind kind = FileKind::unknown;
};

Error usage(std::string message) {
  return {ErrorCode::usage, std::move(message), {}};
}
std::string base_name(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

/// The work on the files, one after the other.
class SceneReader {
 public:
  SceneReader(const ViewOptions& options, Session& session) : options_(options), session_(session) {}

  Result<view::Scene> run(const std::vector<std::string>& files) {
    if (auto ok = read_all(files); !ok) return ok.error();
    if (auto ok = find_machine(); !ok) return ok.error();
    for (const Input& input : inputs_) {
      auto ok = add(input);
      if (!ok) return in_file(ok.error(), input.path);
    }
    for (const Input& input : inputs_)
      scene_.title += (scene_.title.empty() ? "" : ", ") + base_name(input.path);
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
      inputs_.push_back({path, *std::move(bytes), kind});
    }
    const auto paths = std::count_if(inputs_.begin(), inputs_.end(), [](const Input& i) {
      return i.kind == FileKind::cl || i.kind == FileKind::nc;
    });
    if (paths > 1) return usage(std::to_string(paths) + " tool paths are too many (one CL or NC file)");
    return {};
  }

  Result<void> find_machine() {
    if (options_.machine.empty()) return {};
    auto machine = model::find_machine(options_.machine);
    if (!machine) return machine.error();
    auto kinematics = kinematics::Kinematics::make(*machine);
    if (kinematics) {
      machine_ = *std::move(kinematics);
      return {};
    }
    const bool rotary = std::any_of(machine->axes.begin(), machine->axes.end(),
                                    [](const model::Axis& a) { return a.kind == model::AxisKind::rotary; });
    // Machines of two axes have no kinematics, and none is needed to show what they do.
    return rotary ? Result<void>(kinematics.error()) : Result<void>{};
  }

  Result<void> add(const Input& input) {
    switch (input.kind) {
      case FileKind::cl:
        return add_cl(input);
      case FileKind::nc:
        return add_nc(input);
      case FileKind::step:
      case FileKind::iges:
        return add_cad(input);
      case FileKind::stl:
        return add_stl(input);
      case FileKind::dxf:
      case FileKind::svg:
        return add_drawing(input);
      case FileKind::json:
        return add_report(input);
      case FileKind::job:
      case FileKind::csv:
      case FileKind::unknown:
        break;
    }
    return Error{ErrorCode::syntax,
                 "is " + std::string(job::describe(input.kind)) +
                     " (CL, NC, STEP, IGES, STL, DXF, SVG, a JSON report of burin)",
                 {}};
  }

  // --- tool paths

  Result<void> add_cl(const Input& input) {
    auto program = cl::read_apt(input.bytes, {.file_name = input.path}, session_.diagnostics);
    if (!program) return program.error();
    return add_program(input, *program, nullptr);
  }

  Result<void> add_nc(const Input& input) {
    nc::InterpretOptions options;
    options.file_name = input.path;
    options.beam = options_.kerf_mm.has_value() || has_drawing();
    if (machine_ && machine_->rotary_count() > 0) {
      options.machine = &*machine_;
      auto read = nc::interpret_joints(input.bytes, options, session_.diagnostics);
      if (!read) return read.error();
      return add_program(input, read->program, &read->joints);
    }
    auto program = nc::interpret(input.bytes, options, session_.diagnostics);
    if (!program) return program.error();
    if (!options.beam && is_flat_beam(*program)) {
      options.beam = true;
      Diagnostics again;  // the messages are those of the first time
      if (auto beam = nc::interpret(input.bytes, options, again); beam) program = std::move(beam);
    }
    return add_program(input, *program, nullptr);
  }

  bool has_drawing() const {
    return std::any_of(inputs_.begin(), inputs_.end(),
                       [](const Input& i) { return i.kind == FileKind::dxf || i.kind == FileKind::svg; });
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

  Result<void> add_program(const Input& input, const cl::Program& program,
                           const std::vector<kinematics::Joints>* joints) {
    if (program.move_count() == 0) return Error{ErrorCode::syntax, "holds no motion (GOTO or G0 to G3)", {}};
    if (auto ok = cl::validate(program, 0.05); !ok) return ok.error();
    view::PathView path;
    path.program = &program;
    path.joints = joints;
    path.machine = machine_ ? &*machine_ : nullptr;
    path.kerf_mm = options_.kerf_mm.value_or(0);
    if (auto ok = view::put_path(path, scene_); !ok) return ok;
    scene_.program_name = base_name(input.path);
    scene_.program_text = input.bytes;
    const cl::Totals totals = cl::totals(program);
    const auto figure = [this](const char* name, const std::string& value) {
      scene_.figures.push_back({"path", name, value});
    };
    figure("moves", std::to_string(totals.moves));
    figure("feed", format_fixed(totals.feed_mm, 1) + " mm");
    figure("rapid", format_fixed(totals.rapid_mm, 1) + " mm");
    figure("time", format_fixed(scene_.path.time_s.back(), 1) + " s");
    return {};
  }

  // --- parts

  void add_mesh(const Input& input, geom::Mesh mesh) {
    view::SceneMesh out;
    out.name = base_name(input.path);
    out.mesh = std::move(mesh);
    scene_.meshes.push_back(std::move(out));
  }
  Result<void> add_cad(const Input& input) {
    auto cad =
        io::mesh_cad(input.bytes, {.file_name = input.path}, kDeflection_mm, kAngle, session_.diagnostics);
    if (!cad) return cad.error();
    add_mesh(input, std::move(cad->mesh));
    return {};
  }
  Result<void> add_stl(const Input& input) {
    auto mesh = io::read_stl(input.bytes, {.file_name = input.path}, session_.diagnostics);
    if (!mesh) return mesh.error();
    add_mesh(input, *std::move(mesh));
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
  std::optional<kinematics::Kinematics> machine_;
  view::Scene scene_;
};

}  // namespace

Result<view::Scene> scene_of_files(const std::vector<std::string>& files, const ViewOptions& options,
                                   Session& session) {
  return SceneReader(options, session).run(files);
}

}  // namespace burin::cli

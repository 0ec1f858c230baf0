// SPDX-License-Identifier: Apache-2.0
// What the viewer shows: part, tool path, tools, machine, stock, findings. Any operation fills what it has;
// the page shows what is there. mm, degrees, s. docs/viewer.md says how it becomes bytes.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "burin/base/diagnostics.h"
#include "burin/base/result.h"
#include "burin/geom/mesh/mesh.h"
#include "burin/geom/vec.h"
#include "burin/removal/removal.h"

namespace burin::view {

enum class WayKind : std::uint8_t {
  rapid = 0,
  feed = 1,   ///< cutting
  link = 2,   ///< feed move that does not cut: approach, retract, beam off
  dwell = 3,  ///< in place
};

/// Columns, one row a node of the path; row 0 is where the motion begins. What a row says of a way is about
/// the way that ends there. Arcs and joint-linear moves come as lines within what is seen.
struct ScenePath {
  std::vector<geom::Point3> point;  ///< tip
  std::vector<geom::Vec3> axis;     ///< unit; empty: all 0, 0, 1
  std::vector<double> time_s;       ///< from the start, not decreasing
  std::vector<WayKind> kind;
  std::vector<double> feed_mm_min;   ///< as programmed; 0 on rapids
  std::vector<std::uint32_t> move;   ///< GOTO number
  std::vector<std::uint32_t> line;   ///< of the program text, from 1; 0: none
  std::vector<std::uint8_t> tool;    ///< index into Scene::tools
  std::vector<std::uint16_t> group;  ///< index into Scene::groups: contour, pass, path, operation
  std::vector<std::array<double, 2>> rotary_deg;  ///< of machine->axes; empty: nothing turns
};

/// A value a node, to colour the path by and to draw over time: speed, effective radius, deviation.
struct SceneSeries {
  std::string name, unit;
  std::vector<float> value;   ///< NaN: none
  bool signed_scale = false;  ///< colours diverge from 0
};

enum class MeshRole : std::uint8_t { design = 0, stock = 1, obstacle = 2, result = 3 };
struct SceneMesh {
  std::string name;
  MeshRole role = MeshRole::design;
  geom::Mesh mesh;
  std::vector<float> value;  ///< a vertex, for the heat map (deviation); empty: plain; NaN: not measured
  std::string value_name, value_unit;
  /// The colours run from -range to +range; 0: from what is there.
  double value_range = 0;
};

/// Flat curves: outlines of the drawing, the cut's edges.
struct SceneOutline {
  std::string name;
  bool part = true;  ///< an edge of the part; false: other lines of the drawing
  bool closed = true;
  std::vector<geom::Point3> points;
  std::vector<float> value;  ///< a point: deviation; empty: plain
};

/// A body of revolution about the tool axis, heights from the tip.
struct ToolPiece {
  enum class Kind : std::uint8_t { cutter = 0, shank = 1, holder = 2 };
  Kind kind = Kind::cutter;
  double radius = 0, low = 0, high = 0, corner = 0;  ///< corner: rounding of the lower edge
};
struct SceneTool {
  int number = 0;
  std::string name;  ///< "ball 6 mm", "laser, kerf 0.28 mm"
  std::vector<ToolPiece> pieces;
  double kerf_mm = 0;  ///< a beam
};

/// Rotary axes of the machine, from the workpiece to the tool; table axes turn the part.
struct SceneAxis {
  char letter = 'A';
  bool table = true;
  geom::Vec3 direction{1, 0, 0};
  geom::Point3 point;
};
struct SceneMachine {
  std::string name;
  std::vector<SceneAxis> axes;
};

/// The angles of one contact point: what is free, what is not and why.
struct SceneCSpace {
  std::uint32_t node = 0;  ///< of the path
  std::string label;       ///< "path 3, point 17"
  double tilt_min = 0, tilt_max = 0, yaw_min = 0, yaw_max = 0;
  std::uint32_t tilts = 0, yaws = 0;  ///< nodes each way
  std::vector<std::uint8_t> cause;    ///< tilts x yaws, yaw fastest; 0: free; index into Scene::causes
  std::vector<float> radius_mm;       ///< effective cutting radius, for the contours; NaN: not free
  std::array<double, 2> chosen{};     ///< tilt, yaw
  std::optional<std::array<double, 2>> initial;
};

struct SceneFinding {
  enum class Level : std::uint8_t { info = 0, warning = 1, fault = 2 };
  Level level = Level::info;
  std::string title;   ///< "gouge 0.050 mm"
  std::string detail;  ///< "move 17, line 42"
  std::optional<geom::Point3> at;
  std::optional<std::uint32_t> node;
};
struct SceneFigure {
  std::string group, name, value;  ///< value with its unit
};
struct SceneHistogram {
  std::string name, unit;
  double from = 0, step = 0;
  std::vector<double> area;
  double tolerance = 0;
};

struct Scene {
  std::string title, operation, command_line;
  ScenePath path;
  std::vector<std::string> groups;  ///< names
  std::vector<SceneSeries> series;
  std::vector<SceneMesh> meshes;
  std::vector<SceneOutline> outlines;
  std::vector<SceneTool> tools;
  std::optional<SceneMachine> machine;
  std::optional<removal::StockClock> stock;
  std::vector<SceneCSpace> cspaces;
  std::vector<std::string> causes;
  std::vector<SceneFinding> findings;
  std::vector<SceneFigure> figures;
  std::vector<SceneHistogram> histograms;
  std::string program_name, program_text;  ///< the listing
};

struct SceneOptions {
  double point_step_mm = 1e-4;                   ///< path points are rounded to this
  std::size_t max_triangles = 400'000;           ///< of all meshes; larger ones are thinned, which is said
  std::size_t max_text_bytes = 8 * 1024 * 1024;  ///< the listing is cut after this, which is said
};

/// Error (range): columns that are not of one length, indices beyond their tables, numbers not finite, more
/// than 20 million nodes.
Result<void> validate(const Scene& scene);
/// The container of docs/viewer.md. Deterministic.
Result<std::string> scene_bytes(const Scene& scene, const SceneOptions& options = {});
/// The page with the scene in it: one file, no network.
Result<std::string> viewer_page(const Scene& scene, const SceneOptions& options = {});
/// The page without a scene: it asks for "scene.bin" beside it (`burin view --serve`).
std::string viewer_shell(const std::string& title);

}  // namespace burin::view

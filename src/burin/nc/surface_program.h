// SPDX-License-Identifier: Apache-2.0
// Surface programs: ISO 6983 programs with NURBS surface blocks G06.23, the cycles G106.1 and G106.2 (Koo &
// Jee 2007, tables 1 and 2) and NURBS curves G06.2. Text -> what is to be done, in order; nothing is joined
// or planned here. mm, mm/min, absolute positions of the tool tip in the part frame.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "burin/base/diagnostics.h"
#include "burin/base/result.h"
#include "burin/cl/program.h"
#include "burin/geom/surface/join.h"
#include "burin/geom/surface/nurbs.h"

namespace burin::nc {

/// A loop in the parameters of a surface that bounds the region to be machined (docs/surface-program.md, the
/// comments `(BURIN TRIM ...)`; other controls read over them). Not closed by repeating the first point.
struct TrimLoop {
  std::vector<geom::Point2> points;
};

/// G06.23 and its points.
struct SurfaceBlock {
  std::optional<int> number;  ///< N word
  int line = 0;
  geom::NurbsSurface surface;
  double tool_diameter = 0;     ///< D, mm
  double stock = 0;             ///< L, mm left on the surface
  double feed = 0;              ///< F, mm/min
  double scallop = 0;           ///< S, mm
  std::vector<TrimLoop> trims;  ///< empty: the whole surface
};

enum class PathMethod { iso_parametric = 1, iso_scallop = 2 };  ///< the I word

/// One machining of a group of surfaces.
struct MachineGroup {
  int line = 0;
  std::vector<std::size_t> blocks;  ///< indices into SurfaceProgram::blocks
  bool join = false;                ///< G106.2; otherwise the one block by itself
  geom::Grouping grouping = geom::Grouping::largest;
  PathMethod method = PathMethod::iso_parametric;
  double tool_diameter = 0;  ///< of the cycle when it has D, else of the block
  double stock = 0;
  double feed = 0;
  double scallop = 0;
  std::optional<double> side_step;  ///< M
  /// Z of retracts: W, or where the tool stood when the cycle began (W0 and blocks without cycle).
  double safety_z = 0;
  geom::Vec3 displacement;  ///< of a repeat by G106.1; (0, 0, 0) for the first
  bool repeat = false;      ///< counted in counts.repeats
  geom::Point3 start;       ///< where the tool stands before
};

/// G06.2. The tip runs along it at the feed.
struct CurveMove {
  int line = 0;
  geom::NurbsCurve curve;
  double feed = 0;
};

/// Rapid, Feed, Arc, FeedRate, Spindle, ToolChange, Coolant, Dwell, Comment as in any program; record and
/// line.
struct Plain {
  cl::Record record;
  int line = 0;
  double feed = 0;  ///< in force, for Feed and Arc
};

using Step = std::variant<Plain, CurveMove, MachineGroup>;

struct SurfaceProgram {
  std::string name;
  std::vector<SurfaceBlock> blocks;
  std::vector<Step> steps;
  geom::Point3 start;         ///< where the program takes the tool to stand before its first block
  std::size_t nc_blocks = 0;  ///< lines that are not empty
};

struct SurfaceReadOptions {
  std::string file_name;
  /// What else would be a warning about the program (modal G91 at the end, unknown M codes, a word without
  /// effect, the unit assumed) is an error.
  bool strict = false;
  geom::Point3 start;
};

/// Errors as nc::interpret, all with line and column: wrong counts, a program that ends inside a surface,
/// knots that decrease or are too few or too often repeated, weights <= 0, words twice, P after Q, N numbers
/// missing or twice, a cycle without tool diameter, scallop or feed, degenerate surfaces (all points equal).
Result<SurfaceProgram> read_surface_program(std::string_view text, const SurfaceReadOptions& options,
                                            Diagnostics& diagnostics);

/// The other way: blocks and one G106.2 -> program text; what `burin surfaces` writes.
struct SurfaceWriteOptions {
  std::string name;
  geom::Grouping grouping = geom::Grouping::largest;
  PathMethod method = PathMethod::iso_scallop;
  double tool_diameter = 6.0;
  double scallop = 0.01;
  std::optional<double> side_step;
  double feed = 1000.0;
  double safety_z = 50.0;
  int decimals = 6;  ///< of X Y Z; weights and knots get 9 and 12
};
/// Numbers never with exponents, lines under 255 characters. Reading the text back gives the same surfaces
/// within the decimals.
Result<std::string> write_surface_program(const std::vector<SurfaceBlock>& blocks,
                                          const SurfaceWriteOptions& options);

}  // namespace burin::nc

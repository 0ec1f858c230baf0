// SPDX-License-Identifier: Apache-2.0
// What a DXF or SVG file says, independent of its format: curves with layer, colour and origin, in mm, y up.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "burin/base/diagnostics.h"
#include "burin/geom/curve/curve.h"

namespace burin::io {

/// Curves that the file draws as one connected line: each starts where the one before ends, exactly. A closed
/// polyline, circle or SVG subpath with Z is `closed`.
struct Path {
  std::vector<geom::Curve2> curves;
  bool closed = false;
};

/// One geometric entity after block / use expansion: `counts.entities` of the reports counts these.
struct Entity {
  std::string kind;   ///< "LINE", "LWPOLYLINE", "path", "rect", ... as the format calls it
  std::string id;     ///< DXF handle or SVG id; for members of blocks the way there: "INSERT 2F/LINE 31"
  int line = 0;       ///< line of the file where the entity starts, from 1 (0: unknown)
  std::string layer;  ///< DXF layer; SVG: label or id of the nearest Inkscape layer / top-level group
  std::uint32_t color = 0;  ///< 0xRRGGBB of the stroke (else of the fill); by layer/block resolved
  std::vector<Path> paths;

  /// "LINE 2F" / "path#outline", for messages.
  std::string name() const;
};

struct Drawing {
  std::vector<Entity> entities;
  /// Scale that was applied to the numbers of the file, mm per drawing unit, and how it was found:
  /// "$INSUNITS 4 (mm)", "no units, mm assumed", "width 210mm over viewBox 210", "--units inch", "72 dpi
  /// (Illustrator)".
  double mm_per_unit = 1.0;
  std::string units_reason;
  /// Entities that carry no cutting geometry, by kind, with how many (TEXT, DIMENSION, image, hidden layers,
  /// ...).
  std::map<std::string, int> ignored;
  /// All layer names that the file declares or uses, sorted; for the check of --layers.
  std::vector<std::string> layers;
};

/// Overrides the units of the file: DXF drawing unit or SVG user unit.
enum class Units { from_file, mm, inch };

struct ReadOptions {
  std::string file_name;  ///< for messages only
  Units units = Units::from_file;
  /// Limits against hostile files: entities after expansion, nesting of blocks / use / groups, curves in all.
  std::size_t max_entities = 5'000'000;
  int max_depth = 64;
};

/// Applies a map to every curve of the paths (mirrors keep direction: reversing is the joiner's business).
void transform(std::vector<Path>& paths, const geom::Affine2& map);
geom::Box2 bounds(const Drawing& drawing);

}  // namespace burin::io

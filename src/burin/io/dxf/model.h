// SPDX-License-Identifier: Apache-2.0
// What a DXF says, before blocks are expanded: entities in the numbers and coordinate systems of the file.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "burin/geom/vec.h"

namespace burin::io::dxf {

struct LineShape {
  geom::Point3 a, b;  // world coordinates
};
struct ArcShape {
  geom::Point3 center;  // of the entity's own system (OCS)
  double radius = 0;
  double start_deg = 0, end_deg = 0;  // counter-clockwise from start to end
  bool full = false;                  // CIRCLE
};
struct EllipseShape {
  geom::Point3 center;  // world coordinates
  geom::Vec3 major;
  double ratio = 1;
  double start = 0, end = 0;  // radians
};
struct Vertex {
  geom::Point3 at;
  double bulge = 0;
};
struct PolylineShape {
  std::vector<Vertex> vertices;  // OCS, with `elevation` as z; world coordinates for a 3D polyline
  double elevation = 0;
  bool closed = false;
  bool spatial = false;
};
struct SplineShape {
  int degree = 3;
  int flags = 0;  // 1 closed, 2 periodic, 4 rational
  std::vector<double> knots, weights;
  std::vector<geom::Point3> points, fit_points;  // world coordinates
  geom::Vec3 start_tangent, end_tangent;         // (0, 0, 0): not given

  bool closed() const { return (flags & 3) != 0; }
};
struct InsertShape {
  std::string block;
  geom::Point3 at;  // OCS
  geom::Vec3 scale{1, 1, 1};
  double angle_deg = 0;
  int columns = 1, rows = 1;
  double column_spacing = 0, row_spacing = 0;
};

/// No shape: an entity that is listed in `ignored` as `kind`.
using Shape =
    std::variant<std::monostate, LineShape, ArcShape, EllipseShape, PolylineShape, SplineShape, InsertShape>;

/// Colour as the entity says it.
struct Color {
  static constexpr int kByBlock = 0;
  static constexpr int kByLayer = 256;
  int index = kByLayer;
  int rgb = -1;  // 0xRRGGBB, before the index; -1: none
};

struct Item {
  std::string kind;
  std::string handle;  // "" when the file gives none
  int line = 0;
  std::string layer;
  Color color;
  geom::Vec3 extrusion{0, 0, 1};
  bool paper_space = false;
  bool invisible = false;
  bool unsupported = false;  // without shape: carries geometry that somebody may have wanted cut
  std::vector<std::string> repairs;
  Shape shape;
};

struct Layer {
  std::string name;
  bool frozen = false;
  bool off = false;
  Color color{7, -1};
};

struct Block {
  std::string name;
  int flags = 0;
  geom::Point3 base;
  std::vector<Item> items;

  bool external() const { return (flags & (4 | 8 | 16 | 32)) != 0; }
};

struct Model {
  std::map<std::string, Layer> layers;  // by name in lower case
  std::map<std::string, Block> blocks;
  std::vector<Item> items;  // of the ENTITIES section
  int insunits = -1;        // $INSUNITS; -1: absent
  int measurement = -1;     // $MEASUREMENT: 0 English, 1 metric
  std::string code_page;    // $DWGCODEPAGE
};

}  // namespace burin::io::dxf

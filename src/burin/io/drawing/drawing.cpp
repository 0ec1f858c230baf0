// SPDX-License-Identifier: Apache-2.0
#include "burin/io/drawing/drawing.h"

namespace burin::io {

std::string Entity::name() const {
  if (id.empty()) return line > 0 ? kind + " at line " + std::to_string(line) : kind;
  if (id.find('/') != std::string::npos && id.find(kind) != std::string::npos)
    return id;  // the way names its kinds
  const bool svg = !kind.empty() && kind[0] >= 'a' && kind[0] <= 'z';
  return kind + (svg ? "#" : " ") + id;
}

void transform(std::vector<Path>& paths, const geom::Affine2& map) {
  for (Path& path : paths) {
    for (geom::Curve2& curve : path.curves) curve = geom::transformed(map, curve);
  }
}

geom::Box2 bounds(const Drawing& drawing) {
  geom::Box2 box;
  for (const Entity& entity : drawing.entities) {
    for (const Path& path : entity.paths) {
      for (const geom::Curve2& curve : path.curves) box.add(geom::bounds(curve));
    }
  }
  return box;
}

}  // namespace burin::io

// SPDX-License-Identifier: Apache-2.0
// Any bytes as an SVG file: never crashes, and what is read is valid.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "burin/io/svg/read_svg.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  burin::io::ReadOptions options;
  options.max_entities = 2000;
  options.max_depth = 16;
  burin::Diagnostics diagnostics;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const auto drawing = burin::io::read_svg(bytes, options, diagnostics);
  if (!drawing) {
    if (drawing.error().message.empty() || drawing.error().code == burin::ErrorCode::internal) std::abort();
    return 0;
  }
  if (drawing->entities.size() > options.max_entities) std::abort();
  for (const burin::io::Entity& entity : drawing->entities) {
    if (entity.paths.empty()) std::abort();
    for (const burin::io::Path& path : entity.paths) {
      if (path.curves.empty()) std::abort();
      for (const burin::geom::Curve2& curve : path.curves) {
        if (!burin::geom::validate(curve)) std::abort();
      }
    }
  }
  return 0;
}

// SPDX-License-Identifier: Apache-2.0
// Arbitrary bytes through read_dxf: an error or a drawing of valid curves, within the limits given.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "burin/io/dxf/read_dxf.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  burin::io::ReadOptions options;
  options.file_name = "fuzz.dxf";
  options.max_entities = 2000;
  options.max_depth = 8;
  burin::Diagnostics diagnostics;
  const auto drawing = burin::io::read_dxf({reinterpret_cast<const char*>(data), size}, options, diagnostics);
  if (!drawing) {
    // Arbitrary bytes are the file's fault, never ours.
    if (drawing.error().code == burin::ErrorCode::internal || drawing.error().message.empty()) std::abort();
    return 0;
  }
  if (drawing->entities.size() > options.max_entities) std::abort();
  for (const auto& entity : drawing->entities) {
    if (entity.paths.empty() || entity.line <= 0) std::abort();
    for (const auto& path : entity.paths) {
      if (path.curves.empty()) std::abort();
      for (const auto& curve : path.curves) {
        if (!burin::geom::validate(curve)) std::abort();
        (void)burin::geom::point_at(curve, 0.5);
      }
    }
  }
  return 0;
}

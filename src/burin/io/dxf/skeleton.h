// SPDX-License-Identifier: Apache-2.0
// The Model without shapes: what the records say by themselves (names, handles, lines, visibility, block
// structure).
#pragma once

#include <vector>

#include "burin/base/diagnostics.h"
#include "burin/io/dxf/document.h"
#include "burin/io/dxf/model.h"

namespace burin::io::dxf {

/// Index of an item in a block (nullptr: in the entities of the model), for every record; `index` kNone: no
/// item.
struct ItemPlace {
  Block* block = nullptr;
  std::size_t index = Record::kNone;
};

struct Skeleton {
  Model model;
  std::vector<ItemPlace> places;        // parallel to the records; vertices: that of their polyline
  std::vector<Block*> block_of_record;  // parallel to the records; set for block records

  Item* item(std::size_t record);
};

Skeleton build_skeleton(const Document& document, const std::string& file, Diagnostics& diagnostics);

}  // namespace burin::io::dxf

// SPDX-License-Identifier: Apache-2.0
// The structure above the tags: variables, layers, blocks, entities, each a run of tags.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "burin/base/result.h"
#include "burin/io/dxf/tags.h"

namespace burin::io::dxf {

enum class RecordKind { variable, layer, block, end_block, entity, vertex, sequence_end };

/// A variable of the header, or what begins with a tag 0 and goes on to the next one.
struct Record {
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  RecordKind kind = RecordKind::entity;
  std::string_view name;  // "$INSUNITS", "LAYER", "LINE", ...
  std::size_t first = 0;  // tags after the one that begins the record: [first, last)
  std::size_t last = 0;
  int line = 0;
  std::size_t owner = kNone;  // vertex, sequence_end: index of their POLYLINE or INSERT record
};

struct Document {
  std::vector<Tag> tags;
  std::vector<Record> records;  // in file order; blocks as block ... end_block
};

/// Errors (syntax): blocks not balanced, vertices without a polyline, entities outside of their sections.
Result<Document> build_document(std::vector<Tag> tags, const std::string& file);

}  // namespace burin::io::dxf

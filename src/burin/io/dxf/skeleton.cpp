// SPDX-License-Identifier: Apache-2.0
#include "burin/io/dxf/skeleton.h"

#include <algorithm>
#include <array>

#include "burin/base/text.h"
#include "burin/io/dxf/feed.h"
#include "burin/io/dxf/text_codes.h"

namespace burin::io::dxf {
namespace {

// Kinds that hold no outline. What is neither here nor read carries geometry that somebody may want cut.
constexpr std::array<std::string_view, 25> kWithoutOutline = {
    "ACAD_TABLE",  "ARC_DIMENSION", "ATTDEF",    "ATTRIB", "DIMENSION", "GEOPOSITIONMARKER",
    "HATCH",       "IMAGE",         "LEADER",    "LIGHT",  "MLEADER",   "MTEXT",
    "MULTILEADER", "OLE2FRAME",     "OLEFRAME",  "POINT",  "RAY",       "RTEXT",
    "SOLID",       "TEXT",          "TOLERANCE", "TRACE",  "VIEWPORT",  "WIPEOUT",
    "XLINE"};

std::string printable_kind(std::string_view name) {
  constexpr std::size_t kLongest = 64;
  std::string kind;
  for (const char c : name.substr(0, kLongest)) kind += c < '!' || c > '~' ? '?' : c;
  return kind.empty() ? "(nameless)" : kind;
}

class Walker {
 public:
  Walker(const Document& document, const std::string& file, Diagnostics& diagnostics)
      : document_(document), file_(file), diagnostics_(diagnostics) {
    out_.places.resize(document.records.size());
    out_.block_of_record.resize(document.records.size(), nullptr);
  }

  Skeleton run() {
    find_code_page();
    for (std::size_t i = 0; i < document_.records.size(); ++i) visit(i);
    return std::move(out_);
  }

 private:
  void find_code_page() {
    for (const Record& record : document_.records) {
      if (record.kind == RecordKind::variable && record.name == "$DWGCODEPAGE") {
        out_.model.code_page = std::string(text_of(document_, record, 3));
      }
    }
  }

  std::string decoded(const Record& record, int code) const {
    return decode_text(text_of(document_, record, code), out_.model.code_page);
  }

  void visit(std::size_t index) {
    const Record& record = document_.records[index];
    switch (record.kind) {
      case RecordKind::block:
        begin_block(index);
        break;
      case RecordKind::end_block:
        block_ = nullptr, skipping_ = false;
        break;
      case RecordKind::entity:
        if (!skipping_) add_item(index);
        break;
      case RecordKind::vertex:
      case RecordKind::sequence_end:
        if (record.owner != Record::kNone) out_.places[index] = out_.places[record.owner];
        break;
      case RecordKind::variable:
      case RecordKind::layer:
        break;
    }
  }

  void begin_block(std::size_t index) {
    const Record& record = document_.records[index];
    const std::string name = decoded(record, 2);
    const auto [at, inserted] = out_.model.blocks.try_emplace(to_lower(name));
    skipping_ = !inserted;
    if (!inserted) {
      Where where;
      where.file = file_;
      where.line = record.line;
      where.entity = "BLOCK " + name;
      diagnostics_.left_out("duplicate_block",
                            "the block '" + name + "' is defined again; the first definition is used",
                            std::move(where));
      return;
    }
    at->second.name = name;
    block_ = &at->second;
    out_.block_of_record[index] = block_;
  }

  void add_item(std::size_t index) {
    const Record& record = document_.records[index];
    auto& items = block_ != nullptr ? block_->items : out_.model.items;
    out_.places[index] = {block_, items.size()};
    Item& item = items.emplace_back();
    item.kind = printable_kind(record.name);
    item.line = record.line;
    item.handle = printable_handle(text_of(document_, record, 5));
    item.layer = decoded(record, 8);
    if (item.layer.empty()) item.layer = "0";
    item.invisible = int_of(document_, record, 60, 0) == 1;
    item.paper_space = int_of(document_, record, 67, 0) == 1;
    item.unsupported =
        std::find(kWithoutOutline.begin(), kWithoutOutline.end(), record.name) == kWithoutOutline.end();
  }

  static std::string printable_handle(std::string_view text) {
    constexpr std::size_t kLongest = 16;  // a handle is a hexadecimal number of 64 bits
    std::string handle;
    for (const char c : text.substr(0, kLongest)) handle += c < '!' || c > '~' ? '?' : c;
    return handle;
  }

  const Document& document_;
  const std::string& file_;
  Diagnostics& diagnostics_;
  Skeleton out_;
  Block* block_ = nullptr;
  bool skipping_ = false;  // inside a block that is defined for the second time
};

}  // namespace

Item* Skeleton::item(std::size_t record) {
  const ItemPlace& place = places[record];
  if (place.index == Record::kNone) return nullptr;
  return place.block != nullptr ? &place.block->items[place.index] : &model.items[place.index];
}

Skeleton build_skeleton(const Document& document, const std::string& file, Diagnostics& diagnostics) {
  return Walker(document, file, diagnostics).run();
}

}  // namespace burin::io::dxf

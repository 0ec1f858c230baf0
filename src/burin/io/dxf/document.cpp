// SPDX-License-Identifier: Apache-2.0
#include "burin/io/dxf/document.h"

#include "burin/base/text.h"

namespace burin::io::dxf {
namespace {

class Builder {
 public:
  Builder(std::vector<Tag> tags, const std::string& file) : file_(file) { out_.tags = std::move(tags); }

  Result<Document> run() {
    const auto& tags = out_.tags;
    for (std::size_t i = 0; i < tags.size(); ++i) {
      const Tag& tag = tags[i];
      if (tag.code == 0 && tag.value == "SECTION") {
        ++i;  // the scanner made sure that the name follows
        section_ = trim(tags[i].value);
        continue;
      }
      if (tag.code == 0 && tag.value == "ENDSEC") {
        if (auto closed = end_section(tag); !closed) return closed.error();
        continue;
      }
      const bool starts = tag.code == 0 || (tag.code == 9 && section_ == "HEADER");
      if (!starts) {
        extend(i + 1);
        continue;
      }
      if (auto begun = begin_record(tag, i + 1); !begun) return begun.error();
    }
    return std::move(out_);
  }

 private:
  Error error(int line, std::string message) const { return syntax_error(file_, line, std::move(message)); }

  Result<void> begin_record(const Tag& tag, std::size_t first) {
    open_ = false;
    if (section_ == "HEADER") {
      if (tag.code == 9) add(RecordKind::variable, trim(tag.value), tag.line, first);
      return {};
    }
    if (section_ == "TABLES") {
      if (tag.value == "LAYER") add(RecordKind::layer, tag.value, tag.line, first);
      return {};
    }
    if (section_ == "BLOCKS") return begin_in_blocks(tag, first);
    if (section_ == "ENTITIES") return begin_entity(tag, first);
    return {};
  }

  Result<void> begin_in_blocks(const Tag& tag, std::size_t first) {
    if (tag.value == "BLOCK") {
      if (block_line_ > 0) {
        return error(tag.line, "a block begins inside the one of line " + std::to_string(block_line_) +
                                   " (0/ENDBLK is missing)");
      }
      block_line_ = tag.line;
      sequence_ = Record::kNone;
      add(RecordKind::block, tag.value, tag.line, first);
      return {};
    }
    if (block_line_ == 0) {
      return error(tag.line, quoted(tag.value) + " stands between blocks (0/BLOCK or 0/ENDSEC is expected)");
    }
    if (tag.value == "ENDBLK") {
      block_line_ = 0;
      sequence_ = Record::kNone;
      add(RecordKind::end_block, tag.value, tag.line, first);
      return {};
    }
    return begin_entity(tag, first);
  }

  Result<void> begin_entity(const Tag& tag, std::size_t first) {
    const bool member = tag.value == "VERTEX" || tag.value == "ATTRIB" || tag.value == "SEQEND";
    if (!member) {
      sequence_ = tag.value == "POLYLINE" || tag.value == "INSERT" ? out_.records.size() : Record::kNone;
      add(RecordKind::entity, tag.value, tag.line, first);
      return {};
    }
    if (tag.value == "VERTEX" && (sequence_ == Record::kNone || out_.records[sequence_].name != "POLYLINE")) {
      return error(tag.line, "a VERTEX without a POLYLINE before it");
    }
    if (tag.value == "ATTRIB") {
      add(RecordKind::entity, tag.value, tag.line, first);
      return {};
    }
    add(tag.value == "VERTEX" ? RecordKind::vertex : RecordKind::sequence_end, tag.value, tag.line, first);
    out_.records.back().owner = sequence_;
    if (tag.value == "SEQEND") sequence_ = Record::kNone;
    return {};
  }

  Result<void> end_section(const Tag& tag) {
    if (block_line_ > 0) {
      return error(tag.line, "the section ends inside the block of line " + std::to_string(block_line_) +
                                 " (0/ENDBLK is missing)");
    }
    section_ = {};
    sequence_ = Record::kNone;
    open_ = false;
    return {};
  }

  void add(RecordKind kind, std::string_view name, int line, std::size_t first) {
    out_.records.push_back({kind, name, first, first, line, Record::kNone});
    open_ = true;
  }
  void extend(std::size_t last) {
    if (open_) out_.records.back().last = last;
  }

  const std::string& file_;
  Document out_;
  std::string_view section_;
  bool open_ = false;                     // the last record takes the tags that come
  int block_line_ = 0;                    // of the open block, 0: none
  std::size_t sequence_ = Record::kNone;  // POLYLINE or INSERT that VERTEX, ATTRIB, SEQEND belong to
};

}  // namespace

Result<Document> build_document(std::vector<Tag> tags, const std::string& file) {
  return Builder(std::move(tags), file).run();
}

}  // namespace burin::io::dxf

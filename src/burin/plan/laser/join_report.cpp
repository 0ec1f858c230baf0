// SPDX-License-Identifier: Apache-2.0
// What the user is told about curves that are drawn more than once.
#include <algorithm>
#include <map>

#include "burin/base/text.h"
#include "burin/plan/laser/join_parts.h"

namespace burin::laser::detail {
namespace {

enum class Kind { duplicate, overlap, shared };

struct Summary {
  int count = 0;
  double length = 0;
  geom::Point2 at;
  std::uint32_t by = 0;        ///< entity
  std::uint32_t last = kNone;  ///< piece: a piece may be repeated in two places
};

/// Pieces whose spare part is used, with its parameters.
std::multimap<std::uint32_t, const Part*> kept_spares(const Parts& parts, const Runs& runs,
                                                      const Resolved& resolved) {
  std::multimap<std::uint32_t, const Part*> kept;
  for (std::size_t run = runs.base_count; run < runs.list.size(); ++run) {
    if (!resolved.used[run]) continue;
    const Part& part = parts.list[runs.parts[runs.list[run].first]];
    kept.emplace(part.piece, &part);
  }
  return kept;
}

std::string message(Kind kind, const Summary& s, bool several_pieces, const std::string& by) {
  const std::string what =
      several_pieces || s.count > 1 ? std::to_string(s.count) + " of its curves " : "it ";
  const bool plural = several_pieces || s.count > 1;
  switch (kind) {
    case Kind::duplicate:
      return what + (plural ? "are" : "is") + " drawn a second time (first by " + by + "): removed";
    case Kind::overlap:
      return what + (plural ? "lie" : "lies") + " partly on " + by + " (" + format_fixed(s.length, 3) +
             " mm): removed there";
    case Kind::shared:
      break;
  }
  return what + (plural ? "lie" : "lies") + " on " + by + " and both are kept: two contours share the edge";
}

}  // namespace

void report_repeats(const io::Drawing& drawing, const Pieces& pieces, const Parts& parts, const Runs& runs,
                    const Resolved& resolved, const Repeats& repeats, Diagnostics& diagnostics) {
  const auto kept = kept_spares(parts, runs, resolved);
  std::map<std::pair<std::uint32_t, Kind>, Summary> summaries;
  for (const Repeat& repeat : repeats.list) {
    const auto [begin, end] = kept.equal_range(repeat.piece);
    const bool shared = std::any_of(begin, end, [&](const auto& item) {
      return item.second->t0 <= repeat.t && repeat.t <= item.second->t1;
    });
    const Kind kind = shared ? Kind::shared : repeat.whole ? Kind::duplicate : Kind::overlap;
    Summary& summary = summaries[{pieces.list[repeat.piece].entity, kind}];
    if (summary.count == 0) {
      summary.at = geom::point_at(*pieces.list[repeat.piece].curve, repeat.t);
      summary.by = pieces.list[repeat.by].entity;
    }
    summary.count += repeat.piece != summary.last ? 1 : 0;
    summary.last = repeat.piece;
    summary.length += repeat.length;
  }
  for (const auto& [key, summary] : summaries) {
    const io::Entity& entity = drawing.entities[key.first];
    std::size_t curves = 0;
    for (const io::Path& path : entity.paths) curves += path.curves.size();
    const std::string by =
        summary.by == key.first ? "another curve of the same entity" : drawing.entities[summary.by].name();
    const char* code = key.second == Kind::duplicate ? "duplicate_removed"
                       : key.second == Kind::overlap ? "overlap_removed"
                                                     : "shared_edge";
    diagnostics.info_at(code, message(key.second, summary, curves > 1, by), summary.at.x, summary.at.y,
                        {"", entity.line, 0, entity.name()});
  }
  if (repeats.incomplete) {
    diagnostics.info("overlaps_unchecked",
                     "too many curves lie on or across one another: duplicates and overlaps may remain");
  }
}

}  // namespace burin::laser::detail

// SPDX-License-Identifier: Apache-2.0
// Inner types of the joiner: what is passed between its steps (docs/contours.md). Not for other folders.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "burin/base/diagnostics.h"
#include "burin/base/result.h"
#include "burin/base/tolerance.h"
#include "burin/geom/curve/curve.h"
#include "burin/io/drawing/drawing.h"
#include "burin/plan/laser/options.h"

namespace burin::laser::detail {

inline constexpr std::uint32_t kNone = 0xffffffffU;

/// The lengths that decide, mm.
struct JoinScale {
  double point = 0;  ///< the same point
  double same = 0;   ///< the same curve; ends up to `join` apart still count as the same
  double join = 0;   ///< ends that are joined; pieces and overlaps no longer than this are never cut
};
JoinScale join_scale(const Tolerance& tolerance);

/// One drawn curve, in file order.
struct Piece {
  const geom::Curve2* curve = nullptr;
  std::uint32_t entity = 0;
  std::uint32_t order = 0;  ///< count of drawn curves before it, over all treatments
  geom::Point2 a, b;
};

/// Pieces [first, end) follow each other in one Path of the drawing.
struct PathRange {
  std::uint32_t first = 0, end = 0;
  bool closed = false;
};

struct Pieces {
  std::vector<Piece> list;
  std::vector<PathRange> paths;
};

/// A piece, or what is left of it after overlaps were taken out: parameters [t0, t1] of the drawn curve.
/// A `spare` part lies on its twin; it is used only where two contours need the same edge.
struct Part {
  std::uint32_t piece = 0;
  double t0 = 0, t1 = 1;
  geom::Point2 a, b;
  std::uint32_t twin = kNone;  ///< index of the part that draws the same
  bool spare = false;
  bool cut = false;  ///< came out of an overlap or a duplicate: other parts may meet its ends
};

struct Parts {
  std::vector<Part> list;  ///< base parts in order of piece and parameter, then the spare ones
  std::size_t base_count = 0;
};

/// Something that was drawn twice.
struct Repeat {
  std::uint32_t piece = 0;
  std::uint32_t by = 0;  ///< the piece that draws it too
  bool whole = false;    ///< the same curve from end to end
  double t = 0.5;        ///< middle of what is repeated, parameter of `piece`
  double length = 0;
};

struct Repeats {
  std::vector<Repeat> list;  ///< in order of piece
  bool incomplete = false;   ///< too many curves on one another to look at all pairs
};

/// Finds what is drawn more than once and cuts the pieces so that every place is drawn by one base part and
/// at most one spare part.
Parts split_repeats(const Pieces& pieces, const JoinScale& scale, Repeats& repeats);

// ---- where the carriers of lines and arcs meet
// -------------------------------------------------------------------

/// Piece `piece` covers [lo, hi] of a carrier line or circle; its parameters run from t_lo to t_hi over it.
struct Interval {
  std::uint32_t piece = 0;
  double lo = 0, hi = 0;
  double t_lo = 0, t_hi = 1;
};
/// What a carrier's cover leaves of a piece.
struct CoverPart {
  std::uint32_t piece = 0;
  double t0 = 0, t1 = 1;
  std::uint32_t spare_piece = kNone;  ///< draws the same once more
  double spare_t0 = 0, spare_t1 = 1;
};
struct Cover {
  std::vector<CoverPart> parts;        ///< of the pieces in `touched` only
  std::vector<std::uint32_t> touched;  ///< pieces that share some length with another one
  std::vector<Repeat> repeats;
};
/// One-cover of the intervals on one carrier. `around`: circumference of a circle (intervals may not pass
/// it), 0 for a line. O(n log n).
Cover cover(const std::vector<Interval>& intervals, double around, const JoinScale& scale);

/// Whether two curves draw the same points within `tolerance` (sampled, any parameters, any direction).
bool same_curve(const geom::Curve2& a, const geom::Curve2& b, double tolerance);

// ---- graph
// -------------------------------------------------------------------------------------------------------

/// Parts that follow each other without doubt: an edge of the graph. End 2 * run is its start, 2 * run + 1
/// its finish.
struct Run {
  std::uint32_t first = 0, count = 0;  ///< range in Runs::parts
  std::uint32_t twin = kNone;          ///< run whose single part draws the same (spare runs and their base)
  bool twin_reversed = false;
  bool spare = false;
};
struct Runs {
  std::vector<Run> list;  ///< base runs, then spare runs
  std::size_t base_count = 0;
  std::vector<std::uint32_t> parts;
  std::vector<std::uint32_t> neighbour;  ///< by end: the end that follows in the drawn path, or kNone
};

struct Nodes {
  std::vector<std::uint32_t> of_end;  ///< by end
  std::uint32_t count = 0;
};

inline geom::Point2 end_point(const Parts& parts, const Runs& runs, std::uint32_t end) {
  const Run& run = runs.list[end / 2];
  return end % 2 == 0 ? parts.list[runs.parts[run.first]].a
                      : parts.list[runs.parts[run.first + run.count - 1]].b;
}

/// Ends that meet become nodes: nearest ends first, ends of short pieces kept apart.
Nodes cluster_ends(const Pieces& pieces, const Parts& parts, const Runs& runs, const JoinScale& scale);

/// A run in a chain, in drawn direction or against it.
struct Step {
  std::uint32_t run = 0;
  bool reversed = false;
};
struct Chain {
  std::vector<Step> steps;
  bool closed = false;
};
struct Branch {
  std::uint32_t end = 0;  ///< one of the ends that meet there
  int degree = 0;
};
struct Resolved {
  std::vector<Chain> chains;
  std::vector<Branch> branches;
  std::vector<bool> used;  ///< by run: all base runs, and the spare runs that contours need
};
/// Chooses at every node which ends continue each other (docs/contours.md, "Branch points"). O(n log n).
Resolved resolve(const Pieces& pieces, const Parts& parts, const Runs& runs, const Nodes& nodes);

// ---- reports
// -----------------------------------------------------------------------------------------------------

/// "duplicate_removed", "overlap_removed" and "shared_edge", one for each entity and code.
void report_repeats(const io::Drawing& drawing, const Pieces& pieces, const Parts& parts, const Runs& runs,
                    const Resolved& resolved, const Repeats& repeats, Diagnostics& diagnostics);

// ---- layers
// ------------------------------------------------------------------------------------------------------

/// Treatment of every entity by layer name or stroke colour. Error (usage): a name that the drawing does not
/// have.
Result<std::vector<Treatment>> treatments(const io::Drawing& drawing,
                                          const std::map<std::string, Treatment>& layers);

}  // namespace burin::laser::detail

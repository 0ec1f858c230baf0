// SPDX-License-Identifier: Apache-2.0
#include "burin/verify/deviation_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace burin::verify {
namespace {

using geom::Point3;
using geom::Vec3;

// Patches and times are halved at most so often; by then both are far below any resolution.
constexpr int kMostHalvings = 80;
// Those of an excess are of places alone: a step in what is left is never smooth, however small the patch.
constexpr int kMostCuts = 24;
// Stretches of neighbours that are tried on a patch.
constexpr std::size_t kRecent = 8;
// Stretches along the motion that a corner may be covered by, seen from the one that covers the middle.
constexpr int kWalk = 4;
// Halvings towards the place where a moment's cover ends, and how near to a corner a side is cut.
constexpr int kBisect = 6;
constexpr double kLeastShare = 0.1;
// Steps towards the moment at which a corner is deepest in the tool.
constexpr int kTangents = 10;
constexpr double kWider = 2;  // what is left open is bounded by the gap times a power of this

TriangleExtent shifted(const Patch& patch, double height) {
  const std::array<Point3, 3> c{patch.p[0] + height * patch.n[0], patch.p[1] + height * patch.n[1],
                                patch.p[2] + height * patch.n[2]};
  const Vec3 normal = unit(cross(c[1] - c[0], c[2] - c[0]));
  return {c, norm(normal) > 0 ? normal : patch.n[0]};
}
BoxExtent around(const std::vector<Patch>& patches, double height) {
  Enclosure box(patches[0].normal(), patches[0].p[0]);
  for (const Patch& patch : patches)
    for (std::size_t i = 0; i < 3; ++i) box.add(patch.p[i] + height * patch.n[i]);
  return box.extent();
}

}  // namespace

// --- gouge -----------------------------------------------------------------------------------------------
// A place p is gouged deeper than D when a tool holds p and p - D n at once. So the tools are kept out of a
// patch or of the patch sunk by D = found + gap (+ motion, by which all tools are taken larger).

/// A patch, and it sunk.
struct TileSearch::Sunk {
  Sunk(const Patch& patch_, double depth_, double margin_)
      : patch(patch_), above(shifted(patch_, 0)), below(shifted(patch_, -depth_)), margin(margin_) {}
  const Patch& patch;
  TriangleExtent above, below;
  double margin;
};

TileWorst TileSearch::gouge(const std::uint32_t* index, std::size_t count, const TileWorst& known,
                            const SearchLimits& limits) {
  worst_ = known;
  limits_ = limits;
  steps_ = limits.steps;
  worst_.gouge_most = 0;
  worst_.gouge_open = false;
  std::vector<SweptTool::Part> all;
  for (const SweptTool& tool : swept_.tools) tool.add_all(all);
  if (known.gouge.mm < options_.reach_mm) gouge(index, count, all);
  worst_.gouge_most = std::min(std::max(worst_.gouge_most, depth()), options_.reach_mm);
  return worst_;
}

void TileSearch::gouge(const std::uint32_t* index, std::size_t count,
                       const std::vector<SweptTool::Part>& all) {
  std::vector<Patch> patches;
  double most = 0;
  for (std::size_t i = 0; i < count; ++i) {
    patches.push_back(patch_of(mesh_, surface_.normals, surface_.cells[index[i]]));
    most = std::max(most, margin(patches.back(), depth()));
  }
  const BoxExtent top = around(patches, 0), sunk = around(patches, -depth());
  std::vector<SweptTool::Part> some;
  for (const SweptTool::Part& part : all) swept_.tools[part.tool].narrow(part, sunk, top, most, some);
  if (some.empty()) return;
  if (count > kGroup) {
    const std::size_t part = (count + kGroup - 1) / kGroup;
    for (std::size_t first = 0; first < count; first += part)
      gouge(index + first, std::min(part, count - first), some);
    return;
  }
  std::vector<Candidate> candidates;
  for (const SweptTool::Part& part : some)
    swept_.tools[part.tool].gather(part, sunk, top, most, [&](const Candidate& c) {
      const MillBody& body = swept_.tools[c.tool].body(c.body);
      if (upper_bound(body, *c.stretch, c.whole, sunk, -most).value > -most) candidates.push_back(c);
    });
  for (const Patch& patch : patches) {
    const Sunk one(patch, depth(), margin(patch, depth()));
    for (const Candidate& c : candidates) gouge(one, c, c.whole, 0);
  }
}

void TileSearch::gouge(const Sunk& sunk, const Candidate& c, const Span& span, int halvings) {
  const MillBody& body = swept_.tools[c.tool].body(c.body);
  const Upper below = upper_bound(body, *c.stretch, span, sunk.below, -sunk.margin);
  if (below.value <= -sunk.margin) return;
  const Upper above = upper_bound(body, *c.stretch, span, sunk.above, -limits_.motion);
  if (above.value <= -limits_.motion) return;
  if (inscribed_.none_counts(sunk.below.center, sunk.below.radius, depth())) return;
  if (steps_ == 0 || halvings >= kMostHalvings) {
    give_up(sunk.patch, c, span);
    return;
  }
  --steps_;
  if (below.f > 0 && above.f > 0) {
    const double before = worst_.gouge.mm;
    take(sunk.patch.middle(), sunk.patch.normal(), c);
    if (worst_.gouge.mm >= options_.reach_mm) return;
    if (worst_.gouge.mm > before) {
      gouge(Sunk(sunk.patch, depth(), margin(sunk.patch, depth())), c, span, halvings + 1);
      return;
    }
  }
  const Upper& why = above.f < below.f ? above : below;
  if (why.time > why.space) {
    for (const Span& part : span.halves(*c.stretch)) gouge(sunk, c, part, halvings + 1);
  } else {
    for (const Patch& part : sunk.patch.halves())
      gouge(Sunk(part, depth(), margin(part, depth())), c, span, halvings + 1);
  }
}

void TileSearch::take(Point3 p, Vec3 n, const Candidate& c) {
  SampleLine line = swept_.line(p, n, options_);
  swept_.tools[c.tool].lower(line, c);
  swept_.lower(line);
  if (!line.found()) return;
  const double deep = inscribed_.own(line.q, line.n, -line.best, options_.resolution_mm);
  if (deep > worst_.gouge.mm) worst_.gouge = {deep, line.q, line.n, swept_.move_of(line.at)};
}

void TileSearch::give_up(const Patch& patch, const Candidate& c, const Span& span) {
  const MillBody& body = swept_.tools[c.tool].body(c.body);
  worst_.gouge_open = true;
  for (double more = limits_.gap; depth() + more < options_.reach_mm; more *= kWider) {
    const double down = depth() + more, enough = -margin(patch, down);
    if (down > worst_.gouge_most &&
        upper_bound(body, *c.stretch, span, shifted(patch, -down), enough).value > enough)
      continue;
    worst_.gouge_most = std::max(worst_.gouge_most, down);
    return;
  }
  worst_.gouge_most = options_.reach_mm;
}

// --- excess ----------------------------------------------------------------------------------------------
// A patch has no more than H = found + gap when the patch raised by H lies within what one stretch goes
// through. At one moment the tool is convex: three corners in it do. At three moments, to each corner its
// own, the places between are in it at the moments between, but for the turning.

TileWorst TileSearch::excess(const std::uint32_t* index, std::size_t count,
                             const std::vector<Moment>& moments, const TileWorst& known,
                             const SearchLimits& limits) {
  worst_ = known;
  limits_ = limits;
  steps_ = limits.steps;
  worst_.excess_most = 0;
  worst_.excess_open = false;
  recent_.clear();
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t at = index[i];
    if (!surface_.samples[at].machined || !moments[at].found()) continue;
    remember(moments[at]);
    beside_unmachined_ = false;
    excess(patch_of(mesh_, surface_.normals, surface_.cells[at]), 0);
  }
  worst_.excess_most = std::min(std::max(worst_.excess_most, height()), options_.reach_mm);
  return worst_;
}

void TileSearch::remember(const Moment& at) {
  const auto same = std::find_if(recent_.begin(), recent_.end(), [&](const Moment& m) {
    return m.tool == at.tool && m.stretch == at.stretch && m.body == at.body;
  });
  if (same != recent_.end()) {
    recent_.erase(same);
  } else if (recent_.size() >= kRecent) {
    recent_.erase(recent_.begin());
  }
  recent_.push_back(at);
}

/// When a place is deep enough in the tool.
struct TileSearch::Deep {
  std::uint32_t move = 0;  ///< in the order of the motion
  double time = 0;
  Placed placed;
  Vec3 from_tip;
  double f = 0;
};

/// The places between three that are in the tool at a moment each are in a tool whose tip and axis are the
/// same mean of those three. So far is a place of the motion, as the nearest of them is felt at these places,
/// from there: by the tips and axes that the motion has on its way beside the chord from first to last, and
/// by what rotations do to means.
double TileSearch::bent(const SweptTool& tool, std::array<Deep, 3> deep) {
  std::sort(deep.begin(), deep.end(), [](const Deep& a, const Deep& b) {
    return a.move != b.move ? a.move < b.move : a.time < b.time;
  });
  const Deep &first = deep[0], &last = deep[2];
  if (first.move == last.move && first.time == last.time) return 0;
  double far = 0, apart = 0, turned = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Deep &d = deep[i], &e = deep[(i + 1) % 3];
    far = std::max(far, norm(d.from_tip));
    apart = std::max(apart, norm(d.from_tip - e.from_tip));
    turned = std::max(turned, norm(d.placed.axis - e.placed.axis));
  }
  double tips = 0, axes = 0;
  const Vec3 way = last.placed.tip - first.placed.tip, turn = last.placed.axis - first.placed.axis;
  if (first.move == last.move) {
    const double angle = tool.stretch(tool.position(first.move)).angle * (last.time - first.time);
    axes = angle * angle / 8;
  } else {
    if (!(dot(way, way) > 0)) return std::numeric_limits<double>::infinity();
    const auto beside = [&](const Placed& at) {
      const Vec3 d = at.tip - first.placed.tip;
      const double along = dot(d, way) / dot(way, way);
      tips = std::max(tips, norm(d - along * way));
      axes = std::max(axes, norm(at.axis - first.placed.axis - along * turn));
    };
    double bow = 0;
    for (std::uint32_t move = first.move; move <= last.move; ++move) {
      const Stretch& stretch = tool.stretch(tool.position(move));
      bow = std::max(bow, stretch.angle * stretch.angle / 8);
      if (move > first.move) beside(stretch.at(0));
    }
    beside(deep[1].placed);
    // The mean is beside the chord because of the middle one, the motion because of its corners.
    tips *= 2;
    axes = 2 * axes + bow;
  }
  // Of three numbers that add up to 1 the products of two add up to 1 / 3 at most.
  return tips + axes * far + (turned * apart + turned * turned * far) / 3;
}

/// Goes along the motion from a moment on, the way the place gets deeper, until it is deep enough or no
/// deeper.
TileSearch::Deep TileSearch::deepest(Point3 p, const Moment& near, double enough) const {
  const SweptTool& tool = swept_.tools[near.tool];
  const MillBody& body = tool.body(near.body);
  Deep deep{tool.original(near.stretch), near.time, {}, {}, 0};
  double& t = deep.time;
  for (int walked = 0; walked <= kWalk; ++walked) {
    const Stretch& stretch = tool.stretch(tool.position(deep.move));
    double rate = 0;
    const auto look = [&](double time) {
      t = time;
      deep.placed = stretch.at(t);
      deep.from_tip = p - deep.placed.tip;
      const BodyAt b = body_at(body, deep.placed.tip, deep.placed.axis, p);
      deep.f = b.f;
      rate = -dot(b.sides[b.least].gradient, stretch.way + cross(stretch.turn, deep.from_tip));
    };
    look(t);
    // It is concave in time but for the turning: what is this slow does not get there.
    if (deep.f >= enough || deep.f + kWalk * std::abs(rate) < enough) return deep;
    // Where the tangents of a time before and one after it meet: at an edge of the tool at once, elsewhere
    // half way; and it is no deeper than there.
    const double end = rate > 0 ? 1 : 0;
    double a = t, f_a = deep.f, rate_a = rate;
    look(end);
    double e = end, f_e = deep.f, rate_e = rate;
    for (int k = 0; k < kTangents && deep.f < enough && (rate_e > 0) != (rate_a > 0); ++k) {
      const double meet = (f_e - f_a + rate_a * a - rate_e * e) / (rate_a - rate_e);
      if (f_a + rate_a * (meet - a) < enough || !(std::min(a, e) < meet && meet < std::max(a, e))) break;
      look(meet);
      if ((rate > 0) == (rate_a > 0)) {
        a = t, f_a = deep.f, rate_a = rate;
      } else {
        e = t, f_e = deep.f, rate_e = rate;
      }
    }
    if (deep.f >= enough) return deep;
    if (t != end || deep.move + (end > 0 ? 1 : -1) >= tool.size()) return deep;
    deep.move += end > 0 ? 1 : -1;
    t = 1 - end;
  }
  return deep;
}

/// What a moment and the motion around it do for a patch.
struct TileSearch::Cover {
  Moment at;
  std::array<bool, 3> corner{};
  int corners = 0;
  bool whole = false;
};
TileSearch::Cover TileSearch::cover(const Patch& patch, const Moment& at, double height) const {
  const double needed = margin(patch, height);
  std::array<Deep, 3> deep;
  Cover out{at, {}, 0, false};
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    deep[i] = deepest(patch.p[i] + height * patch.n[i], at, needed);
    least = std::min(least, deep[i].f);
    out.corner[i] = deep[i].f >= needed;
    out.corners += out.corner[i];
  }
  out.whole = out.corners == 3 && least >= needed + bent(swept_.tools[at.tool], deep);
  return out;
}
/// Of the moments of late, which come in front of the others when they cover the whole.
TileSearch::Cover TileSearch::best_cover(const Patch& patch, double height) {
  Cover best{};
  for (std::size_t i = recent_.size(); i-- > 0;) {
    const Cover c = cover(patch, recent_[i], height);
    if (c.whole) {
      std::rotate(recent_.begin() + static_cast<std::ptrdiff_t>(i),
                  recent_.begin() + static_cast<std::ptrdiff_t>(i) + 1, recent_.end());
      return c;
    }
    for (std::size_t k = 0; k < 3; ++k) reached_[k] = reached_[k] || c.corner[k];
    if (c.corners > best.corners) best = c;
  }
  return best;
}

/// What stands at a place; nothing: it is not reached.
std::optional<double> TileSearch::look(Point3 p, Vec3 n) {
  SampleLine line = swept_.line(p, n, options_);
  swept_.lower(line, recent_.back());
  swept_.lower(line);
  if (!line.found()) return std::nullopt;
  remember(line.at);
  if (line.best > worst_.excess.mm) worst_.excess = {line.best, p, n, swept_.move_of(line.at)};
  return line.best;
}

void TileSearch::excess(const Patch& patch, int halvings) {
  if (beside_unmachined_) return;
  reached_ = {};
  Cover best = best_cover(patch, height());
  if (best.whole || height() >= options_.reach_mm) return;
  if (steps_ == 0 || halvings >= kMostCuts) {
    worst_.excess_open = true;
    if (look(patch.middle(), patch.normal()) && !raise_over(patch)) {
      // No height covers it. Cut to nothing, it holds an unmachined place, else nothing is known.
      if (halvings >= kMostCuts)
        beside_unmachined_ = true;
      else
        worst_.excess_most = options_.reach_mm;
    }
    return;
  }
  --steps_;
  bool any = false;
  const std::array<bool, 3> reached = reached_;
  for (std::size_t i = 0; i < 3; ++i) {
    if (reached[i]) continue;
    const std::optional<double> mm = look(patch.p[i], patch.n[i]);
    if (!mm) {
      beside_unmachined_ = true;
      return;
    }
    any = true;
    if (*mm < 0) {  // the tool may end below the height asked for, and covers the surface itself
      if (best_cover(patch, 0).whole) return;
      continue;
    }
    // Where the tool is steep, what the motion may be off by matters more than the gap.
    const Point3 p = patch.p[i];
    const Vec3 n = patch.n[i];
    if (!raise_over({{p, p, p}, {n, n, n}})) worst_.excess_most = options_.reach_mm;
  }
  if (any) best = best_cover(patch, height());
  if (best.whole) return;
  for (const Patch& part : cut(patch, best)) excess(part, halvings + 1);
}

/// Where two passes meet: cut where the one that covers most ends, so that it covers one part and, the height
/// asked for being above the ridge, its neighbour the other.
std::array<Patch, 2> TileSearch::cut(const Patch& patch, const Cover& cover) const {
  if (cover.corners == 0 || cover.corners == 3) return patch.halves();
  std::size_t side = 3;
  double longest = -1;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    if (cover.corner[i] == cover.corner[j] || distance(patch.p[i], patch.p[j]) <= longest) continue;
    side = i;
    longest = distance(patch.p[i], patch.p[j]);
  }
  const double needed = margin(patch, height());
  double in = cover.corner[side] ? 0 : 1, out = 1 - in;
  for (int k = 0; k < kBisect; ++k) {
    const double share = 0.5 * (in + out);
    const Patch half = patch.parts(side, share)[1];  // its first corner is the place
    (deepest(half.p[0] + height() * half.n[0], cover.at, needed).f >= needed ? in : out) = share;
  }
  return patch.parts(side, std::clamp(in, kLeastShare, 1 - kLeastShare));
}

/// The height that one moment is known to leave below it: the rest of the tile need not be shown to be lower.
/// False when there is none up to the reach.
bool TileSearch::raise_over(const Patch& patch) {
  for (double more = 0; height() + more < options_.reach_mm; more = std::max(limits_.gap, kWider * more)) {
    const double up = height() + more;
    if (!best_cover(patch, up).whole) continue;
    worst_.excess_most = std::max(worst_.excess_most, up);
    return true;
  }
  return false;
}

}  // namespace burin::verify

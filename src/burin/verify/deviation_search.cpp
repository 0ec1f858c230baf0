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
// Stretches of neighbours that are tried on a patch.
constexpr std::size_t kRecent = 8;
// Steps towards the moment at which a corner is deepest in the tool.
constexpr int kSecant = 4;
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
  if (count <= kGroup) {
    for (const Patch& patch : patches) {
      const TriangleExtent above = shifted(patch, 0), below = shifted(patch, -depth());
      for (const SweptTool::Part& part : some)
        swept_.tools[part.tool].gather(part, below, above, margin(patch, depth()),
                                       [&](const Candidate& c) { gouge(patch, c, c.whole, 0); });
    }
    return;
  }
  const std::size_t part = (count + kGroup - 1) / kGroup;
  for (std::size_t first = 0; first < count; first += part)
    gouge(index + first, std::min(part, count - first), some);
}

void TileSearch::gouge(const Patch& patch, const Candidate& c, const Span& span, int halvings) {
  const MillBody& body = swept_.tools[c.tool].body(c.body);
  const double enough = -margin(patch, depth());
  const Upper below = upper_bound(body, *c.stretch, span, shifted(patch, -depth()), enough);
  if (below.value <= enough) return;
  const Upper above = upper_bound(body, *c.stretch, span, shifted(patch, 0), -limits_.motion);
  if (above.value <= -limits_.motion) return;
  const TriangleExtent sunk = shifted(patch, -depth());
  if (inscribed_.none_counts(sunk.center, sunk.radius, depth())) return;
  if (steps_ == 0 || halvings >= kMostHalvings) {
    give_up(patch, c, span);
    return;
  }
  --steps_;
  if (below.f > 0 && above.f > 0) {
    SampleLine line = swept_.line(patch.middle(), patch.normal(), options_);
    swept_.tools[c.tool].lower(line, c);
    swept_.lower(line);
    take(line);
    if (worst_.gouge.mm >= options_.reach_mm) return;
  }
  const Upper& why = above.f < below.f ? above : below;
  if (why.time > why.space) {
    for (const Span& part : span.halves(*c.stretch)) gouge(patch, c, part, halvings + 1);
  } else {
    for (const Patch& part : patch.halves()) gouge(part, c, span, halvings + 1);
  }
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

void TileSearch::take(const SampleLine& line) {
  if (!line.found()) return;
  const double deep = inscribed_.own(line.q, line.n, -line.best, options_.resolution_mm);
  if (deep > worst_.gouge.mm) worst_.gouge = {deep, line.q, line.n, swept_.move_of(line.at)};
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

void TileSearch::excess(const Patch& patch, int halvings) {
  if (beside_unmachined_ || covered(patch, height())) return;
  if (steps_ == 0 || halvings >= kMostHalvings) {
    give_up(patch);
    return;
  }
  --steps_;
  const Point3 m = patch.middle();
  const Vec3 n = patch.normal();
  if (!covered({{m, m, m}, {n, n, n}}, height())) {
    SampleLine line = swept_.line(m, n, options_);
    swept_.lower(line, recent_.back());
    swept_.lower(line);
    if (!line.found()) {
      beside_unmachined_ = true;
      return;
    }
    remember(line.at);
    if (line.best > worst_.excess.mm) worst_.excess = {line.best, m, n, swept_.move_of(line.at)};
    if (covered(patch, line.at, height())) return;
  }
  for (const Patch& half : patch.halves()) excess(half, halvings + 1);
}

bool TileSearch::covered(const Patch& patch, double height) {
  for (std::size_t i = recent_.size(); i-- > 0;)
    if (covered(patch, recent_[i], height)) {
      std::rotate(recent_.begin() + static_cast<std::ptrdiff_t>(i),
                  recent_.begin() + static_cast<std::ptrdiff_t>(i) + 1, recent_.end());
      return true;
    }
  return false;
}

bool TileSearch::covered(const Patch& patch, const Moment& at, double height) const {
  const SweptTool& tool = swept_.tools[at.tool];
  const MillBody& body = tool.body(at.body);
  const Candidate c = tool.candidate(at.stretch, at.body);
  const Stretch& stretch = *c.stretch;
  const double needed = margin(patch, height);
  double first = 1, last = 0, far = 0, least = std::numeric_limits<double>::infinity();
  double t = at.time;
  for (std::size_t i = 0; i < 3; ++i) {
    const Point3 p = patch.p[i] + height * patch.n[i];
    const auto rate = [&](const Placed& placed, const BodyAt& b) {
      return -dot(b.sides[b.least].gradient, stretch.way + cross(stretch.turn, p - placed.tip));
    };
    Placed placed = stretch.at(t);
    BodyAt b = body_at(body, placed.tip, placed.axis, p);
    if (b.f < needed) {
      // The moment of its own at which it is deepest.
      double a = t, rate_a = rate(placed, b), e = rate_a > 0 ? 1 : 0;
      for (int k = 0; k < kSecant && b.f < needed; ++k) {
        placed = stretch.at(e);
        b = body_at(body, placed.tip, placed.axis, p);
        t = e;
        const double rate_e = rate(placed, b);
        if ((rate_e > 0) == (rate_a > 0)) break;
        e = a + rate_a / (rate_a - rate_e) * (e - a);
      }
      if (b.f < needed) return false;
    }
    first = std::min(first, t);
    last = std::max(last, t);
    far = std::max(far, norm(p - placed.tip));
    least = std::min(least, b.f);
  }
  if (c.turn_rate == 0 || last <= first) return true;
  const double time = last - first, size = 2 * shifted(patch, height).radius;
  const double reach = far + size + c.way_rate * time;
  const double bend =
      0.5 * c.turn_rate * ((c.turn_rate * reach + 2 * c.way_rate) * time * time + 2 * size * time);
  return least >= needed + bend;
}

void TileSearch::give_up(const Patch& patch) {
  worst_.excess_open = true;
  for (double more = limits_.gap; height() + more < options_.reach_mm; more *= kWider) {
    const double up = height() + more;
    if (up > worst_.excess_most && !covered(patch, up)) continue;
    worst_.excess_most = std::max(worst_.excess_most, up);
    return;
  }
  worst_.excess_most = options_.reach_mm;
}

}  // namespace burin::verify

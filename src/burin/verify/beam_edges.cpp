// SPDX-License-Identifier: Apache-2.0
// Places on the outline: how far outwards the cut begins, how deep it goes into the part, and where there is
// none. Stretches are halved until a bound over all their rays says enough. docs/verify-beam.md
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>

#include "burin/base/parallel.h"
#include "burin/verify/beam_entry.h"
#include "burin/verify/beam_parts.h"

namespace burin::verify {
namespace {

using flat::kNever;
using geom::Point2;
using geom::Segment;
using geom::Vec2;

constexpr std::size_t kChunk = 128;  ///< segments a task
/// Of a task, for each stretch it begins with and in all: where a program does not fit its outlines at all,
/// halving would go on everywhere.
constexpr std::size_t kMostLooks = 10, kLooksAtLeast = 1000;
/// Places a drawing gets at most when no spacing is asked for, and beam diameters from one to the next when
/// there are fewer.
constexpr double kMostPlaces = 100'000, kSpacingInKerfs = 2;
constexpr int kMostSteps = 60;           ///< into the part at one place
constexpr double kResolution_mm = 1e-7;  ///< of depths: a tenth of the last decimal of any NC program

enum class Kind { cut, corner, uncut };

/// One ray.
struct Look {
  Kind kind = Kind::cut;
  double mm = 0;            ///< to the cut (corner: the nearest way)
  std::uint32_t piece = 0;  ///< that it meets
  bool meets = false;       ///< `piece` says something
  Point2 p;
};

struct Outcome {
  std::vector<BeamPlace> places;
  BeamWorst excess, corner;
  double left = 0, corner_left = 0;  ///< what was not looked into is no worse
  double weighted_mm2 = 0, length_mm = 0, area_mm2 = 0, uncut_mm = 0, spacing_mm = 0;
};

/// Segments of edges, then of centre lines, by one number.
struct Item {
  const Segment* segment = nullptr;
  std::uint32_t outline = 0;
  bool centre = false;
};
Item item_of(const BeamScene& scene, std::size_t i) {
  const std::size_t edges = scene.edges.segments().size();
  if (i < edges) return {&scene.edges.segments()[i], scene.edge_outline[i], false};
  return {&scene.lines.segments()[i - edges], scene.line_outline[i - edges], true};
}

/// The segments [first, end). First all are looked at here and there, so that refining knows what the worst
/// is at least.
class Task {
 public:
  Task(const BeamScene& scene, double spacing, std::size_t first, std::size_t end)
      : scene_(scene), radius_(scene.radius), spacing_(spacing), first_(first), end_(end) {}

  void survey() {
    for (std::size_t i = first_; i < end_; ++i) {
      take(i);
      const std::size_t n = parts();
      for (std::size_t k = 0; k <= n; ++k) looks_.push_back(look(double(k) / double(n)));
    }
  }

  void refine(double excess, double corner) {
    known_excess_ = excess;
    known_corner_ = corner;
    left_looks_ = kMostLooks * looks_.size() + kLooksAtLeast;
    std::size_t at = 0;
    for (std::size_t i = first_; i < end_; ++i) {
      take(i);
      const std::size_t n = parts();
      for (std::size_t k = 0; length_ > 0 && k < n; ++k)
        halve(double(k) / double(n), double(k + 1) / double(n), looks_[at + k], looks_[at + k + 1]);
      at += n + 1;
    }
    looks_.clear();
  }
  const Outcome& outcome() const { return out_; }

 private:
  double bound() const { return 0.5 * scene_.options.bound_mm; }

  void take(std::size_t i) {
    const Item item = item_of(scene_, i);
    whole_ = item.segment;
    outline_ = item.outline;
    centre_ = item.centre;
    length_ = length_of(*whole_);
  }
  std::size_t parts() const { return static_cast<std::size_t>(std::max(1.0, std::ceil(length_ / spacing_))); }

  // --- one ray
  // -------------------------------------------------------------------------------------------------

  Look look(double f) {
    if (left_looks_ > 0) --left_looks_;
    Look l;
    l.p = point_on(*whole_, f);
    if (centre_) {
      const auto near = scene_.cut.nearest(l.p, radius_);
      l.kind = near.found() ? Kind::cut : Kind::uncut;
      l.mm = near.distance;
      l.piece = near.segment;
      l.meets = near.found();
    } else {
      const Vec2 n = flat::normal_at(*whole_, f);
      l.mm = kNever;
      scene_.cut.along(l.p, n, scene_.options.reach_mm, radius_, [&](std::uint32_t i) {
        const double s = l.mm == 0 ? kNever : entry_of(l.p, n, scene_.cut.segments()[i], radius_);
        if (s < l.mm) l.mm = s, l.piece = i;
        return std::min(l.mm, scene_.options.reach_mm);
      });
      l.meets = l.mm <= scene_.options.reach_mm;
      if (!l.meets || l.mm > bound()) judge(l, n);
    }
    count(l);
    return l;
  }

  /// A place that the cut touches is cut, even when its ray leads away (beside a beam on the wrong side,
  /// rounding alone would decide); a place in the part is no edge of it; a beam that does not fit in here
  /// leaves a corner; a ray that comes to the part again before the cut has found none.
  void judge(Look& l, Vec2 n) {
    const auto touched = scene_.cut.nearest(l.p, radius_ + scene_.options.bound_mm);
    if (touched.found()) {
      l.mm = std::max(0.0, touched.distance - radius_);
      l.piece = touched.segment;
      l.meets = true;
      return;
    }
    if (scene_.winding(l.p - kBeside_mm * n) > 1) {
      l.mm = 0;
      l.meets = false;
      return;
    }
    const double fits = radius_ + scene_.options.tolerance_mm;
    // The disc beside the place holds part, or, in the tip of a corner, lies in it.
    if (scene_.edges.nearest(l.p + fits * n, fits).distance < fits - scene_.options.bound_mm ||
        blocked(l.p, n, std::min(2 * fits, l.mm))) {
      l.kind = Kind::corner;
      const auto near = scene_.cut.nearest(l.p, radius_ + scene_.options.reach_mm);
      l.meets = near.found();
      l.piece = near.segment;
      l.mm = std::max(0.0, near.distance - radius_);
      // Further than a kerf and not in sight: what is near is another cut.
      if (l.meets && l.mm > scene_.options.kerf_mm && blocked(l.p, unit(near.point - l.p), l.mm))
        l.meets = false;
    } else if (l.meets && l.mm > 2 * radius_) {
      l.meets = !blocked(l.p, n, l.mm);
    }
    if (!l.meets) l.kind = Kind::uncut;
  }

  /// Whether part lies between p (on an edge) and p + s n.
  bool blocked(Point2 p, Vec2 n, double s) const {
    const Segment way = geom::make_line(p + std::min(kBeside_mm, 0.5 * s) * n, p + s * n);
    return scene_.in_part(way.a) || scene_.edges.nearest(way, flat::kRounding).distance < kNever;
  }

  void count(const Look& l) {
    if (l.kind == Kind::uncut) return;
    BeamWorst& worst = l.kind == Kind::corner ? out_.corner : out_.excess;
    if (l.mm > worst.mm) worst = {l.mm, l.p, scene_.motion.moves[l.piece]};
  }

  // --- stretches
  // ------------------------------------------------------------------------------------------------

  /// No place of the stretch is worse, whichever piece of the cut it is held against.
  double worst_of(const Segment& s, const Look* looks, bool corner) const {
    double worst = kNever;
    std::uint32_t last = 0;
    bool any = false;
    if (!looks[0].meets && !looks[1].meets && !looks[2].meets) return 0;
    for (int i = 0; i < 3; ++i) {
      if (!looks[i].meets || (any && looks[i].piece == last)) continue;
      last = looks[i].piece;
      any = true;
      const Segment& piece = scene_.cut.segments()[last];
      if (centre_) {
        worst = std::min(worst, flat::most_distance(s, piece));
        continue;
      }
      const double off = std::max(0.0, flat::most_distance(s, piece) - radius_);
      worst = std::min(worst, corner ? off : latest_entry(s, piece, radius_));
      if (off <= scene_.options.bound_mm) worst = std::min(worst, off);  // touched all along
    }
    return worst;
  }

  void halve(double f0, double f1, const Look& from, const Look& to) {
    const double f = 0.5 * (f0 + f1), length = length_ * (f1 - f0);
    const Look looks[3] = {from, look(f), to};
    int uncut = 0, corner = 0;
    for (const Look& l : looks) uncut += l.kind == Kind::uncut, corner += l.kind == Kind::corner;
    const Segment s = flat::stretch(*whole_, f0, f1);
    if (uncut == 3) return place(looks[1], f, s);
    if (uncut == 0) {
      const bool corners = corner == 3;
      const double worst = worst_of(s, looks, corners);
      const double known =
          corners ? std::max(known_corner_, out_.corner.mm) : std::max(known_excess_, out_.excess.mm);
      double& left = corners ? out_.corner_left : out_.left;
      if (worst <= known + bound() || (left_looks_ == 0 && worst < kNever)) {
        left = std::max(left, worst);
        return place(looks[1], f, s);
      }
    }
    if (left_looks_ == 0 && uncut == 0) out_.left = scene_.options.reach_mm;  // nothing is known
    if (length <= bound() || left_looks_ == 0) return place(looks[1], f, s);
    halve(f0, f, from, looks[1]);
    halve(f, f1, looks[1], to);
  }

  /// The middle of a stretch that is not halved any more.
  void place(const Look& l, double f, const Segment& s) {
    BeamPlace place;
    place.p = l.p;
    place.n = flat::normal_at(*whole_, f);
    place.length_mm = length_of(s);
    place.outline = outline_;
    place.corner = l.kind == Kind::corner;
    place.deviation_mm = l.kind == Kind::uncut ? std::numeric_limits<double>::quiet_NaN() : l.mm;
    if (!centre_ && l.mm == 0) place.deviation_mm = -depth(place.p, place.n);
    out_.spacing_mm = std::max(out_.spacing_mm, place.length_mm);
    if (l.kind == Kind::uncut) {
      out_.uncut_mm += place.length_mm;
    } else if (l.kind == Kind::cut) {
      const double mm = std::max(0.0, place.deviation_mm);
      out_.weighted_mm2 += mm * place.length_mm;
      out_.length_mm += place.length_mm;
      // A strip beside an arc is wider or narrower outside.
      const double bend = whole_->is_line() ? 0 : 0.5 * mm / whole_->radius;
      if (!centre_ && mm > scene_.area_from_mm)
        out_.area_mm2 += mm * place.length_mm * std::max(0.0, 1 + bend);
    }
    out_.places.push_back(place);
  }

  /// Down from p through what is swept without a gap, as deep as p is the nearest edge.
  double depth(Point2 p, Vec2 n) const {
    double t = 0, deepest = 0;
    for (int i = 0; i < kMostSteps && t < scene_.options.reach_mm; ++i) {
      const auto near = scene_.cut.nearest(p - t * n, radius_);
      const double step = near.found() ? radius_ - near.distance : 0;
      if (step < kResolution_mm) break;
      t = std::min(t + step, scene_.options.reach_mm);
      const double mm = depth_at(scene_, p - t * n).mm;
      deepest = std::max(deepest, mm);
      if (mm < t - kResolution_mm) break;
    }
    return deepest;
  }

  const BeamScene& scene_;
  double radius_, spacing_;
  std::size_t first_, end_;
  const Segment* whole_ = nullptr;
  std::uint32_t outline_ = 0;
  bool centre_ = false;
  double length_ = 0;
  std::vector<Look> looks_;  ///< of the survey
  double known_excess_ = 0, known_corner_ = 0;
  std::size_t left_looks_ = 0;
  Outcome out_;
};

}  // namespace

Result<BeamReport> measure_edges(const BeamScene& scene) {
  const auto& edges = scene.edges.segments();
  const auto& lines = scene.lines.segments();
  double total = 0;
  for (const auto* all : {&edges, &lines}) {
    for (const Segment& s : *all) total += length_of(s);
  }
  const BeamCheckOptions& o = scene.options;
  const double spacing =
      o.spacing_mm > 0 ? o.spacing_mm : std::max(kSpacingInKerfs * o.kerf_mm, total / kMostPlaces);
  if (!(total / spacing + double(edges.size() + lines.size()) <= double(o.max_samples))) {
    return Error{ErrorCode::range,
                 "too many places on the outline (up to " + std::to_string(o.max_samples) +
                     "; a wider spacing, fewer outlines)",
                 {}};
  }
  const std::size_t count = edges.size() + lines.size();
  std::vector<Task> tasks;
  for (std::size_t i = 0; i < count; i += kChunk)
    tasks.emplace_back(scene, spacing, i, std::min(count, i + kChunk));
  parallel_for(tasks.size(), scene.threads, [&](std::size_t i, std::size_t) { tasks[i].survey(); });
  double excess = 0, corner = 0;
  for (const Task& task : tasks) {
    excess = std::max(excess, task.outcome().excess.mm);
    corner = std::max(corner, task.outcome().corner.mm);
  }
  parallel_for(tasks.size(), scene.threads,
               [&](std::size_t i, std::size_t) { tasks[i].refine(excess, corner); });

  BeamReport report;
  report.outline_mm = total;
  double weighted = 0, length = 0, left = 0, corner_left = 0;
  std::set<std::uint32_t> uncut;
  for (const Task& task : tasks) {
    const Outcome& part = task.outcome();
    report.places.insert(report.places.end(), part.places.begin(), part.places.end());
    if (part.excess.mm > report.excess.mm) report.excess = part.excess;
    if (part.corner.mm > report.corner_excess.mm) report.corner_excess = part.corner;
    left = std::max(left, part.left);
    corner_left = std::max(corner_left, part.corner_left);
    weighted += part.weighted_mm2;
    length += part.length_mm;
    report.excess_area_mm2 += part.area_mm2;
    report.uncut_mm += part.uncut_mm;
    report.spacing_mm = std::max(report.spacing_mm, part.spacing_mm);
    for (const BeamPlace& place : part.places) {
      if (std::isnan(place.deviation_mm)) uncut.insert(place.outline);
    }
  }
  report.uncut_outlines.assign(uncut.begin(), uncut.end());
  if (length > 0) report.excess_mean_mm = weighted / length;
  report.bound_mm = std::max({0.0, left - report.excess.mm, corner_left - report.corner_excess.mm});
  return report;
}

}  // namespace burin::verify

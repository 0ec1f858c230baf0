// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/cycle/order.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace burin::cycle {
namespace {

using geom::Point2;

// Links on the surface are at most this many side steps or this many tool radii long.
constexpr double kLinkSteps = 2.5;
constexpr double kLinkRadii = 1.0;
// How far a link may leave the region, relative to its length: along curved trimming loops.
constexpr double kOutside = 0.25;
// Shorter stretches are points, mm.
constexpr double kShortest = 1e-5;

double chord_length(const Track& track) {
  double sum = 0;
  for (const TrackPiece& p : track)
    for (std::size_t k = 0; k + 1 < p.tip.nodes.size(); ++k)
      sum += distance(p.tip.nodes[k].p, p.tip.nodes[k + 1].p);
  return sum;
}

Track reversed(const Track& track) {
  Track out;
  for (auto p = track.rbegin(); p != track.rend(); ++p) {
    TrackPiece q = *p;
    q.tip = geom::reversed(p->tip);
    q.uv = geom::reversed(p->uv);
    out.push_back(std::move(q));
  }
  return out;
}

Point2 to_uv(const Sheet& sheet, Point2 tw) {
  const Point3 p = sheet.uv(tw.x, tw.y);
  return {p.x, p.y};
}

class Planner {
 public:
  Planner(const Sheet& sheet, int surface, std::vector<Stretch> parts, const std::vector<PairFigures>& pairs,
          const Region& region, double path_mm)
      : sheet_(sheet),
        surface_(surface),
        parts_(std::move(parts)),
        pairs_(pairs),
        region_(region),
        path_mm_(path_mm),
        taken_(parts_.size(), false) {
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      const auto pass = static_cast<std::size_t>(parts_[i].pass);
      if (by_pass_.size() <= pass) by_pass_.resize(pass + 1);
      by_pass_[pass].push_back(i);
    }
  }

  std::vector<Chain> run() {
    for (std::size_t first = 0; first < parts_.size();) {
      if (taken_[first]) {
        ++first;
        continue;
      }
      start_chain(first);
      while (extend()) {
      }
    }
    return std::move(chains_);
  }

 private:
  void start_chain(std::size_t i) {
    bool back = false;
    if (!chains_.empty()) {
      const Point3 at = chains_.back().back().track.tip.end();
      back = distance(at, parts_[i].end) < distance(at, parts_[i].start);
    }
    chains_.emplace_back();
    add(i, back);
  }

  void add(std::size_t i, bool back) {
    Stretch& s = parts_[i];
    taken_[i] = true;
    pass_ = s.pass;
    at_ = back ? s.from : s.to;
    Track track = back ? reversed(s.track) : std::move(s.track);
    s.track.clear();
    Chain& chain = chains_.back();
    for (TrackPiece& p : track) {
      // Pieces meet exactly, whatever rounding left between them.
      if (!chain.empty()) p.tip.nodes.front().p = chain.back().track.tip.nodes.back().p;
      const MotionKind kind = p.over ? MotionKind::link : MotionKind::cut;
      chain.push_back({std::move(p), kind, &sheet_, surface_, pass_, back, 0});
    }
  }

  double link_limit(int pass) const {
    const auto i = static_cast<std::size_t>(std::min(pass, pass_));
    const double step = i < pairs_.size() ? pairs_[i].side_step_max : 0;
    return std::max(kLinkSteps * step, kLinkRadii * sheet_.radius());
  }

  // The nearest end of a stretch of the next pass (or of this one) that can be reached on the surface.
  bool extend() {
    const Point3 here = sheet_.contact(at_.x, at_.y).s;
    std::size_t best = 0;
    bool back = false, found = false;
    double near = std::numeric_limits<double>::infinity();
    for (const int pass : {pass_ + 1, pass_}) {
      if (pass >= static_cast<int>(by_pass_.size())) continue;
      for (const std::size_t i : by_pass_[static_cast<std::size_t>(pass)]) {
        if (taken_[i]) continue;
        for (const bool b : {false, true}) {
          const Point2 to = b ? parts_[i].to : parts_[i].from;
          const double d = distance(here, sheet_.point(to.x, to.y));
          if (!(d < near) || d > link_limit(pass)) continue;
          if (!region_.stays_inside(to_uv(sheet_, at_), to_uv(sheet_, to), kOutside)) continue;
          near = d, best = i, back = b, found = true;
        }
      }
      if (found) break;
    }
    if (!found) return false;
    link(best, back);
    add(best, back);
    return true;
  }

  void link(std::size_t i, bool back) {
    Chain& chain = chains_.back();
    const Point3 from = chain.back().track.tip.end();
    const Point3 to = back ? parts_[i].end : parts_[i].start;
    const Point2 to_tw = back ? parts_[i].to : parts_[i].from;
    if (distance(from, to) <= path_mm_) return;
    Track track;
    if (!(at_.x == to_tw.x && at_.y == to_tw.y)) track = build_track(sheet_, at_, to_tw, path_mm_);
    // A path along a crease may hold the ball on the other side of it than the link does.
    const auto turn = [&](Point2 tw, Point3 a, Point3 b) {
      const Contact c = sheet_.contact(tw.x, tw.y);
      return turn_about(c.s, sheet_.radius(), a, b, c.st, sheet_.uv(tw.x, tw.y));
    };
    if (track.empty()) {
      track.push_back(turn(at_, from, to));
    } else {
      const Point3 starts = track.front().tip.start(), ends = track.back().tip.end();
      if (distance(ends, to) > path_mm_) track.push_back(turn(to_tw, ends, to));
      if (distance(from, starts) > path_mm_) track.insert(track.begin(), turn(at_, from, starts));
    }
    for (TrackPiece& p : track) {
      p.tip.nodes.front().p = chain.back().track.tip.nodes.back().p;
      chain.push_back({std::move(p), MotionKind::link, &sheet_, surface_, -1, false, 0});
    }
    chain.back().track.tip.nodes.back().p = to;
  }

  const Sheet& sheet_;
  int surface_;
  std::vector<Stretch> parts_;
  const std::vector<PairFigures>& pairs_;
  const Region& region_;
  double path_mm_;
  std::vector<bool> taken_;
  std::vector<std::vector<std::size_t>> by_pass_;
  std::vector<Chain> chains_;
  int pass_ = 0;
  Point2 at_;
};

}  // namespace

namespace {

/// The track over t, with what lies beyond the edges told apart.
Track kept_track(const Pass& pass, geom::Interval t) {
  if (!pass.inner) return cut_track(pass.track, t.lo, t.hi);
  Track out;
  const auto add = [&](double lo, double hi, bool over) {
    if (!(lo < hi)) return;
    for (TrackPiece& p : cut_track(pass.track, lo, hi)) {
      p.over = over;
      out.push_back(std::move(p));
    }
  };
  const double lo = std::clamp(pass.inner->lo, t.lo, t.hi), hi = std::clamp(pass.inner->hi, t.lo, t.hi);
  add(t.lo, lo, true);
  add(lo, hi, false);
  add(hi, t.hi, true);
  return out;
}

}  // namespace

std::vector<Stretch> stretches(Passes& passes, const Region& region, geom::Direction along) {
  std::vector<Stretch> out;
  for (std::size_t i = 0; i < passes.passes.size(); ++i) {
    Pass& pass = passes.passes[i];
    const bool whole = region.whole() && pass.graphs.size() == 1 && !pass.kept;
    for (const Graph& g : pass.graphs)
      for (geom::Interval t : region.cut(g, along)) {
        if (pass.kept) t = {std::max(t.lo, pass.kept->lo), std::min(t.hi, pass.kept->hi)};
        if (!(t.lo < t.hi)) continue;
        Stretch s;
        s.pass = static_cast<int>(i);
        s.track = whole ? std::move(pass.track) : kept_track(pass, t);
        if (s.track.empty() || chord_length(s.track) < kShortest) continue;
        s.from = {t.lo, g.at(t.lo).w};
        s.to = {t.hi, g.at(t.hi).w};
        s.start = s.track.front().tip.start();
        s.end = s.track.back().tip.end();
        out.push_back(std::move(s));
      }
    pass.track = {};
  }
  return out;
}

std::vector<Chain> order(const Sheet& sheet, int surface, std::vector<Stretch> parts,
                         const std::vector<PairFigures>& pairs, const Region& region, double path_mm) {
  return Planner(sheet, surface, std::move(parts), pairs, region, path_mm).run();
}

}  // namespace burin::cycle

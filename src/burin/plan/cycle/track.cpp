// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/cycle/track.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace burin::cycle {
namespace {

using geom::QuinticNode;
using geom::QuinticPath;
using geom::Side;

// Halvings between two places where nodes must be: 4096 nodes, 0.02 mm on 100 mm.
constexpr int kMaxDepth = 12;
// First derivatives on both sides of a knot that differ relatively by less than this are one: the error of
// the path is below 0.1 h of it, far below path_mm.
constexpr double kSameTangent = 1e-7;
// Largest value of the quintic Hermite basis function of the second derivative, x^2 (1-x)^3 / 2 at 2/5.
constexpr double kSecondBasis = 0.01728;

/// A place where a node must be; values that are exactly on knots of the surface.
struct Mark {
  double s = 0;
  bool t_knot = false, w_knot = false;
  double t = 0, w = 0;
};

struct Node {
  QuinticNode tip, uv;
  Contact contact;
};

class Builder {
 public:
  Builder(const Sheet& sheet, const UvCurve& curve, double path_mm)
      : sheet_(sheet), curve_(curve), path_mm_(path_mm) {}

  Track build(const std::vector<Mark>& marks) {
    std::vector<std::vector<Node>> runs;
    for (std::size_t i = 0; i + 1 < marks.size(); ++i) {
      std::vector<Node> run;
      run.push_back(node(marks[i], false));
      refine(run, node(marks[i + 1], true), 0);
      runs.push_back(std::move(run));
    }
    std::vector<bool> over_edge;
    for (const Mark& m : marks) over_edge.push_back(m.t_knot && at_edge(m.t));
    return connect(runs, over_edge);
  }

 private:
  // `before`: as the end of the part that arrives at the mark.
  Node node(const Mark& m, bool before) const {
    UvPoint p = curve_(m.s);
    if (m.t_knot) p.t = m.t;
    if (m.w_knot) p.w = m.w;
    const auto side = [before](double speed) {
      if (speed == 0) return Side::right;
      return (speed > 0) == before ? Side::left : Side::right;
    };
    return node(m.s, p, side(p.t1), side(p.w1));
  }

  /// An edge that the sheet goes on beyond.
  bool at_edge(double t) const {
    const geom::Interval inner = sheet_.t_inner(), all = sheet_.t_range();
    return (t == inner.lo && inner.lo > all.lo) || (t == inner.hi && inner.hi < all.hi);
  }

  Node node(double s, const UvPoint& p, Side side_t, Side side_w) const {
    const CentreDerivatives d = sheet_.derivatives(p.t, p.w, side_t, side_w);
    Node r;
    r.contact = d.at;
    r.tip.t = s;
    r.tip.p = sheet_.tip(d.at);
    r.tip.d1 = p.t1 * d.at.ct + p.w1 * d.at.cw;
    r.tip.d2 = (p.t1 * p.t1) * d.ctt + (2 * p.t1 * p.w1) * d.ctw + (p.w1 * p.w1) * d.cww + p.t2 * d.at.ct +
               p.w2 * d.at.cw;
    // Beyond the edges of the surface the parameters stay on the edge.
    const geom::Interval inner = sheet_.t_inner();
    const bool left = side_t == Side::left;
    const bool outside = p.t < inner.lo || p.t > inner.hi || (at_edge(p.t) && (p.t == inner.lo) == left);
    const double keep = outside ? 0.0 : 1.0;
    r.uv = {s, sheet_.uv(p.t, p.w), sheet_.uv_vector(keep * p.t1, p.w1), sheet_.uv_vector(keep * p.t2, p.w2)};
    return r;
  }

  bool good(const Node& a, const Node& b, const Node& mid) const {
    const double tol = 0.7 * path_mm_;
    const QuinticPath piece{{a.tip, b.tip}};
    if (!(distance(evaluate_piece(piece, 0, 0.5).p, mid.tip.p) <= tol)) return false;
    for (const double x : {0.25, 0.75}) {
      const UvPoint p = curve_(a.tip.t + x * (b.tip.t - a.tip.t));
      if (!(distance(evaluate_piece(piece, 0, x).p, sheet_.tip(sheet_.contact(p.t, p.w))) <= tol))
        return false;
    }
    return true;
  }

  void refine(std::vector<Node>& run, const Node& b, int depth) {
    const Node a = run.back();
    const double s = 0.5 * (a.tip.t + b.tip.t);
    if (depth >= kMaxDepth || !(a.tip.t < s && s < b.tip.t)) {
      run.push_back(b);
      return;
    }
    const Node mid = node(s, curve_(s), Side::right, Side::right);
    if (good(a, b, mid)) {
      run.push_back(b);
      return;
    }
    refine(run, mid, depth + 1);
    refine(run, b, depth + 1);
  }

  static TrackPiece piece_of(const std::vector<Node>& run) {
    TrackPiece p;
    for (const Node& n : run) {
      p.tip.nodes.push_back(n.tip);
      p.uv.nodes.push_back(n.uv);
    }
    p.s0 = run.front().tip.t;
    p.s1 = run.back().tip.t;
    return p;
  }

  bool smooth(const TrackPiece& a, const std::vector<Node>& b) const {
    const QuinticNode &l = a.tip.nodes.back(), &r = b.front().tip;
    const double size = std::max(norm(l.d1), norm(r.d1));
    if (norm(l.d1 - r.d1) > kSameTangent * size) return false;
    const double h = std::max(l.t - a.tip.nodes[a.tip.nodes.size() - 2].t, b[1].tip.t - r.t);
    return 0.5 * kSecondBasis * h * h * norm(l.d2 - r.d2) <= 0.25 * path_mm_;
  }

  // The ball turns about the point of a crease.
  TrackPiece swing(const Node& a, const Node& b) const {
    TrackPiece p =
        turn_about(a.contact.s, sheet_.radius(), a.tip.p, b.tip.p, cross(a.contact.n, a.tip.d1), a.uv.p);
    p.s0 = p.s1 = a.tip.t;
    return p;
  }

  // `over_edge`: the run begins on an edge that the path runs over.
  Track connect(const std::vector<std::vector<Node>>& runs, const std::vector<bool>& over_edge) const {
    Track track;
    for (std::size_t i = 0; i < runs.size(); ++i) {
      const std::vector<Node>& run = runs[i];
      TrackPiece next = piece_of(run);
      if (track.empty()) {
        track.push_back(std::move(next));
        continue;
      }
      TrackPiece& last = track.back();
      QuinticNode &l = last.tip.nodes.back(), &r = next.tip.nodes.front();
      if (distance(l.p, r.p) > path_mm_) {
        // The contact of the last node is needed for the swing.
        Node a;
        a.tip = l;
        a.uv = last.uv.nodes.back();
        a.contact = last_contact_of(run.front(), l);
        track.push_back(swing(a, run.front()));
        track.push_back(std::move(next));
        continue;
      }
      l.p = r.p = lerp(l.p, r.p, 0.5);
      if (over_edge[i] || !smooth(last, run)) {
        track.push_back(std::move(next));
        continue;
      }
      l.d1 = 0.5 * (l.d1 + r.d1);
      l.d2 = 0.5 * (l.d2 + r.d2);
      last.s1 = next.s1;
      last.tip.nodes.insert(last.tip.nodes.end(), next.tip.nodes.begin() + 1, next.tip.nodes.end());
      last.uv.nodes.insert(last.uv.nodes.end(), next.uv.nodes.begin() + 1, next.uv.nodes.end());
    }
    return track;
  }

  // At a crease both sides have the same surface point; the normal before follows from the tip.
  Contact last_contact_of(const Node& after, const QuinticNode& before) const {
    Contact c = after.contact;
    c.c = {before.p.x, before.p.y, before.p.z + sheet_.radius()};
    c.n = unit(c.c - c.s);
    return c;
  }

  const Sheet& sheet_;
  const UvCurve& curve_;
  double path_mm_;
};

// Ascending by s; marks that coincide become one.
std::vector<Mark> sorted(std::vector<Mark> marks, double s0, double s1) {
  const double same = 1e-12 * (s1 - s0);
  std::erase_if(marks, [&](const Mark& m) { return m.s < s0 || m.s > s1; });
  std::stable_sort(marks.begin(), marks.end(), [](const Mark& a, const Mark& b) { return a.s < b.s; });
  std::vector<Mark> out;
  for (const Mark& m : marks) {
    if (out.empty() || m.s - out.back().s > same) {
      out.push_back(m);
      continue;
    }
    Mark& k = out.back();
    if (m.t_knot) k.t_knot = true, k.t = m.t;
    if (m.w_knot) k.w_knot = true, k.w = m.w;
  }
  if (out.size() > 1 && out.front().s != s0) out.front().s = s0;
  if (out.size() > 1 && out.back().s != s1) out.back().s = s1;
  return out;
}

}  // namespace

TrackPiece turn_about(Point3 touch, double radius, Point3 from, Point3 to, Vec3 across, Point3 uv) {
  const Point3 centre{touch.x, touch.y, touch.z - radius};
  const Vec3 a = from - centre, b = to - centre;
  Vec3 axis = cross(a, b);
  const double sine = norm(axis);
  constexpr double kKnifeEdge = 1e-9;
  if (sine < kKnifeEdge * norm(a) * norm(b)) axis = across;
  TrackPiece p;
  p.swing = true;
  p.tip = geom::arc(from, centre, unit(axis), std::atan2(sine, dot(a, b)), 0);
  p.tip.nodes.back().p = to;
  for (const QuinticNode& n : p.tip.nodes) p.uv.nodes.push_back({n.t, uv, {}, {}});
  return p;
}

Track build_track(const Sheet& sheet, const Graph& graph, double path_mm) {
  std::vector<Mark> marks;
  for (const double t : graph.t) marks.push_back({t});
  for (const geom::Knot& k : sheet.t_knots()) marks.push_back({k.value, true, false, k.value, 0});
  const auto [lo, hi] = std::minmax_element(graph.w.begin(), graph.w.end());
  const bool flat = *lo == *hi;
  if (!flat)
    for (const geom::Knot& k : sheet.w_knots())
      for (const double s : crossings(graph, k.value)) marks.push_back({s, false, true, 0, k.value});
  const UvCurve curve = [&graph](double s) { return graph.at(s); };
  return Builder(sheet, curve, path_mm).build(sorted(std::move(marks), graph.lo(), graph.hi()));
}

Track build_track(const Sheet& sheet, geom::Point2 a, geom::Point2 b, double path_mm) {
  const geom::Vec2 d = b - a;
  std::vector<Mark> marks{{0}, {1}};
  const auto add = [&](const std::vector<geom::Knot>& knots, double from, double step, bool is_t) {
    if (step == 0) return;
    for (const geom::Knot& k : knots) {
      const double s = (k.value - from) / step;
      if (is_t)
        marks.push_back({s, true, false, k.value, 0});
      else
        marks.push_back({s, false, true, 0, k.value});
    }
  };
  add(sheet.t_knots(), a.x, d.x, true);
  add(sheet.w_knots(), a.y, d.y, false);
  const UvCurve curve = [a, d](double s) { return UvPoint{a.x + s * d.x, a.y + s * d.y, d.x, d.y, 0, 0}; };
  return Builder(sheet, curve, path_mm).build(sorted(std::move(marks), 0, 1));
}

QuinticPath cut_path(const QuinticPath& path, double t0, double t1) {
  QuinticPath out;
  const auto end = [&](double t) {
    const geom::QuinticDerivatives d = evaluate(path, t);
    return QuinticNode{t, d.p, d.d1, d.d2};
  };
  if (t0 <= path.nodes.front().t) t0 = path.nodes.front().t;
  if (t1 >= path.nodes.back().t) t1 = path.nodes.back().t;
  const double same = 1e-12 * (path.nodes.back().t - path.nodes.front().t);
  if (!(t1 - t0 > same)) return out;
  out.nodes.push_back(end(t0));
  for (const QuinticNode& n : path.nodes)
    if (n.t > t0 + same && n.t < t1 - same) out.nodes.push_back(n);
  out.nodes.push_back(end(t1));
  return out;
}

Track cut_track(const Track& track, double s0, double s1) {
  Track out;
  for (const TrackPiece& p : track) {
    if (p.swing) {
      if (p.s0 > s0 && p.s0 < s1) out.push_back(p);
      continue;
    }
    if (p.s1 <= s0 || p.s0 >= s1) continue;
    if (p.s0 >= s0 && p.s1 <= s1) {
      out.push_back(p);
      continue;
    }
    TrackPiece q;
    q.tip = cut_path(p.tip, s0, s1);
    q.uv = cut_path(p.uv, s0, s1);
    if (q.tip.empty() || q.tip.nodes.size() != q.uv.nodes.size()) continue;
    q.s0 = q.tip.nodes.front().t;
    q.s1 = q.tip.nodes.back().t;
    out.push_back(std::move(q));
  }
  return out;
}

std::size_t node_count(const Track& track) {
  std::size_t n = 0;
  for (const TrackPiece& p : track) n += p.tip.nodes.size();
  return n;
}

namespace {

// Distance of p from a box, squared.
double away2(const geom::Box3& box, Point3 p) {
  const double dx = std::max({box.lo.x - p.x, p.x - box.hi.x, 0.0});
  const double dy = std::max({box.lo.y - p.y, p.y - box.hi.y, 0.0});
  const double dz = std::max({box.lo.z - p.z, p.z - box.hi.z, 0.0});
  return dx * dx + dy * dy + dz * dz;
}

}  // namespace

NearestCentre::NearestCentre(const Track& track, double radius) : track_(&track), radius_(radius) {
  for (std::size_t i = 0; i < track.size(); ++i) {
    const QuinticPath& tip = track[i].tip;
    for (std::size_t k = 0; k + 1 < tip.nodes.size(); ++k)
      for (const double x : {0.0, 0.5}) {
        const Point3 p = x == 0 ? tip.nodes[k].p : evaluate_piece(tip, k, x).p;
        samples_.push_back({p, i, k});
      }
    samples_.push_back({tip.nodes.back().p, i, tip.nodes.size() - 2});
  }
  for (Sample& s : samples_) s.c.z += radius_;
  if (!samples_.empty()) build(0, static_cast<std::uint32_t>(samples_.size()));
}

// Samples that follow each other lie near each other: halves of the run make a tree of boxes.
std::uint32_t NearestCentre::build(std::uint32_t first, std::uint32_t last) {
  constexpr std::uint32_t kLeaf = 8;
  const auto index = static_cast<std::uint32_t>(runs_.size());
  runs_.push_back({{}, first, last, 0});
  if (last - first <= kLeaf) {
    for (std::uint32_t i = first; i < last; ++i) runs_[index].box.add(samples_[i].c);
    return index;
  }
  const std::uint32_t mid = first + (last - first) / 2;
  build(first, mid);
  const std::uint32_t right = build(mid, last);
  runs_[index].right = right;
  runs_[index].box = runs_[index + 1].box;
  runs_[index].box.add(runs_[right].box);
  return index;
}

NearestCentre::Place NearestCentre::find(Point3 p) const {
  if (samples_.empty()) return {};
  // The answer to the question before is nearly always next to this one: it only rules places out sooner.
  std::uint32_t nearest = hint_;
  const Vec3 guess = p - samples_[nearest].c;
  double best = dot(guess, guess);
  struct Waiting {
    std::uint32_t run = 0;
    double away = 0;
  };
  // One entry waits on every level of a tree of halves.
  Waiting stack[64];
  int size = 0;
  stack[size++] = {0, 0.0};
  while (size > 0) {
    const Waiting next = stack[--size];
    if (next.away > best) continue;
    const Run& run = runs_[next.run];
    if (run.right == 0) {
      for (std::uint32_t i = run.first; i < run.last; ++i) {
        const Vec3 e = p - samples_[i].c;
        const double d = dot(e, e);
        // Of two that are equally near the earlier one, in whatever order they are visited.
        if (d < best || (d == best && i < nearest)) best = d, nearest = i;
      }
      continue;
    }
    const Waiting left{next.run + 1, away2(runs_[next.run + 1].box, p)};
    const Waiting right{run.right, away2(runs_[run.right].box, p)};
    const bool left_first = left.away <= right.away;
    stack[size++] = left_first ? right : left;
    stack[size++] = left_first ? left : right;
  }
  hint_ = nearest;
  return polish(p, samples_[nearest].piece, samples_[nearest].node);
}

NearestCentre::Place NearestCentre::polish(Point3 p, std::size_t piece, std::size_t interval) const {
  constexpr int kIterations = 24;
  const Track& track = *track_;
  const Point3 q{p.x, p.y, p.z - radius_};
  double x = 0.5;
  Place best;
  double best_distance = std::numeric_limits<double>::infinity();
  for (int it = 0; it < kIterations; ++it) {
    const QuinticPath& tip = track[piece].tip;
    const double h = tip.nodes[interval + 1].t - tip.nodes[interval].t;
    const geom::QuinticDerivatives d = evaluate_piece(tip, interval, x);
    const Vec3 e = d.p - q;
    const double away = dot(e, e);
    const double slope = dot(e, d.d1);
    if (away < best_distance) {
      best_distance = away;
      best.c = {d.p.x, d.p.y, d.p.z + radius_};
      best.tangent = d.d1;
      best.s = track[piece].swing ? track[piece].s0 : tip.nodes[interval].t + x * h;
      constexpr double kEnd = 1e-9;
      best.at_end = (piece == 0 && interval == 0 && x <= kEnd) ||
                    (piece + 1 == track.size() && interval + 2 == tip.nodes.size() && x >= 1 - kEnd);
    }
    double bend = dot(d.d1, d.d1) + dot(e, d.d2);
    if (!(bend > 0.1 * dot(d.d1, d.d1))) bend = dot(d.d1, d.d1);
    if (!(bend > 0)) break;
    const double step = -slope / bend / h;
    const double next = x + step;
    constexpr double kConverged = 1e-10;
    if (next >= 0 && next <= 1) {
      if (std::abs(step) < kConverged) break;
      x = next;
      continue;
    }
    if (next < 0 && x > 0) {
      x = 0;
    } else if (next > 1 && x < 1) {
      x = 1;
    } else if (next < 0) {
      if (interval > 0)
        --interval;
      else if (piece > 0)
        interval = track[--piece].tip.nodes.size() - 2;
      else
        break;
      x = 1;
    } else {
      if (interval + 2 < tip.nodes.size())
        ++interval;
      else if (piece + 1 < track.size())
        ++piece, interval = 0;
      else
        break;
      x = 0;
    }
  }
  return best;
}

}  // namespace burin::cycle

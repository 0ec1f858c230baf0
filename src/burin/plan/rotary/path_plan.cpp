// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/rotary/path_plan.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "burin/geom/vec.h"

namespace burin::rotary {
namespace {

using geom::Point3;

constexpr int kMaxRounds = 16;
// Nodes on either side of a new one that may turn again, halved every round; the others keep their angle.
constexpr std::size_t kWindow = 24;
// A ball this near (mm) to where its contact wants it touches there.
constexpr double kOnContact = 1e-6;

double turned_by(double a) {
  return std::remainder(a, 2 * geom::kPi);
}

double line_accuracy(const Shared& shared) {
  return 0.25 * shared.options.tolerance_mm;
}

Node node_at(const Shared& shared, const CenterLine& line, double s) {
  Node node;
  node.s = s;
  node.place = line.at(s);
  Place& p = node.place;
  // Between places of different contacts the ball stands on what is nearest.
  const double radius = shared.tool.radius;
  if (geom::distance(p.contact.p + radius * p.contact.n, p.center) > kOnContact) {
    if (const auto hit = shared.mesh.nearest(p.center, 2 * radius); hit && hit->distance > 0) {
      p.contact.n = unit(p.center - hit->p);
      p.contact.p = p.center - radius * p.contact.n;
    }
  }
  find_reach(shared, node);
  return node;
}

class PathPlanner {
 public:
  PathPlanner(const Shared& shared, const ContactPath& path, PathBase base, const AxisPose& start)
      : shared_(shared),
        path_(path),
        start_(start),
        dense_(std::move(base.dense)),
        line_(dense_, shared.tool.radius, line_accuracy(shared)),
        nodes_(std::move(base.nodes)) {
    out_.tsi = base.tsi;
    out_.excess_mm = base.excess_mm;
    out_.closed = dense_.closed;
    out_.ssi_mm = base.ssi.error_max_mm;
    out_.ssi_split = base.ssi.split;
    out_.halving_points = base.ssi.halving_points;
  }

  PathPlan run() {
    if (nodes_.empty()) return std::move(out_);
    begin_well();
    for (int round = 0; round < kMaxRounds; ++round) {
      choose();
      if (!refine(round)) break;
    }
    finish();
    return std::move(out_);
  }

 private:
  /// A closed path begins where the tool stands, and comes back there.
  void begin_well() {
    if (!dense_.closed) return;
    const double length = line_.length();
    if (nodes_.size() > 1 && nodes_.back().s - nodes_.front().s >= length * (1 - 1e-12)) nodes_.pop_back();
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    // Where the axis has hardly more than a turn, rings begin at its end and are cut to and fro.
    const RotaryOptions& o = shared_.options;
    const bool narrow = o.theta_max - o.theta_min < 4 * geom::kPi;
    const double seam = (o.theta_min + o.theta_max) / 2 - geom::kPi;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const double d = narrow ? std::abs(turned_by(nodes_[i].initial - seam))
                              : geom::distance(nodes_[i].place.center, start_.center);
      if (d < least) {
        least = d;
        best = i;
      }
    }
    std::rotate(nodes_.begin(), nodes_.begin() + static_cast<std::ptrdiff_t>(best), nodes_.end());
    for (std::size_t i = 1; i < nodes_.size(); ++i)
      if (nodes_[i].s < nodes_[0].s) nodes_[i].s += length;
    nodes_.push_back(nodes_.front());
    nodes_.back().s += length;
  }

  // --- axes

  Layer layer_of(std::size_t i) const {
    const Node& node = nodes_[i];
    Layer layer;
    layer.reachable = node.reachable;
    layer.initial = node.initial;
    const geom::Vec3 n = node.place.contact.n;
    // Leaning along X already keeps the tip out of the cut.
    const double across = std::hypot(n.y, n.z);
    layer.normal = across > std::cos(shared_.options.lean) ? std::atan2(n.y, n.z)
                                                           : std::numeric_limits<double>::quiet_NaN();
    if (i > 0) layer.length = node.s - nodes_[i - 1].s;
    return layer;
  }

  void choose() {
    std::vector<Layer> layers;
    layers.reserve(nodes_.size());
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      layers.push_back(layer_of(i));
      if (!free_.empty() && !free_[i] && nodes_[i].open()) pin(layers.back(), nodes_[i].theta);
    }
    AxisOptions o;
    o.clearance = shared_.options.clearance;
    o.smooth = shared_.options.smooth && shared_.section == nullptr;
    o.lean = shared_.options.lean;
    o.start = start_.theta;
    const AxisChain chain = dense_.closed ? round_and_round(layers, o) : choose_axes(layers, o);
    std::vector<char> broken(nodes_.size(), 0);
    for (const std::size_t b : chain.breaks) broken[b] = 1;
    broken_ = std::move(broken);
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      double theta = chain.theta[i];
      // A pinned angle stays to the last bit, so that what was proven about it stays proven.
      if (!free_.empty() && !free_[i] && std::abs(turned_by(theta - nodes_[i].theta)) < 1e-6)
        theta = nodes_[i].theta + 2 * geom::kPi * std::round((theta - nodes_[i].theta) / (2 * geom::kPi));
      if (theta != nodes_[i].theta) {
        nodes_[i].cut = false;
        if (i + 1 < nodes_.size()) nodes_[i + 1].cut = false;
      }
      nodes_[i].theta = theta;
    }
  }
  /// A closed path comes back with the angle it began with (and whole turns): of three times round the middle
  /// one is taken.
  static AxisChain round_and_round(std::vector<Layer> layers, const AxisOptions& options) {
    if (layers.size() < 3) return choose_axes(layers, options);
    const std::size_t n = layers.size() - 1;
    // The last one is the first one again, with the length that leads to it.
    const Layer seam = layers.back();
    for (int copy = 0; copy < 2; ++copy)
      for (std::size_t i = 1; i <= n; ++i) layers.push_back(i == n ? seam : Layer(layers[i]));
    const AxisChain all = choose_axes(layers, options);
    AxisChain out;
    const double turns = 2 * geom::kPi * std::round((all.theta[n] - options.start) / (2 * geom::kPi));
    for (std::size_t i = n; i <= 2 * n; ++i) out.theta.push_back(all.theta[i] - turns);
    for (const std::size_t b : all.breaks)
      if (b > n && b <= 2 * n) out.breaks.push_back(b - n);
    return out;
  }
  static void pin(Layer& layer, double theta) {
    const double t = turned_by(theta);
    constexpr double kHalf = 1e-9;
    const double lo = t - kHalf < -geom::kPi ? t - kHalf + 2 * geom::kPi : t - kHalf;
    layer.reachable = {{lo, lo + 2 * kHalf}};
  }

  // --- motion

  /// Largest distance of the contact points between two nodes from the ball that passes.
  double undercut(const Node& a, const Node& b) const {
    const AxisPose from = a.pose(), to = b.pose();
    const double radius = shared_.tool.radius;
    const geom::Vec3 chord = to.center - from.center;
    const double h2 = dot(chord, chord);
    double worst = 0;
    if (!(h2 > 0)) return 0;
    line_.between(a.s, b.s, [&](const Place& p) {
      double t = std::clamp(dot(p.center - from.center, chord) / h2, 0.0, 1.0);
      const AxisPose first = rotary::between(from, to, t);
      t = std::clamp(t + dot(p.center - first.center, chord) / h2, 0.0, 1.0);
      const AxisPose second = rotary::between(from, to, t);
      const double d =
          std::min(geom::distance(first.center, p.contact.p), geom::distance(second.center, p.contact.p));
      worst = std::max(worst, d - radius);
    });
    return worst;
  }

  struct Proof {
    bool clear = false;
    double ssi = 0, depth = 0;
  };
  Proof prove(const Node& a, const Node& b) const {
    Proof out;
    const double tolerance = shared_.options.tolerance_mm;
    out.ssi = undercut(a, b);
    if (out.ssi > tolerance) return out;
    const MoveCheck check =
        check_move(a.pose(), b.pose(), shared_.body, shared_.mesh, shared_.tool, shared_.cutting());
    out.clear = check.clear;
    out.depth = check.ball_depth;
    return out;
  }
  bool both_open(std::size_t i) const { return nodes_[i - 1].open() && nodes_[i].open(); }

  /// Every step that is to be cut and is not proven yet.
  void prove_all() {
    std::vector<std::size_t> steps;
    for (std::size_t i = 1; i < nodes_.size(); ++i)
      if (both_open(i) && !broken_[i] && !nodes_[i].cut) steps.push_back(i);
    std::vector<Proof> proofs(steps.size());
    parallel_for(steps.size(), shared_.threads(), [&](std::size_t k, std::size_t) {
      proofs[k] = prove(nodes_[steps[k] - 1], nodes_[steps[k]]);
    });
    for (std::size_t k = 0; k < steps.size(); ++k) {
      nodes_[steps[k]].cut = proofs[k].clear;
      if (!proofs[k].clear) continue;
      out_.ssi_mm = std::max(out_.ssi_mm, proofs[k].ssi);
      out_.gouge_mm = std::max(out_.gouge_mm, proofs[k].depth);
    }
  }

  /// Proves the steps; where that fails a node comes in between. False when nothing was added.
  bool refine(int round) {
    prove_all();
    const double shortest = std::min(shared_.options.tolerance_mm, 0.01 * shared_.tool.radius);
    std::vector<Node> next;
    std::vector<std::size_t> added;
    next.reserve(nodes_.size());
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      if (i > 0) {
        const Node &a = nodes_[i - 1], &b = nodes_[i];
        // Where the axis breaks or an unreachable stretch begins, the place is found by halving too.
        const bool wanted = both_open(i) ? !b.cut : a.open() != b.open() || b.s - a.s > shared_.tool.radius;
        if (wanted && b.s - a.s > 2 * shortest) {
          Node node;
          node.s = (a.s + b.s) / 2;
          added.push_back(next.size());
          next.push_back(std::move(node));
        }
      }
      next.push_back(nodes_[i]);
    }
    nodes_ = std::move(next);
    if (added.empty()) return false;
    parallel_for(added.size(), shared_.threads(), [&](std::size_t k, std::size_t) {
      nodes_[added[k]] = node_at(shared_, line_, nodes_[added[k]].s);
    });
    set_free(added, round);
    return true;
  }

  /// The neighbours of new nodes may turn again.
  void set_free(const std::vector<std::size_t>& added, int round) {
    free_.assign(nodes_.size(), 0);
    const std::size_t window = std::max<std::size_t>(2, kWindow >> round);
    for (const std::size_t a : added) {
      nodes_[a].cut = false;
      if (a + 1 < nodes_.size()) nodes_[a + 1].cut = false;
      const std::size_t lo = a > window ? a - window : 0, hi = std::min(nodes_.size(), a + window + 1);
      std::fill(free_.begin() + static_cast<std::ptrdiff_t>(lo),
                free_.begin() + static_cast<std::ptrdiff_t>(hi), char{1});
    }
  }

  void finish() {
    bool moved = false;
    // The last round may have turned angles after its proofs, or stopped by its number.
    prove_all();
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      Node& node = nodes_[i];
      // (A step that the last choice calls a break stays cut when it was proven with these very angles: it
      // was not halved either.)
      if (i == 0 || !both_open(i)) node.cut = false;
      if (!node.open()) node.place.state = State::unreachable;
      if (i == 0 || node.cut) continue;
      line_.between(nodes_[i - 1].s, node.s, [&](const Place& p) {
        out_.uncut.push_back(p.contact.p);
        moved = moved || p.state == State::moved;
      });
    }
    // The contacts that a moved place stands for are none of its own.
    const std::size_t stride = 1 + path_.points.size() / 4096;
    for (std::size_t i = 0; moved && i < path_.points.size(); i += stride)
      out_.uncut.push_back(path_.points[i].p);
    out_.nodes = std::move(nodes_);
  }

  const Shared& shared_;
  const ContactPath& path_;
  AxisPose start_;
  CenterPath dense_;
  CenterLine line_;
  PathPlan out_;
  std::vector<Node> nodes_;
  std::vector<char> free_, broken_;
};

}  // namespace

double step_tolerance(const Shared& shared) {
  constexpr double kReserve = 0.02;
  const double tolerance = shared.options.tolerance_mm;
  const double unknown = shared.design != nullptr ? 0 : std::min(shared.part.deflection_mm, 0.5 * tolerance);
  return (1 - kReserve) * tolerance - unknown;
}

void find_reach(const Shared& shared, Node& node) {
  const Point3 c = node.place.center;
  node.initial = std::atan2(c.y, c.z);
  // Moves are proven, a place alone is not: where the ball itself is in the part, no axis helps.
  const bool sunk = shared.mesh.nearest(c, shared.tool.radius - shared.options.tolerance_mm).has_value();
  if (sunk) node.place.state = State::unreachable;
  if (node.place.state == State::unreachable) {
    node.initial_interferes = true;
    return;
  }
  AngleSet exact = shared.reach.reachable(c);
  node.initial_interferes = !contains(exact, node.initial);
  // In a slot as wide as the tool the ball sinks in by what resolve_tsi allows, and the shank with it.
  ReachOptions lenient;
  lenient.grow_mm = -shared.options.tolerance_mm / 2;
  if (shared.section == nullptr) {
    node.reachable = exact.empty() ? shared.reach.reachable(c, lenient) : std::move(exact);
    return;
  }
  const SectionReach section = shared.section->at(c, node.place.contact.n);
  node.initial_interferes = !contains(section.reachable, node.initial);
  // The paper takes the middle; where the section did not see what interferes it is left uncut.
  if (section.reachable.empty() || !contains(shared.reach.reachable(c, lenient), section.theta)) return;
  constexpr double kHalf = 1e-6;
  const double lo = std::remainder(section.theta - kHalf, 2 * geom::kPi);
  node.reachable = {{lo >= geom::kPi ? lo - 2 * geom::kPi : lo, 0}};
  node.reachable[0].hi = node.reachable[0].lo + 2 * kHalf;
}

PathBase place_path(const Shared& shared, const ContactPath& path) {
  const RotaryOptions& o = shared.options;
  const double radius = shared.tool.radius;
  PathBase out;
  TsiResult tsi = resolve_tsi(path, shared.mesh, {o.tsi, radius, o.tolerance_mm, shared.part.deflection_mm});
  out.tsi = tsi.interfering;
  out.excess_mm = tsi.excess_max_mm;
  out.dense = std::move(tsi.path);
  out.ssi = thin(out.dense, radius, step_tolerance(shared));
  return out;
}

PathBase swept_along(const PathBase& base, double turn, double dx, double dw) {
  const double c = std::cos(turn), s = std::sin(turn);
  const auto turned = [&](auto v) { return decltype(v){v.x, v.y * c - v.z * s, v.y * s + v.z * c}; };
  const auto move = [&](Place& p) {
    p.center = turned(p.center);
    p.center.x += dx;
    p.contact.p = turned(p.contact.p);
    p.contact.p.x += dx;
    p.contact.n = turned(p.contact.n);
    p.contact.w += dw;
  };
  PathBase out = base;
  for (Place& p : out.dense.places) move(p);
  for (Place& p : out.ssi.points) move(p);
  return out;
}

void add_nodes(const Shared& shared, PathBase& base, unsigned threads) {
  const CenterLine line(base.dense, shared.tool.radius, line_accuracy(shared));
  base.nodes.resize(base.ssi.at.size());
  parallel_for(base.nodes.size(), threads, [&](std::size_t i, std::size_t) {
    Node node;
    node.s = line.length_of(base.ssi.at[i]);
    node.place = base.ssi.points[i];
    find_reach(shared, node);
    base.nodes[i] = std::move(node);
  });
}

PathPlan plan_path(const Shared& shared, const ContactPath& path, PathBase base, const AxisPose& start) {
  return PathPlanner(shared, path, std::move(base), start).run();
}

}  // namespace burin::rotary

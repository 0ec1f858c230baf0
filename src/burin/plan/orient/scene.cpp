// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/orient/scene.h"

#include <algorithm>
#include <cmath>

#include "burin/plan/orient/scene_piece.h"
#include "burin/plan/orient/scene_turn.h"

namespace burin::orient {

using detail::Corners;
using detail::Local;
using detail::Piece;
using detail::Place;
using detail::Turn;
using geom::Point3;
using geom::Vec3;

namespace {

/// A touch is not an interference, and rounding may not make it one: pieces are smaller by this share of the
/// largest coordinate, at least of a metre (half of what the header promises).
constexpr double kTouch = 5e-13;
/// Tilts that first_free answers: multiples of this (rad). The answer is then the same whichever blockers
/// were met on the way to it.
constexpr double kGrid = 1.0 / (1U << 31U);

double grid_above(double a) {
  return std::ceil(a / kGrid) * kGrid;
}

/// The tool's frame at a pose.
struct Frame {
  Point3 p;
  Vec3 ex, ey, u;
  explicit Frame(const cl::Pose& pose) : p(pose.tip), u(pose.axis) {
    // Duff et al. 2017: any two directions across the axis, without a case that loses digits.
    const double sign = std::copysign(1.0, u.z), a = -1 / (sign + u.z), b = u.x * u.y * a;
    ex = {1 + sign * u.x * u.x * a, sign * b, -sign * u.x};
    ey = {b, sign + u.y * u.y * a, -u.y};
  }
  Local at(const Point3& q) const {
    const Vec3 v = q - p;
    return {dot(v, ex), dot(v, ey), dot(v, u)};
  }
};

struct Group {
  Point3 center;
  double radius = 0;
  std::uint32_t first = 0, last = 0;
};

}  // namespace

struct Scene::State {
  geom::Mesh mesh;
  model::Mill mill;
  std::vector<BodyPiece> body;
  std::vector<Piece> pieces;
  std::size_t gouging = 0;  ///< pieces before this one gouge
  std::vector<Group> groups;

  Corners corners(std::uint32_t triangle, const Frame& frame) const {
    const auto& t = mesh.triangles[triangle];
    return {frame.at(mesh.vertices[t[0]]), frame.at(mesh.vertices[t[1]]), frame.at(mesh.vertices[t[2]])};
  }
  std::optional<Blocker> walk(const Frame& frame, std::size_t count, Memory& memory) const;
};

Scene::Scene(const geom::Mesh& mesh, const model::Mill& mill, std::vector<BodyPiece> body)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.mesh.vertices = mesh.vertices;
  for (const auto& t : mesh.triangles)
    if (std::max({t[0], t[1], t[2]}) < mesh.vertices.size()) s.mesh.triangles.push_back(t);
  s.mill = mill;
  s.body = std::move(body);
  double scale = 1000;
  for (const Point3& q : mesh.vertices)
    scale = std::max({scale, std::abs(q.x), std::abs(q.y), std::abs(q.z)});
  const double touch = kTouch * scale;
  while (s.gouging < s.body.size() && s.body[s.gouging].cause == Cause::gouge) ++s.gouging;
  for (const BodyPiece& p : s.body) {
    if (p.grow > touch)
      s.pieces.push_back({p.radius, p.from, p.to, p.grow - touch});
    else
      s.pieces.push_back({p.radius - touch, p.from + touch, p.to - touch, 0});
  }
  constexpr std::uint32_t kGroup = 32;
  const auto n = static_cast<std::uint32_t>(s.mesh.triangles.size());
  for (std::uint32_t i = 0; i < n; i += kGroup) {
    Group g;
    g.first = i;
    g.last = std::min(i + kGroup, n);
    geom::Box3 box;
    for (std::uint32_t k = g.first; k < g.last; ++k)
      for (const auto v : s.mesh.triangles[k]) box.add(s.mesh.vertices[v]);
    g.center = lerp(box.lo, box.hi, 0.5);
    g.radius = 0.5 * box.diagonal() * (1 + 1e-9) + touch;
    s.groups.push_back(g);
  }
}
Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

/// A blocker among the first `count` pieces.
std::optional<Blocker> Scene::State::walk(const Frame& frame, std::size_t count, Memory& memory) const {
  ++memory.tests;
  const auto found = [&](std::uint32_t triangle, std::size_t piece) {
    const Blocker b{triangle, static_cast<std::uint8_t>(piece)};
    auto* end = memory.last.begin() + memory.count;
    auto* it = std::find(memory.last.begin(), end, b);
    if (it == end) {
      if (memory.count < static_cast<int>(memory.last.size()))
        ++memory.count;
      else
        --it;
    }
    std::move_backward(memory.last.begin(), it, it + 1);
    memory.last[0] = b;
    return b;
  };
  for (int i = 0; i < memory.count; ++i) {
    const Blocker b = memory.last[static_cast<std::size_t>(i)];
    if (b.triangle < mesh.triangles.size() && b.piece < count &&
        meets(corners(b.triangle, frame), pieces[b.piece]))
      return found(b.triangle, b.piece);
  }
  for (const Group& g : groups) {
    const Local c = frame.at(g.center);
    for (std::size_t k = 0; k < count; ++k) {
      const Piece& p = pieces[k];
      if (detail::excess(c, {p.radius, p.from, p.to, std::max(p.grow, 1e-300)}) > g.radius) continue;
      for (std::uint32_t i = g.first; i < g.last; ++i)
        if (meets(corners(i, frame), p)) return found(i, k);
    }
  }
  return std::nullopt;
}

std::optional<Blocker> Scene::blocker(const cl::Pose& pose, Memory& memory) const {
  return state_->walk(Frame(pose), state_->pieces.size(), memory);
}

Cause Scene::cause(const cl::Pose& pose, Memory& memory) const {
  const State& s = *state_;
  const Frame frame(pose);
  const auto first = s.walk(frame, s.pieces.size(), memory);
  if (!first) return Cause::none;
  if (s.body[first->piece].cause == Cause::gouge) return Cause::gouge;
  return s.gouging > 0 && s.walk(frame, s.gouging, memory) ? Cause::gouge : s.body[first->piece].cause;
}

Scene::FirstFree Scene::first_free(const CcPoint& at, double beta, double from, double to,
                                   Memory& memory) const {
  const State& s = *state_;
  const Turn turn(at, beta, s.mill);
  FirstFree out;
  double alpha = from, stall = kGrid;
  std::optional<Blocker> last;
  const auto frame = [&](double a) { return Frame(pose(at, {a, beta}, s.mill)); };
  const auto blocks_at = [&](const Blocker& b, double a) {
    return meets(s.corners(b.triangle, frame(a)), s.pieces[b.piece]);
  };
  double blocked = from;  // the last tilt that is known to be blocked
  for (;;) {
    const auto b = s.walk(frame(alpha), s.pieces.size(), memory);
    if (!b) {
      out.found = true;
      break;
    }
    const auto& t = s.mesh.triangles[b->triangle];
    const auto left = turn.until({turn.place(s.mesh.vertices[t[0]]), turn.place(s.mesh.vertices[t[1]]),
                                  turn.place(s.mesh.vertices[t[2]])},
                                 s.pieces[b->piece], alpha, to);
    last = b;
    out.witness = Witness{turn.point(left.last), b->piece};
    blocked = alpha;
    if (alpha >= to) break;
    stall = left.alpha > alpha ? kGrid : std::min(2 * stall, kLeastGap);
    alpha = std::min(std::max(grid_above(left.alpha), grid_above(alpha + 0.5 * stall)), to);
  }
  // The same answer by any way: the place before it is blocked.
  double lo = blocked;
  while (out.found && last && alpha - lo > 1.5 * kGrid) {
    const double before = grid_above(alpha - 1.25 * kGrid);
    if (!(before > lo && before < alpha) || blocks_at(*last, before)) break;
    if (s.walk(frame(before), s.pieces.size(), memory)) break;
    alpha = before;
  }
  out.alpha = alpha;
  if (last) out.cause = s.body[last->piece].cause;
  return out;
}

bool Scene::blocks(const Witness& witness, const cl::Pose& pose) const {
  const State& s = *state_;
  return witness.piece < s.pieces.size() &&
         detail::excess(Frame(pose).at(witness.q), s.pieces[witness.piece]) < 0;
}

double Scene::blocked_until(const Witness& witness, const CcPoint& at, double beta, double alpha,
                            double to) const {
  const State& s = *state_;
  if (witness.piece >= s.pieces.size()) return alpha;
  const Turn turn(at, beta, s.mill);
  return turn.until(turn.place(witness.q), s.pieces[witness.piece], alpha, to);
}

const model::Mill& Scene::mill() const {
  return state_->mill;
}
const std::vector<BodyPiece>& Scene::body() const {
  return state_->body;
}
std::size_t Scene::triangle_count() const {
  return state_->mesh.triangles.size();
}

}  // namespace burin::orient

// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/orient/scene.h"

#include <algorithm>
#include <cmath>

#include "burin/plan/orient/scene_kernels.h"
#include "burin/plan/orient/scene_piece.h"
#include "burin/plan/orient/scene_tree.h"
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
  Corners at(const std::array<Point3, 3>& t) const { return {at(t[0]), at(t[1]), at(t[2])}; }
};
/// A pose to be asked about, and for the order: across from the line about which the tool turns to its axis.
struct Aim {
  Frame frame;
  Vec3 lever;
  double arm = 1, corner = 0, alpha = 0;
};

}  // namespace

struct Scene::State {
  model::Mill mill;
  std::vector<BodyPiece> body;
  std::vector<Piece> pieces;
  std::size_t gouging = 0;  ///< pieces before this one gouge
  std::shared_ptr<const detail::SceneTree> tree;
  std::size_t triangles = 0;
  double touch = 0;  ///< a touch within this is none
  const detail::SceneKernels* kernels = nullptr;
  std::vector<detail::SceneQuery> queries;  ///< the pieces, kScenePieces each; tip and axis to be filled in

  std::array<Point3, 3> corners(std::uint32_t triangle) const {
    const std::uint32_t place = tree->place[triangle];
    return tree->packets[place / 4].corners(static_cast<int>(place % 4));
  }
  bool blocks(const Blocker& b, const Frame& frame) const {
    return meets(frame.at(corners(b.triangle)), pieces[b.piece]);
  }
  void take(std::vector<BodyPiece> wanted);
  void add_queries();
  detail::SceneQuery query(std::size_t batch, const Aim& aim) const;
  template <class Met>
  bool look_at(const detail::ScenePacket& packet, std::size_t batch, unsigned mask, Aim& aim,
               const Met& met) const;
  template <class Met>
  bool walk(std::size_t batch, unsigned mask, Aim& aim, const Met& met) const;
  template <class Met>
  bool climb(std::size_t batch, unsigned mask, Aim& aim, const Met& met) const;
  template <class Met>
  bool climb_all(Aim& aim, const Met& met) const;
  std::optional<Blocker> blocker(const Frame& frame, std::size_t count, Memory& memory) const;
};

Scene::Scene(const geom::Mesh& mesh, const model::Mill& mill, std::vector<BodyPiece> body)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.mill = mill;
  s.tree = std::make_shared<const detail::SceneTree>(detail::build_scene_tree(mesh));
  s.triangles = mesh.triangles.size();
  double scale = 1000;
  for (const Point3& q : mesh.vertices)
    scale = std::max({scale, std::abs(q.x), std::abs(q.y), std::abs(q.z)});
  s.touch = kTouch * scale;
  s.take(std::move(body));
}

Scene::Scene(const Scene& same_part, std::vector<BodyPiece> body) : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.mill = same_part.state_->mill;
  s.tree = same_part.state_->tree;
  s.triangles = same_part.state_->triangles;
  s.touch = same_part.state_->touch;
  s.take(std::move(body));
}

void Scene::State::take(std::vector<BodyPiece> wanted) {
  body = std::move(wanted);
  // Blocker numbers pieces in a byte: what is beyond (no tool has that) becomes one that holds them all.
  constexpr std::size_t kMost = 255;
  while (body.size() > kMost) {
    const BodyPiece top = body.back();
    body.pop_back();
    BodyPiece& p = body.back();
    p = {std::max(p.radius, top.radius), std::min(p.from, top.from), std::max(p.to, top.to),
         std::max(p.grow, top.grow), p.cause};
  }
  kernels = &detail::scene_kernels_avx2();
  while (gouging < body.size() && body[gouging].cause == Cause::gouge) ++gouging;
  for (const BodyPiece& p : body) {
    if (p.grow > touch)
      pieces.push_back({p.radius, p.from, p.to, p.grow - touch});
    else
      pieces.push_back({p.radius - touch, p.from + touch, p.to - touch, 0});
  }
  add_queries();
}

void Scene::State::add_queries() {
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const auto k = static_cast<int>(i % detail::kScenePieces);
    if (k == 0) queries.emplace_back();
    detail::SceneQuery& q = queries.back();
    const Piece& p = pieces[i];
    q.count = k + 1;
    q.middle[k] = static_cast<float>(0.5 * (p.from + p.to));
    q.half[k] = static_cast<float>(0.5 * (p.to - p.from));
    q.radius[k] = static_cast<float>(p.radius);
    q.grow[k] = static_cast<float>(p.grow);
    q.size = std::max(
        q.size, static_cast<float>(1.001 * (std::max(std::abs(p.from), std::abs(p.to)) + p.radius + p.grow)));
  }
}
Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

namespace {

/// To the front of the memory.
void remember(const Blocker& b, Scene::Memory& memory) {
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
}

}  // namespace

detail::SceneQuery Scene::State::query(std::size_t batch, const Aim& aim) const {
  detail::SceneQuery q = queries[batch];
  const auto put = [](float(&to)[3], const Vec3& v) {
    to[0] = static_cast<float>(v.x);
    to[1] = static_cast<float>(v.y);
    to[2] = static_cast<float>(v.z);
  };
  q.tip[0] = aim.frame.p.x;
  q.tip[1] = aim.frame.p.y;
  q.tip[2] = aim.frame.p.z;
  put(q.axis, aim.frame.u);
  put(q.lever, aim.lever);
  q.arm = static_cast<float>(aim.arm);
  q.corner = static_cast<float>(aim.corner);
  return q;
}

/// met(blocker, aim) is told of the triangles of a packet that meet pieces of the batch (bits of `mask`).
template <class Met>
bool Scene::State::look_at(const detail::ScenePacket& packet, std::size_t batch, unsigned mask, Aim& aim,
                           const Met& met) const {
  for (int lane = 0; lane < 4; ++lane) {
    if (lane > 0 && packet.triangle[lane] == packet.triangle[lane - 1]) break;
    const auto c = packet.corners(lane);
    Corners t = aim.frame.at(c);
    for (unsigned left = mask; left != 0; left &= left - 1) {
      const std::size_t piece = batch * detail::kScenePieces + static_cast<std::size_t>(__builtin_ctz(left));
      if (!meets(t, pieces[piece])) continue;
      if (met(Blocker{packet.triangle[lane], static_cast<std::uint8_t>(piece)}, aim)) return true;
      t = aim.frame.at(c);
    }
  }
  return false;
}

/// Whether some triangle meets a piece of the batch (bits of `mask`), the deepest boxes first: exactly.
template <class Met>
bool Scene::State::walk(std::size_t batch, unsigned mask, Aim& aim, const Met& met) const {
  struct Task {
    int child;
    unsigned pieces;
    float last;
  };
  std::array<Task, detail::kSceneStack> todo;
  const detail::SceneQuery q = query(batch, aim);
  std::size_t n = 0;
  todo[n++] = {0, mask, 0};
  while (n > 0) {
    const Task task = todo[--n];
    if (task.child < 0) {
      if (look_at(tree->packets[static_cast<std::size_t>(~task.child)], batch, task.pieces, aim, met))
        return true;
      continue;
    }
    const detail::SceneNode& node = tree->nodes[static_cast<std::size_t>(task.child)];
    detail::SceneHits hits;
    kernels->boxes(node, q, task.pieces, hits);
    unsigned any = 0;
    for (int k = 0; k < q.count; ++k) any |= hits.hit[k];
    const std::size_t base = n;
    while (any != 0) {
      const int lane = __builtin_ctz(any);
      any &= any - 1;
      Task t{node.child[lane], 0, hits.last[lane]};
      for (int k = 0; k < q.count; ++k) t.pieces |= (hits.hit[k] >> lane & 1U) << k;
      std::size_t i = n++;
      for (; i > base && todo[i - 1].last > t.last; --i) todo[i] = todo[i - 1];
      todo[i] = t;
    }
  }
  return false;
}

/// Looks where the tool leaves last, by estimates: `met` moves the aim. What it passes over a walk will find.
template <class Met>
bool Scene::State::climb(std::size_t batch, unsigned mask, Aim& aim, const Met& met) const {
  struct Task {
    int child;
    unsigned pieces;
    double last;
    bool operator<(const Task& o) const { return last < o.last; }
  };
  // The estimates need not be kept all.
  constexpr std::size_t kKept = 192;
  std::array<Task, kKept> todo;
  std::size_t n = 0;
  todo[n++] = {0, mask, aim.alpha};
  detail::SceneQuery q = query(batch, aim);
  while (n > 0 && todo[0].last >= aim.alpha) {
    std::pop_heap(todo.begin(), todo.begin() + n);
    const Task task = todo[--n];
    if (task.child < 0) {
      const double before = aim.alpha;
      if (look_at(tree->packets[static_cast<std::size_t>(~task.child)], batch, task.pieces, aim, met))
        return true;
      if (aim.alpha != before) q = query(batch, aim);
      continue;
    }
    const detail::SceneNode& node = tree->nodes[static_cast<std::size_t>(task.child)];
    detail::SceneHits hits;
    kernels->turning(node, q, task.pieces, hits);
    unsigned any = 0;
    for (int k = 0; k < q.count; ++k) any |= hits.hit[k];
    for (; any != 0 && n < kKept; any &= any - 1) {
      const int lane = __builtin_ctz(any);
      Task t{node.child[lane], 0, aim.alpha + static_cast<double>(hits.last[lane])};
      for (int k = 0; k < q.count; ++k) t.pieces |= (hits.hit[k] >> lane & 1U) << k;
      todo[n++] = t;
      std::push_heap(todo.begin(), todo.begin() + n);
    }
  }
  return false;
}

/// climb() with all batches.
template <class Met>
bool Scene::State::climb_all(Aim& aim, const Met& met) const {
  for (std::size_t batch = 0; batch < queries.size() && !tree->nodes.empty(); ++batch)
    if (climb(batch, (1U << static_cast<unsigned>(queries[batch].count)) - 1, aim, met)) return true;
  return false;
}

/// A blocker among the first `count` pieces: the memory first, then the tree.
std::optional<Blocker> Scene::State::blocker(const Frame& frame, std::size_t count, Memory& memory) const {
  ++memory.tests;
  for (int i = 0; i < memory.count; ++i) {
    const Blocker b = memory.last[static_cast<std::size_t>(i)];
    if (b.triangle >= triangles || tree->place[b.triangle] == detail::kNoPlace || b.piece >= count ||
        !blocks(b, frame))
      continue;
    remember(b, memory);
    return b;
  }
  std::optional<Blocker> out;
  Aim aim{frame, {}};
  const auto met = [&](const Blocker& b, Aim&) {
    out = b;
    return true;
  };
  for (std::size_t batch = 0; batch * detail::kScenePieces < count && !tree->nodes.empty() && !out; ++batch) {
    const std::size_t n = std::min<std::size_t>(count - batch * detail::kScenePieces, detail::kScenePieces);
    walk(batch, (1U << n) - 1, aim, met);
  }
  if (out) remember(*out, memory);
  return out;
}

std::optional<Blocker> Scene::blocker(const cl::Pose& pose, Memory& memory) const {
  return state_->blocker(Frame(pose), state_->pieces.size(), memory);
}

Cause Scene::cause(const cl::Pose& pose, Memory& memory) const {
  const State& s = *state_;
  const Frame frame(pose);
  const auto first = s.blocker(frame, s.pieces.size(), memory);
  if (!first) return Cause::none;
  if (s.body[first->piece].cause == Cause::gouge) return Cause::gouge;
  return s.gouging > 0 && s.blocker(frame, s.gouging, memory) ? Cause::gouge : s.body[first->piece].cause;
}

Scene::FirstFree Scene::first_free(const CcPoint& at, double beta, double from, double to,
                                   Memory& memory) const {
  const State& s = *state_;
  const Turn turn(at, beta, s.mill);
  FirstFree out;
  double blocked = from, stall = kGrid;
  std::optional<Blocker> last;
  bool over = false;
  const auto aim_at = [&](double a) {
    const Turn::Tilt tilt(a);
    return Aim{Frame(pose(at, {a, beta}, s.mill)), turn.across(tilt), turn.arm(), turn.corner(), a};
  };
  Aim aim = aim_at(from);
  // The tilt only grows: each blocker moves it to where that triangle ends to block.
  const auto move = [&](const Blocker& b, double coarse) {
    const auto c = s.corners(b.triangle);
    const auto left = turn.until({turn.place(c[0]), turn.place(c[1]), turn.place(c[2])}, s.pieces[b.piece],
                                 aim.alpha, to, coarse);
    last = b;
    out.witness = Witness{turn.point(left.last), b.piece};
    blocked = aim.alpha;
    if (aim.alpha >= to) return over = true;
    stall = left.alpha > aim.alpha ? kGrid : std::min(2 * stall, kLeastGap);
    aim.alpha = std::min(std::max(grid_above(left.alpha), grid_above(aim.alpha + 0.5 * stall)), to);
    const Turn::Tilt tilt(aim.alpha);
    aim.frame = Frame(turn.pose(tilt));
    aim.lever = turn.across(tilt);
    return false;
  };
  // On the way roughly: the next triangle may do better. What is left when no other does, exactly.
  constexpr double kRough = 0.03;
  const auto met = [&](const Blocker& b, Aim&) { return move(b, kRough); };
  while (!over) {
    const auto b = s.blocker(aim.frame, s.pieces.size(), memory);
    if (!b || move(*b, kRough) || s.climb_all(aim, met)) break;
    while (!over && s.blocks(*last, aim.frame)) move(*last, 0);
    aim = aim_at(aim.alpha);
  }
  double alpha = aim.alpha;
  if (last) remember(*last, memory);
  out.found = !over;
  // The same answer by any way: the place of the grid before it is blocked.
  while (out.found && last && alpha - blocked > 1.5 * kGrid) {
    const double before = grid_above(alpha - 1.25 * kGrid);
    if (!(before > blocked && before < alpha) || s.blocks(*last, aim_at(before).frame)) break;
    if (s.blocker(aim_at(before).frame, s.pieces.size(), memory)) break;
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
  return state_->triangles;
}

}  // namespace burin::orient

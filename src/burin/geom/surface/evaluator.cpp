// SPDX-License-Identifier: Apache-2.0
// SurfaceEvaluator: pieces are converted when a parameter enters them, and a few are kept. What a piece looks
// like depends on the surface alone, so results do not depend on the order of the calls.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "burin/geom/surface/axis.h"
#include "burin/geom/surface/basis.h"
#include "burin/geom/surface/bernstein.h"
#include "burin/geom/surface/evaluate.h"
#include "burin/geom/surface/kernels.h"

namespace burin::geom {
namespace {

using detail::Axis;
using detail::IsoPiece;
using detail::Piece;

static_assert(sizeof(Point3) == 3 * sizeof(double) && sizeof(Point2) == 2 * sizeof(double));
static_assert(sizeof(SurfaceDerivatives) == 18 * sizeof(double));
static_assert(sizeof(SurfaceDerivatives3) == 30 * sizeof(double));
static_assert(sizeof(HPoint) == 4 * sizeof(double));

double* numbers(Point3& p) {
  return reinterpret_cast<double*>(&p);
}
double* numbers(SurfaceDerivatives& d) {
  return reinterpret_cast<double*>(&d);
}

/// Pieces that are kept at a time (a power of two, at most kMaxSlots) may take this many numbers.
constexpr std::size_t kMaxKept = std::size_t{1} << 15;  // 256 kB
constexpr std::size_t kMaxSlots = 32;

/// Rounding of a piece in powers, in units of rounding of the sum in Bernstein form: above this, Bernstein.
/// 400 * 2^-53 = 4.4e-14 of the size of the net is the bound of the loss.
constexpr double kMaxGrowth = 400;

/// Basis functions of the fixed parameter, as IsoKernels::fix wants them, and where they act.
struct Fixed {
  int piece = 0;
  std::array<double, 3 * (detail::kMaxPowerDegree + 1)> values{};

  Fixed(const Axis& axis, const std::vector<double>& knots, double t) : piece(axis.piece(t)) {
    if (axis.degree() > detail::kMaxPowerDegree) return;  // no pieces in powers
    detail::Basis n;
    detail::basis_derivatives(knots, axis.degree(), axis.first_point(piece) + axis.degree(), t, 2, n);
    const auto m = static_cast<std::size_t>(axis.degree() + 1);
    for (std::size_t j = 0; j < m; ++j) {
      values[j] = n.value[0][j];
      values[m + j] = n.value[1][j];
      values[2 * m + j] = 0.5 * n.value[2][j];
    }
  }
};

/// What all copies share.
struct Shared {
  NurbsSurface surface;
  Axis u, v;
  detail::Kernels kernels;
  detail::IsoKernels iso_u, iso_v;
  bool always_powers = false;
  std::size_t slots = 1, slot_size = 0;  // slot_size in doubles

  explicit Shared(const NurbsSurface& s);
  double growth() const {
    if (std::max(u.degree(), v.degree()) > detail::kMaxPowerDegree) {
      return std::numeric_limits<double>::infinity();
    }
    return detail::kPowerGrowth[u.degree()] * detail::kPowerGrowth[v.degree()];
  }
  /// Whether the piece is held in powers.
  bool powers(int iu, int iv) const;
  Fixed fixed(Direction d, double t) const {
    const std::vector<double>& knots = surface.knots(d);
    return {d == Direction::u ? u : v, knots, detail::clamped(knots, t)};
  }
};

std::size_t power_of_two_up_to(std::size_t n) {
  std::size_t p = 1;
  while (2 * p <= n) p *= 2;
  return p;
}

Shared::Shared(const NurbsSurface& s) : surface(s), u(s.knots_u, s.degree_u), v(s.knots_v, s.degree_v) {
  const detail::KernelSet set = detail::kernels_avx2();
  kernels = set.surface(s.degree_u, s.degree_v);
  iso_u = set.iso(s.degree_u);
  iso_v = set.iso(s.degree_v);
  const auto [least, most] =
      std::minmax_element(s.points.begin(), s.points.end(), [](HPoint a, HPoint b) { return a.w < b.w; });
  always_powers = growth() * (most->w / least->w) <= kMaxGrowth;
  slot_size = 4 * static_cast<std::size_t>(s.degree_u + 1) * static_cast<std::size_t>(s.degree_v + 1);
  const std::size_t all = static_cast<std::size_t>(u.pieces()) * static_cast<std::size_t>(v.pieces());
  slots = power_of_two_up_to(std::clamp<std::size_t>(kMaxKept / slot_size, 1, kMaxSlots));
  while (slots >= 2 * all) slots /= 2;
}

bool Shared::powers(int iu, int iv) const {
  if (always_powers || growth() > kMaxGrowth) return always_powers;
  const HPoint* const net = &surface.at(u.first_point(iu), v.first_point(iv));
  double least = net->w, most = net->w;
  for (int j = 0; j <= v.degree(); ++j) {
    for (int i = 0; i <= u.degree(); ++i) {
      const double w = net[static_cast<std::ptrdiff_t>(j) * surface.count_u + i].w;
      least = std::min(least, w), most = std::max(most, w);
    }
  }
  return growth() * (most / least) <= kMaxGrowth;
}

struct Aligned {
  void operator()(double* p) const { ::operator delete[](p, std::align_val_t{32}); }
};
using Numbers = std::unique_ptr<double[], Aligned>;
Numbers aligned(std::size_t n) {
  return Numbers(static_cast<double*>(::operator new[](n * sizeof(double), std::align_val_t{32})));
}

}  // namespace

struct SurfaceEvaluator::State {
  struct Slot {
    std::int64_t tag = -1;
    bool powers = false;
    Piece piece;
  };
  std::shared_ptr<const Shared> shared;
  std::vector<Slot> slots;
  Numbers space, iso_space;
  std::vector<double> mu, mv;  // for axes without tables
  Slot none;                   // holds no parameter
  const Slot* current = &none;

  explicit State(std::shared_ptr<const Shared> s);
  bool in_current(double u, double v) const {
    const Piece& c = current->piece;
    return u >= c.u_lo && u < c.u_hi && v >= c.v_lo && v < c.v_hi;
  }
  /// Whether it is worth asking for a group of four.
  bool may_run(std::span<const Point2> uv, std::size_t i, std::size_t n) const {
    return i + 4 <= n && current->powers && in_current(uv[i].x, uv[i].y) &&
           in_current(uv[i + 3].x, uv[i + 3].y);
  }
  const Slot& enter(int iu, int iv);
  const Slot& enter(double& u, double& v);
  const Slot& enter(double& u, double& v, Side side_u, Side side_v);
  void fill(Slot& slot, double* c, int iu, int iv);
  /// False when there is no piece in powers, or no number.
  bool enter_iso(Direction moving, const Fixed& fixed, double at, IsoPiece& out);
};

SurfaceEvaluator::State::State(std::shared_ptr<const Shared> s) : shared(std::move(s)), slots(shared->slots) {
  space = aligned(shared->slots * shared->slot_size);
  const int most = std::max(shared->u.degree(), shared->v.degree());
  iso_space = aligned(48 * static_cast<std::size_t>(most + 1));
  const auto matrix = [](const Axis& a) {
    return static_cast<std::size_t>((a.degree() + 1) * (a.degree() + 1));
  };
  mu.reserve(matrix(shared->u));
  mv.reserve(matrix(shared->v));
}

void SurfaceEvaluator::State::fill(Slot& slot, double* c, int iu, int iv) {
  const Axis &au = shared->u, &av = shared->v;
  const NurbsSurface& s = shared->surface;
  const HPoint* const net = &s.at(au.first_point(iu), av.first_point(iv));
  slot.powers = shared->powers(iu, iv);
  Piece& p = slot.piece;
  p.u_lo = au.lo(iu), p.v_lo = av.lo(iv);
  p.u_hi = au.above(iu), p.v_hi = av.above(iv);
  p.u0 = slot.powers ? au.middle(iu) : au.lo(iu), p.u1 = au.hi(iu);
  p.v0 = slot.powers ? av.middle(iv) : av.lo(iv), p.v1 = av.hi(iv);
  p.p = s.degree_u, p.q = s.degree_v;
  p.c = c;
  const double* const mu_at = slot.powers ? au.power(iu, mu) : au.bezier(iu, mu);
  const double* const mv_at = slot.powers ? av.power(iv, mv) : av.bezier(iv, mv);
  shared->kernels.convert(mu_at, mv_at, reinterpret_cast<const double*>(net),
                          static_cast<std::ptrdiff_t>(4) * s.count_u, p.p, p.q, c);
}

const SurfaceEvaluator::State::Slot& SurfaceEvaluator::State::enter(int iu, int iv) {
  const std::int64_t tag = iu + std::int64_t{iv} * shared->u.pieces();
  const std::size_t at = static_cast<std::size_t>(tag) & (slots.size() - 1);
  Slot& slot = slots[at];
  if (slot.tag != tag) {
    slot.tag = tag;
    fill(slot, space.get() + at * shared->slot_size, iu, iv);
  }
  return slot;
}

const SurfaceEvaluator::State::Slot& SurfaceEvaluator::State::enter(double& u, double& v) {
  if (in_current(u, v)) return *current;
  const Shared& s = *shared;
  u = detail::clamped(s.surface.knots_u, u);
  v = detail::clamped(s.surface.knots_v, v);
  current = &enter(s.u.piece(u), s.v.piece(v));
  return *current;
}

const SurfaceEvaluator::State::Slot& SurfaceEvaluator::State::enter(double& u, double& v, Side side_u,
                                                                    Side side_v) {
  if (side_u == Side::right && side_v == Side::right) return enter(u, v);
  const Shared& s = *shared;
  u = detail::clamped(s.surface.knots_u, u);
  v = detail::clamped(s.surface.knots_v, v);
  int iu = s.u.piece(u), iv = s.v.piece(v);
  if (side_u == Side::left && iu > 0 && u == s.u.lo(iu)) --iu;
  if (side_v == Side::left && iv > 0 && v == s.v.lo(iv)) --iv;
  current = &enter(iu, iv);
  return *current;
}

SurfaceEvaluator::SurfaceEvaluator(const NurbsSurface& surface)
    : state_(std::make_unique<State>(std::make_shared<const Shared>(surface))) {}
SurfaceEvaluator::~SurfaceEvaluator() = default;
SurfaceEvaluator::SurfaceEvaluator(const SurfaceEvaluator& o)
    : state_(o.state_ ? std::make_unique<State>(o.state_->shared) : nullptr) {}
SurfaceEvaluator& SurfaceEvaluator::operator=(const SurfaceEvaluator& o) {
  if (this != &o) state_ = o.state_ ? std::make_unique<State>(o.state_->shared) : nullptr;
  return *this;
}
SurfaceEvaluator::SurfaceEvaluator(SurfaceEvaluator&&) noexcept = default;
SurfaceEvaluator& SurfaceEvaluator::operator=(SurfaceEvaluator&&) noexcept = default;

Point3 SurfaceEvaluator::point(double u, double v) {
  State& s = *state_;
  const State::Slot& slot = s.enter(u, v);
  Point3 p;
  if (slot.powers) {
    s.shared->kernels.point(slot.piece, u, v, numbers(p));
  } else {
    detail::bernstein(slot.piece, u, v, 0, numbers(p));
  }
  return p;
}

SurfaceDerivatives SurfaceEvaluator::derivatives(double u, double v, Side side_u, Side side_v) {
  State& s = *state_;
  const State::Slot& slot = s.enter(u, v, side_u, side_v);
  SurfaceDerivatives d;
  if (slot.powers) {
    s.shared->kernels.derivatives(slot.piece, u, v, numbers(d));
  } else {
    detail::bernstein(slot.piece, u, v, 2, numbers(d));
  }
  return d;
}

SurfaceDerivatives3 SurfaceEvaluator::derivatives3(double u, double v, Side side_u, Side side_v) {
  State& s = *state_;
  const State::Slot& slot = s.enter(u, v, side_u, side_v);
  SurfaceDerivatives3 d;
  if (slot.powers) {
    s.shared->kernels.derivatives3(slot.piece, u, v, numbers(d));
  } else {
    detail::bernstein(slot.piece, u, v, 3, numbers(d));
  }
  return d;
}

void SurfaceEvaluator::points(std::span<const Point2> uv, std::span<Point3> out) {
  State& s = *state_;
  const std::size_t n = std::min(uv.size(), out.size());
  for (std::size_t i = 0; i < n;) {
    if (s.may_run(uv, i, n)) {
      i += s.shared->kernels.points(s.current->piece, &uv[i].x, n - i, numbers(out[i]));
      if (i >= n) break;
    }
    out[i] = point(uv[i].x, uv[i].y);
    ++i;
  }
}

void SurfaceEvaluator::derivatives(std::span<const Point2> uv, std::span<SurfaceDerivatives> out) {
  State& s = *state_;
  const std::size_t n = std::min(uv.size(), out.size());
  for (std::size_t i = 0; i < n;) {
    if (s.may_run(uv, i, n)) {
      i += s.shared->kernels.derivatives_run(s.current->piece, &uv[i].x, n - i, numbers(out[i]));
      if (i >= n) break;
    }
    out[i] = derivatives(uv[i].x, uv[i].y);
    ++i;
  }
}

// Iso-curves.

namespace {

/// Goes through the parameters piece by piece. Kernels take groups of four; the up to three that are left in
/// a piece go in a group filled up with the last of them. Lanes do not see each other: a value does not
/// depend on its neighbours. `alone`: where the piece is not in powers.
template <class Value, class Run, class Enter, class Alone>
void along(std::span<const double> t, std::span<Value> out, Interval domain, Run run, Enter enter,
           Alone alone) {
  IsoPiece piece;
  const std::size_t n = std::min(t.size(), out.size());
  const auto clamp = [&](double x) { return x < domain.lo ? domain.lo : x > domain.hi ? domain.hi : x; };
  for (std::size_t i = 0; i < n;) {
    i += run(piece, &t[i], n - i, numbers(out[i]));
    double group[4];
    std::size_t k = 0;
    for (; k < 4 && i + k < n; ++k) {
      group[k] = clamp(t[i + k]);
      if (!(group[k] >= piece.t_lo && group[k] < piece.t_hi)) break;
    }
    if (k > 0) {
      for (std::size_t fill = k; fill < 4; ++fill) group[fill] = group[k - 1];
      Value values[4];
      run(piece, group, 4, numbers(values[0]));
      std::copy_n(values, k, &out[i]);
      i += k;
    } else if (i < n && !enter(group[0], piece)) {
      out[i] = alone(group[0]);
      ++i;
    }
  }
}

}  // namespace

bool SurfaceEvaluator::State::enter_iso(Direction moving, const Fixed& fixed, double at, IsoPiece& out) {
  const bool u = moving == Direction::u;
  const Axis &axis = u ? shared->u : shared->v, &across = u ? shared->v : shared->u;
  const int i = axis.piece(at), iu = u ? i : fixed.piece, iv = u ? fixed.piece : i;
  out = {};
  if (std::isnan(at) || !shared->powers(iu, iv)) return false;
  const NurbsSurface& s = shared->surface;
  const HPoint* const net = &s.at(shared->u.first_point(iu), shared->v.first_point(iv));
  const std::ptrdiff_t step_v = std::ptrdiff_t{4} * s.count_u;
  (u ? shared->iso_u : shared->iso_v)
      .fix(axis.power(i, mu), fixed.values.data(), reinterpret_cast<const double*>(net), u ? 4 : step_v,
           u ? step_v : 4, axis.degree(), across.degree(), iso_space.get());
  out = {axis.lo(i), axis.above(i), axis.middle(i), axis.degree(), iso_space.get()};
  return true;
}

void SurfaceEvaluator::iso_points(Direction moving, double fixed, std::span<const double> parameters,
                                  std::span<Point3> out) {
  State& s = *state_;
  const bool u = moving == Direction::u;
  const Fixed f = s.shared->fixed(other(moving), fixed);
  along(
      parameters, out, s.shared->surface.domain(moving), (u ? s.shared->iso_u : s.shared->iso_v).points,
      [&](double at, IsoPiece& piece) { return s.enter_iso(moving, f, at, piece); },
      [&](double at) { return u ? point(at, fixed) : point(fixed, at); });
}

void SurfaceEvaluator::iso_derivatives(Direction moving, double fixed, std::span<const double> parameters,
                                       std::span<SurfaceDerivatives> out) {
  State& s = *state_;
  const bool u = moving == Direction::u;
  const Fixed f = s.shared->fixed(other(moving), fixed);
  const auto kernel = (u ? s.shared->iso_u : s.shared->iso_v).derivatives;
  along(
      parameters, out, s.shared->surface.domain(moving),
      [&](const IsoPiece& piece, const double* t, std::size_t n, double* values) {
        return kernel(piece, u, t, n, values);
      },
      [&](double at, IsoPiece& piece) { return s.enter_iso(moving, f, at, piece); },
      [&](double at) { return u ? derivatives(at, fixed) : derivatives(fixed, at); });
}

}  // namespace burin::geom

// SPDX-License-Identifier: Apache-2.0
#include "burin/nc/surface_block.h"

#include <cmath>

#include "burin/base/text.h"

namespace burin::nc {
namespace {

constexpr int kDefaultOrder = 4;
// A point takes a letter, a digit and the end of the line at least.
constexpr std::size_t kLeastPointText = 3;
constexpr double kMinWeight = 1e-12, kMaxWeight = 1e12;

std::string plural(std::size_t count, const std::string& what) {
  return std::to_string(count) + ' ' + what + (count == 1 ? "" : "s");
}

/// All points on one line have no surface between them.
bool without_area(const geom::NurbsSurface& surface) {
  const geom::Point3 first = geom::project(surface.points.front());
  geom::Vec3 far;
  for (const geom::HPoint& h : surface.points)
    if (const geom::Vec3 d = geom::project(h) - first; norm(d) > norm(far)) far = d;
  if (norm(far) <= kNoExtent_mm) return true;
  const geom::Vec3 along = unit(far);
  for (const geom::HPoint& h : surface.points)
    if (norm(cross(along, geom::project(h) - first)) > kNoExtent_mm) return false;
  return true;
}

bool only_knot(const Block& block) {
  return block.words.size() == 1 && block.words[0].letter == 'K';
}

}  // namespace

Result<SurfaceReader> SurfaceReader::begin(const Source& source, const Block& block, ModalMachine& machine) {
  SurfaceReader reader;
  reader.source_ = source;
  reader.block_ = &block;
  const Word* code = machine.take_code(Group::non_modal);
  reader.place_ = place_of(block, *code);
  for (char letter : {'X', 'Y', 'Z', 'W', 'K'})
    if (const Word* word = machine.words().value(letter))
      return source.error(ErrorCode::syntax,
                          word_text(*word) + " in the block of G6.23 (points and knots in the blocks behind)",
                          place_of(block, *word));
  reader.u_ = machine.take('U');
  reader.v_ = machine.take('V');
  reader.p_ = machine.take('P');
  reader.q_ = machine.take('Q');
  reader.d_ = machine.take('D');
  reader.l_ = machine.take('L');
  reader.s_ = machine.take('S');
  reader.f_ = machine.words().value('F');
  if (!reader.u_ || !reader.v_)
    return source.error(
        ErrorCode::syntax,
        std::string("G6.23 without ") + (reader.u_ ? "V" : "U") + " (U and V, the numbers of control points)",
        reader.place_);
  reader.result_.number = block.number;
  reader.result_.line = block.line;
  return reader;
}

Result<void> SurfaceReader::use(const ModalMachine& machine, SurfaceWords& modal, std::size_t remaining) {
  geom::NurbsSurface& surface = result_.surface;
  scale_ = machine.scale();
  const auto whole = [&](const Word* word, int otherwise, int lo, int hi, const char* what) -> Result<int> {
    if (!word) return otherwise;
    return integer_word(source_, *block_, *word, lo, hi, what);
  };
  const int max_order = geom::kMaxSurfaceDegree + 1;
  auto nu = whole(u_, 0, 2, geom::kMaxControlPoints, "a number of control points");
  if (!nu) return nu.error();
  auto nv = whole(v_, 0, 2, geom::kMaxControlPoints, "a number of control points");
  if (!nv) return nv.error();
  auto order_u = whole(p_, kDefaultOrder, 2, max_order, "an order");
  if (!order_u) return order_u.error();
  auto order_v = whole(q_, kDefaultOrder, 2, max_order, "an order");
  if (!order_v) return order_v.error();
  const auto fewer = [&](int order, const Word* count_word, const Word* order_word) {
    const char name = order_word ? order_word->letter : count_word->letter == 'U' ? 'P' : 'Q';
    return source_.error(ErrorCode::range,
                         word_text(*count_word) + " with order " + std::to_string(order) + " (at least " +
                             std::to_string(order) + " control points, or a smaller order in " + name + ")",
                         place_of(*block_, *count_word));
  };
  if (*nu < *order_u) return fewer(*order_u, u_, p_);
  if (*nv < *order_v) return fewer(*order_v, v_, q_);
  points_needed_ = static_cast<std::size_t>(*nu) * static_cast<std::size_t>(*nv);
  if (points_needed_ > static_cast<std::size_t>(geom::kMaxControlPoints) ||
      points_needed_ > remaining / kLeastPointText + 1)
    return source_.error(ErrorCode::range,
                         plural(points_needed_, "control point") + " for " + plural(remaining, "character") +
                             " of text that follow (as many as there are, at most " +
                             std::to_string(geom::kMaxControlPoints) + ")",
                         place_of(*block_, *u_));
  surface.count_u = *nu;
  surface.count_v = *nv;
  surface.degree_u = *order_u - 1;
  surface.degree_v = *order_v - 1;
  surface.points.reserve(points_needed_);
  knots_u_ = static_cast<std::size_t>(*nu + *order_u);
  knots_v_ = static_cast<std::size_t>(*nv + *order_v);

  if (d_) {
    auto d = positive_word(source_, *block_, *d_, scale_, "a tool diameter");
    if (!d) return d.error();
    modal.diameter = *d;
  }
  if (l_) {
    auto l = machine.length(*l_);
    if (!l) return l.error();
    if (*l < 0)
      return source_.error(ErrorCode::range, word_text(*l_) + ": stock below 0 (0 or more)",
                           place_of(*block_, *l_));
    modal.stock = *l;
  }
  if (s_) {
    auto s = positive_word(source_, *block_, *s_, scale_, "an allowable scallop height");
    if (!s) return s.error();
    modal.scallop = *s;
  }
  if (f_) {
    auto f = positive_word(source_, *block_, *f_, scale_, "a feed");
    if (!f) return f.error();
  }
  result_.tool_diameter = modal.diameter.value_or(0);
  result_.stock = modal.stock.value_or(0);
  result_.scallop = modal.scallop.value_or(0);
  result_.feed = machine.state().feed;
  u_ = v_ = p_ = q_ = d_ = l_ = s_ = f_ = nullptr;  // of a block that is soon gone
  block_ = nullptr;
  return {};
}

Error SurfaceReader::unfinished(Place place, const std::string& what) const {
  const geom::NurbsSurface& surface = result_.surface;
  const std::string of = " of the surface in line " + std::to_string(place_.line);
  if (phase_ == Phase::points)
    return source_.error(ErrorCode::syntax,
                         what + " after " + std::to_string(surface.points.size()) + " of " +
                             plural(points_needed_, "control point") + of + " (blocks with X, Y, Z, W)",
                         place);
  if (phase_ == Phase::knots)
    return source_.error(ErrorCode::syntax,
                         what + " after " + std::to_string(knots_.size()) + " of " +
                             plural(knots_needed(), "knot") + of +
                             " (blocks with one K: " + std::to_string(knots_u_) + " knots of U, then " +
                             std::to_string(knots_v_) + " of V)",
                         place);
  return source_.error(ErrorCode::syntax,
                       what + " while the trim loop in line " + std::to_string(trims_.open_loop().line) +
                           " lacks " + plural(trims_.missing(), "point") + " (BURIN TRIM u,v ...)",
                       place);
}

Result<bool> SurfaceReader::take(const Block& block, std::size_t remaining) {
  if (block.words.empty()) {
    if (!is_trim_comment(block)) return false;
    if (phase_ == Phase::points || phase_ == Phase::knots)
      return unfinished({block.line, std::max(1, block.comment_column)}, "a trim comment");
    if (phase_ == Phase::knots_possible)
      if (auto ok = all_knots(); !ok) return ok.error();
    phase_ = Phase::trims;
    if (auto ok = trims_.read(source_, block, result_.surface, remaining); !ok) return ok.error();
    return true;
  }
  const bool knot = block.find('K') != nullptr && block.find('G') == nullptr;
  if (phase_ == Phase::points || (!knot && block.find('W') != nullptr && block.find('G') == nullptr)) {
    if (auto ok = take_point(block); !ok) return ok.error();
    return true;
  }
  if (knot) {
    if (auto ok = take_knot(block); !ok) return ok.error();
    return true;
  }
  if (phase_ == Phase::knots || !trims_.complete())
    return unfinished(place_of(block), word_text(block.words.front()));
  return false;
}

Result<void> SurfaceReader::take_point(const Block& block) {
  constexpr std::string_view kLetters = "XYZW";
  std::array<bool, 4> seen{};
  for (const Word& word : block.words) {
    const std::size_t i = kLetters.find(word.letter);
    if (i == std::string_view::npos) {
      if (&word == &block.words.front()) return unfinished(place_of(block, word), word_text(word));
      return source_.error(ErrorCode::syntax, word_text(word) + " in a control point (X, Y, Z and W)",
                           place_of(block, word));
    }
    if (std::exchange(seen[i], true))
      return source_.error(ErrorCode::syntax,
                           std::string("the letter ") + word.letter + " twice in one block (once)",
                           place_of(block, word));
    const double value = i < 3 ? word.value * scale_ : word.value;
    if (i < 3 && !(std::abs(value) <= kMaxCoordinate_mm))
      return source_.error(ErrorCode::range, word_text(word) + " beyond " + coordinate_limit() + " (less)",
                           place_of(block, word));
    if (i == 3 && !(value >= kMinWeight && value <= kMaxWeight))
      return source_.error(
          ErrorCode::range,
          word_text(word) + ": a weight of " + format_shortest(value) + " (above 0, from 1e-12 to 1e12)",
          place_of(block, word));
    last_[i] = value;
    if (i < 3) known_[i] = true;
  }
  if (phase_ != Phase::points)
    return source_.error(ErrorCode::syntax,
                         "more control points than " + std::to_string(points_needed_) + " (U" +
                             std::to_string(result_.surface.count_u) + " V" +
                             std::to_string(result_.surface.count_v) + " in line " +
                             std::to_string(place_.line) + ")",
                         place_of(block));
  for (std::size_t i = 0; i < 3; ++i)
    if (!known_[i])
      return source_.error(ErrorCode::syntax,
                           std::string("the first control point without ") + kLetters[i] +
                               " (X, Y and Z; later ones may leave out what stays)",
                           place_of(block));
  result_.surface.points.push_back(geom::homogeneous({last_[0], last_[1], last_[2]}, last_[3]));
  if (result_.surface.points.size() == points_needed_) phase_ = Phase::knots_possible;
  return {};
}

Result<void> SurfaceReader::take_knot(const Block& block) {
  const Place place = place_of(block, *block.find('K'));
  if (!only_knot(block))
    return source_.error(ErrorCode::syntax, "a knot with other words in its block (one K and nothing else)",
                         place);
  if (phase_ == Phase::trims)
    return source_.error(ErrorCode::syntax, "a knot behind trim comments (points, knots, then BURIN TRIM)",
                         place);
  if (knots_.size() == knots_needed())
    return source_.error(ErrorCode::syntax,
                         "more knots than " + std::to_string(knots_needed()) + " (" +
                             std::to_string(knots_u_) + " of U, then " + std::to_string(knots_v_) + " of V)",
                         place);
  if (phase_ == Phase::knots_possible) {
    phase_ = Phase::knots;
    knots_.reserve(knots_needed());
    knot_places_.reserve(knots_needed());
  }
  knots_.push_back(block.words[0].value);
  knot_places_.push_back(place);
  if (knots_.size() < knots_needed()) return {};
  phase_ = Phase::knots_possible;
  return all_knots();
}

Result<void> SurfaceReader::all_knots() {
  geom::NurbsSurface& surface = result_.surface;
  if (knots_.empty()) {
    surface.knots_u = geom::clamped_uniform_knots(surface.count_u, surface.degree_u);
    surface.knots_v = geom::clamped_uniform_knots(surface.count_v, surface.degree_v);
    return {};
  }
  const auto split = static_cast<std::ptrdiff_t>(knots_u_);
  surface.knots_u.assign(knots_.begin(), knots_.begin() + split);
  surface.knots_v.assign(knots_.begin() + split, knots_.end());
  const std::vector<Place> places_u(knot_places_.begin(), knot_places_.begin() + split);
  const std::vector<Place> places_v(knot_places_.begin() + split, knot_places_.end());
  if (auto ok = check_knots(source_, surface.knots_u, places_u, surface.degree_u + 1, " of U"); !ok)
    return ok;
  return check_knots(source_, surface.knots_v, places_v, surface.degree_v + 1, " of V");
}

Result<void> SurfaceReader::end(int last) const {
  if (phase_ == Phase::points || phase_ == Phase::knots || !trims_.complete())
    return unfinished({last, 1}, "the program ends");
  return {};
}

Result<SurfaceBlock> SurfaceReader::finish() {
  if (phase_ == Phase::knots_possible && knots_.empty())
    if (auto ok = all_knots(); !ok) return ok.error();
  if (without_area(result_.surface))
    return source_.error(ErrorCode::geometry,
                         "all control points lie in one point or on one line (points that span a surface)",
                         place_);
  if (auto ok = geom::validate(result_.surface); !ok)
    return source_.error(ok.error().code, ok.error().message, place_);
  result_.trims = trims_.take_loops();
  return std::move(result_);
}

}  // namespace burin::nc

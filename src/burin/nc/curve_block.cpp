// SPDX-License-Identifier: Apache-2.0
#include "burin/nc/curve_block.h"

#include <cmath>

#include "burin/base/text.h"
#include "burin/geom/point_tools.h"
#include "burin/nc/arc.h"

namespace burin::nc {
namespace {

constexpr std::string_view kLetters = "XYZKR";
constexpr std::size_t kKnot = 3, kWeight = 4;
constexpr double kMinWeight = 1e-12, kMaxWeight = 1e12;
constexpr int kCode = 620;

bool any_point_word(const std::array<const Word*, 5>& words) {
  return words[0] || words[1] || words[2] || words[kWeight];
}

}  // namespace

Result<CurveReader> CurveReader::begin(const Source& source, const Block& block, ModalMachine& machine) {
  CurveReader reader;
  reader.source_ = source;
  reader.block_ = &block;
  reader.place_ = place_of(block, *machine.take_code(Group::motion));
  for (std::size_t i = 0; i < kLetters.size(); ++i) reader.first_[i] = machine.take(kLetters[i]);
  reader.p_ = machine.take('P');
  const Word *q = machine.take('Q'), *l = machine.take('L');
  reader.rule_ = q ? q : l;
  if (!reader.first_[kKnot] && !any_point_word(reader.first_) && !reader.p_ && block.words.size() == 1)
    return source.error(ErrorCode::syntax,
                        "G6.2 without anything (P order, K knot and the first control point X Y Z R)",
                        reader.place_);
  return reader;
}

Result<void> CurveReader::use(ModalMachine& machine) {
  scale_ = machine.scale();
  if (machine.state().incremental)
    return source_.error(ErrorCode::unsupported, "G6.2 while G91 is in force (G90)", place_);
  if (p_) {
    auto order = integer_word(source_, *block_, *p_, 2, geom::kMaxSurfaceDegree + 1, "an order");
    if (!order) return order.error();
    order_ = *order;
  }
  if (rule_)
    machine.once(Severity::info, "word_without_effect", "G6.2 Q",
                 word_text(*rule_) + " of G6.2 (LinuxCNC's rule for the feed) has no effect here", rule_);
  if (auto ok = machine.may_feed(first_[0]); !ok)
    return source_.error(ok.error().code, ok.error().message, place_);
  last_ = machine.state().position;
  first_knot_missing_ = first_[kKnot] == nullptr;
  auto ok = add(*block_, first_);
  first_ = {};
  p_ = rule_ = nullptr;
  block_ = nullptr;
  return ok;
}

Error CurveReader::unfinished(Place place, const std::string& what) const {
  return source_.error(ErrorCode::syntax,
                       what + " inside the curve of line " + std::to_string(place_.line) + ", which has " +
                           std::to_string(points_.size()) + " control points and " +
                           std::to_string(knots_.size()) + " knots (as many more knots as its order, " +
                           std::to_string(order_) + ", in blocks with K alone)",
                       place);
}

Result<void> CurveReader::take(const Block& block) {
  std::array<const Word*, 5> words{};
  bool code = false;
  for (const Word& word : block.words) {
    if (word.letter == 'G' && word.code() == kCode && !code) {
      code = true;
      continue;
    }
    const std::size_t i = kLetters.find(word.letter);
    if (i == std::string_view::npos) return unfinished(place_of(block, word), word_text(word));
    if (std::exchange(words[i], &word))
      return source_.error(ErrorCode::syntax,
                           std::string("the letter ") + word.letter + " twice in one block (once)",
                           place_of(block, word));
  }
  if (code && (any_point_word(words) || !words[kKnot])) return unfinished(place_of(block), "a second G6.2");
  if (!words[kKnot])
    return source_.error(ErrorCode::syntax, "a control point of G6.2 without its knot (K, X, Y, Z, R)",
                         place_of(block));
  if (any_point_word(words)) {
    if (trailing_ > 0)
      return source_.error(ErrorCode::syntax,
                           "a control point behind knots without points (" + std::to_string(order_) +
                               " of them, the order, end the curve)",
                           place_of(block));
    return add(block, words);
  }
  ++trailing_;
  return add_knot(block, *words[kKnot]);
}

Result<void> CurveReader::add(const Block& block, const std::array<const Word*, 5>& words) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (!words[i]) continue;
    const double value = words[i]->value * scale_;
    if (!(std::abs(value) <= kMaxCoordinate_mm))
      return source_.error(ErrorCode::range,
                           word_text(*words[i]) + " beyond " + coordinate_limit() + " (less)",
                           place_of(block, *words[i]));
    set_component(last_, i, value);
  }
  const double weight = words[kWeight] ? words[kWeight]->value : 1.0;
  if (!(weight >= kMinWeight && weight <= kMaxWeight))
    return source_.error(ErrorCode::range,
                         word_text(*words[kWeight]) + ": a weight of " + format_shortest(weight) +
                             " (above 0, from 1e-12 to 1e12)",
                         place_of(block, *words[kWeight]));
  if (points_.size() >= static_cast<std::size_t>(geom::kMaxControlPoints))
    return source_.error(
        ErrorCode::range,
        "more than " + std::to_string(geom::kMaxControlPoints) + " control points in one curve (split it)",
        place_of(block));
  points_.push_back(geom::homogeneous(last_, weight));
  return words[kKnot] ? add_knot(block, *words[kKnot]) : Result<void>{};
}

Result<void> CurveReader::add_knot(const Block& block, const Word& word) {
  // The first block without K has the knot of the second.
  const int times = std::exchange(first_knot_missing_, false) ? 2 : 1;
  for (int i = 0; i < times; ++i) {
    knots_.push_back(word.value);
    places_.push_back(place_of(block, word));
  }
  return {};
}

Result<void> CurveReader::end(int last) const {
  return complete() ? Result<void>{} : unfinished({last, 1}, "the program ends");
}

Result<geom::NurbsCurve> CurveReader::finish() {
  if (points_.size() < static_cast<std::size_t>(order_))
    return source_.error(ErrorCode::syntax,
                         std::to_string(points_.size()) + " control points for a curve of order " +
                             std::to_string(order_) + " (at least as many as the order)",
                         place_);
  if (auto ok = check_knots(source_, knots_, places_, order_, ""); !ok) return ok.error();
  geom::NurbsCurve curve{order_ - 1, std::move(knots_), std::move(points_)};
  const geom::Point3 first = geom::project(curve.points.front());
  bool extent = false;
  for (const geom::HPoint& h : curve.points) extent |= distance(first, geom::project(h)) > kNoExtent_mm;
  if (!extent)
    return source_.error(ErrorCode::geometry,
                         "all control points of the curve are one point (points that differ)", place_);
  if (auto ok = geom::validate(curve); !ok) return source_.error(ok.error().code, ok.error().message, place_);
  return curve;
}

}  // namespace burin::nc

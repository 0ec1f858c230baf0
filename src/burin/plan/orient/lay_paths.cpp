// SPDX-License-Identifier: Apache-2.0
// Places of paths so that strips cover what lies between them (docs/strip.md). The load of a gap is the
// largest quotient of distance and strips over its stations: 1 is just covered. Loads of neighbouring gaps
// add up, to first order; so measured loads give a density over w, and places are where its integral has
// passed equal amounts.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <string>

#include "burin/geom/point_tools.h"
#include "burin/plan/orient/paths.h"

namespace burin::orient {
namespace {

using geom::Point3;

/// Lanes of the first look, rounds of laying all paths anew, and of putting single ones between.
constexpr int kCoarse = 13, kRounds = 6, kMendings = 24;
/// Loads are planned for this share of what is allowed, so that small errors of the prediction do no harm.
constexpr double kPlanned = 0.995;
/// Another round is worth its lanes when it leaves at most this share of the paths.
constexpr double kWorthwhile = 0.98;
/// Places of w between two lanes that the density is worked out at.
constexpr int kInner = 16;
/// Lanes nearer than this are one.
constexpr double kLeastStep = 1e-7;
/// A station whose neighbour lies beyond the end of the neighbouring path by more than this share of the
/// distance has none abreast.
constexpr double kBeyondEnd = 0.02;
/// Stands for a gap whose strips have no width at all.
constexpr double kHopeless = 1e12;

/// Walks along a lane and gives its strip abreast of places that come in order.
class StripFinder {
 public:
  explicit StripFinder(const Lane& lane) : lane_(lane) {}

  /// Nothing when no part of the lane is within `reach`, or it is unreachable there.
  std::optional<Strip> at(Point3 place, double reach) {
    if (!near(place, reach)) return std::nullopt;
    const auto& p = lane_.pieces[piece_];
    const auto& s = lane_.strips[piece_];
    const std::size_t k = segment_, l = std::min(k + 1, p.size() - 1);
    if (!(s[k].width() > 0) || !(s[l].width() > 0)) return std::nullopt;
    const geom::Vec3 way = p[l].c - p[k].c;
    const double length2 = dot(way, way);
    const double x = length2 > 0 ? std::clamp(dot(place - p[k].c, way) / length2, 0.0, 1.0) : 0;
    return Strip{s[k].left + x * (s[l].left - s[k].left), s[k].right + x * (s[l].right - s[k].right)};
  }

  /// Whether some of the lane is within `reach`; it is then the place that at() begins to look from.
  bool near(Point3 place, double reach) {
    double best = std::numeric_limits<double>::infinity();
    std::size_t best_piece = 0, best_segment = 0;
    const auto look = [&](std::size_t piece, std::size_t segment) {
      const auto& p = lane_.pieces[piece];
      const double d = segment + 1 < p.size()
                           ? geom::distance_to_segment(place, p[segment].c, p[segment + 1].c)
                           : distance(place, p[segment].c);
      if (d < best) best = d, best_piece = piece, best_segment = segment;
      return d;
    };
    // From where the last one was, as long as it comes nearer; else everywhere.
    if (piece_ < lane_.pieces.size() && segment_ < lane_.pieces[piece_].size()) {
      const std::size_t last = lane_.pieces[piece_].size() - 1;
      look(piece_, segment_);
      for (const int way : {1, -1}) {
        std::size_t at = segment_;
        double before = best;
        while (way > 0 ? at < last : at > 0) {
          at = way > 0 ? at + 1 : at - 1;
          const double d = look(piece_, at);
          if (d > before) break;
          before = d;
        }
      }
    }
    if (best > reach) {
      for (std::size_t i = 0; i < lane_.pieces.size(); ++i) {
        for (std::size_t k = 0; k + 1 < lane_.pieces[i].size(); ++k) look(i, k);
      }
    }
    if (!(best <= reach)) return false;
    piece_ = best_piece, segment_ = best_segment;
    return true;
  }

 private:
  const Lane& lane_;
  std::size_t piece_ = 0, segment_ = 0;
};

double load_of(double distance, double strips) {
  return strips > 0 ? std::min(distance / strips, kHopeless) : distance > 0 ? kHopeless : 0;
}

/// Seen from the stations of `a` only.
double one_way_load(const PathFamily& family, const Lane& a, const Lane& b) {
  double load = 0;
  for (std::size_t i = 0; i < a.pieces.size(); ++i) {
    const auto there = family.abreast(a.pieces[i], a.w, b.w);
    StripFinder finder(b);
    for (std::size_t k = 0; k < there.size(); ++k) {
      const Strip& mine = a.strips[i][k];
      if (!(mine.width() > 0)) continue;
      if (!there[k].found && std::isfinite(there[k].border)) {
        // A border between the two, and the neighbour has nothing near: this lane alone covers up to it (the
        // top of a lobe, a hole's rim). Where the neighbour ends near by, the border only slants.
        if (!finder.near(there[k].place, there[k].distance)) {
          load = std::max(load, load_of(there[k].border, there[k].left ? mine.left : mine.right));
        }
        continue;
      }
      if (!there[k].found) continue;
      const auto other = finder.at(there[k].place, kBeyondEnd * there[k].distance);
      if (!other) continue;
      const double strips = there[k].left ? mine.left + other->right : mine.right + other->left;
      load = std::max(load, load_of(there[k].distance, strips));
    }
  }
  return load;
}

/// Between a lane and the end of the family, `border` 0 or 1.
double border_load(const PathFamily& family, const Lane& a, double border) {
  double load = 0;
  for (std::size_t i = 0; i < a.pieces.size(); ++i) {
    const auto there = family.abreast(a.pieces[i], a.w, border);
    for (std::size_t k = 0; k < there.size(); ++k) {
      const Strip& mine = a.strips[i][k];
      const double way = there[k].found ? there[k].distance : there[k].border;
      if (!(mine.width() > 0) || !std::isfinite(way)) continue;
      load = std::max(load, load_of(way, there[k].left ? mine.left : mine.right));
    }
  }
  return load;
}

/// Lanes worked out so far and what their gaps bear.
class Survey {
 public:
  Survey(const PathFamily& family, const LanePlanner& planner) : family_(family), planner_(planner) {}

  void plan(const std::vector<double>& ws) {
    std::vector<double> missing;
    for (const double w : ws) {
      if (lanes_.find(w) == lanes_.end()) missing.push_back(w);
    }
    if (missing.empty()) return;
    for (Lane& lane : planner_(missing)) lanes_[lane.w] = std::move(lane);
  }
  double gap(double a, double b) {
    const auto key = std::pair{a, b};
    if (const auto known = gaps_.find(key); known != gaps_.end()) return known->second;
    const Lane &x = lanes_.at(a), &y = lanes_.at(b);
    return gaps_[key] = std::max(one_way_load(family_, x, y), one_way_load(family_, y, x));
  }
  double border(double w, double end) {
    const auto key = std::pair{w, end + 2};  // no gap has such an end
    if (const auto known = gaps_.find(key); known != gaps_.end()) return known->second;
    return gaps_[key] = border_load(family_, lanes_.at(w), end);
  }
  /// Forgets the lanes that are not among `ws`, for their size.
  void keep(const std::vector<double>& ws) {
    for (auto i = lanes_.begin(); i != lanes_.end();) {
      i = std::binary_search(ws.begin(), ws.end(), i->first) ? std::next(i) : lanes_.erase(i);
    }
  }

 private:
  const PathFamily& family_;
  const LanePlanner& planner_;
  std::map<double, Lane> lanes_;
  std::map<std::pair<double, double>, double> gaps_;
};

/// loads[0]: border before the first place; loads[i]: gap before place i; loads.back(): border behind.
std::vector<double> loads_of(Survey& survey, const std::vector<double>& ws) {
  survey.plan(ws);
  std::vector<double> loads{survey.border(ws.front(), 0)};
  for (std::size_t i = 1; i < ws.size(); ++i) loads.push_back(survey.gap(ws[i - 1], ws[i]));
  loads.push_back(survey.border(ws.back(), 1));
  return loads;
}

/// What the loads of a set of lanes say about any other set.
class Prediction {
 public:
  Prediction(const std::vector<double>& ws, const std::vector<double>& loads);

  /// Nowhere less than another one says: strips that change abruptly are met differently by each set of
  /// lanes.
  void raise(const Prediction& other);
  /// Places that bear `load` each, from the first border on; nothing when more than `most` are needed.
  std::optional<std::vector<double>> chain(double load, std::size_t most) const;
  /// The fewest places with loads up to `load`, evened out.
  std::optional<std::vector<double>> places(double load, std::size_t most) const;

 private:
  double sum_to(double w) const;
  double place_of(double sum) const;
  void add_up();

  std::vector<double> w_, density_;  ///< between w_[i] and w_[i + 1]
  std::vector<double> sum_;          ///< its integral up to w_[i]
  double before_ = 0, behind_ = 0;   ///< load of the borders by their distance
};

Prediction::Prediction(const std::vector<double>& ws, const std::vector<double>& loads) {
  const std::size_t gaps = ws.size() - 1;
  before_ = ws.front() > 0 ? loads.front() / ws.front() : 0;
  behind_ = ws.back() < 1 ? loads.back() / (1 - ws.back()) : 0;
  // Densities in the middles of the gaps, straight between them, each gap's integral as measured.
  std::vector<double> middle, density;
  for (std::size_t i = 0; i < gaps; ++i) {
    middle.push_back(0.5 * (ws[i] + ws[i + 1]));
    density.push_back(loads[i + 1] / (ws[i + 1] - ws[i]));
  }
  if (gaps == 0) {
    // One lane: its own strips to both sides.
    middle.push_back(0.5), density.push_back(0.5 * std::max(before_, behind_));
  }
  const auto density_at = [&](double w) {
    if (w <= middle.front()) return density.front();
    if (w >= middle.back()) return density.back();
    const auto i =
        static_cast<std::size_t>(std::upper_bound(middle.begin(), middle.end(), w) - middle.begin());
    const double x = (w - middle[i - 1]) / (middle[i] - middle[i - 1]);
    return density[i - 1] + x * (density[i] - density[i - 1]);
  };
  std::vector<double> ends{0};
  for (const double w : ws) {
    if (w > ends.back()) ends.push_back(w);
  }
  if (ends.back() < 1) ends.push_back(1);
  w_.push_back(0);
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const double a = ends[i], b = ends[i + 1], h = (b - a) / kInner;
    double total = 0;
    for (int k = 0; k < kInner; ++k) total += h * density_at(a + (k + 0.5) * h);
    // The gap this stretch is, when it is one.
    const auto at = std::lower_bound(ws.begin(), ws.end(), b);
    const bool gap = at != ws.begin() && at != ws.end() && *(at - 1) == a;
    const double measured = gap ? loads[static_cast<std::size_t>(at - ws.begin())] : total;
    const double scale = total > 0 ? measured / total : 0;
    for (int k = 0; k < kInner; ++k) {
      w_.push_back(k + 1 < kInner ? a + (k + 1) * h : b);
      density_.push_back(scale * density_at(a + (k + 0.5) * h));
    }
  }
  add_up();
}

void Prediction::add_up() {
  sum_.assign(1, 0);
  for (std::size_t i = 0; i < density_.size(); ++i) {
    sum_.push_back(sum_.back() + density_[i] * (w_[i + 1] - w_[i]));
  }
}

void Prediction::raise(const Prediction& other) {
  std::vector<double> w, density;
  std::set_union(w_.begin(), w_.end(), other.w_.begin(), other.w_.end(), std::back_inserter(w));
  std::size_t i = 0, k = 0;
  for (std::size_t c = 0; c + 1 < w.size(); ++c) {
    while (i + 1 < density_.size() && w_[i + 1] <= w[c]) ++i;
    while (k + 1 < other.density_.size() && other.w_[k + 1] <= w[c]) ++k;
    density.push_back(std::max(density_[i], other.density_[k]));
  }
  w_ = std::move(w), density_ = std::move(density);
  before_ = std::max(before_, other.before_), behind_ = std::max(behind_, other.behind_);
  add_up();
}

double Prediction::sum_to(double w) const {
  const auto next = std::upper_bound(w_.begin() + 1, w_.end() - 1, w);
  const auto i = static_cast<std::size_t>(next - w_.begin()) - 1;
  const double x = std::clamp((w - w_[i]) / (w_[i + 1] - w_[i]), 0.0, 1.0);
  return sum_[i] + x * (sum_[i + 1] - sum_[i]);
}

double Prediction::place_of(double sum) const {
  if (!(sum_.back() > 0)) return 0.5;
  if (sum >= sum_.back()) return 1;
  const auto next = std::upper_bound(sum_.begin() + 1, sum_.end() - 1, sum);
  const auto i = static_cast<std::size_t>(next - sum_.begin()) - 1;
  const double step = sum_[i + 1] - sum_[i];
  return w_[i] + (step > 0 ? std::clamp((sum - sum_[i]) / step, 0.0, 1.0) : 1) * (w_[i + 1] - w_[i]);
}

std::optional<std::vector<double>> Prediction::chain(double load, std::size_t most) const {
  // A border that bears nothing (nothing reachable, none abreast): half a step from it.
  const double half = 0.5 * std::min(load, sum_.back());
  double w = before_ > 0 ? load / before_ : place_of(half);
  std::vector<double> places{std::clamp(w, 0.0, 1.0)};
  const double rest = behind_ > 0 ? load / behind_ : 1 - place_of(sum_.back() - half);
  while (places.back() < 1 - rest - kLeastStep) {
    if (places.size() >= most) return std::nullopt;
    w = place_of(sum_to(places.back()) + load);
    // Too small steps to be told apart: too many as well.
    if (!(w > places.back() + kLeastStep)) return std::nullopt;
    places.push_back(w);
  }
  return places;
}

std::optional<std::vector<double>> Prediction::places(double load, std::size_t most) const {
  const auto fewest = chain(load, most);
  if (!fewest) return std::nullopt;
  double lo = 0, hi = load;
  auto best = *fewest;
  for (int i = 0; i < 40; ++i) {
    const double mid = 0.5 * (lo + hi);
    const auto tried = chain(mid, fewest->size());
    if (tried)
      best = *tried, hi = mid;
    else
      lo = mid;
  }
  return best;
}

double worst(const std::vector<double>& loads) {
  return *std::max_element(loads.begin(), loads.end());
}

Error too_many(std::size_t max_paths) {
  return {ErrorCode::range,
          "more than " + std::to_string(max_paths) +
              " paths to stay within the scallop (a greater scallop, a larger tool, or a given side step)",
          {}};
}

/// Lanes into what is not covered.
Result<std::vector<double>> mended(Survey& survey, std::vector<double> ws, std::size_t max_paths) {
  for (int round = 0; round < kMendings; ++round) {
    const std::vector<double> loads = loads_of(survey, ws);
    std::vector<double> more;
    const auto fill = [&](double a, double b, double load, bool from_border, bool to_border) {
      if (!(load > 1) || b - a < 2 * kLeastStep) return;
      // A border takes half a step.
      const double pieces = std::min(std::ceil(load), static_cast<double>(max_paths) + 1);
      const auto n = static_cast<int>(std::max(2.0, pieces));
      const double head = from_border ? 0.5 : 1, tail = to_border ? 0.5 : 1;
      const double all = head + tail + (n - 2);
      for (int k = 0; k + 1 < n; ++k) more.push_back(a + (b - a) * (head + k) / all);
    };
    fill(0, ws.front(), loads.front(), true, false);
    for (std::size_t i = 1; i < ws.size(); ++i) fill(ws[i - 1], ws[i], loads[i], false, false);
    fill(ws.back(), 1, loads.back(), false, true);
    if (more.empty()) return ws;
    if (ws.size() + more.size() > max_paths) return too_many(max_paths);
    ws.insert(ws.end(), more.begin(), more.end());
    std::sort(ws.begin(), ws.end());
  }
  return ws;
}

}  // namespace

Result<std::vector<double>> lay_paths(const PathFamily& family, const LanePlanner& plan_lanes,
                                      std::size_t max_paths) {
  if (max_paths == 0) return too_many(0);
  Survey survey(family, plan_lanes);
  std::vector<double> ws;
  for (int i = 0; i < kCoarse; ++i) ws.push_back((i + 0.5) / kCoarse);
  std::vector<double> loads = loads_of(survey, ws);
  std::optional<std::vector<double>> best;
  if (ws.size() <= max_paths && worst(loads) <= 1) best = ws;
  std::optional<Prediction> all;  // of all rounds but the first look
  int attempts = 0;
  for (int round = 0; round < kRounds; ++round) {
    Prediction latest(ws, loads);
    if (round > 0 && !best) {
      if (all) latest.raise(*all);
      all = latest;
    }
    // What holds already is only given up for fewer, and for that two attempts are enough.
    if (best && ++attempts > 2) break;
    const std::size_t most = best ? best->size() - 1 : max_paths;
    const auto next = most > 0 ? latest.places(best ? 1.0 : kPlanned, most) : std::nullopt;
    if (!next && !best) return too_many(max_paths);
    if (!next || *next == ws) break;
    if (best && static_cast<double>(next->size()) > kWorthwhile * static_cast<double>(best->size())) break;
    survey.plan(*next);
    survey.keep(*next);
    ws = *next;
    loads = loads_of(survey, ws);
    if (worst(loads) <= 1) best = ws;
  }
  if (best) return *best;
  return mended(survey, std::move(ws), max_paths);
}

}  // namespace burin::orient

// SPDX-License-Identifier: Apache-2.0
#include "burin/view/cycle_track.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

#include "burin/geom/surface/evaluate.h"
#include "burin/view/track_labels.h"

namespace burin::view {
namespace {

/// First tolerances, relative to the size of the part, the largest feed and acceleration: below what a screen
/// shows. They double until the points are few enough.
constexpr double kPositionPart = 2e-5, kFeedPart = 2e-3, kAccelPart = 1e-2;
constexpr int kDoublings = 30;
/// Stretches of equal length in each of which the extreme feeds and acceleration stay.
constexpr std::size_t kExtremeStretches = 2000;
constexpr std::size_t kMostMotionSamples = 2'000'000;

double finite(double v) {
  return std::isfinite(v) ? v : 0;
}

/// The samples with their values, wherever they come from.
class Samples {
 public:
  Samples(const CyclePicture& picture, bool timed) : timed_(timed), period_(picture.period_s) {
    if (timed) {
      setpoints_ = picture.setpoints;
      labels_ = label_setpoints(picture);
    } else {
      motions_ = sample_motions(picture, kMostMotionSamples);
      labels_ = std::move(motions_.labels);
      if (!motions_.length.empty()) step_ = std::max(step_, motions_.length.back() / kMostSteps);
    }
    if (!(period_ > 0)) period_ = 0.001;
    measure();
  }

  std::size_t size() const { return timed_ ? setpoints_->size() : motions_.samples.size(); }
  const TrackLabel& label(std::size_t i) const { return labels_.labels[labels_.of_sample[i]]; }
  std::uint32_t label_index(std::size_t i) const { return labels_.of_sample[i]; }
  double period() const { return period_; }
  TrackSample at(std::size_t i) const {
    if (!timed_) return motions_.samples[i];
    const servo::Setpoint& s = (*setpoints_)[i];
    return {{finite(s.x), finite(s.y), finite(s.z)}, finite(s.feed_mm_min), s.u, s.v};
  }
  /// Time or length in steps of the track.
  double position(std::size_t i) const {
    return timed_ ? static_cast<double>(i) : motions_.length[i] / step_;
  }
  double tangential(std::size_t i) const { return timed_ ? static_cast<double>(tangential_[i]) : 0; }
  double axis(std::size_t i) const { return timed_ ? static_cast<double>(axis_[i]) : 0; }

  /// s, or mm.
  double step() const { return timed_ ? period_ : step_; }

 private:
  static constexpr double kLengthStep = 0.001;  // mm
  static constexpr double kMostSteps = 4e9;     // fit 32 bits

  void measure() {
    if (!timed_) return;
    const std::size_t n = size();
    tangential_.assign(n, 0);
    axis_.assign(n, 0);
    for (std::size_t i = 1; i + 1 < n; ++i) {
      const TrackSample a = at(i - 1), b = at(i), c = at(i + 1);
      tangential_[i] = static_cast<float>((c.feed - a.feed) / 60 / (2 * period_));
      const geom::Vec3 second = (c.p - b.p) - (b.p - a.p);
      const double most = std::max({std::abs(second.x), std::abs(second.y), std::abs(second.z)});
      axis_[i] = static_cast<float>(most / (period_ * period_));
    }
  }

  bool timed_ = false;
  double period_ = 0.001, step_ = kLengthStep;
  const std::vector<servo::Setpoint>* setpoints_ = nullptr;
  MotionSamples motions_;
  TrackLabels labels_;
  std::vector<float> tangential_, axis_;
};

constexpr std::size_t kChannels = 6;
using Values = std::array<double, kChannels>;

Values values(const Samples& s, std::size_t i) {
  const TrackSample p = s.at(i);
  return {p.p.x, p.p.y, p.p.z, p.feed, s.tangential(i), s.axis(i)};
}

/// Points that stay: the ends, both sides of a change of label, extremes of every stretch.
std::vector<std::uint8_t> must_stay(const Samples& s, std::size_t most_points) {
  const std::size_t n = s.size();
  std::vector<std::uint8_t> stay(n, 0);
  std::size_t changes = 0;
  for (std::size_t i = 1; i < n; ++i) changes += s.label_index(i) != s.label_index(i - 1) ? 1 : 0;
  if (4 * changes < most_points) {  // so many short paths could not all be shown
    for (std::size_t i = 1; i < n; ++i) {
      if (s.label_index(i) != s.label_index(i - 1)) stay[i - 1] = stay[i] = 1;
    }
  }
  const std::size_t stretches = std::min(kExtremeStretches, most_points / 16 + 1);
  const std::size_t length = n / stretches + 1;
  for (std::size_t from = 0; from < n; from += length) {
    std::size_t low = from, high = from, fast = from;
    for (std::size_t i = from; i < std::min(n, from + length); ++i) {
      if (s.at(i).feed < s.at(low).feed) low = i;
      if (s.at(i).feed > s.at(high).feed) high = i;
      if (s.axis(i) > s.axis(fast)) fast = i;
    }
    stay[low] = stay[high] = stay[fast] = 1;
  }
  if (n > 0) stay.front() = stay.back() = 1;
  return stay;
}

/// Fan method: from the last kept point a cone of slopes for every value holds what has passed within its
/// tolerance; the point before the one whose own slope leaves a cone is kept. What is left out then lies
/// within the tolerance of the line between its kept neighbours. Stops early above `most`.
std::vector<std::uint32_t> thin_out(const Samples& s, const std::vector<std::uint8_t>& stay,
                                    const Values& tolerance, std::size_t most) {
  std::vector<std::uint32_t> kept;
  if (s.size() == 0) return kept;
  constexpr double kInf = std::numeric_limits<double>::infinity();
  Values lo, hi, anchor = values(s, 0);
  double at = s.position(0);
  kept.push_back(0);
  const auto restart = [&](std::size_t i) {
    lo.fill(-kInf);
    hi.fill(kInf);
    anchor = values(s, i);
    at = s.position(i);
    if (kept.back() != i) kept.push_back(static_cast<std::uint32_t>(i));
  };
  restart(0);
  for (std::size_t i = 1; i < s.size() && kept.size() <= most; ++i) {
    const Values v = values(s, i);
    const auto leaves = [&] {
      const double d = s.position(i) - at;
      for (std::size_t c = 0; c < kChannels; ++c) {
        const double rise = v[c] - anchor[c];
        if (d > 0 ? rise < lo[c] * d || rise > hi[c] * d : std::abs(rise) > tolerance[c]) return true;
      }
      return false;
    };
    if (leaves()) restart(i - 1);
    const double d = s.position(i) - at;
    if (stay[i]) {
      restart(i);
    } else if (d > 0) {
      for (std::size_t c = 0; c < kChannels; ++c) {
        lo[c] = std::max(lo[c], (v[c] - tolerance[c] - anchor[c]) / d);
        hi[c] = std::min(hi[c], (v[c] + tolerance[c] - anchor[c]) / d);
      }
    }
  }
  if (kept.back() + 1 != s.size()) kept.push_back(static_cast<std::uint32_t>(s.size() - 1));
  return kept;
}

struct Extent {
  geom::Box3 box;
  double feed = 0, tangential = 0, axis = 0;
};

Extent extent_of(const Samples& s) {
  Extent e;
  for (std::size_t i = 0; i < s.size(); ++i) {
    const TrackSample p = s.at(i);
    e.box.add(p.p);
    e.feed = std::max(e.feed, p.feed);
    e.tangential = std::max(e.tangential, std::abs(s.tangential(i)));
    e.axis = std::max(e.axis, s.axis(i));
  }
  return e;
}

std::vector<std::uint32_t> choose(const Samples& s, const Extent& e, std::size_t most, Track& track) {
  const double accel = kAccelPart * std::max(e.axis, 1e-9);
  Values tolerance{};
  std::fill(tolerance.begin(), tolerance.begin() + 3, std::max(kPositionPart * e.box.diagonal(), 1e-9));
  tolerance[3] = kFeedPart * std::max(e.feed, 1e-9);
  tolerance[4] = tolerance[5] = accel;
  const std::vector<std::uint8_t> stay = must_stay(s, most);
  std::vector<std::uint32_t> kept;
  for (int k = 0; k < kDoublings; ++k) {
    kept = thin_out(s, stay, tolerance, most);
    if (kept.size() <= most) break;
    for (double& t : tolerance) t *= 2;
  }
  if (kept.size() > most) {  // cannot be thinned within tolerances: evenly
    kept.clear();
    const std::size_t stride = s.size() / most + 1;
    for (std::size_t i = 0; i < s.size(); i += stride) kept.push_back(static_cast<std::uint32_t>(i));
  }
  track.position_mm = tolerance[0];
  track.feed_mm_min = tolerance[3];
  track.accel_mm_s2 = tolerance[5];
  return kept;
}

/// Where the ball touches, and how far the tip is above where its surface alone would have it (R, L and the
/// side of the normal as the planner has them).
class Contact {
 public:
  explicit Contact(const CyclePicture& picture) : picture_(picture) {}

  void add_to(TrackPoint& point, const TrackLabel& label, const TrackSample& s) {
    point.lift = label.lift_max;
    if (label.group < 0 || label.surface < 0 || !std::isfinite(s.u) || !std::isfinite(s.v)) return;
    const CycleGroup& group = picture_.groups[static_cast<std::size_t>(label.group)];
    const auto surface = static_cast<std::size_t>(label.surface);
    if (!(group.tool_diameter_mm > 0) || !group.composite || surface >= group.composite->surfaces.size())
      return;
    select(label.group, surface);
    const geom::SurfaceDerivatives d = evaluator_->derivatives(s.u, s.v);
    const geom::Vec3 n = side_ * geom::normal(d);
    if (!(geom::dot(n, n) > 0)) return;
    point.normal = n;
    if (!(label.lift_max > 0)) return;
    const double r = 0.5 * group.tool_diameter_mm;
    const double tip = d.p.z + (r + group.stock_mm) * n.z - r + group.displacement.z;
    point.lift = std::clamp(finite(s.p.z - tip), 0.0, label.lift_max);
  }

 private:
  void select(int group, std::size_t surface) {
    if (group == group_ && surface == surface_) return;
    group_ = group;
    surface_ = surface;
    const geom::NurbsSurface& s =
        picture_.groups[static_cast<std::size_t>(group)].composite->surfaces[surface].surface;
    evaluator_.emplace(s);
    const geom::Interval u = s.domain(geom::Direction::u), v = s.domain(geom::Direction::v);
    side_ = geom::normal(s, 0.5 * (u.lo + u.hi), 0.5 * (v.lo + v.hi)).z < 0 ? -1 : 1;
  }

  const CyclePicture& picture_;
  int group_ = -1;
  std::size_t surface_ = 0;
  double side_ = 1;
  std::optional<geom::SurfaceEvaluator> evaluator_;
};

void add_sample(PassRow& row, const Samples& s, std::size_t i, bool timed) {
  const TrackSample p = s.at(i);
  row.last = static_cast<std::uint32_t>(i);
  if (i > 0) row.length += distance(s.at(i - 1).p, p.p);
  if (!timed) return;
  row.seconds += s.period();
  row.feed_min = std::isnan(row.feed_min) ? p.feed : std::min(row.feed_min, p.feed);
  row.feed_max = std::isnan(row.feed_max) ? p.feed : std::max(row.feed_max, p.feed);
  row.axis_max = std::isnan(row.axis_max) ? s.axis(i) : std::max(row.axis_max, s.axis(i));
}

void add_figures(PassRow& row, const cycle::PassFigures& f) {
  const auto less = [](double a, double b) { return std::isnan(a) ? b : std::min(a, b); };
  const auto more = [](double a, double b) { return std::isnan(a) ? b : std::max(a, b); };
  row.scallop_min = less(row.scallop_min, f.scallop_min);
  row.scallop_max = more(row.scallop_max, f.scallop_max);
  row.side_step = more(row.side_step, f.side_step_max);
  row.last_pass = row.last_pass || f.last;
  row.side_step_binds = row.side_step_binds || f.side_step_binds;
}

using PassKey = std::tuple<int, int, int>;  // group, surface, pass

/// A row for every path in the order they are cut; rows of neighbours together when there are too many.
std::map<PassKey, int> make_rows(const CyclePicture& picture, const Samples& s, std::size_t most,
                                 Track& track) {
  std::map<PassKey, int> order;
  for (std::size_t i = 0; i < s.size(); ++i) {
    const TrackLabel& l = s.label(i);
    if (l.kind == TrackKind::cut && (i == 0 || s.label_index(i) != s.label_index(i - 1)))
      order.try_emplace({l.group, l.surface, l.pass}, static_cast<int>(order.size()));
  }
  const std::size_t together = order.size() / std::max<std::size_t>(1, most) + 1;
  for (auto& [key, row] : order) row /= static_cast<int>(together);
  track.rows.resize(order.empty() ? 0 : (order.size() - 1) / together + 1);
  int row = -1;
  std::uint32_t label = ~0u;
  for (std::size_t i = 0; i < s.size(); ++i) {
    if (s.label(i).kind != TrackKind::cut) continue;
    if (s.label_index(i) != label) {
      label = s.label_index(i);
      const TrackLabel& l = s.label(i);
      row = order.at({l.group, l.surface, l.pass});
      PassRow& r = track.rows[static_cast<std::size_t>(row)];
      if (r.pass < 0) {
        r.group = l.group;
        r.surface = l.surface;
        r.pass = r.pass_last = l.pass;
        r.first = static_cast<std::uint32_t>(i);
      }
      if (l.group == r.group && l.surface == r.surface) r.pass_last = std::max(r.pass_last, l.pass);
      r.lift = std::max(r.lift, l.lift_max);
    }
    add_sample(track.rows[static_cast<std::size_t>(row)], s, i, track.timed);
  }
  for (std::size_t g = 0; g < picture.groups.size(); ++g) {
    if (!picture.groups[g].plan) continue;
    for (const cycle::PassFigures& f : picture.groups[g].plan->figures) {
      const auto found = order.find({static_cast<int>(g), f.surface, f.pass});
      if (found != order.end()) add_figures(track.rows[static_cast<std::size_t>(found->second)], f);
    }
  }
  for (PassRow& r : track.rows) {
    if (r.seconds > 0) r.feed_mean = r.length / r.seconds * 60;
  }
  return order;
}

}  // namespace

Track make_track(const CyclePicture& picture, const TrackLimits& limits) {
  Track track;
  track.timed = picture.setpoints && !picture.setpoints->empty();
  const Samples s(picture, track.timed);
  track.step = s.step();
  track.samples = s.size();
  const Extent e = extent_of(s);
  track.feed_max = e.feed;
  track.tangential_max = e.tangential;
  track.axis_max = e.axis;
  const std::map<PassKey, int> rows = make_rows(picture, s, limits.most_rows, track);
  Contact contact(picture);
  std::uint32_t before = ~0u;
  for (const std::uint32_t i : choose(s, e, limits.most_points, track)) {
    const TrackSample p = s.at(i);
    const TrackLabel& label = s.label(i);
    if (s.label_index(i) != before) {
      const auto row = rows.find({label.group, label.surface, label.pass});
      track.runs.push_back(
          {track.points.size(), label, label.kind == TrackKind::cut && row != rows.end() ? row->second : -1});
      before = s.label_index(i);
    }
    TrackPoint point{static_cast<std::uint32_t>(s.position(i)), p.p, p.feed, s.tangential(i), s.axis(i)};
    contact.add_to(point, label, p);
    track.lift_max = std::max(track.lift_max, point.lift);
    track.points.push_back(point);
  }
  // The page finds rows by the numbers that its points carry.
  for (PassRow& r : track.rows) {
    r.first = static_cast<std::uint32_t>(s.position(r.first));
    r.last = static_cast<std::uint32_t>(s.position(r.last));
  }
  return track;
}

}  // namespace burin::view

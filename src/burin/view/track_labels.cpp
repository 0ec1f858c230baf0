// SPDX-License-Identifier: Apache-2.0
#include "burin/view/track_labels.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace burin::view {
namespace {

/// Motions of a plan follow each other within this.
constexpr double kSamePlace_mm = 1e-6;
/// Rounding of sums of lengths, mm.
constexpr double kSumRounding_mm = 1e-6;

using cycle::MotionKind;
using servo::Setpoint;

/// A motion of a plan, in the order of the program.
struct Item {
  std::uint32_t label = 0;
  int group = -1;
  bool cut = false;
  double length = 0;
};

TrackKind kind_of(MotionKind kind) {
  switch (kind) {
    case MotionKind::rapid:
      return TrackKind::rapid;
    case MotionKind::plunge:
      return TrackKind::plunge;
    case MotionKind::cut:
      return TrackKind::cut;
    case MotionKind::link:
      break;
  }
  return TrackKind::link;
}

/// Length of the chords between the nodes: enough to share a gap out.
double rough_length(const geom::QuinticPath& path) {
  double sum = 0;
  for (std::size_t i = 1; i < path.nodes.size(); ++i) {
    sum += distance(path.nodes[i - 1].p, path.nodes[i].p);
  }
  return sum;
}

class Labeller {
 public:
  explicit Labeller(const CyclePicture& picture) : setpoints_(*picture.setpoints) {
    out_.labels.push_back({});                                 // 0: moves of the program
    out_.labels.push_back({TrackKind::curve, -1, -1, -1, 0});  // 1
    collect(picture);
  }

  TrackLabels run() {
    out_.of_sample.assign(setpoints_.size(), 0);
    std::size_t at = 0;
    std::size_t gap = 0;        // where the run without a pass began
    std::size_t before = none;  // the cut item before it
    while (at < setpoints_.size()) {
      if (setpoints_[at].pass < 0) {
        ++at;
        continue;
      }
      std::size_t end = at + 1;
      while (end < setpoints_.size() && same_pass(setpoints_[at], setpoints_[end])) ++end;
      const std::size_t item = next_item(setpoints_[at], before);
      share_out(gap, at, before, item);
      std::fill(out_.of_sample.begin() + static_cast<std::ptrdiff_t>(at),
                out_.of_sample.begin() + static_cast<std::ptrdiff_t>(end),
                item == none ? foreign(setpoints_[at]) : items_[item].label);
      if (item != none) before = last_of_pass(item);
      gap = at = end;
    }
    share_out(gap, at, before, none);
    return std::move(out_);
  }

 private:
  static constexpr std::size_t none = static_cast<std::size_t>(-1);
  using Key = std::tuple<int, int>;  // surface, pass

  static bool same_pass(const Setpoint& a, const Setpoint& b) {
    return a.surface == b.surface && a.pass == b.pass;
  }

  void collect(const CyclePicture& picture) {
    std::vector<int> offsets = first_surfaces(picture);
    for (std::size_t g = 0; g < picture.groups.size(); ++g) {
      const CycleGroup& group = picture.groups[g];
      if (!group.plan) continue;
      for (const cycle::Motion& m : group.plan->motions) {
        const TrackLabel label{kind_of(m.kind), static_cast<int>(g), m.surface, m.pass, m.lift_max};
        if (out_.labels.back() != label) out_.labels.push_back(label);
        const bool cut = m.kind == MotionKind::cut && m.pass >= 0;
        if (cut) {
          in_group_[{m.surface, m.pass}].push_back(items_.size());
          in_program_[{m.surface + offsets[g], m.pass}].push_back(items_.size());
        }
        items_.push_back({static_cast<std::uint32_t>(out_.labels.size() - 1), static_cast<int>(g), cut,
                          rough_length(m.path)});
      }
    }
  }

  /// Number of the first surface of every group: repeats have those of the group they repeat.
  static std::vector<int> first_surfaces(const CyclePicture& picture) {
    std::vector<int> first;
    int next = 0;
    for (std::size_t g = 0; g < picture.groups.size(); ++g) {
      const geom::Composite* composite = picture.groups[g].composite;
      std::size_t same = 0;
      while (same < g && !(composite && picture.groups[same].composite == composite)) ++same;
      first.push_back(same < g ? first[same] : next);
      if (same == g && composite) next += static_cast<int>(composite->surfaces.size());
    }
    return first;
  }

  /// The first cut of that surface and pass after `before`.
  std::size_t next_item(const Setpoint& s, std::size_t before) const {
    const std::size_t from = before == none ? 0 : before + 1;
    for (const auto* index : {&in_program_, &in_group_}) {
      const auto found = index->find(Key{s.surface, s.pass});
      if (found == index->end()) continue;
      const auto item = std::lower_bound(found->second.begin(), found->second.end(), from);
      if (item != found->second.end()) return *item;
    }
    return none;
  }

  /// Cuts that follow without a gap are one run of setpoints.
  std::size_t last_of_pass(std::size_t item) const {
    while (item + 1 < items_.size() && items_[item + 1].cut && items_[item + 1].label == items_[item].label) {
      ++item;
    }
    return item;
  }

  /// A pass that no plan knows: shown as a cut without group.
  std::uint32_t foreign(const Setpoint& s) {
    const TrackLabel label{TrackKind::cut, -1, s.surface, s.pass, 0};
    if (out_.labels.back() != label) out_.labels.push_back(label);
    return static_cast<std::uint32_t>(out_.labels.size() - 1);
  }

  double step_length(std::size_t i) const {
    if (i == 0) return 0;
    const Setpoint &a = setpoints_[i - 1], &b = setpoints_[i];
    const double l = std::hypot(b.x - a.x, b.y - a.y, b.z - a.z);
    return std::isfinite(l) ? l : 0;
  }

  /// Setpoints [from, to) lie between two cuts: the motions after the first come first, those before the
  /// second last, what is between belongs to the program.
  void share_out(std::size_t from, std::size_t to, std::size_t before, std::size_t after) {
    if (from >= to) return;
    std::vector<std::size_t> head, tail;
    if (before != none) {
      for (std::size_t i = before + 1; i < items_.size() && i != after; ++i) {
        if (items_[i].group != items_[before].group || items_[i].cut) break;
        head.push_back(i);
      }
    }
    const bool one_group = before != none && after != none && items_[before].group == items_[after].group;
    if (after != none && !one_group) {
      for (std::size_t i = after; i-- > 0 && items_[i].group == items_[after].group && !items_[i].cut;) {
        tail.push_back(i);
      }
      std::reverse(tail.begin(), tail.end());
    }
    double total = 0;
    for (std::size_t i = from; i <= to && i < setpoints_.size(); ++i) total += step_length(i);
    assign(from, to, head, tail, total);
  }

  void assign(std::size_t from, std::size_t to, const std::vector<std::size_t>& head,
              const std::vector<std::size_t>& tail, double total) {
    double tail_length = 0;
    for (const std::size_t i : tail) tail_length += items_[i].length;
    double way = 0;
    std::size_t h = 0, t = 0;
    double head_end = head.empty() ? 0 : items_[head[0]].length;
    double tail_end = total - tail_length + (tail.empty() ? 0 : items_[tail[0]].length);
    for (std::size_t i = from; i < to; ++i) {
      way += step_length(i);
      const double here = way - kSumRounding_mm;
      while (h < head.size() && here > head_end) {
        if (++h < head.size()) head_end += items_[head[h]].length;
      }
      if (h < head.size()) {
        out_.of_sample[i] = items_[head[h]].label;
      } else if (!tail.empty() && here > total - tail_length) {
        while (t + 1 < tail.size() && here > tail_end) tail_end += items_[tail[++t]].length;
        out_.of_sample[i] = items_[tail[t]].label;
      } else {
        out_.of_sample[i] = setpoints_[i].surface < 0 && std::isfinite(setpoints_[i].u) ? 1u : 0u;
      }
    }
  }

  const std::vector<Setpoint>& setpoints_;
  std::vector<Item> items_;
  std::map<Key, std::vector<std::size_t>> in_group_, in_program_;
  TrackLabels out_;
};

}  // namespace

TrackLabels label_setpoints(const CyclePicture& picture) {
  return Labeller(picture).run();
}

MotionSamples sample_motions(const CyclePicture& picture, std::size_t most) {
  std::size_t pieces = 0;
  for (const CycleGroup& g : picture.groups) {
    if (!g.plan) continue;
    for (const cycle::Motion& m : g.plan->motions)
      pieces += m.path.nodes.empty() ? 0 : m.path.nodes.size() - 1;
  }
  constexpr std::size_t kPerPiece = 8;
  const std::size_t per_piece =
      std::clamp<std::size_t>(most / std::max<std::size_t>(1, pieces), 1, kPerPiece);
  MotionSamples out;
  double way = 0;
  const auto add = [&](geom::Point3 p, geom::Point3 uv, bool has_uv) {
    if (!out.samples.empty()) way += distance(out.samples.back().p, p);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    out.samples.push_back({p, 0, has_uv ? uv.x : nan, has_uv ? uv.y : nan});
    out.labels.of_sample.push_back(static_cast<std::uint32_t>(out.labels.labels.size() - 1));
    out.length.push_back(way);
  };
  for (std::size_t g = 0; g < picture.groups.size(); ++g) {
    const CycleGroup& group = picture.groups[g];
    if (!group.plan) continue;
    for (const cycle::Motion& m : group.plan->motions) {
      if (m.path.empty()) continue;
      const TrackLabel label{kind_of(m.kind), static_cast<int>(g), m.surface, m.pass, m.lift_max};
      const geom::Point3 start = m.path.start();
      if (out.samples.empty() || distance(out.samples.back().p, start) > kSamePlace_mm) {
        out.labels.labels.push_back({});  // a way of the program from the group before
        add(start, {}, false);
      }
      if (out.labels.labels.back() != label) out.labels.labels.push_back(label);
      const bool has_uv = m.uv.nodes.size() == m.path.nodes.size();
      for (std::size_t i = 0; i + 1 < m.path.nodes.size(); ++i) {
        const bool line = m.path.nodes.size() == 2 && m.kind != MotionKind::cut && m.kind != MotionKind::link;
        const std::size_t steps = line ? 1 : per_piece;
        for (std::size_t k = 1; k <= steps; ++k) {
          const double x = static_cast<double>(k) / static_cast<double>(steps);
          add(geom::evaluate_piece(m.path, i, x).p,
              has_uv ? geom::evaluate_piece(m.uv, i, x).p : geom::Point3{}, has_uv);
        }
      }
    }
  }
  return out;
}

}  // namespace burin::view

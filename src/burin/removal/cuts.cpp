// SPDX-License-Identifier: Apache-2.0
#include "burin/removal/cuts.h"

#include <string>

namespace burin::removal {
namespace {

using geom::component;
using geom::Point3;
using geom::Vec3;
using verify::Body;

// An axis so near to +Z (sine) stands upright: over 100 mm it leans by 1e-5 mm.
constexpr double kUpright = 1e-7;

/// Of a cylinder from height `low` to `high` that stands at `at`.
geom::Box3 box_of(const verify::MillBody& body, const verify::Placed& at) {
  geom::Box3 box;
  const auto aside = [&](std::size_t i) {
    const double a = component(at.axis, i);
    return body.radius * std::sqrt(std::max(0.0, 1 - a * a));
  };
  const Vec3 grow{aside(0), aside(1), aside(2)};
  for (const double h : {body.low, body.high}) {
    box.add(at.tip + h * at.axis - grow);
    box.add(at.tip + h * at.axis + grow);
  }
  return box;
}

/// From the middle of the tip's way to the farthest corner of the box, and half of the way.
double reach(const Cut& cut) {
  double far2 = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double tip = component(cut.motion.tip, i);
    const double d = std::max(std::abs(static_cast<double>(cut.box.lo[i]) - tip),
                              std::abs(static_cast<double>(cut.box.hi[i]) - tip));
    far2 += d * d;
  }
  return std::sqrt(far2) + 0.5 * norm(cut.motion.way);
}

}  // namespace

bool is_upright(const verify::CheckedPath& path) {
  const auto upright = [](const cl::Pose& p) {
    return p.axis.z > 0 && std::hypot(p.axis.x, p.axis.y) <= kUpright;
  };
  for (const verify::ToolPath& tool : path.tools) {
    if (tool.pieces.empty()) continue;
    if (!upright(tool.from)) return false;
    for (const verify::PathPiece& piece : tool.pieces)
      if (!upright(piece.to)) return false;
  }
  return true;
}

CutSource::CutSource(const verify::CheckedPath& path, const Grid& grid, double tolerance)
    : path_(&path), grid_(grid), tolerance_(tolerance), total_(path.piece_count()) {
  start_tool();
}

double CutSource::done() const {
  return total_ == 0 ? 1 : static_cast<double>(gone_) / static_cast<double>(total_);
}

void CutSource::start_tool() {
  pieces_.clear();
  span_ = 0;
  piece_ = 0;
  if (tool_ == path_->tools.size()) return;
  const verify::CheckedMill& tool = path_->tools[tool_].tool;
  pieces_.push_back({{tool.radius, 0, tool.length, tool.corner_radius}, Body::cutter});
  for (const verify::ToolCylinder& c : tool.cylinders)
    pieces_.push_back({{c.radius, c.from, c.to, 0}, c.holder ? Body::holder : Body::shank});
  for (const Piece& p : pieces_)
    span_ = std::max(span_, std::hypot(p.body.radius, std::max(std::abs(p.body.low), std::abs(p.body.high))));
}

std::vector<Cut> CutSource::next(std::size_t most) {
  std::vector<Cut> out;
  for (; tool_ < path_->tools.size() && out.size() < most;) {
    const verify::ToolPath& tool = path_->tools[tool_];
    if (piece_ == tool.pieces.size()) {
      ++tool_;
      start_tool();
      continue;
    }
    const verify::PathPiece& piece = tool.pieces[piece_];
    const cl::Pose& from = piece_ == 0 ? tool.from : tool.pieces[piece_ - 1].to;
    verify::Stretch stretch = verify::Stretch::between(from, piece.to);
    stretch.middle.tip = Point3{} + (stretch.middle.tip - grid_.origin);
    const int parts = Motion::parts(stretch, span_, 0.5 * tolerance_);
    for (int k = 0; k < parts; ++k)
      add(out, Motion::part(stretch, static_cast<double>(k) / parts, static_cast<double>(k + 1) / parts),
          piece);
    ++piece_, ++gone_;
  }
  return out;
}

/// A place of the stock meets the pieces of the tool in the order of their heights when the tool goes down
/// its axis, the other way round when it draws back: what is listed first has it.
void CutSource::add(std::vector<Cut>& out, const Motion& motion, const verify::PathPiece& piece) const {
  const bool down = dot(motion.way, motion.axis) <= 0;
  for (std::size_t n = 0; n < pieces_.size(); ++n) {
    const Piece& p = pieces_[down ? n : pieces_.size() - 1 - n];
    geom::Box3 box;
    for (const double t : {-0.5, 0.5}) {
      const Vec3 axis = unit(motion.axis + t * cross(motion.turn, motion.axis));
      box.add(box_of(p.body, {motion.tip + t * motion.way, axis}));
    }
    // What a turning axis leaves between its ends, and rounding to single precision.
    box = box.grown((motion.turns ? tolerance_ : 0) +
                    1e-6 * std::max({grid_.length(0), grid_.length(1), grid_.length(2)}));
    Cut cut{motion, {}, p.body, p.kind, piece.rapid || p.kind != Body::cutter, piece.move, 0};
    bool reaches = true;
    for (std::size_t i = 0; i < 3; ++i) {
      const double lo = std::max(component(box.lo, i), 0.0),
                   hi = std::min(component(box.hi, i), grid_.length(i));
      reaches = reaches && lo < hi;
      cut.box.lo[i] = static_cast<float>(lo), cut.box.hi[i] = static_cast<float>(hi);
    }
    if (!reaches) continue;
    cut.reach = std::min(reach(cut),
                         std::hypot(p.body.radius, std::max(std::abs(p.body.low), std::abs(p.body.high))));
    out.push_back(cut);
  }
}

CutTree::CutTree(const std::vector<Cut>& cuts) {
  if (cuts.empty()) return;
  levels_.emplace_back();
  for (const Cut& cut : cuts) levels_.back().push_back(cut.box);
  while (levels_.back().size() > 1) {
    const std::vector<CutBox>& below = levels_.back();
    std::vector<CutBox> level;
    for (std::size_t i = 0; i < below.size(); ++i) {
      if (i % kFan == 0) {
        level.push_back(below[i]);
      } else {
        level.back().add(below[i]);
      }
    }
    levels_.push_back(std::move(level));
  }
}

}  // namespace burin::removal

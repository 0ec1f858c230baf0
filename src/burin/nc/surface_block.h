// SPDX-License-Identifier: Apache-2.0
// G06.23: the words of its block, then the points, knots and trim comments that follow, one block at a time.
#pragma once

#include "burin/nc/modal.h"
#include "burin/nc/place.h"
#include "burin/nc/surface_program.h"
#include "burin/nc/trim_comment.h"

namespace burin::nc {

/// What stands in the blocks of a surface, or of an earlier one, or nowhere.
struct SurfaceWords {
  std::optional<double> diameter, stock, scallop;
};

class SurfaceReader {
 public:
  /// Takes its words out of `machine`, where `block` is open; `modal` holds the words of the surface before
  /// and is brought up to date. Lengths wait for use() since the unit may change in this very block.
  static Result<SurfaceReader> begin(const Source& source, const Block& block, ModalMachine& machine);
  /// After machine.carry_out(): the numbers in mm. `remaining`: characters of text that follow.
  Result<void> use(const ModalMachine& machine, SurfaceWords& modal, std::size_t remaining);

  /// True: the block was points, a knot or a trim comment of this surface. False: it belongs to what follows,
  /// and the surface is complete. An error when it does not belong here and the surface is not complete.
  Result<bool> take(const Block& block, std::size_t remaining);
  /// The end of the text, in the line `last`.
  Result<void> end(int last) const;
  /// Complete: the surface with everything checked. `feed` and the other numbers are not checked here.
  Result<SurfaceBlock> finish();

  Place place() const { return place_; }

 private:
  enum class Phase { points, knots_possible, knots, trims };
  Result<void> take_point(const Block& block);
  Result<void> take_knot(const Block& block);
  Result<void> all_knots();
  Error unfinished(Place place, const std::string& what) const;
  std::size_t knots_needed() const { return knots_u_ + knots_v_; }

  Source source_;
  Place place_;  // of the G word
  const Block* block_ = nullptr;
  const Word *u_ = nullptr, *v_ = nullptr, *p_ = nullptr, *q_ = nullptr;
  const Word *d_ = nullptr, *l_ = nullptr, *s_ = nullptr, *f_ = nullptr;
  SurfaceBlock result_;
  Phase phase_ = Phase::points;
  double scale_ = 1;
  std::size_t points_needed_ = 0, knots_u_ = 0, knots_v_ = 0;
  std::array<double, 4> last_{0, 0, 0, 1};  // X Y Z W
  std::array<bool, 3> known_{};
  std::vector<double> knots_;
  std::vector<Place> knot_places_;
  TrimReader trims_;
};

}  // namespace burin::nc

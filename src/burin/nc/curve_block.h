// SPDX-License-Identifier: Apache-2.0
// G06.2 as on Fanuc controls: P order, one K and one control point X Y Z with weight R in each block, the
// first beside the code, then as many blocks with K alone as the order. LinuxCNC's form of the same (the code
// repeated before the last knots, a Q or L word for its feed rule) is read too.
#pragma once

#include "burin/geom/surface/nurbs.h"
#include "burin/nc/modal.h"
#include "burin/nc/place.h"

namespace burin::nc {

class CurveReader {
 public:
  /// Takes its words out of `machine`, where `block` is open.
  static Result<CurveReader> begin(const Source& source, const Block& block, ModalMachine& machine);
  /// After machine.carry_out(): the first control point, that of the block or where the tool stands.
  Result<void> use(ModalMachine& machine);
  /// One block more. Errors when it does not belong to the curve.
  Result<void> take(const Block& block);
  /// All knots are there.
  bool complete() const { return trailing_ > 0 && trailing_ == order_; }
  Result<void> end(int last) const;
  Result<geom::NurbsCurve> finish();

  Place place() const { return place_; }

 private:
  Result<void> add(const Block& block, const std::array<const Word*, 5>& words);
  Result<void> add_knot(const Block& block, const Word& word);
  Error unfinished(Place place, const std::string& what) const;

  Source source_;
  Place place_;
  const Block* block_ = nullptr;
  std::array<const Word*, 5> first_{};  // X Y Z K R
  const Word *p_ = nullptr, *rule_ = nullptr;
  int order_ = 4, trailing_ = 0;
  double scale_ = 1;
  bool first_knot_missing_ = false;
  geom::Point3 last_;
  std::vector<geom::HPoint> points_;
  std::vector<double> knots_;
  std::vector<Place> places_;
};

}  // namespace burin::nc

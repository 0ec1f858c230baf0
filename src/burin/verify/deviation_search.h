// SPDX-License-Identifier: Apache-2.0
// The worst gouge and excess of the places between the samples of a tile, with proof. Internal to verify. mm.
// docs/verify-deviation.md
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "burin/verify/inscribed.h"
#include "burin/verify/sample_tile.h"
#include "burin/verify/surface_cell.h"

namespace burin::verify {

struct SearchLimits {
  double gap = 0;         ///< may be left to find
  double motion = 0;      ///< the tools may be so far from where the stretches have them
  std::size_t steps = 0;  ///< of gouge and excess each; what is not proven by then widens `..._most`
};
struct TileWorst {
  WorstDeviation gouge, excess;
  double gouge_most = 0, excess_most = 0;        ///< no place of the tile has more
  bool gouge_open = false, excess_open = false;  ///< the steps did not do
};

class TileSearch {
 public:
  TileSearch(const geom::Mesh& mesh, const SampledSurface& surface, const Swept& swept,
             const Inscribed& inscribed, const DeviationOptions& options)
      : mesh_(mesh), surface_(surface), swept_(swept), inscribed_(inscribed), options_(options) {}

  /// `known`: the worst found so far anywhere. `moments`: of all samples, when their lines are entered.
  TileWorst gouge(const std::uint32_t* index, std::size_t count, const TileWorst& known,
                  const SearchLimits& limits);
  TileWorst excess(const std::uint32_t* index, std::size_t count, const std::vector<Moment>& moments,
                   const TileWorst& known, const SearchLimits& limits);

 private:
  // gouge
  double depth() const { return std::max(worst_.gouge.mm + limits_.gap + limits_.motion, worst_.gouge_most); }
  double margin(const Patch& patch, double height) const {
    return limits_.motion + std::abs(height) * patch.bulge();
  }
  void gouge(const std::uint32_t* index, std::size_t count, const std::vector<SweptTool::Part>& all);
  struct Sunk;
  void gouge(const Sunk& sunk, const Candidate& c, const Span& span, int halvings);
  void give_up(const Patch& patch, const Candidate& c, const Span& span);
  void take(geom::Point3 p, geom::Vec3 n, const Candidate& c);
  // excess
  double height() const { return std::max(worst_.excess.mm + limits_.gap, worst_.excess_most); }
  struct Deep;
  struct Cover;
  static double bent(const SweptTool& tool, std::array<Deep, 3> deep);
  Deep deepest(geom::Point3 p, const Moment& near, double enough) const;
  Cover cover(const Patch& patch, const Moment& at, double height) const;
  Cover best_cover(const Patch& patch, double height);
  std::optional<double> look(geom::Point3 p, geom::Vec3 n);
  bool raise_over(const Patch& patch);
  void excess(const Patch& patch, int halvings);
  std::array<Patch, 2> cut(const Patch& patch, const Cover& cover) const;
  void remember(const Moment& at);

  const geom::Mesh& mesh_;
  const SampledSurface& surface_;
  const Swept& swept_;
  const Inscribed& inscribed_;
  const DeviationOptions& options_;
  SearchLimits limits_;
  TileWorst worst_;
  std::size_t steps_ = 0;
  bool beside_unmachined_ = false;
  std::array<bool, 3> reached_{};  // corners of a patch, by any of the moments
  std::vector<Moment> recent_;     // the last one last
};

}  // namespace burin::verify

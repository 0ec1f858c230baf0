// SPDX-License-Identifier: Apache-2.0
// CC paths: iso-parametric or plane cuts of the design's faces, or contacts from a file. mm.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <string_view>
#include <vector>

#include "burin/base/result.h"
#include "burin/plan/orient/part.h"
#include "burin/plan/orient/strip.h"

namespace burin::orient {

enum class Pattern { iso_u, iso_v, plane };

struct CcPath {
  int number = 0;  ///< from 0, over the whole job: --path
  int face = -1;   ///< index into Part::faces; -1: from a file
  double at = 0;   ///< where it lies in its family, 0 to 1
  std::vector<CcPoint> points;
};

struct PathOptions {
  Pattern pattern = Pattern::iso_u;
  geom::Vec3 plane_normal{1, 0, 0};  ///< of pattern plane: cuts normal to this
  /// The polyline of contact points leaves the curve by at most this, and the normal turns by at most
  /// max_turn between two.
  double chord_mm = 0.01;
  double max_turn = 5 * geom::kPi / 180;
  double max_step_mm = 0;  ///< 0: a 64th of the face's size
  double edge_mm = 0;      ///< paths and their ends keep this from the face's border
};

/// All paths of one face and pattern: a family over w in [0, 1]. iso-u: v runs with w (u runs along the
/// path).
class PathFamily {
 public:
  /// Error (geometry): no such plane cut, a face without area.
  static Result<PathFamily> make(const Part& part, int face, const PathOptions& options);
  ~PathFamily();
  PathFamily(PathFamily&&) noexcept;
  PathFamily& operator=(PathFamily&&) noexcept;

  /// The pieces of the path at w (trims and plane cuts may give several), each in the same sense; none where
  /// the family has nothing. Each piece has at least two points, normals on the tool's side, curvatures.
  std::vector<std::vector<CcPoint>> at(double w) const;
  /// How far the neighbour at w_to lies from a contact of the path at w, measured along t on the surface;
  /// infinite where there is none abreast.
  double distance(const CcPoint& from, double w, double w_to) const;
  /// The same for the contacts of one path in their order, with the place met. (What lay_paths measures by.)
  struct Abreast {
    bool found = false;
    geom::Point3 place;   ///< on the path at w_to
    double distance = 0;  ///< along t, on the surface
    bool left = false;    ///< towards +t
    /// Not found because the trims' border lies between: its distance; else infinite.
    double border = std::numeric_limits<double>::infinity();
  };
  std::vector<Abreast> abreast(const std::vector<CcPoint>& from, double w, double w_to) const;
  /// A length of the whole: the largest distance to the neighbour at each w, added up. Equal steps of w are
  /// equal shares of it, so extent() / count is the largest distance between `count` + 1 even places.
  double extent() const;

 private:
  PathFamily();
  struct State;
  std::unique_ptr<State> state_;
};

/// path,x,y,z,nx,ny,nz,fx,fy,fz (a header line; path numbers ascending, equal ones one path). Normals and
/// feeds are made unit, feeds made tangent. Errors (syntax, geometry; with file and line): columns, numbers,
/// zero normals or feeds, feed along the normal, one point only is fine.
Result<std::vector<CcPath>> read_contacts(std::string_view csv, const std::string& file_name);

/// Where paths lie. `strips(w)`: for each contact point of the path at w its strip (all pieces after each
/// other, in the order of at(w)); called in rounds, `map` may run them in parallel.
struct Lane {
  double w = 0;
  std::vector<std::vector<CcPoint>> pieces;
  std::vector<std::vector<Strip>> strips;
};
using LanePlanner = std::function<std::vector<Lane>(const std::vector<double>& ws)>;

/// Of one face, wherever a number of paths is asked for or laid.
inline constexpr int kMostPaths = 100'000;

/// Places w such that between neighbours right strip and left strip together cover the distance everywhere
/// (no more than `scallop` is left), with as few paths as that allows within 2 %, first and last at the
/// borders. Rounds: coarse strips first, then what is missing or too much. Error (range): more than
/// max_paths.
Result<std::vector<double>> lay_paths(const PathFamily& family, const LanePlanner& plan_lanes,
                                      std::size_t max_paths);

}  // namespace burin::orient

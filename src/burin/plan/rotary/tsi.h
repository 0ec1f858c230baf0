// SPDX-License-Identifier: Apache-2.0
// Shared by the two ways to resolve tool-size interference.
#pragma once

#include <vector>

#include "burin/plan/rotary/center_path.h"

namespace burin::rotary::detail {

/// Procedure 2 of the paper.
TsiResult resolve_by_path(const ContactPath& path, const TsiOptions& options);

Place place_at(const Contact& contact, double radius);
/// The contact a part of the way from a to b: the point straight, the normal evenly turned, u round the seam.
Contact mixed(const Contact& a, const Contact& b, double f);
/// The path with contacts between, so that centres are at most `spacing` apart (the last to the first too
/// when closed). `original` says for each how many given contacts it is: 1 or 0.
std::vector<Contact> densified(const ContactPath& path, double radius, double spacing,
                               std::vector<std::uint8_t>& original);

/// Whether contacts i and i + 1, at one place, are the two sides of a hollow corner.
bool concave_at(const ContactPath& path, std::size_t i);

/// Pushes a ball to where it touches the part and gouges nothing: away from the nearest point while that is
/// nearer than R, towards it while it is farther; when that does not come to rest, radially away from the
/// axis.
class Roller {
 public:
  Roller(const geom::MeshIndex& part, double radius, double accuracy_mm);

  /// False when there is no such place. u and w of `place` stay.
  bool touch(geom::Point3 near, Place& place) const;
  /// Distance from the ball to the mesh, negative where the ball holds some of it; radius when there is more.
  /// `nearest` is the place of the mesh that is nearest, when there is one.
  double room(geom::Point3 center, geom::Point3& nearest) const;
  bool on_part(geom::Point3 p, double within) const;

 private:
  bool push_out(geom::Point3& c) const;
  bool radially(geom::Point3& c) const;
  void settle(geom::Point3& c, geom::Point3 wanted) const;
  bool pull_in(geom::Point3& c, geom::MeshIndex::Hit& hit) const;

  const geom::MeshIndex& part_;
  double radius_, accuracy_;
  double size_;
};

}  // namespace burin::rotary::detail

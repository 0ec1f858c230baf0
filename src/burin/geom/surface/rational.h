// SPDX-License-Identifier: Apache-2.0
// From derivatives of homogeneous points to those of the points (quotient rule; The NURBS Book, A4.2 and
// A4.4 written out). Internal to geom/surface.
#pragma once

#include "burin/geom/surface/evaluate.h"

namespace burin::geom::detail {

inline Vec3 numerator(const HPoint& h) {
  return {h.x, h.y, h.z};
}

struct HSurface {
  HPoint p, u, v, uu, uv, vv, uuu, uuv, uvv, vvv;
};

inline void rational2(const HSurface& a, SurfaceDerivatives& d) {
  const double r = 1 / a.p.w;
  d.p = {a.p.x * r, a.p.y * r, a.p.z * r};
  const Vec3 s{d.p.x, d.p.y, d.p.z};
  d.du = r * (numerator(a.u) - a.u.w * s);
  d.dv = r * (numerator(a.v) - a.v.w * s);
  d.duu = r * (numerator(a.uu) - (2 * a.u.w) * d.du - a.uu.w * s);
  d.duv = r * (numerator(a.uv) - a.u.w * d.dv - a.v.w * d.du - a.uv.w * s);
  d.dvv = r * (numerator(a.vv) - (2 * a.v.w) * d.dv - a.vv.w * s);
}

inline void rational3(const HSurface& a, SurfaceDerivatives3& d) {
  rational2(a, d);
  const double r = 1 / a.p.w;
  const Vec3 s{d.p.x, d.p.y, d.p.z};
  d.duuu = r * (numerator(a.uuu) - (3 * a.u.w) * d.duu - (3 * a.uu.w) * d.du - a.uuu.w * s);
  d.duuv = r * (numerator(a.uuv) - (2 * a.u.w) * d.duv - a.v.w * d.duu - a.uu.w * d.dv - (2 * a.uv.w) * d.du -
                a.uuv.w * s);
  d.duvv = r * (numerator(a.uvv) - (2 * a.v.w) * d.duv - a.u.w * d.dvv - a.vv.w * d.du - (2 * a.uv.w) * d.dv -
                a.uvv.w * s);
  d.dvvv = r * (numerator(a.vvv) - (3 * a.v.w) * d.dvv - (3 * a.vv.w) * d.dv - a.vvv.w * s);
}

}  // namespace burin::geom::detail

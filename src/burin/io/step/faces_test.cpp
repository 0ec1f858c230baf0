// SPDX-License-Identifier: Apache-2.0
// Faces of known shape, written by OpenCASCADE as STEP and IGES, against closed forms.
#include <gtest/gtest.h>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepLib.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <Geom2d_Line.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_OffsetSurface.hxx>
#include <Geom_SphericalSurface.hxx>
#include <Geom_SurfaceOfLinearExtrusion.hxx>
#include <Geom_SurfaceOfRevolution.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColgp_Array1OfPnt.hxx>
#include <gp_Circ.hxx>
#include <gp_Cone.hxx>
#include <gp_Cylinder.hxx>
#include <gp_Pln.hxx>
#include <gp_Sphere.hxx>
#include <gp_Torus.hxx>
#include <gp_Vec2d.hxx>

#include <functional>

#include "burin/io/step/convert.h"
#include "burin/io/step/read_step.h"
#include "burin/io/step/step_test_util.h"

namespace burin::io {
namespace {

using geom::Point2;
using geom::Point3;
using geom::Vec3;
using step::test::evaluate;

CadModel read(const std::string& text, Diagnostics& diagnostics) {
  auto model = read_cad(text, {}, diagnostics);
  EXPECT_TRUE(model) << model.error().to_string();
  return model ? *model : CadModel{};
}

/// Points over the whole surface.
void for_points(const CadFace& f, const std::function<void(Point3)>& check) {
  constexpr int kGrid = 15;
  const geom::Interval u = f.surface.domain(geom::Direction::u), v = f.surface.domain(geom::Direction::v);
  for (int j = 0; j <= kGrid; ++j) {
    for (int i = 0; i <= kGrid; ++i) {
      const double a = i == kGrid ? u.hi : u.lo + u.length() * i / kGrid;
      const double b = j == kGrid ? v.hi : v.lo + v.length() * j / kGrid;
      check(evaluate(f.surface, a, b));
    }
  }
}

/// The one face of each kind, as a sheet over a rectangle of its parameters.
struct Sheet {
  const char* kind;
  TopoDS_Face face;
  std::function<double(Point3)> off;  ///< distance from the ideal surface, about
  double area;
};

const gp_Ax3 kFrame(gp_Pnt(10, -5, 3), gp_Dir(0.3, 0.4, 0.8), gp_Dir(1, 0.2, -0.1));

/// Radius and height over kFrame.
std::pair<double, double> polar(Point3 p) {
  const gp_Vec d(kFrame.Location(), gp_Pnt(p.x, p.y, p.z));
  const double h = d.Dot(gp_Vec(kFrame.Direction()));
  return {std::sqrt(std::max(0.0, d.SquareMagnitude() - h * h)), h};
}

std::vector<Sheet> sheets() {
  const double pi = geom::kPi;
  std::vector<Sheet> list;
  list.push_back({"plane", BRepBuilderAPI_MakeFace(gp_Pln(kFrame), -2, 5, 1, 4).Face(),
                  [](Point3 p) { return polar(p).second; }, 21});
  list.push_back({"cylinder", BRepBuilderAPI_MakeFace(gp_Cylinder(kFrame, 8), 0.5, 4.5, -3, 6).Face(),
                  [](Point3 p) { return polar(p).first - 8; }, 8 * 4 * 9});
  list.push_back({"cone", BRepBuilderAPI_MakeFace(gp_Cone(kFrame, 0.4, 6), 1, 6.5, 2, 9).Face(),
                  [](Point3 p) {
                    const auto [r, h] = polar(p);
                    return (r - 6) * std::cos(0.4) - h * std::sin(0.4);
                  },
                  5.5 * (6 * 7 + 0.5 * std::sin(0.4) * (81 - 4))});
  list.push_back({"sphere", BRepBuilderAPI_MakeFace(gp_Sphere(kFrame, 12), 0, 2 * pi, -0.5, 0.5 * pi).Face(),
                  [](Point3 p) { return std::hypot(polar(p).first, polar(p).second) - 12; },
                  2 * pi * 144 * (1 + std::sin(0.5))});
  list.push_back({"torus", BRepBuilderAPI_MakeFace(gp_Torus(kFrame, 20, 5), 0.2, 3.5, -1, 2.5).Face(),
                  [](Point3 p) { return std::hypot(polar(p).first - 20, polar(p).second) - 5; },
                  3.3 * 5 * (20 * 3.5 + 5 * (std::sin(2.5) + std::sin(1.0)))});
  return list;
}

double mesh_area(const CadMesh& m) {
  double twice = 0;
  for (const auto& t : m.mesh.triangles) {
    const Point3 a = m.mesh.vertices[t[0]];
    twice += norm(cross(m.mesh.vertices[t[1]] - a, m.mesh.vertices[t[2]] - a));
  }
  return 0.5 * twice;
}

TEST(Faces, AnalyticOnesAreExactThroughStepAndIges) {
  for (const Sheet& sheet : sheets()) {
    for (const bool iges : {false, true}) {
      SCOPED_TRACE(std::string(sheet.kind) + (iges ? " IGES" : " STEP"));
      const std::string text =
          iges ? step::test::iges_text(sheet.face, false) : step::test::step_text(sheet.face);
      Diagnostics diagnostics;
      const CadModel model = read(text, diagnostics);
      ASSERT_EQ(model.faces.size(), 1u);
      const CadFace& face = model.faces[0];
      if (!iges) {
        EXPECT_EQ(face.kind, sheet.kind);
      }
      // Planes change their axes on the way through IGES.
      EXPECT_EQ(face.trimmed, iges && sheet.kind == std::string("plane"));
      EXPECT_TRUE(geom::validate(face.surface));
      double worst = 0;
      for_points(face, [&](Point3 p) { worst = std::max(worst, std::abs(sheet.off(p))); });
      EXPECT_LT(worst, iges ? 1e-6 : 1e-9);  // IGES is written with fewer digits
      auto mesh = mesh_cad(text, {}, 0.02, 0.15, diagnostics);
      ASSERT_TRUE(mesh);
      EXPECT_NEAR(mesh_area(*mesh), sheet.area, 5e-3 * sheet.area);
      EXPECT_TRUE(diagnostics.empty());
    }
  }
}

TEST(Faces, UnitsBecomeMillimetres) {
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(gp_Pnt(1, 2, 3), gp_Pnt(11, 22, 33)).Shape();
  for (const auto& [unit, word] : std::vector<std::pair<std::string, std::string>>{
           {"MM", "mm"}, {"INCH", "inch"}, {"M", "m"}, {"CM", "cm"}}) {
    for (const bool iges : {false, true}) {
      const std::string name = iges && unit == "INCH" ? "IN" : unit;
      const std::string text =
          iges ? step::test::iges_text(box, true, name) : step::test::step_text(box, unit);
      SCOPED_TRACE(unit + (iges ? " IGES" : " STEP"));
      Diagnostics diagnostics;
      const CadModel model = read(text, diagnostics);
      EXPECT_EQ(model.unit, word);
      EXPECT_EQ(model.faces.size(), 6u);
      EXPECT_NEAR(model.bounds.lo.y, 2, 1e-6);
      EXPECT_NEAR(model.bounds.hi.z, 33, 1e-6);
    }
  }
}

/// Points away from `inside` when the face is reversed as it says.
void expect_outward(const CadFace& f, Point3 inside) {
  const geom::Interval u = f.surface.domain(geom::Direction::u), v = f.surface.domain(geom::Direction::v);
  const double a = u.lo + 0.37 * u.length(), b = v.lo + 0.41 * v.length();
  const double h = 1e-5;
  const Point3 p = evaluate(f.surface, a, b);
  const Vec3 su = evaluate(f.surface, a + h * u.length(), b) - p,
             sv = evaluate(f.surface, a, b + h * v.length()) - p;
  const Vec3 n = cross(su, sv);
  EXPECT_GT(dot(f.reversed ? -n : n, p - inside), 0) << "face " << f.number;
}

TEST(Faces, SolidsSayWhereOutsideIs) {
  gp_Trsf placed;
  placed.SetTranslation(gp_Vec(100, 50, -20));
  const gp_Pnt center(0, 0, 0);
  const TopoDS_Shape parts[] = {BRepPrimAPI_MakeBox(gp_Pnt(-5, -5, -5), gp_Pnt(5, 5, 5)).Shape(),
                                BRepPrimAPI_MakeSphere(center, 7).Shape(),
                                BRepPrimAPI_MakeCylinder(4, 6).Shape()};
  for (const TopoDS_Shape& part : parts) {
    const TopoDS_Shape moved = part.Moved(TopLoc_Location(placed));
    for (const bool iges : {false, true}) {
      Diagnostics diagnostics;
      const CadModel model =
          read(iges ? step::test::iges_text(moved, true) : step::test::step_text(moved), diagnostics);
      for (const CadFace& face : model.faces) {
        EXPECT_TRUE(face.of_solid);
        expect_outward(face, {100, 50, -19});
      }
    }
  }
}

TEST(Faces, WholeSphereAndTorusAreNatural) {
  for (const TopoDS_Shape& part : {BRepPrimAPI_MakeSphere(9).Shape(), BRepPrimAPI_MakeTorus(20, 4).Shape()}) {
    Diagnostics diagnostics;
    const std::string text = step::test::step_text(part);
    const CadModel model = read(text, diagnostics);
    ASSERT_EQ(model.faces.size(), 1u);
    EXPECT_FALSE(model.faces[0].trimmed);
  }
}

TopoDS_Face plate_with_hole(double side, double radius) {
  const gp_Pln plane(gp_Pnt(0, 0, 7), gp_Dir(0, 0, 1));
  BRepBuilderAPI_MakeFace face(plane, 0, side, 0, side);
  const gp_Circ circle(gp_Ax2(gp_Pnt(0.4 * side, 0.5 * side, 7), gp_Dir(0, 0, -1)), radius);
  face.Add(BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(circle).Edge()).Wire());
  return face.Face();
}

double signed_area(const std::vector<Point2>& p) {
  double twice = 0;
  for (std::size_t i = 0; i < p.size(); ++i) twice += cross(p[i] - p[0], p[(i + 1) % p.size()] - p[0]);
  return 0.5 * twice;
}

TEST(Faces, HolesRunClockwiseWithinTheTolerance) {
  const std::string text = step::test::step_text(plate_with_hole(50, 12));
  for (const double tolerance : {0.5, 0.05, 0.005, 0.0005}) {
    ReadCadOptions options;
    options.trim_tolerance_mm = tolerance;
    Diagnostics diagnostics;
    const auto model = read_cad(text, options, diagnostics);
    ASSERT_TRUE(model);
    const CadFace& face = model->faces.at(0);
    ASSERT_TRUE(face.trimmed);
    ASSERT_EQ(face.loops.size(), 2u);
    EXPECT_NEAR(signed_area(face.loops[0].points), 2500, 1e-6);
    EXPECT_EQ(face.loops[0].points.size(), 4u);
    const std::vector<Point2>& hole = face.loops[1].points;
    EXPECT_LT(signed_area(hole), 0);
    double worst = 0;
    for (std::size_t i = 0; i < hole.size(); ++i) {
      const Point2 a = hole[i], b = hole[(i + 1) % hole.size()];
      for (const double t : {0.0, 0.25, 0.5}) {
        const Point2 q = lerp(a, b, t);
        const Point3 p = evaluate(face.surface, q.x, q.y);
        worst = std::max(worst, std::abs(std::hypot(p.x - 20, p.y - 25) - 12));
      }
    }
    EXPECT_LE(worst, tolerance * 1.0001);
    // Not many more points than the tolerance asks for: half angle acos(1 - tolerance / radius).
    EXPECT_LT(static_cast<double>(hole.size()), 1.4 * geom::kPi / std::acos(1 - tolerance / 12) + 4);
  }
}

TEST(Faces, TheBaseSurfaceDoesNotComeAlong) {
  // A small triangle on a huge sphere, its sides straight in the parameters.
  const Handle(Geom_Surface) sphere = new Geom_SphericalSurface(gp_Ax3(), 1000);
  const gp_Pnt2d corners[] = {gp_Pnt2d(0.3, 0.1), gp_Pnt2d(0.31, 0.1), gp_Pnt2d(0.3, 0.12)};
  BRepBuilderAPI_MakeWire wire;
  for (int i = 0; i < 3; ++i) {
    const gp_Pnt2d from = corners[i], to = corners[(i + 1) % 3];
    const Handle(Geom2d_Curve) side = new Geom2d_Line(from, gp_Dir2d(gp_Vec2d(from, to)));
    wire.Add(BRepBuilderAPI_MakeEdge(side, sphere, 0, from.Distance(to)).Edge());
  }
  ASSERT_TRUE(wire.IsDone());
  const TopoDS_Face face = BRepBuilderAPI_MakeFace(sphere, wire.Wire()).Face();
  BRepLib::BuildCurves3d(face);
  Diagnostics diagnostics;
  const CadModel model = read(step::test::step_text(face), diagnostics);
  ASSERT_EQ(model.faces.size(), 1u);
  EXPECT_TRUE(model.faces[0].trimmed);
  EXPECT_LT(model.bounds.diagonal(), 40);
  for_points(model.faces[0], [&](Point3 p) { EXPECT_NEAR(norm(p - Point3{}), 1000, 1e-9); });
  const std::vector<Point2>& loop = model.faces[0].loops.at(0).points;
  EXPECT_GT(signed_area(loop), 0);
  for (const gp_Pnt2d& uv : corners) {
    const gp_Pnt corner = sphere->Value(uv.X(), uv.Y());
    double nearest = 1e9;
    for (const Point2 q : loop) {
      const Point3 p = evaluate(model.faces[0].surface, q.x, q.y);
      nearest = std::min(nearest, distance(p, {corner.X(), corner.Y(), corner.Z()}));
    }
    EXPECT_LT(nearest, 1e-3);
  }
}

Handle(Geom_BSplineCurve) profile() {
  TColgp_Array1OfPnt poles(1, 5);
  poles(1) = gp_Pnt(5, 0, 0);
  poles(2) = gp_Pnt(8, 0, 3);
  poles(3) = gp_Pnt(4, 0, 6);
  poles(4) = gp_Pnt(9, 0, 9);
  poles(5) = gp_Pnt(6, 0, 14);
  TColStd_Array1OfReal knots(1, 3);
  knots(1) = 0;
  knots(2) = 0.4;
  knots(3) = 1;
  TColStd_Array1OfInteger multiplicities(1, 3);
  multiplicities(1) = multiplicities(3) = 4;
  multiplicities(2) = 1;
  return new Geom_BSplineCurve(poles, knots, multiplicities, 3);
}

TEST(Faces, SweptSurfacesAreExact) {
  const Handle(Geom_BSplineCurve) curve = profile();
  const Handle(Geom_Surface) turned = new Geom_SurfaceOfRevolution(curve, gp_Ax1());
  const Handle(Geom_Surface) pushed = new Geom_SurfaceOfLinearExtrusion(curve, gp_Dir(0, 1, 0.2));
  struct Case {
    const char* kind;
    Handle(Geom_Surface) surface;
    TopoDS_Face face;
  };
  const Case cases[] = {{"revolution", turned, BRepBuilderAPI_MakeFace(turned, 0.5, 5, 0, 1, 1e-7).Face()},
                        {"extrusion", pushed, BRepBuilderAPI_MakeFace(pushed, 0.1, 0.9, -3, 8, 1e-7).Face()}};
  for (const Case& c : cases) {
    Diagnostics diagnostics;
    const CadModel model = read(step::test::step_text(c.face), diagnostics);
    ASSERT_EQ(model.faces.size(), 1u);
    EXPECT_EQ(model.faces[0].kind, c.kind);
    EXPECT_FALSE(model.faces[0].trimmed);
    const geom::NurbsSurface& s = model.faces[0].surface;
    const geom::Interval u = s.domain(geom::Direction::u), v = s.domain(geom::Direction::v);
    // The iso-curves at the ends and in the knots keep their parameters; inside of arcs the place on the
    // iso-curve of the other direction is what counts.
    for (int j = 0; j <= 10; ++j) {
      const double b = v.lo + v.length() * j / 10;
      const Point3 p = evaluate(s, u.lo, b);
      const gp_Pnt q = c.surface->Value(u.lo, b);
      EXPECT_LT(distance(p, {q.X(), q.Y(), q.Z()}), 1e-9);
    }
  }
}

TEST(Faces, OffsetSurfacesStayWithinTheApproximation) {
  std::mt19937 random(21);
  const geom::NurbsSurface base = step::test::random_surface(random, 3, 3, 5, 5);
  geom::NurbsSurface smooth = base;  // single knots only: an offset needs tangents
  smooth.knots_u = smooth.knots_v = {0, 0, 0, 0, 0.5, 1, 1, 1, 1};
  const Handle(Geom_Surface) offset = new Geom_OffsetSurface(step::to_occt(smooth), 0.5);
  const TopoDS_Face face = BRepBuilderAPI_MakeFace(offset, 0, 1, 0, 1, 1e-7).Face();
  Diagnostics diagnostics;
  const CadModel model = read(step::test::step_text(face), diagnostics);
  ASSERT_EQ(model.faces.size(), 1u);
  EXPECT_EQ(model.faces[0].kind, "offset");
  for (int j = 0; j <= 10; ++j) {
    for (int i = 0; i <= 10; ++i) {
      const Point3 p = evaluate(model.faces[0].surface, i / 10.0, j / 10.0);
      const gp_Pnt q = offset->Value(i / 10.0, j / 10.0);
      EXPECT_LT(distance(p, {q.X(), q.Y(), q.Z()}), 1e-4);
    }
  }
}

TEST(Faces, PeriodicSplinesAreCutOpenWhereTheFaceLies) {
  // A closed B-spline tube, periodic in u, and the face across its seam.
  TColgp_Array2OfPnt poles(1, 8, 1, 3);
  for (int i = 1; i <= 8; ++i) {
    const double a = 2 * geom::kPi * (i - 1) / 8;
    for (int j = 1; j <= 3; ++j) poles(i, j) = gp_Pnt(10 * std::cos(a), 7 * std::sin(a), 5.0 * j + (i % 3));
  }
  TColStd_Array1OfReal ku(1, 9), kv(1, 2);
  TColStd_Array1OfInteger mu(1, 9), mv(1, 2);
  for (int i = 1; i <= 9; ++i) ku(i) = i - 1, mu(i) = 1;
  kv(1) = 0;
  kv(2) = 1;
  mv(1) = mv(2) = 3;
  const Handle(Geom_BSplineSurface) tube =
      new Geom_BSplineSurface(poles, ku, kv, mu, mv, 3, 2, Standard_True);
  for (const auto& [lo, hi] :
       std::vector<std::pair<double, double>>{{1.5, 6.25}, {6.5, 10.75}, {7.0, 9.0}, {0, 8}}) {
    SCOPED_TRACE(lo);
    auto part = step::to_nurbs(tube, {lo, hi}, {0.25, 1}, 1e-4);
    ASSERT_TRUE(part);
    ASSERT_TRUE(geom::validate(part->surface)) << geom::validate(part->surface).error().message;
    EXPECT_NEAR(part->surface.knots_u.front(), lo, 1e-9);
    EXPECT_NEAR(part->surface.knots_u.back(), hi, 1e-9);
    for (int i = 0; i <= 20; ++i) {
      const double u = i == 20 ? part->surface.knots_u.back() : lo + (hi - lo) * i / 20;
      const Point3 p = evaluate(part->surface, u, 0.6);
      const gp_Pnt q = tube->Value(u, 0.6);
      EXPECT_LT(distance(p, {q.X(), q.Y(), q.Z()}), 1e-9) << u;
    }
  }
}

TEST(Faces, UnclampedSplinesAreClamped) {
  TColgp_Array2OfPnt poles(1, 6, 1, 2);
  for (int i = 1; i <= 6; ++i) {
    for (int j = 1; j <= 2; ++j) poles(i, j) = gp_Pnt(2.0 * i, 9.0 * j, i % 2);
  }
  TColStd_Array1OfReal ku(1, 10), kv(1, 2);
  TColStd_Array1OfInteger mu(1, 10), mv(1, 2);
  for (int i = 1; i <= 10; ++i) ku(i) = i, mu(i) = 1;
  kv(1) = 0;
  kv(2) = 1;
  mv(1) = mv(2) = 2;
  const Handle(Geom_BSplineSurface) open = new Geom_BSplineSurface(poles, ku, kv, mu, mv, 3, 1);
  const TopoDS_Face face = BRepBuilderAPI_MakeFace(open, 1e-7).Face();
  Diagnostics diagnostics;
  const CadModel model = read(step::test::step_text(face), diagnostics);
  ASSERT_EQ(model.faces.size(), 1u);
  const geom::NurbsSurface& s = model.faces[0].surface;
  ASSERT_TRUE(geom::validate(s)) << geom::validate(s).error().message;
  EXPECT_FALSE(model.faces[0].trimmed);
  for (int i = 0; i <= 12; ++i) {
    const Point3 p = evaluate(s, 4 + 0.25 * i, 0.3);
    const gp_Pnt q = open->Value(4 + 0.25 * i, 0.3);
    EXPECT_LT(distance(p, {q.X(), q.Y(), q.Z()}), 1e-9);
  }
}

TEST(Faces, WireframeOnlyIsSaid) {
  const TopoDS_Shape line = BRepBuilderAPI_MakeEdge(gp_Pnt(0, 0, 0), gp_Pnt(1, 2, 3)).Shape();
  for (const std::string& text : {step::test::step_text(line), step::test::iges_text(line, false)}) {
    Diagnostics diagnostics;
    ReadCadOptions options;
    options.file_name = "frame.igs";
    const auto model = read_cad(text, options, diagnostics);
    ASSERT_FALSE(model);
    EXPECT_EQ(model.error().code, ErrorCode::geometry);
    EXPECT_EQ(model.error().where.file, "frame.igs");
    EXPECT_NE(model.error().message.find("wireframe only, 1 curve "), std::string::npos)
        << model.error().message;
  }
}

// --- mesh
// ----------------------------------------------------------------------------------------------------

double mesh_volume(const CadMesh& m) {
  double six = 0;
  for (const auto& t : m.mesh.triangles) {
    const Vec3 a = m.mesh.vertices[t[0]] - Point3{}, b = m.mesh.vertices[t[1]] - Point3{},
               c = m.mesh.vertices[t[2]] - Point3{};
    six += dot(a, cross(b, c));
  }
  return six / 6;
}

TEST(Mesh, SolidsAreClosedAndTurnedOutward) {
  const double pi = geom::kPi;
  const std::vector<std::pair<TopoDS_Shape, double>> parts = {
      {BRepPrimAPI_MakeBox(10, 20, 30).Shape(), 6000},
      {BRepPrimAPI_MakeSphere(8).Shape(), 4.0 / 3 * pi * 512},
      {BRepPrimAPI_MakeCylinder(5, 12).Shape(), pi * 25 * 12},
      {BRepPrimAPI_MakeTorus(20, 6).Shape(), 2 * pi * pi * 20 * 36}};
  for (const auto& [part, volume] : parts) {
    const std::string text = step::test::step_text(part);
    Diagnostics diagnostics;
    const auto mesh = mesh_cad(text, {}, 0.01, 0.1, diagnostics);
    ASSERT_TRUE(mesh);
    EXPECT_NEAR(mesh_volume(*mesh), volume, 5e-3 * volume);
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const auto& t : mesh->mesh.triangles) {
      for (int k = 0; k < 3; ++k)
        ++edges[{t[static_cast<std::size_t>(k)], t[static_cast<std::size_t>((k + 1) % 3)]}];
    }
    for (const auto& [edge, count] : edges) {
      EXPECT_EQ(count, 1);
      EXPECT_EQ(edges.count({edge.second, edge.first}), 1u);
    }
    ASSERT_EQ(mesh->face_of.size(), mesh->mesh.triangles.size());
  }
}

TEST(Mesh, FacesCanBeChosen) {
  const std::string text = step::test::step_text(BRepPrimAPI_MakeBox(1, 1, 1).Shape());
  ReadCadOptions options;
  options.faces = {5, 2};
  Diagnostics diagnostics;
  const auto mesh = mesh_cad(text, options, 0.1, 0.5, diagnostics);
  ASSERT_TRUE(mesh);
  EXPECT_EQ(mesh->face_of, (std::vector<std::uint32_t>{2, 2, 5, 5}));
  EXPECT_EQ(mesh_cad(text, options, 0, 0.5, diagnostics).error().code, ErrorCode::usage);
  EXPECT_EQ(mesh_cad(text, options, 0.1, std::nan(""), diagnostics).error().code, ErrorCode::usage);
}

}  // namespace
}  // namespace burin::io

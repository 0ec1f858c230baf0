// SPDX-License-Identifier: Apache-2.0
#include "burin/io/step/step_test_util.h"

#include <IGESControl_Controller.hxx>
#include <IGESControl_Writer.hxx>
#include <Interface_Static.hxx>
#include <STEPControl_Controller.hxx>
#include <STEPControl_Writer.hxx>
#include <StepData_Protocol.hxx>
#include <StepData_StepModel.hxx>
#include <StepData_StepWriter.hxx>
#include <XSControl_WorkSession.hxx>
#include <algorithm>
#include <sstream>

#include "burin/io/step/load.h"

namespace burin::io::step::test {

geom::NurbsSurface random_surface(std::mt19937& random, int degree_u, int degree_v, int count_u,
                                  int count_v) {
  std::uniform_real_distribution<double> unit(0, 1);
  const auto knots = [&](int degree, int count) {
    std::vector<double> inner;
    for (int i = 0; i < count - degree - 1; ++i) inner.push_back(0.05 + 0.9 * unit(random));
    if (inner.size() >= 2 && degree >= 2) inner[1] = inner[0];
    std::sort(inner.begin(), inner.end());
    std::vector<double> all(static_cast<std::size_t>(degree) + 1, 0.0);
    all.insert(all.end(), inner.begin(), inner.end());
    all.insert(all.end(), static_cast<std::size_t>(degree) + 1, 1.0);
    return all;
  };
  geom::NurbsSurface s;
  s.degree_u = degree_u;
  s.degree_v = degree_v;
  s.count_u = count_u;
  s.count_v = count_v;
  s.knots_u = knots(degree_u, count_u);
  s.knots_v = knots(degree_v, count_v);
  for (int j = 0; j < count_v; ++j) {
    for (int i = 0; i < count_u; ++i) {
      const geom::Point3 p{10.0 * i + unit(random), 10.0 * j + unit(random), 8 * unit(random)};
      s.points.push_back(homogeneous(p, 0.5 + unit(random)));
    }
  }
  return s;
}

std::string step_text(const TopoDS_Shape& shape, const std::string& unit) {
  std::string text;
  const auto done = with_occt({}, [&]() -> Result<void> {
    STEPControl_Controller::Init();
    set_statics();
    Interface_Static::SetCVal("write.step.unit", unit.c_str());
    STEPControl_Writer writer;
    if (writer.Transfer(shape, STEPControl_AsIs) != IFSelect_RetDone) return Error{};
    StepData_StepWriter out(writer.Model());
    out.SendModel(Handle(StepData_Protocol)::DownCast(writer.WS()->Protocol()));
    std::ostringstream stream;
    out.Print(stream);
    text = stream.str();
    return {};
  });
  return done ? text : "";
}

std::string iges_text(const TopoDS_Shape& shape, bool as_brep, const std::string& unit) {
  std::string text;
  const auto done = with_occt({}, [&]() -> Result<void> {
    IGESControl_Controller::Init();
    set_statics();
    IGESControl_Writer writer(unit.c_str(), as_brep ? 1 : 0);
    writer.AddShape(shape);
    writer.ComputeModel();
    std::ostringstream stream;
    writer.Write(stream);
    text = stream.str();
    return {};
  });
  return done ? text : "";
}

}  // namespace burin::io::step::test

// SPDX-License-Identifier: Apache-2.0
#include "burin/io/drawing/drawing.h"

#include <gtest/gtest.h>

namespace burin::io {
namespace {

Entity entity(const char* kind, const char* id, int line) {
  Entity e;
  e.kind = kind;
  e.id = id;
  e.line = line;
  return e;
}

TEST(Entity, NamesAreWhatAUserFindsInTheFile) {
  EXPECT_EQ(entity("LINE", "2F", 7).name(), "LINE 2F");
  EXPECT_EQ(entity("path", "outline", 7).name(), "path#outline");
  EXPECT_EQ(entity("path", "", 7).name(), "path at line 7");
  EXPECT_EQ(entity("LINE", "INSERT 10F(1,2)/LINE 101", 7).name(), "INSERT 10F(1,2)/LINE 101");
  EXPECT_EQ(entity("path", "clone/leaf", 7).name(), "path#clone/leaf");
}

TEST(Drawing, MapsAndBounds) {
  Drawing drawing;
  Entity e = entity("LINE", "1", 1);
  e.paths.push_back({{geom::Line2{{0, 0}, {2, 1}}, geom::Arc2{{2, 2}, 1, -geom::kPi / 2, geom::kPi}}, false});
  drawing.entities.push_back(e);
  EXPECT_NEAR(bounds(drawing).hi.x, 3, 1e-12);
  transform(drawing.entities[0].paths, {0, 2, -2, 0, 10, 0});  // a quarter turn, twice the size, moved
  const geom::Box2 box = bounds(drawing);
  EXPECT_NEAR(box.lo.x, 10 - 6, 1e-12);
  EXPECT_NEAR(box.hi.x, 10, 1e-12);
  EXPECT_NEAR(box.hi.y, 6, 1e-12);
}

}  // namespace
}  // namespace burin::io

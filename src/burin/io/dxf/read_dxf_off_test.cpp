// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "burin/io/dxf/read_dxf.h"

namespace {

TEST(ReadDxfOff, SaysThatItIsLeftOut) {
  EXPECT_FALSE(burin::io::dxf_supported());
  burin::io::ReadOptions options;
  options.file_name = "part.dxf";
  burin::Diagnostics diagnostics;
  const auto drawing = burin::io::read_dxf("0\nEOF\n", options, diagnostics);
  ASSERT_FALSE(drawing);
  EXPECT_EQ(drawing.error().code, burin::ErrorCode::unsupported);
  EXPECT_NE(drawing.error().message.find("without DXF"), std::string::npos);
  EXPECT_EQ(drawing.error().where.file, "part.dxf");
}

}  // namespace

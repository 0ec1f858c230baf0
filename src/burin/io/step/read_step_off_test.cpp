// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "burin/io/step/read_step.h"

namespace {

TEST(ReadStepOff, SaysThatItIsLeftOut) {
  burin::io::ReadCadOptions options;
  options.file_name = "part.step";
  burin::Diagnostics diagnostics;
  const auto model = burin::io::read_cad("ISO-10303-21;", options, diagnostics);
  ASSERT_FALSE(model);
  EXPECT_EQ(model.error().code, burin::ErrorCode::unsupported);
  EXPECT_NE(model.error().message.find("without STEP"), std::string::npos);
  EXPECT_EQ(model.error().where.file, "part.step");
  EXPECT_FALSE(burin::io::mesh_cad("", options, 0.1, 0.1, diagnostics));
  EXPECT_FALSE(burin::io::write_step({}, "part"));
}

}  // namespace

// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

extern "C" int c_interface(void);

TEST(BurinServo, WorksFromC) {
  EXPECT_EQ(c_interface(), 0) << "line of c_interface.c";
}

// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "burin/control/burin_servo.h"

extern "C" int c_interface(void);

TEST(BurinServo, WorksFromC) {
  EXPECT_EQ(c_interface(), 0) << "line of c_interface.c";
}

TEST(BurinServo, RunsASurfaceProgram) {
  const std::string program =
      "%\nG21 G90 G00 Z20.;\nG06.23 U2 V2 P2 Q2 D6. L0. F1200. S0.05;\n"
      "X0. Y0. Z0. W1.;\nX20.;\nX0. Y10.;\nX20.;\nM30;\n%\n";
  char message[200];
  burin_servo* servo = burin_servo_load(program.data(), program.size(), nullptr, message, sizeof message);
  ASSERT_NE(servo, nullptr) << message;
  burin_servo_setpoint s{};
  uint64_t count = 0;
  double lowest = 1e9;
  while (burin_servo_tick(servo, &s) == BURIN_SERVO_RUNNING) {
    ++count;
    if (s.path >= 0) lowest = std::min(lowest, s.z_mm);
  }
  EXPECT_EQ(count, burin_servo_setpoints(servo));
  EXPECT_NEAR(lowest, 0, 1e-9);
  burin_servo_free(servo);
}

TEST(BurinServo, SaysWhereAProgramIsWrong) {
  const std::string program = "G21 G90 G00 Z20.\nG06.23 U2 V2 D6.\nX0 Q3\n";
  char message[200];
  EXPECT_EQ(burin_servo_load(program.data(), program.size(), nullptr, message, sizeof message), nullptr);
  EXPECT_NE(std::string(message).find("program:"), std::string::npos) << message;
  EXPECT_EQ(burin_servo_load(nullptr, 0, nullptr, message, sizeof message), nullptr);
}

/* SPDX-License-Identifier: Apache-2.0
 * The header and the calls as C: returns 0, or the line of the first check that failed. */
#include "burin/control/burin_servo.h"

#include <math.h>
#include <string.h>

#define CHECK(condition) \
  if (!(condition)) return __LINE__

int c_interface(void);

static int drives_a_polyline(void) {
  const double xyz[] = {0, 0, 0, 10, 0, 0, 10, 5, 0, 10, 5, 0, 10, 5, -2};
  char message[64];
  burin_servo_setpoint now, before;
  uint64_t count, i;
  burin_servo* servo = burin_servo_load_polyline(xyz, 5, 1200, NULL, message, sizeof message);
  CHECK(servo != NULL && message[0] == '\0');
  count = burin_servo_setpoints(servo);
  CHECK(count > 100);
  CHECK(burin_servo_tick(servo, &before) == BURIN_SERVO_RUNNING);
  CHECK(before.t_s == 0 && before.x_mm == 0 && before.feed_mm_min == 0 && before.surface == -1);
  CHECK(isnan(before.u) && isnan(before.v));
  for (i = 1; i < count; ++i) {
    CHECK(burin_servo_tick(servo, &now) == BURIN_SERVO_RUNNING);
    CHECK(fabs(now.t_s - (double)i * 0.001) < 1e-9);
    CHECK(hypot(hypot(now.x_mm - before.x_mm, now.y_mm - before.y_mm), now.z_mm - before.z_mm) < 0.0200001);
    before = now;
  }
  CHECK(now.x_mm == 10 && now.y_mm == 5 && now.z_mm == -2);
  CHECK(burin_servo_tick(servo, &now) == BURIN_SERVO_DONE);
  CHECK(now.z_mm == -2 && now.t_s == before.t_s);
  burin_servo_restart(servo);
  CHECK(burin_servo_tick(servo, &now) == BURIN_SERVO_RUNNING && now.t_s == 0 && now.x_mm == 0);
  burin_servo_free(servo);
  return 0;
}

static int refuses_what_cannot_be(void) {
  const double bad[] = {0, 0, 0, 1, NAN, 0};
  const double good[] = {0, 0, 0, 1, 0, 0};
  char message[16];
  burin_servo_limits limits = burin_servo_default_limits();
  burin_servo_setpoint out;
  CHECK(limits.period_s == 0.001 && limits.rapid_mm_min == 10000);
  CHECK(!burin_servo_load_polyline(bad, 2, 100, NULL, message, sizeof message));
  CHECK(strlen(message) == sizeof message - 1); /* cut, and ended */
  CHECK(!burin_servo_load_polyline(NULL, 2, 100, NULL, message, sizeof message) && message[0]);
  CHECK(!burin_servo_load_polyline(good, 0, 100, NULL, NULL, 0));
  CHECK(!burin_servo_load_polyline(good, 2, 0, NULL, NULL, 0));
  limits.jerk_mm_s3 = -1;
  CHECK(!burin_servo_load_polyline(good, 2, 100, &limits, message, 1) && message[0] == '\0');
  CHECK(burin_servo_tick(NULL, &out) == BURIN_SERVO_ERROR);
  CHECK(burin_servo_setpoints(NULL) == 0);
  burin_servo_restart(NULL);
  burin_servo_free(NULL);
  return 0;
}

int c_interface(void) {
  const int line = drives_a_polyline();
  return line ? line : refuses_what_cannot_be();
}

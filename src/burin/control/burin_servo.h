/* SPDX-License-Identifier: Apache-2.0
 * C interface of the interpolator, for controls. Loading allocates and may fail; burin_servo_tick does
 * neither. */
#ifndef BURIN_SERVO_H
#define BURIN_SERVO_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* NOLINTBEGIN(modernize-use-using): C */
typedef struct burin_servo burin_servo;

typedef struct burin_servo_limits {
  double period_s, chord_error_mm, accel_mm_s2, jerk_mm_s3, axis_velocity_mm_s, rapid_mm_min;
} burin_servo_limits;

typedef struct burin_servo_setpoint {
  double t_s, x_mm, y_mm, z_mm, feed_mm_min, u, v;
  int32_t surface, path;
} burin_servo_setpoint;
/* NOLINTEND(modernize-use-using) */

enum { BURIN_SERVO_RUNNING = 0, BURIN_SERVO_DONE = 1, BURIN_SERVO_ERROR = -1 };

/* The defaults of `burin cycle`. */
burin_servo_limits burin_servo_default_limits(void);
/* Reads a surface program (text, not a file name) and plans it. NULL on error; the message, cut to `size` - 1
 * characters, is then in `message` (may be NULL). Free with burin_servo_free. */
burin_servo* burin_servo_load(const char* program, size_t length, const burin_servo_limits* limits,
                              char* message, size_t size);
/* Plans a polyline of `count` points (x y z each) at one feed. */
burin_servo* burin_servo_load_polyline(const double* xyz, size_t count, double feed_mm_min,
                                       const burin_servo_limits* limits, char* message, size_t size);
/* The real-time call: no allocation, no lock, bounded time. */
int burin_servo_tick(burin_servo* servo, burin_servo_setpoint* out);
void burin_servo_restart(burin_servo* servo);
uint64_t burin_servo_setpoints(const burin_servo* servo);
void burin_servo_free(burin_servo* servo);

#ifdef __cplusplus
}
#endif
#endif

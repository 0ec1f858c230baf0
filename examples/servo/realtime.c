/* SPDX-License-Identifier: Apache-2.0
 * A control's servo loop: one setpoint a millisecond from a SCHED_FIFO thread with locked memory, where the
 * system permits it, else from an ordinary one (a note says so).
 *
 *   servo_realtime [PERIODS]      default 5000
 *
 * Prints how late the thread woke up and how long the tick took. What a control would do with the setpoint
 * stands at `send`. */
#define _GNU_SOURCE
#include <errno.h>
#include <pthread.h>
#include <sched.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <time.h>

#include "burin/control/burin_servo.h"

enum { PERIOD_NS = 1000000, PRIORITY = 80, PREFAULT = 64 * 1024, MAX_PERIODS = 10000000 };

struct loop {
  burin_servo* servo;
  size_t periods;    /* how many to run */
  uint32_t* late_ns; /* of each period: how late the thread woke up */
  uint32_t* tick_ns; /* and how long the tick took */
  burin_servo_setpoint last;
};

static int64_t ns_between(struct timespec a, struct timespec b) {
  return (int64_t)(b.tv_sec - a.tv_sec) * 1000000000 + (b.tv_nsec - a.tv_nsec);
}

static uint32_t clipped(int64_t ns) {
  return ns < 0 ? 0 : ns > UINT32_MAX ? UINT32_MAX : (uint32_t)ns;
}

static void send(const burin_servo_setpoint* setpoint) {
  (void)setpoint; /* to the drives */
}

static void* servo_thread(void* argument) {
  struct loop* loop = argument;
  volatile char stack[PREFAULT]; /* touched once, so that no page is missing later */
  struct timespec next, woken, done;
  size_t i;
  memset((char*)stack, 0, sizeof stack);
  clock_gettime(CLOCK_MONOTONIC, &next);
  for (i = 0; i < loop->periods; ++i) {
    next.tv_nsec += PERIOD_NS;
    if (next.tv_nsec >= 1000000000) next.tv_nsec -= 1000000000, ++next.tv_sec;
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &next, NULL) == EINTR) continue;
    clock_gettime(CLOCK_MONOTONIC, &woken);
    if (burin_servo_tick(loop->servo, &loop->last) == BURIN_SERVO_DONE) burin_servo_restart(loop->servo);
    clock_gettime(CLOCK_MONOTONIC, &done);
    send(&loop->last);
    loop->late_ns[i] = clipped(ns_between(next, woken));
    loop->tick_ns[i] = clipped(ns_between(woken, done));
  }
  return NULL;
}

/* A SCHED_FIFO thread; without the right to it an ordinary one. */
static int start(pthread_t* thread, struct loop* loop) {
  pthread_attr_t attributes;
  struct sched_param priority;
  int failed;
  memset(&priority, 0, sizeof priority);
  priority.sched_priority = PRIORITY;
  pthread_attr_init(&attributes);
  pthread_attr_setinheritsched(&attributes, PTHREAD_EXPLICIT_SCHED);
  pthread_attr_setschedpolicy(&attributes, SCHED_FIFO);
  pthread_attr_setschedparam(&attributes, &priority);
  failed = pthread_create(thread, &attributes, servo_thread, loop);
  pthread_attr_destroy(&attributes);
  if (!failed) return puts("scheduling: SCHED_FIFO, priority 80"), 0;
  printf("scheduling: ordinary (SCHED_FIFO: %s); times are those of a busy system\n", strerror(failed));
  return pthread_create(thread, NULL, servo_thread, loop);
}

static int ascending(const void* a, const void* b) {
  const uint32_t x = *(const uint32_t*)a, y = *(const uint32_t*)b;
  return (x > y) - (x < y);
}

static void report(const char* what, uint32_t* times, size_t n) {
  qsort(times, n, sizeof *times, ascending);
  printf("%-12s median %8.3f us   99.9 %% %8.3f us   max %8.3f us\n", what, times[n / 2] * 1e-3,
         times[n - 1 - n / 1000] * 1e-3, times[n - 1] * 1e-3);
}

/* A square with its diagonals, 40 mm wide. */
static burin_servo* load(char* message, size_t size) {
  static const double xyz[] = {0, 0, 0, 40, 0,  0, 40, 40, 0, 0, 40, 0,
                               0, 0, 0, 40, 40, 0, 40, 0,  5, 0, 40, 0};
  return burin_servo_load_polyline(xyz, sizeof xyz / sizeof *xyz / 3, 6000, NULL, message, size);
}

int main(int argc, char** argv) {
  char message[200];
  struct loop loop;
  pthread_t thread;
  const long periods = argc > 1 ? strtol(argv[1], NULL, 10) : 5000;
  if (argc > 2 || periods < 1 || periods > MAX_PERIODS) {
    fprintf(stderr, "usage: servo_realtime [PERIODS] (1 to %d)\n", MAX_PERIODS);
    return 2;
  }
  memset(&loop, 0, sizeof loop);
  loop.periods = (size_t)periods;
  loop.servo = load(message, sizeof message);
  if (!loop.servo) return fprintf(stderr, "%s\n", message), 1;
  loop.late_ns = calloc(loop.periods, sizeof *loop.late_ns);
  loop.tick_ns = calloc(loop.periods, sizeof *loop.tick_ns);
  if (!loop.late_ns || !loop.tick_ns) return fprintf(stderr, "not enough memory\n"), 1;
  if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0)
    printf("memory: not locked (mlockall: %s)\n", strerror(errno));
  else
    puts("memory: locked");
  if (start(&thread, &loop) != 0) return fprintf(stderr, "no thread: %s\n", strerror(errno)), 1;
  pthread_join(thread, NULL);
  printf("plan: %llu setpoints, %zu periods of %d us run\n",
         (unsigned long long)burin_servo_setpoints(loop.servo), loop.periods, PERIOD_NS / 1000);
  report("woken late", loop.late_ns, loop.periods);
  report("tick", loop.tick_ns, loop.periods);
  free(loop.late_ns);
  free(loop.tick_ns);
  burin_servo_free(loop.servo);
  return 0;
}

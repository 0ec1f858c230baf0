// SPDX-License-Identifier: Apache-2.0
#include "burin/base/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>

namespace burin {

void parallel_for(std::size_t count, unsigned threads,
                  const std::function<void(std::size_t task, std::size_t worker)>& body) {
  // More than the machine has do no good, and oneTBB prints a warning.
  const auto machine = static_cast<unsigned>(std::max(1, tbb::info::default_concurrency()));
  const std::size_t workers = std::min<std::size_t>(std::clamp(threads, 1U, machine), count);
  if (workers <= 1) {
    for (std::size_t i = 0; i < count; ++i) body(i, 0);
    return;
  }
  // The lowest task that threw so far: those above it are not begun, those below still run, so that it does
  // not depend on the threads whose exception comes out.
  std::atomic<std::size_t> thrown_by{count};
  std::mutex mutex;
  std::exception_ptr thrown;
  const auto run = [&](std::size_t task) {
    if (task > thrown_by) return;
    try {
      body(task, static_cast<std::size_t>(tbb::this_task_arena::current_thread_index()));
    } catch (...) {
      const std::lock_guard<std::mutex> lock(mutex);
      if (task < thrown_by) thrown_by = task, thrown = std::current_exception();
    }
  };
  // An arena of its own: a thread that waits here takes no task of an outer loop, whose worker it is.
  tbb::task_arena arena(static_cast<int>(workers));
  arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, count, 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
          for (std::size_t i = range.begin(); i != range.end(); ++i) run(i);
        },
        tbb::simple_partitioner());
  });
  if (thrown) std::rethrow_exception(thrown);
}

unsigned thread_count(unsigned asked) {
  if (asked == 0) asked = std::max(1U, std::thread::hardware_concurrency());
  return std::min(asked, kMostThreads);
}

}  // namespace burin

// SPDX-License-Identifier: Apache-2.0
#include "burin/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace burin {

void parallel_for(std::size_t count, unsigned threads,
                  const std::function<void(std::size_t task, std::size_t worker)>& body) {
  const std::size_t workers = std::min<std::size_t>(std::max(1U, threads), count);
  if (workers <= 1) {
    for (std::size_t i = 0; i < count; ++i) body(i, 0);
    return;
  }
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::exception_ptr thrown;
  std::size_t thrown_by = count;
  const auto work = [&](std::size_t worker) {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        body(i, worker);
      } catch (...) {
        const std::lock_guard<std::mutex> lock(mutex);
        if (i < thrown_by) thrown_by = i, thrown = std::current_exception();
        next = count;  // what has not begun is not begun
        return;
      }
    }
  };
  std::vector<std::thread> others;
  others.reserve(workers - 1);
  try {
    for (std::size_t w = 1; w < workers; ++w) others.emplace_back(work, w);
  } catch (const std::system_error&) {
    // No more threads are to be had: those that run do the work.
  }
  work(0);
  for (std::thread& t : others) t.join();
  if (thrown) std::rethrow_exception(thrown);
}

unsigned thread_count(unsigned asked) {
  if (asked == 0) asked = std::max(1U, std::thread::hardware_concurrency());
  return std::min(asked, kMostThreads);
}

}  // namespace burin

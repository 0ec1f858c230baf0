// SPDX-License-Identifier: Apache-2.0
// Run by mpirun with several processes (tests/CMakeLists.txt): each checks what it has got.
#include <chrono>
#include <cstdio>
#include <new>
#include <stdexcept>
#include <thread>

#include "cluster.h"

namespace {

using burin::Error;
using burin::ErrorCode;
using burin::Result;
using burin::cli::Cluster;

int failures = 0;
void check(bool fine, const char* what, int rank) {
  if (fine) return;
  ++failures;
  std::fprintf(stderr, "rank %d: %s\n", rank, what);
}

/// Unequal in size and in time.
std::string expected(std::size_t task) {
  return task % 7 == 0 ? std::string()
                       : std::string(task % 11 == 0 ? 3'000'000 : task, static_cast<char>('a' + task % 26));
}

void check_results(Cluster& cluster) {
  const auto workers = cluster.workers(2);
  for (const std::size_t count : {0u, 1u, 2u, 40u}) {
    const auto results = workers->map(count, [](std::size_t task) {
      std::this_thread::sleep_for(std::chrono::microseconds(task % 5 == 0 ? 3000 : 100));
      return expected(task);
    });
    bool fine = results.size() == count;
    for (std::size_t i = 0; fine && i < count; ++i) fine = results[i] == expected(i);
    check(fine, "results differ", cluster.rank());
  }
}

void check_exceptions(Cluster& cluster) {
  const auto workers = cluster.workers(1);
  std::string message;
  try {
    (void)workers->map(20, [](std::size_t task) -> std::string {
      if (task == 7 || task == 13) throw std::runtime_error("task " + std::to_string(task));
      return "fine";
    });
  } catch (const std::runtime_error& error) {
    message = error.what();
  }
  check(message == "task 7", "the exception of the lowest task is not there", cluster.rank());
  bool out_of_memory = false;
  try {
    (void)workers->map(3, [](std::size_t task) -> std::string {
      if (task == 2) throw std::bad_alloc();
      return "fine";
    });
  } catch (const std::bad_alloc&) {
    out_of_memory = true;
  }
  check(out_of_memory, "bad_alloc is not there", cluster.rank());
}

void check_answers(Cluster& cluster) {
  const auto text = cluster.from_first(
      [&]() -> Result<std::string> { return "from rank " + std::to_string(cluster.rank()); });
  check(text.ok() && *text == "from rank 0", "another answer than the first rank's", cluster.rank());
  const Error wanted{
      ErrorCode::syntax, "wrong (right)", {.file = "a.csv", .line = 3, .column = 5, .entity = "LINE 2F"}};
  const auto error = cluster.from_first([&]() -> Result<std::string> { return wanted; });
  check(!error.ok() && error.error() == wanted, "another error than the first rank's", cluster.rank());
}

}  // namespace

int main() {
  const auto launch = burin::cli::find_launch();
  const auto cluster = burin::cli::join_cluster(launch);
  if (cluster == nullptr) {
    std::printf("alone\n");
    return launch.several ? 1 : 0;
  }
  check_results(*cluster);
  check_exceptions(*cluster);
  check_answers(*cluster);
  if (cluster->rank() == 0) std::printf("%d ranks\n", cluster->size());
  return failures == 0 ? 0 : 1;
}

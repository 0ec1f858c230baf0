// SPDX-License-Identifier: Apache-2.0
#include "burin/base/workers.h"

#include "burin/base/parallel.h"

namespace burin {

std::vector<std::string> LocalWorkers::map(std::size_t count, const Task& body) {
  std::vector<std::string> results(count);
  parallel_for(count, thread_count(threads_),
               [&](std::size_t task, std::size_t) { results[task] = body(task); });
  return results;
}

}  // namespace burin

// SPDX-License-Identifier: Apache-2.0
// Work that is split into numbered tasks, on several threads (oneTBB). What a task does may depend on its
// number only, so that results are the same for every number of threads.
#pragma once

#include <cstddef>
#include <functional>

namespace burin {

/// Runs body(task, worker) for all tasks from 0 to count - 1; `worker` counts from 0 and is below `threads`,
/// for scratch space of a thread. With one thread (or one task) everything runs here. What a task throws is
/// thrown here, that of the lowest number when several do: tasks below it all run, those above may not. Never
/// more threads at work than the machine has, however many are asked for and however loops are nested.
void parallel_for(std::size_t count, unsigned threads,
                  const std::function<void(std::size_t task, std::size_t worker)>& body);

/// 0 stands for as many threads as the machine has; never more than kMostThreads.
inline constexpr unsigned kMostThreads = 64;
unsigned thread_count(unsigned asked);

}  // namespace burin

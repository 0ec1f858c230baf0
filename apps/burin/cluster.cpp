// SPDX-License-Identifier: Apache-2.0
#include "cluster.h"

#include <cstdlib>

#include "burin/base/text.h"

namespace burin::cli {
namespace {

std::optional<long long> number(const char* name) {
  const char* text = std::getenv(name);
  return text == nullptr ? std::nullopt : parse_integer(text);
}

}  // namespace

Launch find_launch() {
  // Open MPI; MPICH and Intel MPI. Both say rank and number of processes.
  constexpr const char* kNames[][2] = {{"OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK"},
                                       {"PMI_SIZE", "PMI_RANK"}};
  for (const auto& [size_name, rank_name] : kNames) {
    const auto size = number(size_name), rank = number(rank_name);
    if (!size || !rank || *size < 1 || *rank < 0 || *rank >= *size) continue;
    return {*size > 1, static_cast<int>(*rank)};
  }
  // A resource manager that speaks PMIx says the rank only.
  const auto rank = number("PMIX_RANK");
  if (rank && *rank >= 0 && *rank < (1ll << 31)) return {true, static_cast<int>(*rank)};
  return {};
}

#ifndef BURIN_WITH_MPI
std::unique_ptr<Cluster> join_cluster(const Launch& /*launch*/) {
  return nullptr;
}
bool built_with_mpi() {
  return false;
}
#endif

}  // namespace burin::cli

// SPDX-License-Identifier: Apache-2.0
// The processes of one run that mpirun has started (MPI ranks). Every rank runs the same command; inputs and
// answers about files come from the first rank, which alone prints and writes. Without MPI, or when started
// by hand, there is no cluster.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "burin/base/result.h"
#include "burin/base/workers.h"

namespace burin::cli {

/// What the environment says of the way this process was started; nothing is loaded or called for it.
struct Launch {
  bool several = false;  ///< one of several processes, or of a number that only MPI knows
  int rank = 0;
};
Launch find_launch();

class Cluster {
 public:
  virtual ~Cluster() = default;
  virtual int rank() const = 0;
  virtual int size() const = 0;
  /// Called on every rank in the same order; `ask` runs on the first rank only, its answer arrives on all.
  virtual Result<std::string> from_first(const std::function<Result<std::string>()>& ask) = 0;
  /// Tasks shared out over all ranks; `threads` on this one, 0: its part of the machine.
  virtual std::unique_ptr<Workers> workers(unsigned threads) = 0;
};

/// Joins the other ranks; nothing when this process is the only one or burin was built without MPI. The
/// destructor leaves the others in peace, or ends all of them while an exception is on its way.
std::unique_ptr<Cluster> join_cluster(const Launch& launch);
bool built_with_mpi();

}  // namespace burin::cli

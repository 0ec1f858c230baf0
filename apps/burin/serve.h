// SPDX-License-Identifier: Apache-2.0
// The viewer from this machine to itself: one page and one scene at an address of the loopback.
#pragma once

#include <functional>
#include <string>

#include "burin/base/result.h"

namespace burin::cli {

struct Served {
  std::string page;   ///< at "/"
  std::string scene;  ///< at "/scene.bin"
};

/// Answers GET and HEAD of "/", "/scene.bin" and "/health" at 127.0.0.1 until the process gets SIGINT or
/// SIGTERM; everything else is 404, another Host than this address is 403. `port` 0: any that is free.
/// `ready` is told the address once it can be opened. Nothing is read from files and nothing is kept of
/// requests. Error (io): the port is taken.
Result<void> serve(const Served& served, int port, const std::function<void(const std::string& url)>& ready);

}  // namespace burin::cli

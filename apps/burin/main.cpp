// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <exception>
#include <new>
#include <string>
#include <string_view>

#include "cli.h"
#include "commands.h"
#include "terminal.h"

namespace {

/// Last resort for exceptions that nobody can catch (thrown in a thread or out of a noexcept function).
[[noreturn]] void give_up() noexcept {
  constexpr std::string_view kMessage = "burin: internal error, nothing was written\n";
  [[maybe_unused]] const ssize_t ignored = write(STDERR_FILENO, kMessage.data(), kMessage.size());
  _exit(burin::cli::kFailed);
}

}  // namespace

int main(int argc, char** argv) {
  std::set_terminate(give_up);
  std::signal(SIGPIPE, SIG_IGN);  // a reader that went away is a write error like any other
  std::signal(SIGXFSZ, SIG_IGN);  // and so is a limit of file size
  try {
    burin::cli::Cli cli;
    burin::cli::add_laser(cli);
    burin::cli::add_kerf(cli);
    burin::cli::add_surfaces(cli);
    burin::cli::add_cycle(cli);
    burin::cli::add_rotary(cli);
    burin::cli::add_orient(cli);
    burin::cli::add_cspace(cli);
    burin::cli::add_post(cli);
    burin::cli::add_verify(cli);
    burin::cli::add_view(cli);
    return cli.run(argc, argv);
  } catch (const std::bad_alloc&) {
    burin::cli::print_error("burin: out of memory (a smaller input, or more memory)");
  } catch (const std::exception& error) {
    burin::cli::print_error(std::string("burin: internal error: ") + error.what());
  } catch (...) {
    burin::cli::print_error("burin: internal error");
  }
  return burin::cli::kFailed;
}

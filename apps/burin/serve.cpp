// SPDX-License-Identifier: Apache-2.0
#include "serve.h"

#include <fcntl.h>
#include <httplib.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <string_view>
#include <thread>

#include "burin/base/text.h"

namespace burin::cli {
namespace {

constexpr const char* kAddress = "127.0.0.1";
/// One person looks at it; a few threads, so that a connection that says nothing does not stop the others.
constexpr std::size_t kThreads = 4;
constexpr time_t kTimeout_s = 5;
constexpr std::size_t kLongestPath = 256;

/// The page is one file: scripts and styles stand in it, nothing is loaded but the scene.
constexpr const char* kPolicy =
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:; "
    "font-src data:; "
    "connect-src 'self'; worker-src blob:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// A page elsewhere whose name was made to point here names its own host: it gets nothing.
bool is_own_host(const httplib::Request& request, int port) {
  if (request.get_header_value_count("Host") != 1) return false;
  std::string host = to_lower(request.get_header_value("Host"));
  const std::string suffix = ":" + std::to_string(port);
  if (host.ends_with(suffix)) host.resize(host.size() - suffix.size());
  return host == kAddress || host == "localhost";
}

void plain(httplib::Response& response, int status, const char* text) {
  response.status = status;
  response.set_content(text, "text/plain; charset=utf-8");
}

void set_headers(httplib::Server& server) {
  server.set_default_headers({{"Content-Security-Policy", kPolicy},
                              {"X-Content-Type-Options", "nosniff"},
                              {"X-Frame-Options", "DENY"},
                              {"Referrer-Policy", "no-referrer"},
                              {"Cross-Origin-Resource-Policy", "same-origin"},
                              {"Cache-Control", "no-store"}});
}

/// What is refused before anything is looked at, and before a body is read.
void set_gate(httplib::Server& server, const int& port) {
  using Response = httplib::Server::HandlerResponse;
  server.set_pre_routing_handler([&port](const httplib::Request& request, httplib::Response& response) {
    if (!is_own_host(request, port)) {
      plain(response, 403, "403: only localhost is answered\n");
    } else if (request.method != "GET" && request.method != "HEAD") {
      response.set_header("Allow", "GET, HEAD");
      plain(response, 405, "405: GET and HEAD are answered\n");
    } else if (request.target.size() > kLongestPath) {
      plain(response, 414, "414: the address is too long\n");
    } else {
      return Response::Unhandled;
    }
    return Response::Handled;
  });
}

/// Not copied for each request: it may be large.
void give(httplib::Server& server, const char* path, const char* type, const std::string& content) {
  server.Get(path, [&content, type](const httplib::Request&, httplib::Response& response) {
    response.set_content_provider(content.size(), type,
                                  [&content](std::size_t from, std::size_t length, httplib::DataSink& sink) {
                                    return sink.write(content.data() + from, length);
                                  });
  });
}

/// Where the handler of signals writes to; a handler can reach nothing else.
volatile std::sig_atomic_t wake_fd = -1;

extern "C" void wake(int) {
  const char byte = 0;
  [[maybe_unused]] const ssize_t ignored = write(wake_fd, &byte, 1);
}

/// SIGINT and SIGTERM stop the server, whichever thread gets them: those of the work before are still there.
class Signals {
 public:
  Signals() {
    if (pipe2(pipe_, O_CLOEXEC) != 0) return;
    wake_fd = pipe_[1];
    struct sigaction action {};
    action.sa_handler = wake;
    sigemptyset(&action.sa_mask);
    action.sa_flags = SA_RESTART;
    sigaction(SIGINT, &action, &interrupt_);
    sigaction(SIGTERM, &action, &terminate_);
  }
  ~Signals() {
    if (pipe_[0] < 0) return;
    wake(0);
    if (waiter_.joinable()) waiter_.join();
    sigaction(SIGINT, &interrupt_, nullptr);
    sigaction(SIGTERM, &terminate_, nullptr);
    close(pipe_[0]);
    close(pipe_[1]);
  }
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;
  bool ready() const { return pipe_[0] >= 0; }
  void stop_on_signal(httplib::Server& server) {
    waiter_ = std::thread([this, &server] {
      char byte = 0;
      while (read(pipe_[0], &byte, 1) < 0 && errno == EINTR) {
      }
      // Stopping before it has begun to listen would be lost.
      while (!server.is_running() && !done_) std::this_thread::sleep_for(std::chrono::milliseconds(5));
      server.stop();
    });
  }
  /// Nobody listens any more.
  void done() { done_ = true; }

 private:
  int pipe_[2] = {-1, -1};
  struct sigaction interrupt_ {
  }, terminate_{};
  std::atomic<bool> done_ = false;
  std::thread waiter_;
};

}  // namespace

Result<void> serve(const Served& served, int port, const std::function<void(const std::string& url)>& ready) {
  httplib::Server server;
  Signals signals;  // gone before the server that it stops
  if (!signals.ready()) return Error{ErrorCode::io, "no pipe can be opened (fewer open files)", {}};
  server.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
  // A body is never read, so a connection that sent one cannot go on.
  server.set_keep_alive_max_count(1);
  server.set_payload_max_length(0);
  server.set_read_timeout(kTimeout_s);
  server.set_write_timeout(kTimeout_s);
  // The library's own choice, SO_REUSEPORT, lets a second server share a port that is taken.
  server.set_socket_options([](socket_t socket) {
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
  int open_port = port;
  set_headers(server);
  set_gate(server, open_port);
  give(server, "/", "text/html; charset=utf-8", served.page);
  give(server, "/scene.bin", "application/octet-stream", served.scene);
  const std::string healthy = "ok\n";
  give(server, "/health", "text/plain; charset=utf-8", healthy);
  server.set_error_handler([](const httplib::Request&, httplib::Response& response) {
    if (response.body.empty()) plain(response, response.status, "not here\n");
  });
  if (port == 0) {
    open_port = server.bind_to_any_port(kAddress);
  } else if (!server.bind_to_port(kAddress, port)) {
    open_port = -1;
  }
  if (open_port <= 0)
    return Error{ErrorCode::io,
                 "port " + std::to_string(port) + " of 127.0.0.1 cannot be opened (another --port, or none)",
                 {}};
  signals.stop_on_signal(server);
  ready("http://127.0.0.1:" + std::to_string(open_port) + "/");
  const bool listened = server.listen_after_bind();
  signals.done();
  if (!listened) return Error{ErrorCode::io, "the connection was lost", {}};
  return {};
}

}  // namespace burin::cli

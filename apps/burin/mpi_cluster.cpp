// SPDX-License-Identifier: Apache-2.0
// Cluster over MPI. Only the main thread talks to MPI (MPI_THREAD_FUNNELED): while its threads work it hands
// out tasks one at a time, so that ranks of unequal speed finish together; results then travel to all ranks.
#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <cstring>
#include <deque>
#include <exception>
#include <mutex>
#include <new>
#include <stdexcept>
#include <thread>

#include "burin/base/parallel.h"
#include "cluster.h"

namespace burin::cli {
namespace {

constexpr int kAsk = 1, kTake = 2;  ///< tags: a rank wants a task; its number, or kNoMore
constexpr std::uint64_t kNoMore = ~0ull;
constexpr std::size_t kChunk = 1u << 30;                 ///< bytes in one message: MPI counts in int
constexpr auto kPause = std::chrono::microseconds(100);  ///< between two looks for messages

// --- bytes

void put_number(std::string& bytes, std::uint64_t value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof value);
}
void put_text(std::string& bytes, const std::string& text) {
  put_number(bytes, text.size());
  bytes += text;
}

/// Reads what put_ has written; ranks run the same program, so that nothing can be amiss.
class Reader {
 public:
  explicit Reader(const std::string& bytes) : bytes_(&bytes) {}
  bool done() const { return at_ >= bytes_->size(); }
  std::uint64_t number() {
    std::uint64_t value = 0;
    std::memcpy(&value, bytes_->data() + at_, sizeof value);
    at_ += sizeof value;
    return value;
  }
  std::string text() {
    const std::size_t size = number();
    at_ += size;
    return bytes_->substr(at_ - size, size);
  }

 private:
  const std::string* bytes_;
  std::size_t at_ = 0;
};

/// `bytes` of rank `root` arrive on all ranks.
void broadcast(std::string& bytes, int root) {
  std::uint64_t size = bytes.size();
  MPI_Bcast(&size, 1, MPI_UINT64_T, root, MPI_COMM_WORLD);
  bytes.resize(size);
  for (std::size_t at = 0; at < size; at += kChunk)
    MPI_Bcast(bytes.data() + at, static_cast<int>(std::min(kChunk, size - at)), MPI_BYTE, root,
              MPI_COMM_WORLD);
}

// --- the threads of one rank

enum class Ending : std::uint8_t { fine, failed, out_of_memory };
struct Done {
  std::size_t task = 0;
  Ending ending = Ending::fine;
  std::string bytes;  ///< of the result, or the message
};

Done carry_out(std::size_t task, const Workers::Task& body) {
  try {
    return {task, Ending::fine, body(task)};
  } catch (const std::bad_alloc&) {
    return {task, Ending::out_of_memory, {}};
  } catch (const std::exception& error) {
    return {task, Ending::failed, error.what()};
  } catch (...) {
    return {task, Ending::failed, "unknown exception"};
  }
}

/// Threads that take the tasks given, until it is said that no more will come.
class Crew {
 public:
  Crew(unsigned threads, const Workers::Task& body) : body_(&body) {
    for (unsigned i = 0; i < threads; ++i) threads_.emplace_back([this] { work(); });
  }
  ~Crew() {
    no_more();
    for (std::thread& thread : threads_) thread.join();
  }

  /// A thread has nothing to do, or soon will: no task lies ready.
  bool hungry() {
    const std::lock_guard lock(mutex_);
    return tasks_.empty() && !closed_;
  }
  void give(std::size_t task) {
    const std::lock_guard lock(mutex_);
    tasks_.push_back(task);
    changed_.notify_one();
  }
  void no_more() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    changed_.notify_all();
  }
  bool finished() {
    const std::lock_guard lock(mutex_);
    return closed_ && tasks_.empty() && busy_ == 0;
  }
  std::vector<Done> results() {
    const std::lock_guard lock(mutex_);
    return std::move(done_);
  }

 private:
  void work() {
    std::unique_lock lock(mutex_);
    for (;;) {
      changed_.wait(lock, [this] { return closed_ || !tasks_.empty(); });
      if (tasks_.empty()) return;
      const std::size_t task = tasks_.front();
      tasks_.pop_front();
      ++busy_;
      lock.unlock();
      Done done = carry_out(task, *body_);
      lock.lock();
      done_.push_back(std::move(done));
      --busy_;
    }
  }

  const Workers::Task* body_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::size_t> tasks_;
  std::vector<Done> done_;
  std::size_t busy_ = 0;
  bool closed_ = false;
  std::vector<std::thread> threads_;
};

// --- sharing out

class MpiWorkers final : public Workers {
 public:
  MpiWorkers(int rank, int size, unsigned threads) : rank_(rank), size_(size), threads_(threads) {}

  std::vector<std::string> map(std::size_t count, const Task& body) override {
    std::vector<Done> mine;
    {
      Crew crew(static_cast<unsigned>(std::clamp<std::size_t>(count, 1, threads_)), body);
      rank_ == 0 ? share_out(count, crew) : take_part(crew);
      mine = crew.results();
    }
    return exchange(count, mine);
  }

 private:
  void share_out(std::size_t count, Crew& crew) const {
    std::size_t next = 0;
    int waiting = size_ - 1;  // ranks that have not been told that there is no more
    while (waiting > 0 || !crew.finished()) {
      bool idle = true;
      if (crew.hungry()) {
        next < count ? crew.give(next++) : crew.no_more();
        idle = false;
      }
      int here = 0;
      MPI_Status status;
      MPI_Iprobe(MPI_ANY_SOURCE, kAsk, MPI_COMM_WORLD, &here, &status);
      if (here != 0) {
        MPI_Recv(nullptr, 0, MPI_BYTE, status.MPI_SOURCE, kAsk, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
        const std::uint64_t task = next < count ? next++ : kNoMore;
        MPI_Send(&task, 1, MPI_UINT64_T, status.MPI_SOURCE, kTake, MPI_COMM_WORLD);
        if (task == kNoMore) --waiting;
        idle = false;
      }
      if (idle) std::this_thread::sleep_for(kPause);
    }
  }

  static void take_part(Crew& crew) {
    bool asked = false, ended = false;
    while (!ended || !crew.finished()) {
      bool idle = true;
      if (!asked && !ended && crew.hungry()) {
        MPI_Send(nullptr, 0, MPI_BYTE, 0, kAsk, MPI_COMM_WORLD);
        asked = true;
      }
      int here = 0;
      MPI_Iprobe(0, kTake, MPI_COMM_WORLD, &here, MPI_STATUS_IGNORE);
      if (here != 0) {
        std::uint64_t task = 0;
        MPI_Recv(&task, 1, MPI_UINT64_T, 0, kTake, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
        asked = idle = false;
        ended = task == kNoMore;
        ended ? crew.no_more() : crew.give(task);
      }
      if (idle) std::this_thread::sleep_for(kPause);
    }
  }

  std::vector<std::string> exchange(std::size_t count, std::vector<Done>& mine) const {
    std::string packed;
    for (const Done& done : mine) {
      put_number(packed, done.task);
      put_number(packed, static_cast<std::uint64_t>(done.ending));
      put_text(packed, done.bytes);
    }
    mine.clear();
    std::vector<std::string> results(count);
    std::size_t worst = count;  // the failed task of the lowest number
    Ending ending = Ending::fine;
    for (int root = 0; root < size_; ++root) {
      std::string bytes = root == rank_ ? std::move(packed) : std::string();
      broadcast(bytes, root);
      for (Reader reader(bytes); !reader.done();) {
        const std::size_t task = reader.number();
        const auto end = static_cast<Ending>(reader.number());
        results[task] = reader.text();
        if (end != Ending::fine && task < worst) worst = task, ending = end;
      }
    }
    if (ending == Ending::out_of_memory) throw std::bad_alloc();
    if (ending == Ending::failed) throw std::runtime_error(results[worst]);
    return results;
  }

  int rank_, size_;
  unsigned threads_;
};

class MpiCluster final : public Cluster {
 public:
  MpiCluster() {
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
  }
  ~MpiCluster() override {
    // Others may wait for this rank's part: they cannot go on without it.
    if (std::uncaught_exceptions() > 0) MPI_Abort(MPI_COMM_WORLD, 1);
    MPI_Finalize();
  }

  int rank() const override { return rank_; }
  int size() const override { return size_; }

  Result<std::string> from_first(const std::function<Result<std::string>()>& ask) override {
    std::string bytes;
    if (rank_ == 0) {
      const Result<std::string> answer = ask();
      put_number(bytes, answer.ok() ? 1 : 0);
      if (answer.ok()) {
        put_text(bytes, *answer);
      } else {
        const Error& e = answer.error();
        put_number(bytes, static_cast<std::uint64_t>(e.code));
        put_text(bytes, e.message);
        put_text(bytes, e.where.file);
        put_number(bytes, static_cast<std::uint64_t>(e.where.line));
        put_number(bytes, static_cast<std::uint64_t>(e.where.column));
        put_text(bytes, e.where.entity);
      }
    }
    broadcast(bytes, 0);
    Reader reader(bytes);
    if (reader.number() == 1) return reader.text();
    Error e;
    e.code = static_cast<ErrorCode>(reader.number());
    e.message = reader.text();
    e.where.file = reader.text();
    e.where.line = static_cast<int>(reader.number());
    e.where.column = static_cast<int>(reader.number());
    e.where.entity = reader.text();
    return e;
  }

  std::unique_ptr<Workers> workers(unsigned threads) override {
    if (threads == 0) {
      MPI_Comm machine;
      int here = 1;
      MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
      MPI_Comm_size(machine, &here);
      MPI_Comm_free(&machine);
      threads = std::max(1u, thread_count(0) / static_cast<unsigned>(here));
    }
    return std::make_unique<MpiWorkers>(rank_, size_, thread_count(threads));
  }

 private:
  int rank_ = 0, size_ = 1;
};

}  // namespace

std::unique_ptr<Cluster> join_cluster(const Launch& launch) {
  if (!launch.several) return nullptr;
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
  auto cluster = std::make_unique<MpiCluster>();
  if (cluster->size() == 1) return nullptr;
  return cluster;
}
bool built_with_mpi() {
  return true;
}

}  // namespace burin::cli

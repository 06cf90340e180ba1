#pragma once
/// MPI in this process: begins and ends it, guards its calls, and waits for its requests.
#include <mpi.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <span>
#include <string>

#include "voxdag/core/parallel/work.hpp"

namespace voxdag {

/// A mutex that threads get in the order in which they asked for it.
///
/// A thread that takes a std::mutex again and again can keep others out for seconds. Here each
/// thread draws a number and waits for its turn. Meets BasicLockable.
class TurnLock {
 public:
  void lock() {
    const std::uint32_t mine = drawn_.fetch_add(1, std::memory_order_relaxed);
    for (std::uint32_t now; (now = turn_.load(std::memory_order_acquire)) != mine;)
      turn_.wait(now, std::memory_order_acquire);
  }
  void unlock() {
    turn_.fetch_add(1, std::memory_order_release);
    turn_.notify_all();
  }

 private:
  std::atomic<std::uint32_t> drawn_{0}, turn_{0};
};

/// Every call of MPI goes through call() or run(), which allow one thread at a time. So MPI needs
/// to support MPI_THREAD_SERIALIZED only.
///
/// Waits test requests and sleep in between, instead of MPI's own waits, which keep a CPU busy and
/// cannot be cancelled.
class MpiSession {
 public:
  /// Begins MPI. Throws Error if this process began it before, or if MPI's thread level is lower.
  explicit MpiSession(Work work);
  MpiSession(const MpiSession&) = delete;
  MpiSession& operator=(const MpiSession&) = delete;

  MPI_Comm comm() const { return comm_; }
  int rank() const { return rank_; }
  int count() const { return count_; }

  /// Calls `function` while no other thread is in MPI, and returns its error code. Throws Error if
  /// the session was stopped.
  template <class Function>
  int call(const Function& function) {
    const std::scoped_lock turn(lock_);
    if (is_stopped_) throw_stopped();
    return function();
  }
  /// Calls `function` also after the session was stopped.
  template <class Function>
  int call_always(const Function& function) {
    const std::scoped_lock turn(lock_);
    return function();
  }
  /// Calls `function`. If it returns an error, stops and throws Error("MPI: WHAT: text").
  template <class Function>
  void run(const char* what, const Function& function) {
    if (const int code = call(function); code != MPI_SUCCESS) fail(what, code);
  }

  /// Returns MPI's text for an error code.
  std::string error_text(int code);

  /// Longest sleeps between the tests of a request. Many bytes move inside the tests only, so their
  /// sleeps must be short: with 1 ms, two ranks on one computer exchanged a third fewer bytes per
  /// second.
  static constexpr std::chrono::microseconds kIdleSleep{1000}, kTransferSleep{50};

  /// Wait until requests are complete. `what` names the operation in errors. If they throw,
  /// requests are still active, and MPI may still use their buffers until the process ends. So they
  /// stop the session.
  void wait(MPI_Request& request, const char* what,
            std::chrono::microseconds longest_sleep = kIdleSleep);
  void wait_all(std::span<MPI_Request> requests, const char* what);
  /// Waits for all ranks.
  void barrier();

  /// Makes all later calls throw.
  void stop();
  bool is_stopped();

  /// Ends MPI. All ranks must call it, after a barrier.
  void finalize();
  [[noreturn]] void abort(int status);

 private:
  [[noreturn]] static void throw_stopped();
  [[noreturn]] void fail(const char* what, int code);
  void check_cancelled();
  Work work_;
  TurnLock lock_;
  bool is_stopped_ = false;
  MPI_Comm comm_ = MPI_COMM_NULL;
  int rank_ = 0, count_ = 1;
};

}  // namespace voxdag

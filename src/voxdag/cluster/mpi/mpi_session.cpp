#include "voxdag/cluster/mpi/mpi_session.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <thread>
#include <vector>

#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

/// Pauses between polls: gives the CPU away a few times, then sleeps, longer each time, up to
/// `longest`.
class Backoff {
 public:
  using Duration = std::chrono::microseconds;

  explicit Backoff(Duration longest) : longest_(longest) {}

  void pause() {
    if (yields_ < kYields) {
      ++yields_;
      std::this_thread::yield();
      return;
    }
    std::this_thread::sleep_for(sleep_);
    sleep_ = std::min(sleep_ * 2, longest_);
  }
  /// Begins with short pauses again.
  void reset() {
    yields_ = 0;
    sleep_ = kShortest;
  }

 private:
  static constexpr int kYields = 32;
  static constexpr Duration kShortest{10};

  Duration longest_, sleep_ = kShortest;
  int yields_ = 0;
};

}  // namespace

MpiSession::MpiSession(Work work) : work_(work) {
  int has_begun = 0;
  MPI_Initialized(&has_begun);
  if (has_begun != 0) throw Error("MPI: this process has joined its job already");
  int level = MPI_THREAD_SINGLE;
  run("MPI_Init_thread",
      [&] { return MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &level); });
  if (level < MPI_THREAD_SERIALIZED)
    throw Error(
        "MPI: this library serves one thread only; voxdag needs one that supports "
        "MPI_THREAD_SERIALIZED");
  MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
  run("MPI_Comm_dup", [&] { return MPI_Comm_dup(MPI_COMM_WORLD, &comm_); });
  MPI_Comm_set_errhandler(comm_, MPI_ERRORS_RETURN);
  run("MPI_Comm_rank", [&] { return MPI_Comm_rank(comm_, &rank_); });
  run("MPI_Comm_size", [&] { return MPI_Comm_size(comm_, &count_); });
}

std::string MpiSession::error_text(int code) {
  const std::scoped_lock turn(lock_);
  std::array<char, MPI_MAX_ERROR_STRING + 1> text{};
  int length = 0;
  if (MPI_Error_string(code, text.data(), &length) != MPI_SUCCESS)
    return "error " + std::to_string(code);
  return {text.data(), static_cast<std::size_t>(length)};
}

void MpiSession::wait(MPI_Request& request, const char* what,
                      std::chrono::microseconds longest_sleep) {
  for (Backoff backoff(longest_sleep);; backoff.pause()) {
    int is_done = 0;
    run(what, [&] { return MPI_Test(&request, &is_done, MPI_STATUS_IGNORE); });
    if (is_done != 0) return;
    check_cancelled();
  }
}

void MpiSession::wait_all(std::span<MPI_Request> requests, const char* what) {
  const int count = static_cast<int>(requests.size());
  std::vector<int> indices(requests.size());
  std::vector<MPI_Status> statuses(requests.size());
  int left = count;
  for (Backoff backoff(kTransferSleep); left > 0;) {
    int done = 0;
    const int code = call([&] {
      return MPI_Testsome(count, requests.data(), &done, indices.data(), statuses.data());
    });
    if (code == MPI_ERR_IN_STATUS)
      for (int i = 0; i < done; ++i)
        if (statuses[i].MPI_ERROR != MPI_SUCCESS) fail(what, statuses[i].MPI_ERROR);
    if (code != MPI_SUCCESS) fail(what, code);
    left -= done;
    check_cancelled();
    if (done > 0)
      backoff.reset();
    else
      backoff.pause();
  }
}

void MpiSession::barrier() {
  MPI_Request request = MPI_REQUEST_NULL;
  run("MPI_Ibarrier", [&] { return MPI_Ibarrier(comm_, &request); });
  wait(request, "MPI_Ibarrier");
}

void MpiSession::stop() {
  const std::scoped_lock turn(lock_);
  is_stopped_ = true;
}

bool MpiSession::is_stopped() {
  const std::scoped_lock turn(lock_);
  return is_stopped_;
}

void MpiSession::finalize() {
  const std::scoped_lock turn(lock_);
  is_stopped_ = true;
  MPI_Comm_free(&comm_);
  MPI_Finalize();
}

void MpiSession::abort(int status) {
  {
    const std::scoped_lock turn(lock_);
    is_stopped_ = true;
    MPI_Abort(MPI_COMM_WORLD, status);
  }
  ::_exit(status);
}

void MpiSession::throw_stopped() {
  throw Error("MPI: an operation failed or was cancelled before; only abort() is possible");
}

void MpiSession::fail(const char* what, int code) {
  const std::string text = error_text(code);
  stop();
  throw Error(std::string("MPI: ") + what + ": " + text);
}

void MpiSession::check_cancelled() {
  if (!work_.cancelled()) return;
  stop();
  throw Cancelled();
}

}  // namespace voxdag

#include "voxdag/cluster/mpi/mpi_counters.hpp"

#include <chrono>

namespace voxdag {

MpiCounters::MpiCounters(MpiSession& session, int counters) : session_(session) {
  constexpr int kStride = sizeof(std::uint64_t);
  session.run("MPI_Win_allocate", [&] {
    const MPI_Aint bytes = session.rank() == 0 ? MPI_Aint{counters} * kStride : 0;
    return MPI_Win_allocate(bytes, kStride, MPI_INFO_NULL, session.comm(), &values_, &window_);
  });
  MPI_Win_set_errhandler(window_, MPI_ERRORS_RETURN);
  session.run("MPI_Win_lock_all", [&] { return MPI_Win_lock_all(0, window_); });
  if (session.rank() == 0)
    for (int counter = 0; counter < counters; ++counter) set_zero(counter);
  session.barrier();
  if (session.rank() == 0 && session.count() > 1)
    server_ = std::jthread([this](const std::stop_token& stop) { serve(stop); });
}

std::uint64_t MpiCounters::next(int counter) { return fetch(counter, 1, MPI_SUM); }

std::optional<std::uint64_t> MpiCounters::next_after_failure(int counter) {
  constexpr int kMostTests = 1000;  // of a millisecond
  MPI_Request request = MPI_REQUEST_NULL;
  int code =
      session_.call_always([&] { return begin_fetch(counter, one_, answer_, MPI_SUM, request); });
  for (int test = 0; code == MPI_SUCCESS && test < kMostTests; ++test) {
    int is_done = 0;
    code = session_.call_always([&] { return MPI_Test(&request, &is_done, MPI_STATUS_IGNORE); });
    if (code == MPI_SUCCESS && is_done != 0) return answer_;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return std::nullopt;
}

void MpiCounters::set_zero(int counter) { fetch(counter, 0, MPI_REPLACE); }

/// Does what MPI_Fetch_and_op does, but gives a request, so that the wait can be cancelled. The
/// request is complete when the old value has arrived.
int MpiCounters::begin_fetch(int counter, const std::uint64_t& value, std::uint64_t& old,
                             MPI_Op operation, MPI_Request& request) {
  return MPI_Rget_accumulate(&value, 1, MPI_UINT64_T, &old, 1, MPI_UINT64_T, 0, counter, 1,
                             MPI_UINT64_T, operation, window_, &request);
}

std::uint64_t MpiCounters::fetch(int counter, std::uint64_t value, MPI_Op operation) {
  std::uint64_t old = 0;
  MPI_Request request = MPI_REQUEST_NULL;
  session_.run("MPI_Rget_accumulate",
               [&] { return begin_fetch(counter, value, old, operation, request); });
  session_.wait(request, "MPI_Rget_accumulate");
  return old;
}

void MpiCounters::serve(const std::stop_token& stop) {
  // Other ranks may call next_after_failure() after this one was stopped.
  while (!stop.stop_requested()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    session_.call_always([] {
      // Finds nothing, because nobody sends here; MPI serves its network meanwhile.
      int found = 0;
      return MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_SELF, &found, MPI_STATUS_IGNORE);
    });
  }
}

void MpiCounters::close() {
  if (server_.joinable()) {
    server_.request_stop();
    server_.join();
  }
  session_.run("MPI_Win_unlock_all", [&] { return MPI_Win_unlock_all(window_); });
  session_.run("MPI_Win_free", [&] { return MPI_Win_free(&window_); });
}

}  // namespace voxdag

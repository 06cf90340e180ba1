#include "voxdag/cluster/mpi/mpi_counters.hpp"

#include <array>
#include <chrono>

#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

constexpr int kQuestion = 1, kAnswer = 2;  // tags

}  // namespace

MpiCounters::MpiCounters(MpiSession& session, int counters)
    : session_(session), values_(static_cast<std::size_t>(counters)) {
  session.run("MPI_Comm_dup", [&] { return MPI_Comm_dup(session.comm(), &comm_); });
  MPI_Comm_set_errhandler(comm_, MPI_ERRORS_RETURN);
  session.barrier();
  if (session.rank() == 0 && session.count() > 1)
    server_ = std::jthread([this](const std::stop_token& stop) { serve(stop); });
}

std::uint64_t MpiCounters::next(int counter) {
  if (session_.rank() == 0) return draw(counter);
  const std::lock_guard one_question(mutex_);
  question_ = counter;
  std::array<MPI_Request, 2> requests = {MPI_REQUEST_NULL, MPI_REQUEST_NULL};
  session_.run("MPI_Irecv", [&] {
    return MPI_Irecv(&answer_, 1, MPI_UINT64_T, 0, kAnswer, comm_, &requests[0]);
  });
  session_.run("MPI_Isend", [&] {
    return MPI_Isend(&question_, 1, MPI_INT, 0, kQuestion, comm_, &requests[1]);
  });
  session_.wait_all(requests, "MPI_Isend and MPI_Irecv");
  return answer_;
}

std::uint64_t MpiCounters::draw(int counter) {
  const std::lock_guard guard(mutex_);
  return values_[static_cast<std::size_t>(counter)]++;
}

void MpiCounters::set_zero(int counter) {
  const std::lock_guard guard(mutex_);
  values_[static_cast<std::size_t>(counter)] = 0;
}

void MpiCounters::serve(const std::stop_token& stop) {
  try {
    while (!stop.stop_requested())
      if (!answer()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  } catch (const Cancelled&) {
  } catch (const Error&) {
    // The session was stopped.
  }
}

bool MpiCounters::answer() {
  int found = 0, counter = 0;
  MPI_Status status;
  session_.run("MPI_Iprobe",
               [&] { return MPI_Iprobe(MPI_ANY_SOURCE, kQuestion, comm_, &found, &status); });
  if (found == 0) return false;
  session_.run("MPI_Recv", [&] {
    return MPI_Recv(&counter, 1, MPI_INT, status.MPI_SOURCE, kQuestion, comm_, MPI_STATUS_IGNORE);
  });
  answer_ = draw(counter);
  MPI_Request request = MPI_REQUEST_NULL;
  session_.run("MPI_Isend", [&] {
    return MPI_Isend(&answer_, 1, MPI_UINT64_T, status.MPI_SOURCE, kAnswer, comm_, &request);
  });
  session_.wait(request, "MPI_Isend");
  return true;
}

void MpiCounters::close() {
  if (server_.joinable()) {
    server_.request_stop();
    server_.join();
  }
  session_.run("MPI_Comm_free", [&] { return MPI_Comm_free(&comm_); });
}

}  // namespace voxdag

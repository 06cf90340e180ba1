#include "voxdag/cluster/mpi/mpi_counters.hpp"

#include <chrono>

namespace voxdag {
namespace {

// Tags of questions; the tag of an answer is one more.
constexpr int kQuestion = 1, kLastQuestion = 3;

constexpr std::chrono::milliseconds kPause{1};

}  // namespace

MpiCounters::MpiCounters(MpiSession& session, int counters)
    : session_(session), values_(static_cast<std::size_t>(counters)) {
  session.run("MPI_Comm_dup", [&] { return MPI_Comm_dup(session.comm(), &comm_); });
  MPI_Comm_set_errhandler(comm_, MPI_ERRORS_RETURN);
  session.barrier();
  if (session.rank() == 0 && session.count() > 1)
    server_ = std::jthread([this](const std::stop_token& stop) { serve(stop); });
}

int MpiCounters::ask(Message& message, int tag) {
  const int code =
      MPI_Irecv(&message.answer, 1, MPI_UINT64_T, 0, tag + 1, comm_, &message.requests[0]);
  if (code != MPI_SUCCESS) return code;
  return MPI_Isend(&message.counter, 1, MPI_INT, 0, tag, comm_, &message.requests[1]);
}

std::uint64_t MpiCounters::next(int counter) {
  if (session_.rank() == 0) return draw(counter);
  const std::lock_guard one_question(mutex_);
  message_.counter = counter;
  session_.run("MPI_Isend", [&] { return ask(message_, kQuestion); });
  session_.wait_all(message_.requests, "MPI_Isend and MPI_Irecv");
  return message_.answer;
}

std::optional<std::uint64_t> MpiCounters::next_after_failure(int counter) {
  if (session_.rank() == 0) return draw(counter);
  constexpr int kMaxTests = 1000;
  last_message_.counter = counter;
  int code = session_.call_always([&] { return ask(last_message_, kLastQuestion); });
  for (int test = 0; code == MPI_SUCCESS && test < kMaxTests; ++test) {
    int is_done = 0;
    code = session_.call_always(
        [&] { return MPI_Testall(2, last_message_.requests, &is_done, MPI_STATUSES_IGNORE); });
    if (code == MPI_SUCCESS && is_done != 0) return last_message_.answer;
    std::this_thread::sleep_for(kPause);
  }
  return std::nullopt;
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
  while (!stop.stop_requested())
    if (!answer(stop)) std::this_thread::sleep_for(kPause);
}

bool MpiCounters::answer(const std::stop_token& stop) {
  int found = 0, counter = 0;
  MPI_Status status;
  MPI_Request request = MPI_REQUEST_NULL;
  const int code = session_.call_always([&] {
    int error = MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, comm_, &found, &status);
    if (error != MPI_SUCCESS || found == 0) return error;
    error =
        MPI_Recv(&counter, 1, MPI_INT, status.MPI_SOURCE, status.MPI_TAG, comm_, MPI_STATUS_IGNORE);
    if (error != MPI_SUCCESS) return error;
    reply_ = draw(counter);
    return MPI_Isend(&reply_, 1, MPI_UINT64_T, status.MPI_SOURCE, status.MPI_TAG + 1, comm_,
                     &request);
  });
  int error = code;
  for (int is_done = 0; error == MPI_SUCCESS && found != 0 && is_done == 0;) {
    if (stop.stop_requested()) return false;
    error = session_.call_always([&] { return MPI_Test(&request, &is_done, MPI_STATUS_IGNORE); });
  }
  // Makes this rank's next call fail, which ends the job. Otherwise the asker would wait forever.
  if (error != MPI_SUCCESS) session_.stop();
  return error == MPI_SUCCESS && found != 0;
}

void MpiCounters::close() {
  if (server_.joinable()) {
    server_.request_stop();
    server_.join();
  }
  session_.run("MPI_Comm_free", [&] { return MPI_Comm_free(&comm_); });
}

}  // namespace voxdag

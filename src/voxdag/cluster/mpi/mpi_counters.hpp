#pragma once
/// Counters that rank 0 keeps and all ranks draw from.
///
/// A rank asks rank 0 with a message, and waits for the answer. One-sided MPI would need no server,
/// but Debian's Open MPI disables it between hosts over TCP.
#include <mpi.h>

#include <cstdint>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "voxdag/cluster/mpi/mpi_session.hpp"

namespace voxdag {

/// Rank 0 has a thread that answers, so its other threads need not call anything.
class MpiCounters {
 public:
  /// Makes the counters, all 0. Collective.
  MpiCounters(MpiSession& session, int counters);
  MpiCounters(const MpiCounters&) = delete;
  MpiCounters& operator=(const MpiCounters&) = delete;

  /// Returns the value of a counter and adds 1. Any thread may call it.
  std::uint64_t next(int counter);
  /// Draws as next() does, also after the session was stopped. Returns nothing if rank 0 does not
  /// answer within a second. Call it once.
  std::optional<std::uint64_t> next_after_failure(int counter);
  /// Sets a counter to 0. Other ranks must not draw from it meanwhile. Called on rank 0.
  void set_zero(int counter);
  /// Ends the answers. Collective, after a barrier; before MPI_Finalize.
  void close();

 private:
  /// The buffers of a question, which MPI may use after its wait was cancelled.
  struct Message {
    int counter = 0;
    std::uint64_t answer = 0;
    MPI_Request requests[2] = {MPI_REQUEST_NULL, MPI_REQUEST_NULL};
  };

  /// Begins to ask rank 0. Returns MPI's error code.
  int ask(Message& message, int tag);
  std::uint64_t draw(int counter);
  void serve(const std::stop_token& stop);
  /// Answers a question if there is one; returns whether there was. Works after the session was
  /// stopped.
  bool answer(const std::stop_token& stop);

  MpiSession& session_;
  MPI_Comm comm_ = MPI_COMM_NULL;      ///< For these messages only.
  std::mutex mutex_;                   ///< Rank 0: guards values_. Others: allows one question.
  std::vector<std::uint64_t> values_;  ///< On rank 0.
  Message message_, last_message_;
  std::uint64_t reply_ = 0;  ///< The server's.
  std::jthread server_;      ///< On rank 0.
};

}  // namespace voxdag

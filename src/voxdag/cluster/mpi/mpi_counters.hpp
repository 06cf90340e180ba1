#pragma once
/// Counters in the memory of rank 0 that all ranks change with one-sided operations.
#include <mpi.h>

#include <cstdint>
#include <optional>
#include <thread>

#include "voxdag/cluster/mpi/mpi_session.hpp"

namespace voxdag {

/// Rank 0 need not call anything while others draw numbers. Where the network has no hardware for
/// that (TCP), MPI serves other ranks only inside its calls. So rank 0 has a thread that calls MPI
/// every millisecond.
class MpiCounters {
 public:
  /// Makes the counters, all 0. Collective.
  MpiCounters(MpiSession& session, int counters);
  MpiCounters(const MpiCounters&) = delete;
  MpiCounters& operator=(const MpiCounters&) = delete;

  /// Returns the value of a counter and adds 1.
  std::uint64_t next(int counter);
  /// Does what next() does, also after the session was stopped. Returns nothing if rank 0 does not
  /// answer within a second. Call it once.
  std::optional<std::uint64_t> next_after_failure(int counter);
  /// Sets a counter to 0. Other ranks must not draw from it meanwhile. Called on one rank.
  void set_zero(int counter);
  /// Frees the counters. Collective, after a barrier; before MPI_Finalize.
  void close();

 private:
  std::uint64_t fetch(int counter, std::uint64_t value, MPI_Op operation);
  int begin_fetch(int counter, const std::uint64_t& value, std::uint64_t& old, MPI_Op operation,
                  MPI_Request& request);
  void serve(const std::stop_token& stop);

  MpiSession& session_;
  std::uint64_t* values_ = nullptr;
  MPI_Win window_ = MPI_WIN_NULL;
  std::uint64_t one_ = 1, answer_ = 0;  ///< Of next_after_failure(): MPI may use them later.
  std::jthread server_;                 ///< On rank 0 only.
};

}  // namespace voxdag

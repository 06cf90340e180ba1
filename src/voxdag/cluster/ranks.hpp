#pragma once
/// The processes that share one job, and the operations that connect them.
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

namespace voxdag {

/// A file that several ranks write. SharedFile (shared_file.hpp) adds a temporary name to it.
class RankFile {
 public:
  virtual ~RankFile() = default;
  /// Writes bytes at an offset in bytes. Not collective. Ranks must write disjoint ranges.
  /// Throws Error(path, "byte OFFSET", the system's reason).
  virtual void write_at(std::uint64_t offset, std::span<const std::byte> bytes) = 0;
  /// Closes the file; afterwards all ranks see all bytes. Collective. Throws Error on the rank that
  /// fails.
  virtual void close() = 0;
};

/// The processes that share one job: the ranks. join_ranks() makes the object. One process alone is
/// rank 0 of 1.
///
/// Every rank must call the collective functions, in one order, and from one thread at a time. The
/// other functions may be called by any thread at any time.
///
/// A function that waits for other ranks throws Cancelled if the Progress of join_ranks() is
/// cancelled, and Error("MPI: ...") if MPI reports an error. After either of them this rank can
/// only call fails_first() and abort(); its other functions throw. A rank that is to end because of
/// any exception must call abort(): the others would wait for it.
class Ranks {
 public:
  /// Number of the counters that next() offers.
  static constexpr int kCounters = 16;

  Ranks() = default;
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;
  /// Waits for all ranks and leaves the job, unless a function failed or an exception is in flight.
  virtual ~Ranks() = default;

  /// Returns the number of this process: 0 to count() - 1.
  virtual int rank() const = 0;
  /// Returns the number of ranks, 1 or more.
  virtual int count() const = 0;

  /// Waits until all ranks are here. Collective.
  virtual void barrier() = 0;
  /// Returns the values of all ranks, those of rank 0 first. All ranks give equally many values, at
  /// most 2³¹ - 1. Collective.
  virtual std::vector<std::uint64_t> all_gather(std::span<const std::uint64_t> values) = 0;
  /// Replaces `bytes` by those of rank 0, of any size. Collective.
  virtual void broadcast(std::vector<std::byte>& bytes) = 0;
  /// Sends outgoing[r] to rank r, and returns what each rank sent here: element r is from rank r.
  /// `outgoing` has count() elements of any sizes. Memory: the bytes sent and those received.
  /// Collective.
  virtual std::vector<std::vector<std::byte>> exchange(
      std::vector<std::vector<std::byte>> outgoing) = 0;

  /// Returns the value of a counter that all ranks share, and adds 1 to it. Counters begin at 0.
  /// `counter` is 0 to kCounters - 1. Not collective: no other rank needs to call anything.
  virtual std::uint64_t next(int counter) = 0;
  /// Sets a counter to 0. Collective.
  virtual void reset(int counter) = 0;

  /// Opens an existing file for writing. Collective. Throws Error on the rank that fails.
  virtual std::unique_ptr<RankFile> open_file(const std::filesystem::path& path) = 0;

  /// Returns whether this is the first rank that calls it, so that only one rank reports a failure
  /// that many have. Not collective. Waits a second at most, and then returns true.
  virtual bool fails_first() = 0;
  /// Ends all ranks with this exit status (1 to 255) at once, without waiting for them.
  [[noreturn]] virtual void abort(int status) = 0;

  /// Returns the bytes that this rank sent to other ranks so far. Counts what all_gather(),
  /// broadcast() and exchange() were given, once for each receiver.
  virtual std::uint64_t bytes_sent() const = 0;
};

}  // namespace voxdag

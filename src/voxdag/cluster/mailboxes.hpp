#pragma once
/// Messages between the owners of a distributed table.
///
/// A step of a job sends messages to numbered mailboxes; a later step reads them. Mailbox b belongs
/// to rank b % ranks, which keeps it as a file of the work folder. There can be many more mailboxes
/// than ranks: then a rank handles one after the other, and needs memory for one.
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "voxdag/cluster/ranks.hpp"
#include "voxdag/cluster/work_folder.hpp"
#include "voxdag/core/memory_budget.hpp"
#include "voxdag/core/parallel/polled_for.hpp"

namespace voxdag {

/// The mailboxes that one step fills. All ranks make it and close it; send() and close() may wait
/// for the other ranks. The order of the messages in a mailbox depends on timing.
class Mailboxes {
 public:
  /// Makes `count` empty mailboxes with the files NAME-0, NAME-1, ... `budget` counts their
  /// buffers, up to a quarter of what is left. Throws Error and OverMemory.
  Mailboxes(Ranks& ranks, const WorkFolder& folder, const std::string& name, std::uint32_t count,
            MemoryBudget& budget);

  /// Collects the messages of one thread.
  class Sender {
   public:
    explicit Sender(Mailboxes& mailboxes);
    /// Sends a message of at most 1024 bytes. Throws Error and Cancelled.
    void send(std::uint32_t mailbox, std::span<const std::byte> message);
    template <class T>
    void send_value(std::uint32_t mailbox, const T& value) {
      send(mailbox, std::as_bytes(std::span<const T>(&value, 1)));
    }
    /// Passes all messages on; call it at the end. Throws Error and Cancelled.
    void flush();

   private:
    Mailboxes& mailboxes_;
    MemoryReservation memory_;
    std::vector<std::vector<std::byte>> messages_;  ///< By mailbox.
  };

  /// Ends the step, when all senders have flushed: the mailboxes of this rank are complete. Throws
  /// Error and Cancelled.
  void close();

 private:
  /// A mailbox of this rank.
  struct Own {
    explicit Own(WorkFileWriter writer) : file(std::move(writer)) {}
    std::mutex mutex;
    WorkFileWriter file;
  };

  /// Takes the messages of a mailbox. Thread-safe.
  void put(std::uint32_t mailbox, std::span<const std::byte> messages);
  void put_own(std::uint32_t mailbox, std::span<const std::byte> messages);
  /// Sends the messages that wait for other ranks. Returns whether all ranks have closed.
  bool exchange(bool is_closed);

  Ranks& ranks_;
  std::uint32_t count_;
  MemoryBudget& budget_;
  std::size_t buffer_bytes_;  ///< Of each mailbox, and of each in a sender.
  MemoryReservation memory_;
  std::vector<std::unique_ptr<Own>> own_;  ///< By mailbox / ranks.
  std::mutex outgoing_mutex_;
  std::vector<std::vector<std::byte>> outgoing_;  ///< By rank.
};

/// Calls body(mailbox) for the mailboxes of a rank, on all threads. Throws Cancelled.
template <class Body>
void for_each_own(const Ranks& ranks, std::uint32_t mailboxes, Work work, const Body& body) {
  const auto rank = static_cast<std::uint32_t>(ranks.rank()),
             count = static_cast<std::uint32_t>(ranks.count());
  const std::uint32_t own = mailboxes > rank ? (mailboxes - rank - 1) / count + 1 : 0;
  parallel_for(own, [&](std::size_t i) {
    work.poll();
    body(rank + static_cast<std::uint32_t>(i) * count);
  });
}

/// Returns the name of a mailbox's file.
std::string mailbox_name(const std::string& name, std::uint32_t mailbox);

/// Returns a number of mailboxes, at least one for each rank, for data that need `bytes` of memory
/// in all ranks together. The mailboxes that all threads of a rank handle at once need at most a
/// quarter of what is left of the budget. Ranks with other numbers of threads get other results;
/// use that of rank 0. Throws OverMemory if more than 4096 would be needed. Collective.
std::uint32_t mailboxes_of(Ranks& ranks, std::uint64_t bytes, const MemoryBudget& budget);

/// Returns whether a step is done, as rank 0 sees it. Collective.
bool is_done_for_all(Ranks& ranks, const WorkFolder& folder, const std::string& step);
/// Waits until all ranks have finished a step and notes that it is done. Collective.
void mark_done_for_all(Ranks& ranks, const WorkFolder& folder, const std::string& step);

}  // namespace voxdag

#include "voxdag/cluster/mailboxes.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "voxdag/core/parallel/thread_count.hpp"

namespace voxdag {
namespace {

/// A rank exchanges messages when the bytes for one other rank reach kMaxWaiting divided by the
/// number of ranks, but at least kMinWaiting.
constexpr std::uint64_t kMaxWaiting = std::uint64_t{8} << 20, kMinWaiting = std::uint64_t{64} << 10;

/// Bytes that a sender collects for a mailbox, and that a mailbox collects before it writes.
constexpr std::uint64_t kMinBuffer = 1024, kMaxBuffer = std::uint64_t{16} << 10;

/// Returns the bytes of the buffers of `count` mailboxes and of a sender for each thread, which may
/// take a quarter of what is left.
std::size_t buffer_bytes(const MemoryBudget& budget, std::uint32_t count) {
  constexpr std::uint64_t kUsers = 2 + 4;  // the mailboxes, and some threads
  return static_cast<std::size_t>(
      std::clamp(budget.left() / 4 / kUsers / std::max(count, 1u), kMinBuffer, kMaxBuffer));
}

/// Precedes messages to another rank.
struct Envelope {
  std::uint32_t mailbox;
  std::uint32_t bytes;
};

}  // namespace

std::string mailbox_name(const std::string& name, std::uint32_t mailbox) {
  return numbered_name(name, mailbox);
}

Mailboxes::Mailboxes(Ranks& ranks, const WorkFolder& folder, const std::string& name,
                     std::uint32_t count, MemoryBudget& budget)
    : ranks_(ranks),
      count_(count),
      budget_(budget),
      buffer_bytes_(buffer_bytes(budget, count)),
      outgoing_(static_cast<std::size_t>(ranks.count())) {
  for (auto box = static_cast<std::uint32_t>(ranks.rank()); box < count_;
       box += static_cast<std::uint32_t>(ranks.count()))
    own_.push_back(std::make_unique<Own>(folder.create(mailbox_name(name, box), buffer_bytes_)));
  memory_ = MemoryReservation(
      &budget, own_.size() * buffer_bytes_ + (ranks.count() > 1 ? 2 * kMaxWaiting : 0));
}

Mailboxes::Sender::Sender(Mailboxes& mailboxes)
    : mailboxes_(mailboxes),
      memory_(&mailboxes.budget_, mailboxes.count_ * mailboxes.buffer_bytes_),
      messages_(mailboxes.count_) {}

void Mailboxes::Sender::send(std::uint32_t mailbox, std::span<const std::byte> message) {
  std::vector<std::byte>& waiting = messages_[mailbox];
  if (waiting.size() + message.size() > mailboxes_.buffer_bytes_) {
    mailboxes_.put(mailbox, waiting);
    waiting.clear();
  }
  if (waiting.capacity() == 0) waiting.reserve(mailboxes_.buffer_bytes_);
  waiting.insert(waiting.end(), message.begin(), message.end());
}

void Mailboxes::Sender::flush() {
  for (std::uint32_t mailbox = 0; mailbox < messages_.size(); ++mailbox) {
    if (messages_[mailbox].empty()) continue;
    mailboxes_.put(mailbox, messages_[mailbox]);
    messages_[mailbox].clear();
  }
}

void Mailboxes::put_own(std::uint32_t mailbox, std::span<const std::byte> messages) {
  Own& own = *own_[mailbox / static_cast<std::uint32_t>(ranks_.count())];
  const std::lock_guard guard(own.mutex);
  own.file.write(messages);
}

void Mailboxes::put(std::uint32_t mailbox, std::span<const std::byte> messages) {
  const auto rank = mailbox % static_cast<std::uint32_t>(ranks_.count());
  if (rank == static_cast<std::uint32_t>(ranks_.rank())) return put_own(mailbox, messages);
  const Envelope envelope{mailbox, static_cast<std::uint32_t>(messages.size())};
  const auto head = std::as_bytes(std::span<const Envelope>(&envelope, 1));
  const std::lock_guard guard(outgoing_mutex_);
  outgoing_[rank].insert(outgoing_[rank].end(), head.begin(), head.end());
  outgoing_[rank].insert(outgoing_[rank].end(), messages.begin(), messages.end());
  // Each rank then receives at most about kMaxWaiting at once.
  const auto ranks = static_cast<std::uint64_t>(ranks_.count());
  if (outgoing_[rank].size() >= std::max(kMaxWaiting / ranks, kMinWaiting)) exchange(false);
}

bool Mailboxes::exchange(bool is_closed) {
  const std::uint64_t mine = is_closed ? 1 : 0;
  const std::vector<std::uint64_t> closed = ranks_.all_gather({&mine, 1});
  const std::vector<std::vector<std::byte>> incoming = ranks_.exchange(std::move(outgoing_));
  outgoing_.assign(static_cast<std::size_t>(ranks_.count()), {});
  for (const std::vector<std::byte>& bytes : incoming)
    for (std::size_t at = 0; at < bytes.size();) {
      Envelope envelope;
      std::memcpy(&envelope, bytes.data() + at, sizeof envelope);
      at += sizeof envelope;
      put_own(envelope.mailbox, std::span(bytes).subspan(at, envelope.bytes));
      at += envelope.bytes;
    }
  return std::all_of(closed.begin(), closed.end(), [](std::uint64_t c) { return c != 0; });
}

void Mailboxes::close() {
  if (ranks_.count() > 1)
    while (!exchange(true)) {
    }
  for (const auto& own : own_) own->file.commit();
  own_.clear();
  ranks_.barrier();
}

std::uint32_t mailboxes_of(Ranks& ranks, std::uint64_t bytes, const MemoryBudget& budget) {
  constexpr std::uint32_t kMaxMailboxes = 4096;
  std::uint64_t left = budget.left();
  for (const std::uint64_t of_rank : ranks.all_gather({&left, 1})) left = std::min(left, of_rank);
  // Threads handle mailboxes side by side; little data is not worth many files.
  constexpr std::uint64_t kLittle = std::uint64_t{8} << 20;
  const auto threads = static_cast<std::uint64_t>(thread_count()),
             count = static_cast<std::uint64_t>(ranks.count());
  const std::uint64_t needed = bytes / std::max<std::uint64_t>(left / 4 / threads, 1) + 1;
  // So a mailbox has fewer than 2^32 different records, if each counts for 16 bytes or more.
  const std::uint64_t least = std::max(count, bytes >> 36);
  const std::uint64_t wanted = std::max({least, needed, bytes < kLittle ? 1 : 2 * count * threads});
  if (needed > kMaxMailboxes && needed > count)
    budget.throw_over_memory(budget.base() + budget.used() + bytes / kMaxMailboxes * 4 * threads);
  return static_cast<std::uint32_t>(wanted);
}

bool is_done_for_all(Ranks& ranks, const WorkFolder& folder, const std::string& step) {
  const std::uint64_t is_done = ranks.rank() == 0 && folder.is_done(step) ? 1 : 0;
  return ranks.all_gather({&is_done, 1})[0] != 0;
}

void mark_done_for_all(Ranks& ranks, const WorkFolder& folder, const std::string& step) {
  ranks.barrier();
  if (ranks.rank() == 0) folder.mark_done(step);
  ranks.barrier();
}

}  // namespace voxdag

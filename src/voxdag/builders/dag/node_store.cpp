#include "voxdag/builders/dag/node_store.hpp"

#include <algorithm>
#include <cstring>

#include "voxdag/core/error.hpp"

namespace voxdag {

void NodeStore::prefetch_found([[maybe_unused]] std::uint64_t hash) const {
#ifndef __wasm__  // It has no prefetch.
  NodeId id = 0;
  if (table_.find_tag(hash, id)) __builtin_prefetch(words(id));
#endif
}

NodeId NodeStore::intern(const std::uint32_t* words, int count, std::uint64_t hash, Run& run) {
  const auto size = static_cast<std::uint32_t>(count);
  return table_.find_or_add(
      hash, size,
      [&](NodeId id) {
        const std::uint32_t* stored = this->words(id);
        // If the first words are equal, the lengths are equal, so the other words may be read.
        return stored[0] == words[0] && std::equal(words + 1, words + count, stored + 1);
      },
      [&] {
        if (run.end - run.next < size) take_run(run);
        std::memcpy(this->words(run.next), words, std::size_t{size} * 4);
        return run.next;
      },
      [&] { run.next += size; });
}

void NodeStore::take_run(Run& run) {
  const std::lock_guard guard(runs_mutex_);
  const int chunk = chunk_of(end_);
  const int bits = std::min(kFirstChunkBits + chunk - kRunsBits, kMaxRunBits);
  const std::uint32_t words = 1u << bits;
  // The last id plus one must fit in a slot.
  if (end_ > kNoNode - words)
    throw Error("the DAG is too large: one level has more words than 32-bit pointers can address");
  const std::size_t chunk_words = std::size_t{1} << (kFirstChunkBits + chunk);
  std::uint64_t bytes = std::uint64_t{words} * 4;
  // Large chunks become resident in whole huge pages.
  if (chunk_words * 4 >= kHugePage)
    bytes = std::uint64_t{end_ - chunk_begin(chunk)} * 4 % kHugePage == 0 ? kHugePage : 0;
  MemoryReservation reserved(budget_, bytes);
  if (chunks_[chunk].empty()) chunks_[chunk] = PageVector<std::uint32_t>::zeros(chunk_words);
  reserved.keep();
  run = {end_, end_ + words};
  end_ += words;
  word_bytes_ += bytes;
}

void NodeStore::release() {
  release_slots();
  for (auto& chunk : chunks_) chunk.release();
  budget_->release(std::exchange(word_bytes_, 0));
  end_ = 0;
}

}  // namespace voxdag

#pragma once
/// Many records, written in parallel and copied one by one.
#include <cstdint>
#include <vector>

#include "voxdag/core/memory_budget.hpp"
#include "voxdag/core/parallel/polled_for.hpp"
#include "voxdag/stored/compact/bit_stream.hpp"

namespace voxdag {

class EncodedRecords {
 public:
  explicit EncodedRecords(MemoryBudget* budget) : begins_(budget), budget_(budget) {}

  /// Writes `count` records. Each task calls make_writer() for a writer of its own, and
  /// encode(i, writer) for each of its records, which appends record i to writer.bits, a BitWriter.
  template <class MakeWriter, class Encode>
  void write(std::size_t count, Work work, const MakeWriter& make_writer, const Encode& encode) {
    begins_.resize(count + 1);
    parts_.resize((count + kPart - 1) / kPart);
    polled_for(parts_.size(), 1, work, "encode", [&](std::size_t part) {
      auto writer = make_writer();
      const std::size_t end = std::min(count, (part + 1) * kPart);
      for (std::size_t i = part * kPart; i < end; ++i) {
        begins_[i] = static_cast<std::uint32_t>(writer.bits.bits());
        encode(i, writer);
      }
      parts_[part].bits = writer.bits.bits();
      parts_[part].words = writer.bits.finish();
      parts_[part].memory = MemoryReservation(budget_, parts_[part].words.size() * 4);
    });
  }

  /// Returns the number of bits of record i.
  std::uint64_t bits(std::size_t i) const {
    const bool last = i % kPart == kPart - 1 || i + 2 == begins_.size();
    return (last ? parts_[i / kPart].bits : begins_[i + 1]) - begins_[i];
  }
  /// Appends record i to `out`.
  void copy(std::size_t i, BitWriter& out) const {
    out.copy(parts_[i / kPart].words.data(), begins_[i], bits(i));
  }

 private:
  static constexpr std::size_t kPart = 512;  ///< A record has less than 2^23 bits.
  struct Part {
    std::vector<std::uint32_t> words;
    std::uint64_t bits = 0;
    MemoryReservation memory;
  };

  CountedVector<std::uint32_t> begins_;  ///< Of each record in its part.
  std::vector<Part> parts_;
  MemoryBudget* budget_;
};

}  // namespace voxdag

#pragma once
/// The contexts in which the wire form codes the runs of material ids. docs/format.md lists them.
#include <algorithm>
#include <cstdint>

#include "voxdag/stored/attributes/material_ids.hpp"
#include "voxdag/stored/wire/range_coder.hpp"

namespace voxdag::wire {

/// The adaptive contexts, and the fields that choose among them. About 600 KB.
class MaterialModel {
 public:
  explicit MaterialModel(int id_bits) : id_bits_(id_bits) {}

  /// Does what ValueModel::code_page() does, for a page of runs.
  template <class Coder, class Bits>
  bool code_page(Coder& coder, Bits& bits) {
    std::uint32_t begin = 0;  ///< Of the run, in the page.
    int length_before = 0;
    for (;;) {
      if (!bits.has_room(id_bits_ + MaterialRun::kLastBits)) return false;
      const std::uint32_t id = code_id(coder, static_cast<std::uint32_t>(bits.take(id_bits_)));
      bits.put(id_bits_, id);
      const std::uint32_t slot = id * kSpread >> (32 - kSlotBits);
      const std::uint32_t left = std::min<std::uint32_t>(begin, kPageValues - 1) / 32;
      const bool is_last =
          coder.code(lasts_[left][slot][length_before], bits.take(MaterialRun::kLastBits) != 0);
      bits.put(MaterialRun::kLastBits, is_last ? 1 : 0);
      if (is_last) return true;
      if (!bits.has_room(MaterialRun::kLengthBits)) return false;
      const std::uint32_t below = sizes_[slot][length_before].code(
          coder, static_cast<std::uint32_t>(bits.take(MaterialRun::kLengthBits)));
      bits.put(MaterialRun::kLengthBits, below);
      const int width = static_cast<int>(below);
      if (!bits.has_room(width)) return false;
      const std::uint32_t rest =
          lengths_[below][slot].code(coder, static_cast<std::uint32_t>(bits.take(width)), width);
      bits.put(width, rest);
      begin += 1u << below | rest;
      length_before = width;
    }
  }

 private:
  static constexpr std::uint32_t kSpread = 0x9E3779B1u;  ///< 2^32 over the golden ratio.
  static constexpr int kIdContextBits = 16, kSlotBits = 6;
  static constexpr int kSlots = 1 << kSlotBits, kLengths = 1 << MaterialRun::kLengthBits;

  /// Codes an id, given the one before it. Ids share contexts at random.
  template <class Coder>
  std::uint32_t code_id(Coder& coder, std::uint32_t id) {
    std::uint32_t prefix = 1;
    for (int bit = id_bits_ - 1; bit >= 0; --bit) {
      const std::uint32_t context =
          (id_before_ * kSpread + prefix) * kSpread >> (32 - kIdContextBits);
      prefix =
          prefix << 1 | static_cast<std::uint32_t>(coder.code(ids_[context], (id >> bit & 1) != 0));
    }
    id_before_ = prefix - (1u << id_bits_);
    return id_before_;
  }

  int id_bits_;
  std::uint32_t id_before_ = 0;
  AdaptiveBit ids_[1 << kIdContextBits];
  AdaptiveBit lasts_[kPageValues / 32][kSlots][kLengths];
  BitTree<MaterialRun::kLengthBits> sizes_[kSlots][kLengths];
  BitTree<7> lengths_[kLengths][kSlots];
};

}  // namespace voxdag::wire

#pragma once
/// Packs the materials of cells.
#include <array>

#include "voxdag/core/memory_budget.hpp"
#include "voxdag/stored/attributes/material_ids.hpp"

namespace voxdag {

/// Packs ids that come in the order of the cells' numbers.
class MaterialEncoder {
 public:
  /// Ids are less than `materials`, 1 to kMaxMaterials. Counts the packed ids in `memory`.
  explicit MaterialEncoder(std::uint32_t materials, MemoryBudget* memory = nullptr);

  /// Adds `count` cells of one material. Throws OverMemory.
  void add(std::uint32_t id, std::uint64_t count);

  /// Returns all ids, which depend on the calls' cells alone. The budget no longer counts them.
  MaterialIds finish();

 private:
  void write(std::uint64_t value, int bits);
  void write_page();

  int id_bits_;
  MaterialIds ids_;
  MemoryReservation counted_;
  std::uint64_t at_ = 0;  // bits written
  std::size_t count_ = 0;
  std::array<std::uint16_t, kPageValues> page_;
};

}  // namespace voxdag

#pragma once
/// The materials of cells, by number: lossless run lengths.
///
/// A page holds the ids of 256 cells with consecutive numbers, as runs of equal ids:
///
///   id       as many bits as materials - 1 needs; none if there is one material
///   last     1 bit: 1 if the run is the page's last, which ends with the page or the last cell
///   length   3 bits b, then the b bits of the length below its leading one; absent in the last run
///
/// Lengths are at least 1, and two runs that follow each other have different ids. So the ids
/// determine the bits. cell_pages.hpp describes the tables that find pages.
#include <cstdint>

#include "voxdag/stored/attributes/cell_pages.hpp"

namespace voxdag {

inline constexpr std::uint32_t kMaxMaterials = 65535;

/// A run of cells of one material.
struct MaterialRun {
  static constexpr int kLastBits = 1, kLengthBits = 3;

  std::uint32_t id = 0;
  std::uint32_t length = 0;  ///< 0: up to the end of the page.
  int bits = 0;              ///< Size of the stored run, in bits.
};

/// A view for kernels and readers.
struct MaterialIdsView : CellPagesView {
  std::uint32_t materials = 0;  ///< Ids are less than this, 1 to kMaxMaterials.

  /// Returns the number of bits of an id.
  VOXDAG_HD int id_bits() const {
    int bits = 0;
    while (materials > 1u << bits) ++bits;
    return bits;
  }
};

/// Ids in memory. The view is valid while this object lives unchanged.
struct MaterialIds : CellPages {
  std::uint32_t materials = 0;

  MaterialIdsView view() const { return {CellPages::view(), materials}; }
};

/// Reads the run that begins at bit `at`. `id_bits` is that of the view. Reads at most 28 bits.
VOXDAG_HD inline MaterialRun read_material_run(const MaterialIdsView& view, std::uint64_t at,
                                               int id_bits) {
  MaterialRun run;
  run.id = static_cast<std::uint32_t>(read_bits(view.words, at, id_bits));
  run.bits = id_bits + MaterialRun::kLastBits;
  at += static_cast<std::uint64_t>(id_bits);
  if (read_bits(view.words, at, MaterialRun::kLastBits) != 0) return run;
  at += MaterialRun::kLastBits;
  const int below = static_cast<int>(read_bits(view.words, at, MaterialRun::kLengthBits));
  at += MaterialRun::kLengthBits;
  run.length = 1u << below | static_cast<std::uint32_t>(read_bits(view.words, at, below));
  run.bits += MaterialRun::kLengthBits + below;
  return run;
}

/// Returns the material of the cell with number `number`, less than view.values. Skips half of the
/// page's runs on average.
VOXDAG_HD inline std::uint32_t read_material(const MaterialIdsView& view, std::uint64_t number) {
  const int id_bits = view.id_bits();
  std::uint64_t at = view.page_begin(number / kPageValues);
  auto left = static_cast<std::uint32_t>(number % kPageValues);
  for (;;) {
    const MaterialRun run = read_material_run(view, at, id_bits);
    if (run.length == 0 || left < run.length) return run.id;
    left -= run.length;
    at += static_cast<std::uint64_t>(run.bits);
  }
}

}  // namespace voxdag

#include "voxdag/builders/solid/winding/winding_sheets.hpp"

#include <algorithm>

#include "voxdag/core/morton.hpp"
#include "voxdag/core/parallel/polled_for.hpp"
#include "voxdag/stored/svdag/svdag_lookup.hpp"

namespace voxdag {

PageVector<std::uint64_t> find_sheets(const WindingField& field, const SvdagView& cover,
                                      Work work) {
  constexpr std::size_t kChunk = 256;
  // The cells of a level in which the inside may end, in Morton order.
  PageVector<std::uint64_t> cells(work.memory);
  cells.push_back(0);
  for (int level = 0; level <= cover.levels; ++level) {
    const int log2_side = cover.levels - level;
    PageVector<std::uint8_t> may_differ(work.memory);
    may_differ.resize(cells.size());
    polled_for((cells.size() + kChunk - 1) / kChunk, 1, work, "holes", [&](std::size_t chunk) {
      for (std::size_t i = chunk * kChunk; i < std::min(cells.size(), (chunk + 1) * kChunk); ++i) {
        const Vec3i cell = morton_decode(cells[i]);
        const bool is_set = log2_side == 0 && svdag_contains(cover, cell, cover.levels);
        may_differ[i] = !is_set && field.may_differ(cell, log2_side) ? 1 : 0;
      }
    });
    PageVector<std::uint64_t> next(work.memory);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (may_differ[i] == 0) continue;
      if (log2_side == 0) next.push_back(cells[i]);
      for (std::uint64_t child = 0; log2_side > 0 && child < 8; ++child)
        next.push_back(cells[i] << 3 | child);
    }
    cells = std::move(next);
  }
  return cells;
}

}  // namespace voxdag

#include "voxdag/builders/dag/subvolume_bins.hpp"

#include <array>
#include <vector>

#include "voxdag/builders/voxelize/cell_finder.hpp"
#include "voxdag/core/parallel/per_thread.hpp"
#include "voxdag/core/parallel/polled_for.hpp"

namespace voxdag {
namespace {

using Entries = PageVector<std::uint64_t>;  // Morton code of the cell << 32 | triangle
using Cursors = std::array<std::size_t, 4096>;

/// Moves the entries of all `parts` to one array, sorted stably by the 12 bits of the cell from bit
/// `shift` up. Frees the parts.
Entries sort_by_digit(std::vector<Entries>& parts, int shift, Work work) {
  const auto digit_of = [shift](std::uint64_t entry) {
    return (entry >> (32 + shift)) % std::tuple_size_v<Cursors>;
  };
  Cursors next{};
  for (const Entries& part : parts)
    for (std::size_t i = 0; i < part.size(); ++i) {
      work.poll_seldom(i);
      ++next[digit_of(part[i])];
    }
  std::size_t count = 0;
  for (std::size_t& cursor : next) count += std::exchange(cursor, count);
  Entries sorted(work.memory);
  sorted.resize(count);
  for (Entries& part : parts) {
    for (std::size_t i = 0; i < part.size(); ++i) {
      work.poll_seldom(i);
      sorted[next[digit_of(part[i])]++] = part[i];
    }
    part.release();
  }
  return sorted;
}

}  // namespace

// Sorts the cells' codes by a radix sort with 12-bit digits, the lowest first.
SubvolumeBins bin_triangles(const QuantizedMesh& mesh, int levels, int level,
                            const CellRange& range, const IndexSet& excluded, Work work) {
  const CellFinder cells(levels, level, range);
  PerThread<Entries> per_thread([&] { return Entries(work.memory); });
  polled_for(mesh.triangle_count(), 1024, work, "bin", [&](std::size_t i) {
    if (!mesh.in_range(i) || excluded.contains(i)) return;
    Entries& entries = per_thread.local();
    cells.for_each(mesh.triangle(i),
                   [&](std::uint64_t code) { entries.push_back(code << 32 | i); });
  });
  std::vector<Entries> parts;
  for (Entries& entries : per_thread) parts.push_back(std::move(entries));
  for (int shift = 0; shift == 0 || shift < 3 * level; shift += 12) {
    Entries sorted = sort_by_digit(parts, shift, work);
    parts.clear();
    parts.push_back(std::move(sorted));
  }

  const Entries& all = parts[0];
  SubvolumeBins bins(work.memory);
  bins.level = level;
  bins.triangles.resize(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    work.poll_seldom(i);
    const std::uint32_t cell = static_cast<std::uint32_t>(all[i] >> 32);
    if (bins.cells.empty() || bins.cells.back() != cell) {
      bins.cells.push_back(cell);
      bins.begin.push_back(i);
    }
    bins.triangles[i] = static_cast<std::uint32_t>(all[i]);
  }
  bins.begin.push_back(all.size());
  return bins;
}

}  // namespace voxdag

#include "voxdag/stored/svdag/top_grid.hpp"

#include <algorithm>
#include <array>
#include <cassert>

#include "voxdag/core/parallel/parallel_for.hpp"

namespace voxdag {
namespace {

constexpr std::uint64_t kEmpty = ~std::uint64_t{0};

/// Sets the nodes of the grid's cells below `node`, whose cell of `level` is the cell at (x,y,z).
void set_nodes(const SvdagView& dag, std::uint32_t node, int level, std::size_t x, std::size_t y,
               std::size_t z, TopGrid& grid) {
  if (level == grid.level) {
    grid.cells[x | y << level | z << (2 * level)] = std::uint64_t{node} << 32;
    return;
  }
  const std::uint32_t* const words = dag.nodes + node;
  for (std::size_t i = 0; i < 8; ++i)
    if ((child_mask(words) >> i & 1u) != 0)
      set_nodes(dag, child_pointer(words, static_cast<int>(i)), level + 1, 2 * x + (i & 1),
                2 * y + (i >> 1 & 1), 2 * z + (i >> 2), grid);
}

/// Finds the free ways in one octant, plane by plane: that of an empty cell is one more than the
/// least of its seven neighbours in the octant.
class FreeWays {
 public:
  FreeWays(const TopGrid& grid, std::uint32_t octant)
      : grid_(grid), octant_(octant), side_(std::size_t{1} << grid.level) {
    for (Plane& plane : planes_) plane.assign((side_ + 1) * row(), 255);
  }

  /// Continues with plane z, the next one in the direction opposite to the octant's.
  void next(std::size_t z) {
    std::swap(planes_[0], planes_[1]);
    for (std::size_t i = 0; i < side_; ++i) {
      const std::size_t y = is_up(1) ? side_ - 1 - i : i;
      const std::uint64_t* const cells = &grid_.cells[y << grid_.level | z << (2 * grid_.level)];
      // Rows and cells are in the order of the walk; the one before the first is outside.
      const std::uint8_t* const before = &planes_[1][i * row()];
      const std::uint8_t* const beside = before + row();
      const std::uint8_t* const last = &planes_[0][i * row()];
      std::uint8_t* const ways = &planes_[0][(i + 1) * row()];
      for (std::size_t at = 0; at <= side_; ++at)
        least_[at] = std::min({before[at], beside[at], last[at]});
      for (std::size_t at = 0; at < side_; ++at) {
        const std::uint8_t least = std::min({least_[at], least_[at + 1], ways[at]});
        const bool is_empty = TopGridView::is_empty(cells[is_up(0) ? side_ - 1 - at : at]);
        ways[at + 1] = is_empty ? static_cast<std::uint8_t>(std::min<int>(least, 254) + 1) : 0;
      }
    }
  }

  bool is_up(int axis) const { return (octant_ >> axis & 1u) != 0; }
  std::uint32_t octant() const { return octant_; }
  std::uint8_t way(std::size_t x, std::size_t y) const {
    return planes_[0]
                  [((is_up(1) ? side_ - 1 - y : y) + 1) * row() + (is_up(0) ? side_ - x : x + 1)];
  }

 private:
  using Plane = std::vector<std::uint8_t>;

  std::size_t row() const { return side_ + 1; }

  const TopGrid& grid_;
  std::uint32_t octant_;
  std::size_t side_;
  std::array<Plane, 2> planes_;  ///< This one and the one before.
  std::vector<std::uint8_t> least_ = std::vector<std::uint8_t>(side_ + 1);
};

/// Sets the free ways in the four octants that are up or down on z.
void set_free_ways(TopGrid& grid, bool is_up) {
  std::vector<FreeWays> octants;
  for (std::uint32_t i = 0; i < 4; ++i) octants.emplace_back(grid, i | (is_up ? 4u : 0u));
  const std::size_t side = std::size_t{1} << grid.level;
  for (std::size_t i = 0; i < side; ++i) {
    const std::size_t z = is_up ? side - 1 - i : i;
    parallel_for(octants.size(), [&](std::size_t octant) { octants[octant].next(z); });
    parallel_for(side, [&](std::size_t y) {
      std::uint64_t* const cells = &grid.cells[y << grid.level | z << (2 * grid.level)];
      for (const FreeWays& ways : octants) {
        const std::uint32_t shift = 8 * ways.octant();
        for (std::size_t x = 0; x < side; ++x)
          if (TopGridView::is_empty(cells[x]))
            cells[x] = (cells[x] & ~(std::uint64_t{255} << shift)) | std::uint64_t{ways.way(x, y)}
                                                                         << shift;
      }
    });
  }
}

}  // namespace

TopGrid make_top_grid(const SvdagView& dag, int level) {
  assert(level >= 0 && level <= dag.levels - 2);
  TopGrid grid;
  if (level == 0) return grid;
  grid.level = level;
  grid.cells.assign(std::size_t{1} << (3 * level), kEmpty);
  if (!dag.is_empty()) set_nodes(dag, dag.root, 0, 0, 0, 0, grid);
  set_free_ways(grid, false);
  set_free_ways(grid, true);
  return grid;
}

}  // namespace voxdag

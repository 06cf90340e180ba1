#include "voxdag/algebra/components.hpp"

#include <map>

#include "voxdag/algebra/select_regions.hpp"

namespace voxdag {
namespace {

struct LargeComponents {
  static constexpr bool kKeepsVoxels = false;
  std::uint64_t least;

  const Regions& regions;

  bool is_open_selected(std::uint32_t region) const {
    return regions.size(0, regions.source().root(), region) >= least;
  }
  bool is_closed_selected(int level, std::uint32_t node, std::uint32_t region,
                          std::uint32_t) const {
    return regions.size(level, node, region) >= least;
  }
  static std::uint32_t root_state() { return 0; }
  static std::uint32_t state_below(std::uint32_t, int) { return 0; }
};

struct Cavities {
  static constexpr bool kKeepsVoxels = true;

  static bool is_open_selected(std::uint32_t) { return false; }
  static bool is_closed_selected(int, std::uint32_t, std::uint32_t, std::uint32_t) { return true; }
  static std::uint32_t root_state() { return 0; }
  static std::uint32_t state_below(std::uint32_t, int) { return 0; }
};

}  // namespace

std::vector<ComponentSizes> component_sizes(const SvdagView& dag, Neighbours neighbours,
                                            Work work) {
  const Regions regions(dag, RegionKind::kVoxels, neighbours, work);
  std::map<std::uint64_t, std::uint64_t, std::greater<>> counts;
  if (dag.is_empty()) return {};
  const std::uint32_t root = regions.source().root();
  for (std::uint32_t i = 0; i < regions.counts(0, root).open; ++i)
    ++counts[regions.size(0, root, i)];
  // How often each node occurs, level after level.
  std::map<std::uint32_t, std::uint64_t> level_nodes{{root, 1}};
  for (int level = 0; level <= dag.levels - 2; ++level) {
    std::map<std::uint32_t, std::uint64_t> below;
    for (const auto& [node, times] : level_nodes) {
      const Regions::Counts of_node = regions.counts(level, node);
      for (std::uint32_t i = 0; i < of_node.closed; ++i)
        counts[regions.size(level, node, of_node.open + i)] += times;
      if (level == dag.levels - 2) continue;
      for (int child = 0; child < 8; ++child) {
        const std::uint32_t of_child = regions.source().child(level, node, child);
        if (of_child != kNoCell) below[of_child] += times;
      }
    }
    level_nodes = std::move(below);
  }
  std::vector<ComponentSizes> sizes;
  for (const auto& [voxels, count] : counts) sizes.push_back({voxels, count});
  return sizes;
}

Svdag keep_components(const SvdagView& dag, std::uint64_t least, Neighbours neighbours, Work work) {
  const Regions regions(dag, RegionKind::kVoxels, neighbours, work);
  return select_regions(regions, LargeComponents{least, regions}, work);
}

Svdag fill_cavities(const SvdagView& dag, Work work) {
  const Regions regions(dag, RegionKind::kEmpty, Neighbours::k6, work);
  return select_regions(regions, Cavities{}, work);
}

}  // namespace voxdag

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

Components::Components(const SvdagView& dag, Neighbours neighbours, Work work)
    : regions_(std::make_unique<Regions>(dag, RegionKind::kVoxels, neighbours, work)),
      work_(work) {}

Components::~Components() = default;

std::vector<ComponentSizes> Components::sizes() const {
  const Regions& regions = *regions_;
  const std::uint32_t root = regions.source().root();
  if (root == kNoCell) return {};
  std::map<std::uint64_t, std::uint64_t, std::greater<>> counts;
  for (std::uint32_t i = 0; i < regions.counts(0, root).open; ++i)
    ++counts[regions.size(0, root, i)];
  // Counts how often each node that contains closed components occurs.
  UniqueCells<std::array<std::uint32_t, 1>> nodes(work_.memory);
  CountedVector<std::uint64_t> times(1, 1, work_.memory);
  nodes.add({root});
  for (int level = 0; level <= regions.levels() - 2; ++level) {
    UniqueCells<std::array<std::uint32_t, 1>> below(work_.memory);
    CountedVector<std::uint64_t> times_below(work_.memory);
    for (std::size_t n = 0; n < times.size(); ++n) {
      work_.poll_seldom(n);
      const std::uint32_t node = nodes.cells()[n][0];
      const Regions::Counts of_node = regions.counts(level, node);
      for (std::uint32_t i = 0; i < of_node.closed; ++i)
        counts[regions.size(level, node, of_node.open + i)] += times[n];
      if (level == regions.levels() - 2) continue;
      for (int child = 0; child < 8; ++child) {
        const std::uint32_t of_child = regions.source().child(level, node, child);
        if (!regions.has_closed(level + 1, of_child)) continue;
        const std::uint32_t number = below.add({of_child});
        if (number == times_below.size()) times_below.push_back(0);
        times_below[number] += times[n];
      }
    }
    nodes = std::move(below);
    times = std::move(times_below);
  }
  std::vector<ComponentSizes> sizes;
  for (const auto& [voxels, count] : counts) sizes.push_back({voxels, count});
  return sizes;
}

Svdag Components::keep(std::uint64_t least) const {
  return select_regions(*regions_, LargeComponents{least, *regions_}, work_);
}

std::vector<ComponentSizes> component_sizes(const SvdagView& dag, Neighbours neighbours,
                                            Work work) {
  return Components(dag, neighbours, work).sizes();
}

Svdag keep_components(const SvdagView& dag, std::uint64_t least, Neighbours neighbours, Work work) {
  return Components(dag, neighbours, work).keep(least);
}

Svdag fill_cavities(const SvdagView& dag, Work work) {
  const Regions regions(dag, RegionKind::kEmpty, Neighbours::k6, work);
  return select_regions(regions, Cavities{}, work);
}

}  // namespace voxdag

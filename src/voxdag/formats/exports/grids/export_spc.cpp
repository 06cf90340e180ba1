#include "voxdag/formats/exports/grids/export_spc.hpp"

#include <array>
#include <string>

#include "voxdag/file/npy.hpp"
#include "voxdag/formats/exports/export_common.hpp"
#include "voxdag/stored/svdag/svdag_counts.hpp"

namespace voxdag {
namespace {

constexpr int kMaxSpcLevels = 15;

/// Exchanges x and z in a child index.
constexpr int turned(int child) { return (child & 1) << 2 | (child & 2) | child >> 2; }

/// Exchanges x and z in all child indices of a mask.
constexpr std::array<std::uint8_t, 256> kTurnedMasks = [] {
  std::array<std::uint8_t, 256> masks{};
  for (int mask = 0; mask < 256; ++mask)
    for (int child = 0; child < 8; ++child)
      if ((mask >> child & 1) != 0) masks[mask] |= static_cast<std::uint8_t>(1 << turned(child));
  return masks;
}();

/// Visits the nodes of one level in kaolin's order.
template <class Fn>
class LevelWalk {
 public:
  LevelWalk(const SvdagView& dag, int level, const Fn& fn) : dag_(dag), level_(level), fn_(fn) {}

  /// Calls fn(child mask) for the nodes of the level in a node.
  void visit(int at_level, std::uint32_t pointer) const {
    if (at_level == dag_.levels - 2) return visit_block(dag_.leaf_blocks[pointer]);
    const std::uint32_t* const node = dag_.nodes + pointer;
    if (at_level == level_) return fn_(child_mask(node));
    for (int i = 0; i < 8; ++i)
      if (const int child = turned(i); (child_mask(node) >> child & 1) != 0)
        visit(at_level + 1, child_pointer(node, child));
  }

 private:
  void visit_block(std::uint64_t block) const {
    if (level_ == dag_.levels - 2) return fn_(leaf_block_child_mask(block));
    for (int i = 0; i < 8; ++i)
      if (const std::uint64_t mask = block >> 8 * turned(i) & 0xFF; mask != 0)
        fn_(static_cast<std::uint32_t>(mask));
  }

  const SvdagView& dag_;
  int level_;
  const Fn& fn_;
};

}  // namespace

void export_spc(const std::filesystem::path& path, const SvdagView& dag, const Grid& grid,
                const ExportOptions& options) {
  if (dag.levels > kMaxSpcLevels)
    refuse_export(path, std::to_string(std::int64_t{1} << dag.levels) +
                            " voxels a side are more than the 32768 of kaolin");
  constexpr std::uint64_t kMaxItems = 0x7FFFFFFF;
  const SvdagCounts counts = dag.is_empty() ? SvdagCounts{} : count_svdag(dag);
  const std::uint64_t count = dag.is_empty() ? 0 : counts.svo_nodes();
  if (count + counts.voxels > kMaxItems)
    refuse_export(path, std::to_string(count + counts.voxels) +
                            " nodes and voxels are more than the 2147483647 of kaolin");
  check_disk_space(path, count);
  NpyWriter file(path, "|u1", {}, 1, count);
  std::string bytes;
  const auto add = [&](std::uint32_t mask) {
    bytes.push_back(static_cast<char>(kTurnedMasks[mask]));
    if (bytes.size() < 65536) return;
    file.write_bytes(bytes.data(), bytes.size());
    bytes.clear();
    report_export(options, file.rows_written(), count);
  };
  for (int level = 0; level < dag.levels && !dag.is_empty(); ++level)
    LevelWalk(dag, level, add).visit(0, 0);
  file.write_bytes(bytes.data(), bytes.size());
  file.commit();
  write_placement(path, grid, options.window.value_or(whole_grid(dag.levels)),
                  {"octrees of kaolin.rep.Spc: child masks, breadth first", "uint8", ""}, options);
}

}  // namespace voxdag

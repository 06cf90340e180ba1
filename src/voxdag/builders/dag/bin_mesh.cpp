
#include <algorithm>

#include "voxdag/builders/dag/build_methods.hpp"
#include "voxdag/builders/dag/subvolume.hpp"

namespace voxdag {

BinnedMesh bin_mesh(const BuildInput& input) {
  QuantizedMesh mesh(input.mesh, input.grid, input.work);
  const IndexSet duplicates = find_duplicate_triangles(mesh, input.work);
  SubvolumeBins bins =
      bin_triangles(mesh, input.grid.levels, input.bin_level, {}, duplicates, input.work);
  const double quantized = static_cast<double>(input.mesh.vertices.size()) * sizeof(Vec3i);
  const double table = static_cast<double>(mesh.triangle_count()) * 12;
  const double binning = static_cast<double>(bins.triangles.size()) * 16;
  return {std::move(mesh), std::move(bins), quantized + std::max(table, binning)};
}

double list_scratch_bytes(const SubvolumeBins& bins) {
  using Context = SubvolumeContext<TreeSink>;
  std::size_t longest = 0;
  for (std::size_t i = 0; i < bins.cells.size(); ++i)
    longest = std::max(longest, bins.list(i).size());
  const std::size_t setups = std::min(longest, std::size_t{1} << 14);
  // A triangle is in lists of each level that the recursion descends at once, and on a level in the
  // lists of two or three cells.
  constexpr std::size_t kLists = 4;
  return static_cast<double>(
      Context::kStackBytes +
      setups *
          (sizeof(TriangleSetup) + sizeof(Context::Item) * kLists + sizeof(Context::Classified)) +
      longest * sizeof(std::uint32_t) +
      (longest > setups ? longest * (sizeof(Context::Classified) + 2 * sizeof(std::uint32_t)) : 0));
}

}  // namespace voxdag

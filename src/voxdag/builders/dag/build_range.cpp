#include "voxdag/builders/dag/build_range.hpp"

#include <algorithm>

#include "voxdag/builders/dag/build_methods.hpp"
#include "voxdag/builders/voxelize/duplicate_triangles.hpp"

namespace voxdag {

Svdag build_range(CountedVector<QuantizedTriangle> triangles, int levels, const CellRange& range,
                  Work work) {
  MemoryBudget unlimited;
  if (work.memory == nullptr) work.memory = &unlimited;
  const int bin_level = std::max(hash_bin_level(levels, triangles.size()), range.level);
  BuildReport report;
  StageBytes bytes;
  QuantizedMesh mesh(std::move(triangles));
  const IndexSet duplicates = find_duplicate_triangles(mesh, work);
  SubvolumeBins bins = bin_triangles(mesh, levels, bin_level, range, duplicates, work);
  const BinnedMesh binned{std::move(mesh), std::move(bins), 0};
  return number_nodes(voxelize_binned(binned, levels, work, report, bytes), levels, work, report);
}

}  // namespace voxdag

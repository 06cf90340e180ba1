#include "voxdag/dag/build_methods.hpp"
namespace voxdag {
BuildResult build_by_sorting(const QuantizedMesh& mesh, int levels, MemoryBudget& budget,
                             Progress* progress) {
  return build_hash_consed(mesh, levels, budget, progress);
}
}  // namespace voxdag

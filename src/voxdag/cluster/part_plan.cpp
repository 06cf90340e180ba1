#include "voxdag/cluster/part_plan.hpp"

namespace voxdag {

double CellLoad::bytes() const {
  // Estimates, not measured: a triangle with its lists and its setup; a voxel's share of leaf
  // blocks, inner nodes and tables.
  constexpr double kTriangleBytes = 120, kVoxelBytes = 2;
  return static_cast<double>(triangles) * kTriangleBytes + voxels * kVoxelBytes;
}

void add_loads(const TriangleSegment& segment, std::span<CellLoad> loads) {
  for (const SegmentCell& cell : segment.cells()) {
    loads[cell.code].triangles += cell.triangles;
    loads[cell.code].voxels += cell.voxels;
  }
}

std::vector<CellRange> plan_parts(std::span<const CellLoad> loads, int level, double part_bytes) {
  std::vector<CellRange> parts;
  double bytes = 0;
  for (std::uint32_t code = 0; code < loads.size(); ++code) {
    if (loads[code].triangles == 0) continue;
    const double more = loads[code].bytes();
    if (parts.empty() || bytes + more > part_bytes) {
      parts.push_back({level, code, code});
      bytes = 0;
    }
    parts.back().last = code + 1;
    bytes += more;
  }
  return parts;
}

}  // namespace voxdag

#include "voxdag/builders/pieces/load_pieces.hpp"

#include "voxdag/builders/voxelize/overlap.hpp"

namespace voxdag {
namespace {

/// A cube of the grid, in units of 1/256 voxel; half-open.
class UnitCube {
 public:
  UnitCube(Vec3i origin, int log2_size)
      : side_(std::int64_t{kSubvoxels} << log2_size),
        lo_(static_cast<Vec3l>(origin) * std::int64_t{kSubvoxels}),
        hi_(lo_ + Vec3l{side_, side_, side_}) {}

  bool meets(const QuantizedTriangle& t) const {
    const auto least = static_cast<Vec3l>(min(t.x, min(t.y, t.z)));
    const auto most = static_cast<Vec3l>(max(t.x, max(t.y, t.z)));
    bool is_inside = true, is_outside = false;
    for (int axis = 0; axis < 3; ++axis) {
      is_inside &= least[axis] >= lo_[axis] && most[axis] < hi_[axis];
      is_outside |= most[axis] < lo_[axis] || least[axis] >= hi_[axis];
    }
    // The exact test is slow, and most triangles lie inside the cube.
    return is_inside || (!is_outside && triangle_overlaps_cube(t.x, t.y, t.z, lo_, side_));
  }

 private:
  std::int64_t side_;
  Vec3l lo_, hi_;
};

std::optional<QuantizedTriangle> quantize(const Grid& grid, const MicroTriangle& micro) {
  QuantizedTriangle quantized;
  for (int i = 0; i < 3; ++i) {
    const std::optional<Vec3i> q = quantize(grid, micro.positions[static_cast<std::size_t>(i)]);
    if (!q) return std::nullopt;
    quantized[i] = *q;
  }
  return quantized;
}

}  // namespace

void load_pieces(PieceStack& pieces, const PieceSampler& sampler, const TriangleSource& source,
                 int level, Vec3i cell, std::span<const std::uint32_t> triangles) {
  const Grid& grid = source.grid;
  const int log2_size = grid.levels - level;
  const Vec3i origin = cell * (1 << log2_size);
  const UnitCube cube(origin, log2_size);
  const Box3d box = world_box(grid, cell, log2_size);
  const auto add = [&](SurfaceTriangle&& surface, std::uint32_t triangle) {
    surface.constant_sample = sampler.constant_sample(surface);
    pieces.add(surface, triangle);
  };
  pieces.start(log2_size, origin, triangles.size());
  for (const std::uint32_t triangle : triangles) {
    if (!source.is_displaced(triangle)) {
      add(SurfaceTriangle::make(source.mesh.triangle(triangle), origin,
                                source.mesh.source(triangle), source.open_edges[triangle]),
          triangle);
      continue;
    }
    source.displaced->tessellate(
        triangle, box, source.edge_limit(), [&](const MicroTriangle& micro) {
          const std::optional<QuantizedTriangle> quantized = quantize(grid, micro);
          if (!quantized || !cube.meets(*quantized)) return;
          const Vec2f barycentrics[3] = {micro.barycentrics[0], micro.barycentrics[1],
                                         micro.barycentrics[2]};
          add(SurfaceTriangle::make_displaced(*quantized, origin, triangle, barycentrics),
              triangle);
        });
  }
}

}  // namespace voxdag

#include <array>
#include <cstring>
#include <string>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/atomic_file.hpp"
#include "voxdag/formats/exports/coordinates.hpp"
#include "voxdag/formats/exports/faces/export_faces.hpp"
#include "voxdag/formats/exports/faces/exported_polygons.hpp"

namespace voxdag {
namespace {

constexpr std::uint64_t kMaxTriangles = 0xFFFFFFFF;
constexpr std::size_t kHeadBytes = 80, kTriangleBytes = 50;

void write_triangle(AtomicFile& file, Vec3f normal, Vec3f a, Vec3f b, Vec3f c) {
  std::array<char, kTriangleBytes> bytes{};  // ends in two bytes that are 0
  const std::array<Vec3f, 4> values{normal, a, b, c};
  std::memcpy(bytes.data(), values.data(), sizeof values);
  file.write(bytes.data(), bytes.size());
}

Vec3f normal_of(const FacePolygon& polygon, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  const std::vector<Vec3d>& p = polygon.corners;
  const Vec3d normal =
      normalized_or(cross(p[b] - p[a], p[c] - p[a]), Vec3d(face_normal(polygon.face)));
  return Vec3f(normal + Vec3d{});  // No zero is negative.
}

}  // namespace

void export_stl(const std::filesystem::path& path, const VoxelSet& voxels, const Grid& world,
                const ExportOptions& options) {
  const Box3i window = export_window(path, voxels, options);
  Grid grid = world;
  std::optional<Vec3d> offset;
  if (!float_suffices(world)) {
    offset = world.to_world(Vec3d(window.lo));
    grid.origin = Vec3d(window.lo) * -grid.voxel_size;
    if (!float_suffices(grid))
      throw Error(path.string(), "",
                  "STL has float coordinates, which cannot hold voxels of this size: export .obj, "
                  ".ply or .glb");
  }
  ExportedPolygons polygons(voxels, window, options, PolygonFormat::kNoColors);
  const std::uint64_t triangles = polygons.measure().triangles;
  if (triangles > kMaxTriangles)
    refuse_export(
        path, std::to_string(triangles) + " triangles are more than the 4294967295 of an STL file");
  check_disk_space(path, kHeadBytes + 4 + triangles * kTriangleBytes);
  AtomicFile file(path);
  std::string head = "binary STL made by voxdag";  // must not begin with "solid"
  head.resize(kHeadBytes, ' ');
  file.write(head);
  const auto count = static_cast<std::uint32_t>(triangles);
  file.write(&count, sizeof count);
  std::vector<Vec3f> corners;
  polygons.for_each([&](const FacePolygon& polygon, const SharedVertices&) {
    corners.clear();
    for (const Vec3d place : polygon.corners) corners.push_back(Vec3f(grid.to_world(place)));
    for (const auto& [a, b, c] : polygon.triangles)
      write_triangle(file, normal_of(polygon, a, b, c), corners[a], corners[b], corners[c]);
  });
  file.commit();
  if (!offset) return remove_placement(path);
  ArrayLayout layout{"triangles", "float32", ""};
  layout.offset = offset;
  write_placement(path, world, window, layout, options);
  if (options.notes == nullptr) return;
  std::string note =
      "floats are too coarse for its place in the world: its coordinates need the offset";
  for (int axis = 0; axis < 3; ++axis) note.append(" ").append(shortest((*offset)[axis]));
  options.notes->push_back(path.string() + ": " + note + ", as " + path.filename().string() +
                           ".json says");
}

}  // namespace voxdag

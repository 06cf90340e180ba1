#include <array>
#include <cstring>
#include <string>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/atomic_file.hpp"
#include "voxdag/formats/exports/coordinates.hpp"
#include "voxdag/formats/exports/faces/export_faces.hpp"
#include "voxdag/formats/exports/faces/exported_rectangles.hpp"

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

}  // namespace

void export_stl(const std::filesystem::path& path, const VoxelSet& voxels, const Grid& grid,
                const ExportOptions& options) {
  const Box3i window = export_window(path, voxels, options);
  if (!float_suffices(grid))
    throw Error(path.string(), "",
                "STL has float coordinates, which are too coarse for this grid's place in the "
                "world: export .obj, .ply or .glb");
  ExportedRectangles faces(voxels, window, options, false);
  const std::uint64_t triangles = 2 * faces.measure().count;
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
  faces.for_each([&](const FaceRectangle& face) {
    std::array<Vec3f, 4> corners;
    const std::array<Vec3i, 4> places = corners_of(face);
    for (std::size_t i = 0; i < 4; ++i) corners[i] = Vec3f(grid.to_world(Vec3d(places[i])));
    const Vec3f normal(face_normal(face.face));
    write_triangle(file, normal, corners[0], corners[1], corners[2]);
    write_triangle(file, normal, corners[0], corners[2], corners[3]);
  });
  file.commit();
}

}  // namespace voxdag

#include "voxdag/formats/readers/used_vertices.hpp"

#include <algorithm>

#include "voxdag/core/parallel/parallel_for.hpp"
#include "voxdag/formats/readers/warnings.hpp"

namespace voxdag {
namespace {

/// Keeps `of_each` values of each triangle for which is_kept(triangle).
template <class Values, class IsKept>
void keep(Values& values, std::size_t of_each, const IsKept& is_kept) {
  std::size_t kept = 0;
  for (std::size_t t = 0; t * of_each < values.size(); ++t) {
    if (!is_kept(t)) continue;
    std::copy_n(values.data() + t * of_each, of_each, values.data() + kept);
    kept += of_each;
  }
  values.resize(kept);
}

}  // namespace

UsedVertices used_vertices(const MeshSource& source, const Mesh& mesh) {
  constexpr std::size_t kStep = 65536;
  std::vector<UsedVertices> parts(mesh.triangles.size() / kStep + 1);
  parallel_for(parts.size(), [&](std::size_t i) {
    source.work().poll();
    UsedVertices part;
    const std::size_t end = std::min((i + 1) * kStep, mesh.triangles.size());
    for (std::size_t t = i * kStep; t < end; ++t) {
      const auto [a, b, c] = mesh.triangles[t];
      part.add(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
    }
    parts[i] = part;
    source.count_work(kStep * sizeof(Triangle));
  });
  UsedVertices used;
  for (const UsedVertices& part : parts) used.add(part);
  return used;
}

void remove_bad_triangles(const MeshSource& source, std::uint64_t bad_triangles,
                          MeshWithAppearance& read) {
  if (bad_triangles == 0) return;
  Mesh& mesh = read.mesh;
  Appearance& appearance = read.appearance;
  if (bad_triangles == mesh.triangles.size()) throw source.error(kNoGoodTriangle);
  CancelPoll poll(source.work());
  const auto is_good = [&](std::size_t t) {
    poll.step();
    const auto [a, b, c] = mesh.triangles[t];
    return UsedVertices{}.add(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
  };
  keep(mesh.triangle_materials, 1, is_good);
  keep(appearance.normals, 3, is_good);
  keep(appearance.uvs, 3, is_good);
  keep(appearance.colors, 3, is_good);
  std::uint64_t triangle = 0, left_out = 0;
  for (ObjectRun& run : mesh.object_runs) {
    for (; triangle < run.first_triangle; ++triangle) left_out += is_good(triangle) ? 0 : 1;
    run.first_triangle -= left_out;
  }
  keep(mesh.triangles, 1, is_good);  // Last: the others ask for the triangles.
  read.warnings.push_back(bad_triangles_warning(source.name, bad_triangles));
}

std::string bad_triangles_warning(const std::string& file, std::uint64_t bad_triangles) {
  return file + ": " + counted(bad_triangles, "triangle") + " left out: a vertex is not finite";
}

}  // namespace voxdag

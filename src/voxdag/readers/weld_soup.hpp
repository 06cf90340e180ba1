#pragma once
/// Welding of a triangle soup: corners with equal bits become one vertex, in the order in which the
/// soup first has them.
///
/// The soup is read twice: once to count its triangles and, from a sample, its vertices, so that
/// what is made has the right size from the start; and once to make it, a batch of parts at a time.
/// Threads weld each part on its own; then the vertices of the parts, far fewer than their corners,
/// are welded in order. Beside the finished mesh there is a table of vertices, of at most 0.27
/// times its size.
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "voxdag/mesh/mesh.hpp"
#include "voxdag/mesh/vertex_table.hpp"
#include "voxdag/parallel/parallel_for.hpp"
#include "voxdag/readers/chunks.hpp"

namespace voxdag {

/// What a first reading of a soup tells.
struct SoupSize {
  std::vector<std::size_t> first_triangles;  ///< Of each part and, last, their number.
  std::size_t vertices = 0;                  ///< Distinct ones; may be exceeded by a few.
};

/// Reads a soup in parts: `visit(part, body)` calls body(Vec3f) for the corners of one part in
/// order, three for each triangle, and throws Fault at bad input, which is thrown as an Error.
template <class Visit>
SoupSize measure_soup(const MeshSource& source, const std::vector<std::string_view>& parts,
                      char line_end, const Visit& visit) {
  constexpr unsigned kOneIn = 16;  // vertices in the sample, by hash
  SoupSize size{std::vector<std::size_t>(parts.size() + 1), 0};
  std::vector<std::vector<Vec3f>> samples(parts.size());
  for_each_chunk(source, parts, line_end, "scan", [&](std::size_t part) {
    VertexTable sample;
    std::size_t corners = 0;
    visit(part, [&](Vec3f position) {
      ++corners;
      if (hash_bits(position) % kOneIn == 0) sample.find_or_add(position);
    });
    size.first_triangles[part + 1] = corners / 3;
    samples[part] = sample.take_vertices();
  });
  VertexTable sample;
  for (std::size_t part = 0; part < parts.size(); ++part) {
    size.first_triangles[part + 1] += size.first_triangles[part];
    for (const Vec3f position : samples[part]) sample.find_or_add(position);
  }
  // Four standard deviations above the estimate are hardly ever exceeded.
  const auto sampled = static_cast<double>(sample.vertices().size());
  size.vertices = static_cast<std::size_t>(kOneIn * (sampled + 4 * std::sqrt(sampled) + 4));
  size.vertices = std::min(size.vertices, 3 * size.first_triangles.back());
  return size;
}

/// Welds a soup as measure_soup takes it, which has fewer than 2^32 / 3 triangles.
template <class Visit>
Mesh weld(const MeshSource& source, const std::vector<std::string_view>& parts, char line_end,
          const Visit& visit, const SoupSize& size) {
  Mesh mesh;
  const std::vector<std::size_t>& starts = size.first_triangles;
  const std::size_t triangles = starts.back();
  mesh.triangles.resize(triangles);
  // A full table is slow, so it is full only where nearly no corners are shared.
  VertexTable table(size.vertices,
                    64 + std::min(size.vertices * 8 / 5, (triangles + size.vertices) / 5 * 4));

  const auto threads =
      static_cast<std::size_t>(std::max(tbb::this_task_arena::max_concurrency(), 1));
  const std::size_t batch = 2 * threads;
  for (std::size_t first = 0; first < parts.size(); first += batch) {
    const std::size_t last = std::min(first + batch, parts.size());
    const auto at = [&](std::size_t part) {
      return parts.begin() + static_cast<std::ptrdiff_t>(part);
    };
    std::vector<std::vector<Vec3f>> vertices(last - first);
    for_each_chunk(source, {at(first), at(last)}, line_end, "weld", [&](std::size_t i) {
      VertexTable own;
      std::uint32_t* corner = mesh.triangles.data()->data() + 3 * starts[first + i];
      const std::uint32_t* const end = mesh.triangles.data()->data() + 3 * starts[first + i + 1];
      const auto changed = [&] {
        return Fault{parts[first + i].data(), "the file changed while it was read"};
      };
      visit(first + i, [&](Vec3f position) {
        if (corner == end) throw changed();
        *corner++ = own.find_or_add(position);
      });
      if (corner != end) throw changed();
      vertices[i] = own.take_vertices();
    });
    std::vector<std::vector<std::uint32_t>> numbers(last - first);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      numbers[i].reserve(vertices[i].size());
      for (const Vec3f position : vertices[i]) numbers[i].push_back(table.find_or_add(position));
    }
    parallel_for(numbers.size(), [&](std::size_t i) {
      for (std::size_t t = starts[first + i]; t < starts[first + i + 1]; ++t)
        for (std::uint32_t& corner : mesh.triangles[t]) corner = numbers[i][corner];
    });
  }
  mesh.vertices = table.take_vertices();
  return mesh;
}

}  // namespace voxdag

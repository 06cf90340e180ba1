#pragma once
/// Welds a triangle soup: corners with equal bits become one vertex. Vertices are in the order of
/// their first corners in the soup.
///
/// A first pass over the soup counts its triangles and estimates its vertices from a sample, so
/// that the arrays have their final size from the start. A second pass reads a batch of parts at a
/// time. Threads weld each part by itself. Then the vertices of the parts, which are far fewer than
/// the corners, are welded in order. A hash table takes at most 0.27 times the size of the finished
/// mesh.
#include <tbb/task_arena.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "voxdag/core/parallel/parallel_for.hpp"
#include "voxdag/formats/readers/chunks.hpp"
#include "voxdag/mesh/mesh.hpp"
#include "voxdag/mesh/vertex_table.hpp"

namespace voxdag {

/// The result of the first pass over a soup.
struct SoupSize {
  std::vector<std::size_t> first_triangles;  ///< Per part, and then the number of all triangles.
  std::size_t vertices = 0;                  ///< Estimated number of distinct vertices.
};

/// Counts a soup. `visit(part, body)` calls body(Vec3f) for the corners of one part in order, three
/// per triangle, and throws Fault at bad input. Throws Error, OverMemory, Cancelled.
template <class Visit>
SoupSize measure_soup(const MeshSource& source, const std::vector<std::string_view>& parts,
                      char line_end, const Visit& visit) {
  // One in so many vertices is in the sample, by hash: 16, and fewer in files over 1 GiB, so that
  // the sample stays small. A power of two.
  const std::uint64_t one_in =
      std::max<std::uint64_t>(16, std::bit_floor(source.bytes.size() >> 26));
  SoupSize size{std::vector<std::size_t>(parts.size() + 1), 0};
  MemoryBudget* const memory = source.work().memory;
  std::vector<CountedVector<Vec3f>> samples(parts.size(), CountedVector<Vec3f>(memory));
  for_each_chunk(source, parts, line_end, "scan", [&](std::size_t part) {
    VertexTable sample;
    std::size_t corners = 0;
    visit(part, [&](Vec3f position) {
      ++corners;
      if ((hash_bits(position) & (one_in - 1)) == 0) sample.find_or_add(position);
    });
    size.first_triangles[part + 1] = corners / 3;
    samples[part].assign(sample.vertices().begin(), sample.vertices().end());
  });
  VertexTable sample;
  MemoryReservation counted(memory, 0);
  for (std::size_t part = 0; part < parts.size(); ++part) {
    size.first_triangles[part + 1] += size.first_triangles[part];
    counted.resize(sample.bytes_with(samples[part].size()));
    for (const Vec3f position : samples[part]) sample.find_or_add(position);
  }
  // The true number hardly ever exceeds the estimate by four standard deviations.
  const auto sampled = static_cast<double>(sample.vertices().size());
  size.vertices = static_cast<std::size_t>(static_cast<double>(one_in) *
                                           (sampled + 4 * std::sqrt(sampled) + 4));
  size.vertices = std::min(size.vertices, 3 * size.first_triangles.back());
  return size;
}

/// Welds a soup of fewer than 2^32 / 3 triangles, which measure_soup() has counted. Throws Error,
/// OverMemory, Cancelled.
template <class Visit>
Mesh weld(const MeshSource& source, const std::vector<std::string_view>& parts, char line_end,
          const Visit& visit, const SoupSize& size) {
  const ReadOptions& options = source.options;
  Mesh mesh = empty_mesh(options.arrays);
  const std::vector<std::size_t>& starts = size.first_triangles;
  const std::size_t triangles = starts.back();
  // A full table is slow. This one is full only if almost no corners are shared.
  const std::size_t slots =
      64 + std::min(size.vertices * 8 / 5, (triangles + size.vertices) / 5 * 4);
  const std::uint64_t triangle_bytes = triangles * sizeof(Triangle);
  MemoryReservation memory(options.work.memory,
                           options.counted(triangle_bytes + size.vertices * sizeof(Vec3f) +
                                           slots * sizeof(std::uint32_t)));
  mesh.triangles.resize(triangles);
  VertexTable table(size.vertices, slots, options.arrays);

  const auto threads =
      static_cast<std::size_t>(std::max(tbb::this_task_arena::max_concurrency(), 1));
  const std::size_t batch = 2 * threads;
  for (std::size_t first = 0; first < parts.size(); first += batch) {
    const std::size_t last = std::min(first + batch, parts.size());
    const auto at = [&](std::size_t part) {
      return parts.begin() + static_cast<std::ptrdiff_t>(part);
    };
    // Each corner may need a vertex and a slot in the part's table; both arrays may double.
    const MemoryReservation scratch(
        options.work.memory,
        3 * (starts[last] - starts[first]) * (2 * sizeof(Vec3f) + 5 * sizeof(std::uint32_t)));
    std::vector<StoredVector<Vec3f>> vertices(last - first);
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
      memory.resize(options.counted(triangle_bytes + table.bytes_with(vertices[i].size())));
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

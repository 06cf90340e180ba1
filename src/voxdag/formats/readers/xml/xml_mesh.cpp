#include "voxdag/formats/readers/xml/xml_mesh.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "voxdag/formats/readers/text_scan.hpp"

namespace voxdag {

InstancedMesh::InstancedMesh(const MeshSource& source, std::uint64_t vertices,
                             std::uint64_t triangles)
    : source_(source), mesh_(empty_mesh(source.options.arrays)) {
  if (triangles == 0) throw source.error("no triangles: there is no surface to read");
  if (vertices >= std::numeric_limits<std::uint32_t>::max())
    throw source.error("the mesh has more than 4,294,967,294 vertices");
  memory_ = MemoryReservation(
      source.work().memory,
      source.options.counted(vertices * sizeof(Vec3f) +
                             triangles * (sizeof(Triangle) + sizeof(std::uint32_t))));
  mesh_.vertices.reserve(vertices);
  mesh_.triangles.reserve(triangles);
  mesh_.triangle_materials.reserve(triangles);
}

void InstancedMesh::begin_instance(const AffineTransform& transform) {
  source_.work().poll();
  transform_ = transform;
  first_vertex_ = static_cast<std::uint32_t>(mesh_.vertices.size());
  is_mirrored_ = transform.is_mirroring();
}

void InstancedMesh::add_vertex(Vec3d position) {
  const Vec3f vertex = source_.vertex(transform_.point(position));
  mesh_.vertices.push_back(vertex);
  source_.count_work(sizeof vertex);
}

void InstancedMesh::add_triangle(Triangle corners, std::uint32_t material) {
  if (is_mirrored_) std::swap(corners[1], corners[2]);
  for (std::uint32_t& corner : corners) corner += first_vertex_;
  mesh_.triangles.push_back(corners);
  mesh_.triangle_materials.push_back(material);
  source_.count_work(sizeof corners);
}

std::string_view take_word(std::string_view& text) {
  const auto is_gap = [](char c) { return is_blank(c) || c == '\n'; };
  while (!text.empty() && is_gap(text.front())) text.remove_prefix(1);
  std::size_t size = 0;
  while (size < text.size() && !is_gap(text[size])) ++size;
  const std::string_view token = text.substr(0, size);
  text.remove_prefix(size);
  return token;
}

void parse_exact_numbers(std::string_view text, std::span<double> values, const char* what) {
  const auto fail = [&](const std::string& reason) {
    throw Error(std::string(what) + " must have " + std::to_string(values.size()) +
                " finite numbers: " + reason);
  };
  for (double& value : values) {
    const std::string_view token = take_word(text);
    if (token.empty()) fail("it has fewer");
    if (!parse_float(token, value) || !std::isfinite(value)) fail("not " + in_quotes(token));
  }
  if (!take_word(text).empty()) fail("it has more");
}

std::uint32_t take_index(std::string_view& text, std::uint64_t end, const char* what) {
  const std::string_view token = take_word(text);
  std::int64_t value = 0;
  if (!parse_int(token, value) || value < 0 || static_cast<std::uint64_t>(value) >= end)
    throw Error(std::string(what) + " " + in_quotes(token) + " is no whole number from 0 to " +
                std::to_string(end) + " (excluded)");
  return static_cast<std::uint32_t>(value);
}

}  // namespace voxdag

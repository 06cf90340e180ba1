#pragma once
/// The memory that a mesh and its appearance hold.
#include <cstdint>

#include "voxdag/mesh/appearance.hpp"
#include "voxdag/mesh/mesh.hpp"

namespace voxdag {

/// Returns the bytes that a vector holds on the heap: none if it is in a store.
template <class T>
std::uint64_t memory_bytes(const StoredVector<T>& vector) {
  return vector.get_allocator().store() == nullptr ? vector.capacity() * sizeof(T) : 0;
}

/// Returns the bytes that the arrays of a mesh hold on the heap. Arrays in a store do not count.
inline std::uint64_t memory_bytes(const Mesh& mesh) {
  std::uint64_t bytes =
      memory_bytes(mesh.vertices) + memory_bytes(mesh.triangles) +
      memory_bytes(mesh.triangle_materials) +
      (mesh.materials.capacity() + mesh.objects.capacity()) * sizeof(std::string) +
      mesh.object_runs.capacity() * sizeof(ObjectRun);
  for (const std::string& name : mesh.materials) bytes += name.capacity();
  for (const std::string& name : mesh.objects) bytes += name.capacity();
  return bytes;
}

/// Returns the bytes that the arrays, materials and encoded images of an appearance hold.
inline std::uint64_t memory_bytes(const Appearance& appearance) {
  std::uint64_t bytes = appearance.normals.capacity() * sizeof(Vec3f) +
                        appearance.uvs.capacity() * sizeof(Vec2f) +
                        appearance.colors.capacity() * sizeof(Rgba16) +
                        appearance.materials.capacity() * sizeof(Material) +
                        appearance.images.capacity() * sizeof(TextureImage);
  for (const Material& material : appearance.materials) bytes += material.name.capacity();
  for (const TextureImage& image : appearance.images)
    bytes += image.name.capacity() + image.path.native().capacity() + image.bytes.capacity();
  return bytes;
}

}  // namespace voxdag

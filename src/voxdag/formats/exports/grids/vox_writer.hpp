#pragma once
/// Writes the chunks of a MagicaVoxel scene.
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "voxdag/core/io/atomic_file.hpp"
#include "voxdag/stored/attributes/value_pages.hpp"

namespace voxdag {

/// A voxel of a model: place and palette index.
struct VoxVoxel {
  std::uint8_t x, y, z, color;
};

/// Models are written as they come; the scene follows at the end.
class VoxWriter {
 public:
  explicit VoxWriter(const std::filesystem::path& path);

  /// Adds a model of 1 to 256 voxels a side whose voxel (0, 0, 0) lies at `position`.
  void add_model(Vec3i position, Vec3i size, std::span<const VoxVoxel> voxels);
  /// Writes the scene and the palette, whose color i has index i + 1, and completes the file.
  void commit(std::span<const Value8> palette);

 private:
  struct Instance {
    Vec3i position, size;
  };

  void write_chunk(const char (&name)[5], const std::string& content);
  void write_scene();

  AtomicFile file_;
  std::vector<Instance> instances_;
};

}  // namespace voxdag

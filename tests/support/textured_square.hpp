#pragma once
/// A mesh for tests of textures.
#include <cstdint>
#include <random>
#include <vector>

#include "support/temp_dir.hpp"
#include "support/test_png.hpp"
#include "voxdag/mesh/appearance.hpp"

namespace voxdag {

/// The unit square in the plane z = 0 as two triangles; the image stands upright on it.
struct Square {
  Mesh mesh;
  Appearance appearance;
  TempDir directory;

  Square() {
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    appearance.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 1}, {1, 0}, {0, 0}};
    appearance.materials.resize(1);
  }
  Material& material() { return appearance.materials[0]; }

  TextureUse texture(const char* name, int width, int height, int channels,
                     const std::vector<std::uint16_t>& samples) {
    const auto path = directory.path() / name;
    write_test_png(path, width, height, channels, 8, samples);
    appearance.images.push_back({path.string(), path, {}});
    TextureUse use;
    use.image = static_cast<int>(appearance.images.size()) - 1;
    return use;
  }
  /// Returns an image of RGB noise.
  TextureUse noise(int size, std::uint32_t seed) {
    std::mt19937 rng(seed);
    std::vector<std::uint16_t> samples(static_cast<std::size_t>(size * size) * 3);
    for (auto& sample : samples) sample = static_cast<std::uint16_t>(rng() >> 24 & 255);
    return texture("noise.png", size, size, 3, samples);
  }
};

}  // namespace voxdag

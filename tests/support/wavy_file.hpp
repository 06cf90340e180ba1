#pragma once
/// An ESVO file for tests of streaming.
#include <algorithm>
#include <cmath>

#include "support/grid_mesh.hpp"
#include "support/temp_dir.hpp"
#include "voxdag/builders/esvo/build/build_esvo.hpp"
#include "voxdag/builders/voxelize/grid_mapping.hpp"
#include "voxdag/cpu/render_image.hpp"
#include "voxdag/cpu/stream/stream_blocks.hpp"
#include "voxdag/file/esvo_file.hpp"
#include "voxdag/file/esvo_writer.hpp"

namespace voxdag {

/// Returns waves of some thousand triangles.
inline Mesh waves(int n) {
  return test::grid_mesh(n, [n](int i, int j) {
    const float x = static_cast<float>(i) / static_cast<float>(n);
    const float z = static_cast<float>(j) / static_cast<float>(n);
    return Vec3f{x, 0.2f + 0.1f * std::sin(20 * x) * std::cos(17 * z), z};
  });
}

/// An ESVO file of waves with many small blocks, and the options of a picture of it.
struct WavyFile {
  WavyFile() {
    const Mesh mesh = waves(60);
    EsvoOptions build;
    build.settings.max_error = 0.1f;
    build.settings.normal_error = 0.001f;
    build.pack.max_slots = 200;
    EsvoMemory memory;
    EsvoMetadata metadata;
    metadata.grid = grid = fit_grid(mesh, 9);
    EsvoResult result = build_esvo(mesh, metadata.grid, build, nullptr, nullptr, memory);
    metadata.root = result.root;
    metadata.counts = result.counts;
    EsvoFileWriter writer(path());
    const std::vector<std::uint64_t> slots = memory.take();
    bytes = slots.size() * 8;
    writer.append(slots);
    writer.finish(std::move(result.directory), metadata);
    options.width = 96;
    options.height = 64;
    options.occlusion_samples = 4;
    options.shadow_samples = 2;
    options.view.eye = Vec3d{0.5, 0.5, -0.2};
    options.view.target = Vec3d{0.5, 0.15, 0.4};
  }
  std::filesystem::path path() const { return dir / "waves.esvo"; }
  RenderedImage whole() const {
    const EsvoFile file(path());
    return render_image(file.view(), file.grid(), options);
  }
  TempDir dir;
  Grid grid;
  std::uint64_t bytes = 0;  ///< Of all blocks.
  RenderOptions options;
};

/// Returns the maximum bytes of a block and its ancestors.
inline std::uint64_t least_memory(const EsvoStream& stream) {
  std::uint64_t least = 0;
  for (std::size_t i = 0; i < stream.directory().size(); ++i) {
    std::uint64_t bytes = 0;
    for (auto at = static_cast<std::int64_t>(i); at >= 0;
         at = stream.parent(static_cast<std::size_t>(at)))
      bytes += stream.directory()[static_cast<std::size_t>(at)].slots * 8ull;
    least = std::max(least, bytes);
  }
  return least;
}

}  // namespace voxdag

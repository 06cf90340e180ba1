#pragma once
/// Random splats, and files of them that tests import.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "support/temp_dir.hpp"
#include "voxdag/formats/imports/import_voxels.hpp"

namespace voxdag {

/// A splat as a file stores it.
struct RawSplat {
  std::array<float, 3> center, log_scale, color;
  std::array<float, 4> rotation;
  float opacity;
};

inline std::vector<RawSplat> random_splats(int count, double side, double scale, unsigned seed) {
  std::mt19937 rng(seed);
  const auto any = [&](double lo, double hi) {
    return static_cast<float>(std::uniform_real_distribution<>(lo, hi)(rng));
  };
  std::vector<RawSplat> splats;
  for (int i = 0; i < count; ++i) {
    RawSplat splat{};
    for (std::size_t k = 0; k < 3; ++k) {
      splat.center[k] = any(0, side);
      splat.log_scale[k] = any(std::log(scale) - 4, std::log(scale));
      splat.color[k] = any(-3, 3);
    }
    for (float& part : splat.rotation) part = any(-2, 2);
    splat.opacity = any(-5, 6);
    splats.push_back(splat);
  }
  return splats;
}

/// Returns a PLY file. The properties are in an order of their own, among others.
inline std::string ply_of(const std::vector<RawSplat>& splats, bool is_text = false) {
  std::string ply = std::string("ply\nformat ") + (is_text ? "ascii" : "binary_little_endian") +
                    " 1.0\nelement vertex " + std::to_string(splats.size()) + "\n";
  for (const char* name :
       {"rot_0", "rot_1", "rot_2", "rot_3", "x", "y", "z", "nx", "f_dc_0", "f_dc_1", "f_dc_2",
        "f_rest_0", "opacity", "scale_0", "scale_1", "scale_2"})
    ply += std::string("property float ") + name + "\n";
  ply += "end_header\n";
  for (const RawSplat& s : splats) {
    const float row[] = {s.rotation[0], s.rotation[1],  s.rotation[2],  s.rotation[3],
                         s.center[0],   s.center[1],    s.center[2],    0,
                         s.color[0],    s.color[1],     s.color[2],     7,
                         s.opacity,     s.log_scale[0], s.log_scale[1], s.log_scale[2]};
    for (const float value : row) {
      char text[32];
      std::snprintf(text, sizeof text, "%.9g ", static_cast<double>(value));
      if (is_text)
        ply += text;
      else
        ply.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    if (is_text) ply += "\n";
  }
  return ply;
}

class SplatsTest : public testing::Test {
 protected:
  std::unique_ptr<VoxelSource> open(const std::string& bytes, const char* name = "s.ply") const {
    write_text(dir_ / name, bytes);
    return open_voxel_source(dir_ / name);
  }
  ImportOptions options() const {
    ImportOptions options;
    options.folder = dir_.path();
    options.color_bound = 0;
    return options;
  }
  ImportResult import(const std::string& bytes, const ImportOptions& options) const {
    return import_voxels(*open(bytes), options);
  }

  TempDir dir_;
};

}  // namespace voxdag

#pragma once
/// Imports volumes that tests write byte by byte, and damages them.
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "support/error_of.hpp"
#include "support/temp_dir.hpp"
#include "voxdag/formats/imports/import_voxels.hpp"

namespace voxdag {

/// Appends the lowest `bytes` bytes of a number.
inline void append(std::string& text, std::uint64_t value, int bytes, bool big_endian = false) {
  for (int i = 0; i < bytes; ++i)
    text += static_cast<char>(value >> 8 * (big_endian ? bytes - 1 - i : i));
}

/// All voxels of a source, in its order.
struct SourceVoxels {
  std::vector<Vec3i> voxels;
  std::vector<Rgb8> colors;
  std::vector<Label> labels;
  std::vector<double> channels;
};

class VolumeTest : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return dir_ / name; }
  /// Writes a new file, because writing to an existing one may wait for the disk.
  void write(const std::string& name, const std::string& bytes) const {
    std::filesystem::remove(path(name));
    write_text(path(name), bytes);
  }
  std::unique_ptr<VoxelSource> open(const std::string& name,
                                    std::optional<double> threshold = {}) const {
    return open_voxel_source(path(name), {threshold});
  }
  ImportResult import(const std::string& name, std::optional<double> threshold = {}) const {
    ImportOptions options;
    options.folder = dir_.path();
    return import_voxels(*open(name, threshold), options);
  }
  SourceVoxels read(const std::string& name, std::optional<double> threshold = {}) const {
    return read_with(name, {threshold});
  }
  SourceVoxels read_with(const std::string& name, const VoxelSourceOptions& options) const {
    SourceVoxels all;
    const auto source = open_voxel_source(path(name), options);
    const std::size_t each = source->channels().size();
    source->visit_all([&](const VoxelBatch& batch) {
      EXPECT_EQ(batch.labels.size(), source->has_labels() ? batch.places.size() : 0);
      EXPECT_EQ(batch.channels.size(), each * batch.places.size());
      all.labels.insert(all.labels.end(), batch.labels.begin(), batch.labels.end());
      all.channels.insert(all.channels.end(), batch.channels.begin(), batch.channels.end());
      for (const Vec3d place : batch.places) all.voxels.push_back(static_cast<Vec3i>(place));
      all.colors.insert(all.colors.end(), batch.colors.begin(), batch.colors.end());
    });
    return all;
  }
  /// Returns the error of importing a file of these bytes, or "no error".
  std::string error_of_bytes(const std::string& name, const std::string& bytes,
                             std::optional<double> threshold = {}) const {
    write(name, bytes);
    return error_of([&] { import(name, threshold); });
  }
  /// Expects that every file that ends early is refused.
  void expect_no_prefix_is_read(const std::string& name, const std::string& good) const {
    ASSERT_EQ(error_of_bytes(name, good), "no error");
    for (std::size_t size = 0; size < good.size(); ++size)
      EXPECT_NE(error_of_bytes(name, good.substr(0, size)), "no error") << size << " bytes";
  }
  /// Flips every bit in turn, which an Error or a result must follow. Returns how many files were
  /// refused.
  int flip_every_bit(const std::string& name, const std::string& good) const {
    int refused = 0;
    for (std::size_t bit = 0; bit < 8 * good.size(); ++bit) {
      std::string bad = good;
      bad[bit / 8] ^= static_cast<char>(1 << bit % 8);
      refused += error_of_bytes(name, bad) != "no error" ? 1 : 0;
    }
    return refused;
  }
  static bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  }

  TempDir dir_;
};

}  // namespace voxdag

#pragma once
/// Checks that the tests of all readers of points share.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "support/brute_svdag.hpp"
#include "support/error_of.hpp"
#include "support/temp_dir.hpp"
#include "voxdag/core/io/nameless_file.hpp"
#include "voxdag/formats/imports/import_voxels.hpp"

namespace voxdag {

struct PointCloud {
  std::vector<Vec3d> places;
  std::vector<Rgb8> colors;  ///< One for each point, or none.

  friend bool operator==(const PointCloud&, const PointCloud&) = default;
};

/// The warning about 16 bits that hold 8.
inline const std::vector<std::string> kTakenAs255 = {
    "16-bit colours are taken as 0 to 255: none is greater"};

/// Appends the bytes of a number.
template <class T>
void append(std::string& bytes, T value, bool is_big_endian = false) {
  char number[sizeof(T)];
  std::memcpy(number, &value, sizeof(T));
  if (is_big_endian) std::reverse(number, number + sizeof(T));
  bytes.append(number, sizeof(T));
}

/// Returns points whose coordinates are multiples of 1/8, so that every format can hold them.
inline PointCloud random_cloud(int count, unsigned seed) {
  std::mt19937 rng(seed);
  const auto any = [&](int lo, int hi) {
    return (lo + static_cast<int>(rng() % static_cast<unsigned>(hi - lo))) / 8.0;
  };
  PointCloud cloud;
  for (int i = 0; i < count; ++i) {
    cloud.places.push_back({any(-400, 600), any(8'000, 8'300), any(-10, 10)});
    const auto color = [&] { return static_cast<std::uint8_t>(rng()); };
    cloud.colors.push_back({color(), color(), color()});
  }
  return cloud;
}

/// Reads the bytes as a file whose name ends with `ending`.
class PointFile : public testing::Test {
 protected:
  explicit PointFile(const std::string& ending)
      : path_(dir_ / ("cloud" + ending)), memory_(open_memory_file()) {
    std::filesystem::create_symlink(path_of_descriptor(memory_.get()), path_);
  }

  PointCloud read(const std::string& bytes) const {
    write_text(path_, bytes);
    const auto source = open_voxel_source(path_);
    EXPECT_TRUE(source->has_points());
    PointCloud cloud;
    source->visit_all([&](const VoxelBatch& batch) {
      EXPECT_FALSE(batch.places.empty());
      EXPECT_EQ(batch.colors.size(), source->has_colors() ? batch.places.size() : 0);
      cloud.places.insert(cloud.places.end(), batch.places.begin(), batch.places.end());
      cloud.colors.insert(cloud.colors.end(), batch.colors.begin(), batch.colors.end());
    });
    return cloud;
  }
  struct LabelledPoints {
    std::vector<Label> labels;
    std::map<Label, std::string> names;
  };
  LabelledPoints read_labels(const std::string& bytes, const std::string& field) const {
    write_text(path_, bytes);
    const auto source = open_voxel_source(path_, {.labels = field});
    LabelledPoints points{{}, source->label_names()};
    source->visit_all([&](const VoxelBatch& batch) {
      points.labels.insert(points.labels.end(), batch.labels.begin(), batch.labels.end());
    });
    return points;
  }
  std::vector<std::string> warnings(const std::string& bytes) const {
    write_text(path_, bytes);
    return open_voxel_source(path_)->warnings();
  }
  std::string error(const std::string& bytes) const {
    return error_of([&] { read(bytes); });
  }
  void expect_error(const std::string& bytes, const std::string& part) const {
    const std::string message = error(bytes);
    EXPECT_NE(message.find(part), std::string::npos) << message;
    EXPECT_EQ(message.rfind(path_.string() + ": ", 0), 0u) << message;
  }

  /// Expects that importing the file sets the voxels of the points.
  void expect_voxels(const std::string& bytes, const std::vector<Vec3d>& places) const {
    write_text(path_, bytes);
    ImportOptions options;
    options.resolution = 64;
    options.folder = dir_.path();
    const ImportResult result = import_voxels(*open_voxel_source(path_), options);
    std::vector<Vec3i> voxels;
    for (const Vec3d place : places) {
      Vec3i voxel;
      for (int axis = 0; axis < 3; ++axis)
        voxel[axis] = std::min(
            63, static_cast<std::int32_t>(
                    std::floor((place[axis] - result.grid.origin[axis]) / result.grid.voxel_size)));
      voxels.push_back(voxel);
    }
    EXPECT_EQ(result.read, places.size());
    EXPECT_EQ(result.dag, brute_svdag(6, voxels));
  }

  /// Expects that every truncation is refused if it cuts the first `needed` bytes, and that all
  /// damaged files are refused in one line or read.
  void expect_damage_is_safe(const std::string& good, std::size_t needed) const {
    ASSERT_EQ(error(good), "no error");
    for (std::size_t size = 0; size < good.size(); ++size) {
      const std::string message = error(good.substr(0, size));
      EXPECT_TRUE(size >= needed || message != "no error") << size << " bytes";
      EXPECT_EQ(message.find('\n'), std::string::npos);
    }
    int refused = 0;
    for (std::size_t bit = 0; bit < 8 * good.size(); ++bit) {
      std::string bad = good;
      bad[bit / 8] = static_cast<char>(bad[bit / 8] ^ 1 << bit % 8);
      const std::string message = error(bad);
      EXPECT_EQ(message.find('\n'), std::string::npos);
      refused += message != "no error" ? 1 : 0;
    }
    EXPECT_GT(refused, 40);
  }

  TempDir dir_;
  std::filesystem::path path_;  ///< A link to a file in memory, which is fast to write.

 private:
  Descriptor memory_;
};

}  // namespace voxdag

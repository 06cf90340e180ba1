#pragma once
/// Writes and reads small files of meshes with appearance.
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "support/temp_dir.hpp"
#include "voxdag/formats/readers/read_mesh.hpp"

namespace voxdag {

class ReadAppearance : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& bytes) {
    std::ofstream(directory_.path() / name, std::ios::binary) << bytes;
    return directory_.path() / name;
  }
  /// Writes and reads a file; expects no warnings.
  MeshWithAppearance read(const std::string& name, const std::string& bytes) {
    MeshWithAppearance result = read_mesh_with_appearance(write(name, bytes));
    EXPECT_TRUE(result.warnings.empty()) << result.warnings[0];
    return result;
  }
  std::string path(const std::string& name) const { return (directory_.path() / name).string(); }

  TempDir directory_;
};

inline void expect_near(Vec3f a, Vec3f b, float error = 1e-4f) {
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(a[axis], b[axis], error);
}

inline const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

}  // namespace voxdag

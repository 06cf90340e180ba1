#pragma once
/// A mesh with colours and normals, the files that are built from it, and the hits that are traced
/// at them.
#include <gtest/gtest.h>

#include <array>
#include <cstring>

#include "colored_waves.hpp"
#include "npy_rays.hpp"
#include "process.hpp"
#include "support/temp_dir.hpp"
#include "support/test_rays.hpp"
#include "voxdag/file/npy.hpp"

namespace voxdag::cli {

inline constexpr const char* kHitDtype =
    "[('t', '<f4'), ('voxel', '<i4', (3,)), ('face', '|i1'), ('hit', '|b1'), "
    "('normal', '<f4', (3,)), ('color', '|u1', (3,))]";
inline constexpr std::size_t kHitRowBytes = 33;
inline constexpr std::size_t kGeometryBytes = 18;  ///< The bytes of a row before the normal.

/// A row of the traced hits.
struct Hit {
  explicit Hit(const std::string& row)
      : geometry(row.substr(0, kGeometryBytes)), is_hit(row[kGeometryBytes - 1] != 0) {
    std::memcpy(&normal, row.data() + kGeometryBytes, sizeof normal);
    std::memcpy(color.data(), row.data() + kGeometryBytes + sizeof normal, sizeof color);
  }

  std::string geometry;  ///< The bytes of t, voxel, face and hit.
  bool is_hit;
  Vec3f normal;
  std::array<std::uint8_t, 3> color{};
};

class AttributesCommand : public testing::Test {
 protected:
  AttributesCommand() { write_text(dir_ / "waves.obj", colored_waves()); }

  ProcessResult run_build(const std::string& name, std::vector<std::string> options) const {
    options.insert(options.begin(), {"build", dir_ / "waves.obj", "-r", "64", "-o", dir_ / name});
    return run_voxdag(options);
  }
  std::string build(const std::string& name, const std::vector<std::string>& options) const {
    const ProcessResult result = run_build(name, options);
    EXPECT_EQ(result.status, 0) << result.err;
    return dir_ / name;
  }
  std::vector<std::string> trace(const std::string& scene,
                                 const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words = {"trace",           scene, "--rays",
                                      dir_ / "rays.npy", "-o",  dir_ / "hits.npy"};
    words.insert(words.end(), more.begin(), more.end());
    const ProcessResult result = run_voxdag(words);
    EXPECT_EQ(result.status, 0) << result.err;
    NpyReader reader(dir_ / "hits.npy", kHitDtype, {}, kHitRowBytes);
    std::vector<std::string> rows(reader.rows(), std::string(kHitRowBytes, '\0'));
    for (std::string& row : rows) reader.read_rows(row.data(), 1);
    return rows;
  }
  void write_rays(const Grid& grid) const {
    TestRays source(grid, 1);
    std::vector<std::array<float, 8>> rays(3000);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Ray ray = source.make(static_cast<RayKind>(i % static_cast<int>(RayKind::kCount)));
      std::memcpy(rays[i].data(), &ray, sizeof ray);
    }
    write_text(dir_ / "rays.npy", rays_npy(rays));
  }

  TempDir dir_;
};

}  // namespace voxdag::cli

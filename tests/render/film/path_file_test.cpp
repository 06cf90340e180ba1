#include "voxdag/render/film/path_file.hpp"

#include <gtest/gtest.h>

#include "support/error_of.hpp"
#include "support/temp_dir.hpp"

namespace voxdag {
namespace {

TEST(PathFile, IsReadAsItWasWritten) {
  PathFile path;
  path.sun = Vec3d{0, 1, 0.5};
  path.keys = {{0, {1, 2, 3}, {4, 5, 6}, Vec3d{0, 1, 0}, 50.0},
               {1.5, {7, 8, 9}, {0, 0, 0}, {}, {}}};
  const TempDir folder;
  write_text(folder / "path.json", path_json(path));
  const PathFile read = read_path_file(folder / "path.json");
  ASSERT_EQ(read.keys.size(), 2u);
  EXPECT_EQ(read.sun, path.sun);
  EXPECT_EQ(read.keys[0].up, path.keys[0].up);
  EXPECT_EQ(read.keys[0].fov_degrees, path.keys[0].fov_degrees);
  EXPECT_EQ(read.keys[1].eye, path.keys[1].eye);
  EXPECT_FALSE(read.keys[1].up);
}

TEST(PathFile, AnEndlessFileIsRefused) {
  EXPECT_EQ(error_of([] { read_path_file("/dev/zero"); }),
            "/dev/zero: is neither a regular file nor a pipe");
}

TEST(PathFile, AnErrorNamesTheKey) {
  const TempDir folder;
  write_text(folder / "path.json", R"({"keys": [{"time": 0, "eye": [0,0,1], "target": 3}]})");
  EXPECT_EQ(
      error_of([&] { read_path_file(folder / "path.json"); }),
      (folder / "path.json").string() + ": key 0: \"target\" is not an array of three numbers");
}

}  // namespace
}  // namespace voxdag

// Compressed files and pipes, as every reader gets them.
#include "voxdag/formats/input_file.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>
#include <zstd.h>

#include <thread>

#include "imports/gzip_text.hpp"
#include "support/error_of.hpp"
#include "support/temp_dir.hpp"
#include "voxdag/formats/imports/import_voxels.hpp"
#include "voxdag/formats/readers/read_mesh.hpp"

namespace voxdag {
namespace {

const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

std::string zstd(const std::string& text) {
  std::string out(ZSTD_compressBound(text.size()), '\0');
  out.resize(ZSTD_compress(out.data(), out.size(), text.data(), text.size(), 3));
  return out;
}

TEST(InputFile, MeshesMayBeCompressed) {
  const TempDir dir;
  write_text(dir / "a.obj.gz", gzip(kTriangle));
  write_text(dir / "a.obj.zst", zstd(kTriangle));
  write_text(dir / "twice.obj.zst", zstd(kTriangle.substr(0, 9)) + zstd(kTriangle.substr(9)));
  write_text(dir / "b.obj", gzip(kTriangle));
  write_text(dir / "C.OBJ.GZ", gzip(kTriangle));
  for (const char* name : {"a.obj.gz", "a.obj.zst", "twice.obj.zst", "b.obj", "C.OBJ.GZ"})
    EXPECT_EQ(read_mesh(dir / name).triangles.size(), 1u) << name;
}

TEST(InputFile, ErrorsNameTheFileAsItWasGiven) {
  const TempDir dir;
  const auto error_of_file = [&](const std::string& name, const std::string& bytes) {
    write_text(dir / name, bytes);
    return error_of([&] { read_mesh(dir / name); });
  };
  const std::string name = (dir / "a.obj.gz").string();
  EXPECT_EQ(error_of_file("a.obj.gz", gzip("v 0 0 0\nf 1 2 9\n")).find(name + ": line 2"), 0u);
  EXPECT_EQ(error_of([&] { read_mesh(dir / "none.obj.gz"); }).find((dir / "none.obj.gz").string()),
            0u);
  const std::string packed = gzip(kTriangle), packed_zstd = zstd(kTriangle);
  for (std::size_t size = 4; size < packed.size(); ++size)
    EXPECT_EQ(error_of_file("a.obj.gz", packed.substr(0, size)).find(name + ": byte "), 0u) << size;
  for (std::size_t size = 4; size < packed_zstd.size(); ++size)
    EXPECT_NE(error_of_file("z.obj.zst", packed_zstd.substr(0, size)), "no error") << size;
  EXPECT_NE(error_of_file("z.obj.zst", packed_zstd + "more"), "no error");
}

TEST(InputFile, TheBudgetCountsWhatIsUnpacked) {
  const TempDir dir;
  write_text(dir / "a.obj.gz", gzip(kTriangle + std::string(4 << 20, '\n')));
  MemoryBudget memory(2 << 20);
  ReadOptions options;
  options.work = &memory;
  EXPECT_THROW(read_mesh(dir / "a.obj.gz", options), OverMemory);
  EXPECT_EQ(memory.used(), 0u);
  MemoryBudget enough(16 << 20);
  options.work = &enough;
  EXPECT_EQ(read_mesh(dir / "a.obj.gz", options).triangles.size(), 1u);
  EXPECT_LT(enough.used(), 1u << 20);
}

TEST(InputFile, PointsAndVolumesMayBeCompressed) {
  const TempDir dir;
  write_text(dir / "a.xyz.gz", gzip("0 0 0\n1 0 0\n"));
  write_text(dir / "a.xyz.zst", zstd("0 0 0\n1 0 0\n"));
  for (const char* name : {"a.xyz.gz", "a.xyz.zst"}) {
    ImportOptions options;
    options.voxel_size = 1;
    options.folder = dir.path();
    EXPECT_EQ(import_voxels(*open_voxel_source(dir / name), options).read, 2u) << name;
  }
  // The format may be named with the compression, as in names of files.
  std::filesystem::copy_file(dir / "a.xyz.gz", dir / "plain");
  for (const char* format : {"xyz", "xyz.gz", "XYZ.GZ"})
    EXPECT_TRUE(
        open_voxel_source(dir / "plain", {.threshold = {}, .format = format})->has_points());
  write_text(dir / "bad.xyz.gz", gzip("0 0 0\n1 0\n"));
  const std::string error = error_of([&] {
    ImportOptions options;
    options.voxel_size = 1;
    import_voxels(*open_voxel_source(dir / "bad.xyz.gz"), options);
  });
  EXPECT_EQ(error.find((dir / "bad.xyz.gz").string() + ": line 2"), 0u) << error;
}

TEST(InputFile, APipeIsReadOnceAndMayBeOpenedAgain) {
  for (const bool is_packed : {false, true}) {
    std::array<int, 2> ends{};
    ASSERT_EQ(pipe(ends.data()), 0);
    std::thread writer([&] {
      const std::string bytes = is_packed ? gzip(kTriangle) : kTriangle;
      EXPECT_EQ(write(ends[1], bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
      close(ends[1]);
    });
    // A number that no test uses again: its bytes stay known.
    const int descriptor = fcntl(ends[0], F_DUPFD, is_packed ? 801 : 800);
    close(ends[0]);
    const std::string path = "/dev/fd/" + std::to_string(descriptor);
    ReadOptions options;
    options.format = "obj";
    for (int i = 0; i < 2; ++i) EXPECT_EQ(read_mesh(path, options).triangles.size(), 1u);
    EXPECT_NE(error_of([&] { read_mesh(path); }), "no error");  // OBJ does not tell itself.
    writer.join();
  }
}

}  // namespace
}  // namespace voxdag

#include "voxdag/formats/exports/grids/export_binvox.hpp"

#include <algorithm>
#include <string>

#include "voxdag/core/io/atomic_file.hpp"
#include "voxdag/formats/exports/bit_planes.hpp"
#include "voxdag/formats/exports/coordinates.hpp"
#include "voxdag/formats/exports/export_common.hpp"

namespace voxdag {
namespace {

/// Writes values as pairs of bytes: the value and how often it follows itself, at most 255 times.
class RunWriter {
 public:
  explicit RunWriter(AtomicFile& file) : file_(file) {}

  void add(bool value, std::uint64_t count) {
    if (value != value_) {
      flush();
      value_ = value;
    }
    count_ += count;
  }
  void flush() {
    constexpr std::uint64_t kMax = 255;
    while (count_ > 0) {
      const std::uint64_t count = std::min(count_, kMax);
      const unsigned char pair[] = {value_ ? std::uint8_t{1} : std::uint8_t{0},
                                    static_cast<unsigned char>(count)};
      file_.write(pair, sizeof pair);
      count_ -= count;
    }
  }

 private:
  AtomicFile& file_;
  bool value_ = false;
  std::uint64_t count_ = 0;
};

}  // namespace

void export_binvox(const std::filesystem::path& path, const VoxelSet& voxels, const Grid& grid,
                   const ExportOptions& options) {
  const Box3i window = export_window(path, voxels, options);
  const Vec3i size = window.hi - window.lo;
  const std::int32_t side = std::max({size.x, size.y, size.z});
  const auto side64 = static_cast<std::uint64_t>(side);
  // A cube without voxels takes this many bytes.
  check_disk_space(path, side64 * side64 * side64 / 255 * 2);
  AtomicFile file(path);
  const std::string side_text = std::to_string(side);
  const Vec3d corner = grid.to_world(Vec3d(window.lo));
  file.write("#binvox 1\ndim " + side_text + " " + side_text + " " + side_text + "\ntranslate " +
             shortest(corner.x) + " " + shortest(corner.y) + " " + shortest(corner.z) + "\nscale " +
             shortest(grid.voxel_size * side) + "\ndata\n");
  RunWriter runs(file);
  // y runs fastest, then z, then x.
  const PlaneAxes axes{0, 2, 1};
  std::uint64_t done = 0;
  for_each_row(voxels, window, axes,
               [&](std::int32_t x, std::int32_t row, std::span<const std::uint64_t> bits) {
                 if ((row & 255) == 0 && options.progress)
                   options.progress(static_cast<double>(x - window.lo.x) / size.x, done);
                 std::int32_t at = 0;
                 for_each_run(bits, [&](std::int32_t begin, std::int32_t end) {
                   runs.add(false, static_cast<std::uint64_t>(begin - at));
                   runs.add(true, static_cast<std::uint64_t>(end - begin));
                   done += static_cast<std::uint64_t>(end - begin);
                   at = end;
                 });
                 runs.add(false, static_cast<std::uint64_t>(side - at));
                 if (row == size.z - 1)
                   runs.add(false, static_cast<std::uint64_t>(side - size.z) * side64);
               });
  runs.add(false, (side64 - static_cast<std::uint64_t>(size.x)) * side64 * side64);
  runs.flush();
  file.commit();
}

}  // namespace voxdag

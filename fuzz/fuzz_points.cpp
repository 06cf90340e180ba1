/// Fuzzes the readers of points: any bytes give points or an Error. The first byte chooses the
/// format, and whether labels are read; the others are the file.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "input_file.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/formats/imports/points/point_sources.hpp"

namespace {

using Path = std::filesystem::path;
using voxdag::LabelRequest;
using Open = std::unique_ptr<voxdag::VoxelSource> (*)(const Path&, const LabelRequest&);
/// The reader without channels.
template <auto kOpen>
std::unique_ptr<voxdag::VoxelSource> with_fields(const Path& path, const LabelRequest& labels) {
  return kOpen(path, labels, {});
}
constexpr Open kReaders[] = {
    [](const Path& path, const LabelRequest& labels) {
      return voxdag::open_ply_points(path, false, labels);
    },
    with_fields<voxdag::open_las_points>,
    with_fields<voxdag::open_pcd_points>,
    [](const Path& path, const LabelRequest& labels) {
      return voxdag::open_xyz_points(path, labels, {});
    },
    [](const Path& path, const LabelRequest& labels) {
      return voxdag::open_npy_points(path, voxdag::read_npy_start(path), labels);
    },
    [](const Path& path, const LabelRequest&) { return voxdag::open_splat_file(path); }};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const Path path = voxdag::input_file(data + 1, size - 1);
  try {
    const LabelRequest labels = data[0] >= 128 ? LabelRequest("") : std::nullopt;
    const auto source = kReaders[data[0] % std::size(kReaders)](path, labels);
    std::uint64_t points = 0;
    source->visit_all([&](const voxdag::VoxelBatch& batch) {
      points += batch.places.size();
      if (batch.colors.size() != (source->has_colors() ? batch.places.size() : 0)) abort();
      if (batch.labels.size() != (source->has_labels() ? batch.places.size() : 0)) abort();
      if (batch.splats.size() != (source->has_splats() ? batch.places.size() : 0)) abort();
    });
    // No format holds a point in less than three bytes, compressed by at most 88.
    if (points > 88 * size / 3) abort();
  } catch (const voxdag::Error&) {
  }
  return 0;
}

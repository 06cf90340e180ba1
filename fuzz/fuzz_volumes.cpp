/// Fuzzes the readers of volumes. The first byte chooses the reader, the threshold and whether
/// labels are read, the rest is the file. The voxels must lie in the grid of the file, or an Error
/// must follow.
#include <cmath>
#include <cstdlib>
#include <string>

#include "input_file.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/formats/imports/volumes/volume_sources.hpp"

namespace voxdag {
namespace {

/// A small file may stand for many voxels.
constexpr std::uint64_t kMaxVoxels = std::uint64_t{1} << 20;
struct Enough {};

std::unique_ptr<VoxelSource> open_chosen(std::uint8_t choice, const std::string& path) {
  std::optional<double> threshold;
  if (choice >= 128) threshold = 1.5;
  const LabelRequest labels = (choice & 64) != 0 ? LabelRequest("") : std::nullopt;
  switch (choice % 7) {
    case 0:
      return open_vox(path, labels);
    case 1:
      return open_binvox(path);
    case 2:
      return open_npy(path, threshold, labels);
    case 3:
      return open_nrrd(path, threshold, labels);
    case 4:
      return open_schematic(path, labels);
    case 5:
      return open_octomap(path, choice >= 128 ? std::optional(0.7) : std::nullopt);
    default:
      return open_nifti(path, threshold, labels);
  }
}

void check(const VoxelSource& source, const VoxelBatch& batch) {
  if (batch.colors.size() != (source.has_colors() ? batch.places.size() : 0)) std::abort();
  if (batch.labels.size() != (source.has_labels() ? batch.places.size() : 0)) std::abort();
  if (!source.grid()) return;
  const auto side = static_cast<double>(source.grid()->resolution());
  for (const Vec3d place : batch.places)
    for (int axis = 0; axis < 3; ++axis)
      if (!(place[axis] >= 0 && place[axis] < side) || place[axis] != std::floor(place[axis]))
        std::abort();
}

void read_all(std::uint8_t choice, const std::string& path) {
  const auto source = open_chosen(choice, path);
  source->warnings();
  std::uint64_t voxels = 0;
  source->visit_all([&](const VoxelBatch& batch) {
    check(*source, batch);
    voxels += batch.places.size();
    if (voxels > kMaxVoxels) throw Enough();
  });
}

}  // namespace
}  // namespace voxdag

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::filesystem::path path = voxdag::input_file(data + 1, size - 1);
  try {
    voxdag::read_all(data[0], path);
  } catch (const voxdag::Error&) {
  } catch (const voxdag::Enough&) {
  }
  return 0;
}

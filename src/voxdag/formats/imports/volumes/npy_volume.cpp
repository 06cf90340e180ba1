#include <bit>
#include <string_view>

#include "voxdag/core/error.hpp"
#include "voxdag/core/printable.hpp"
#include "voxdag/file/npy.hpp"
#include "voxdag/formats/imports/labels/label_value.hpp"
#include "voxdag/formats/imports/npy_type.hpp"
#include "voxdag/formats/imports/points/point_sources.hpp"
#include "voxdag/formats/imports/volumes/dense_source.hpp"
#include "voxdag/formats/imports/volumes/volume_sources.hpp"

namespace voxdag {
namespace {

std::unique_ptr<VoxelSource> open_volume(const std::filesystem::path& path, const NpyStart& start,
                                         std::optional<double> threshold, bool has_labels,
                                         const std::vector<ChannelRequest>& channels) {
  DenseVolume volume;
  volume.threshold = threshold;
  volume.has_labels = has_labels;
  const std::optional<NpyType> type = parse_npy_type(start.header.dtype);
  if (!type)
    throw Error(
        path.string(), "header",
        "the items of a volume must be bools, integers or real numbers of 16, 32 or 64 bits, "
        "not " +
            in_quotes(start.header.dtype));
  volume.type = type->value;
  volume.is_big_endian = type->is_swapped != (std::endian::native == std::endian::big);
  const std::vector<std::uint64_t>& shape = start.header.shape;
  volume.size = {shape[0], shape[1], shape[2]};
  check_volume_size(path, volume.size);
  volume.is_z_fastest = !start.header.fortran_order;
  if (shape.size() == 4) {
    if (!start.header.dtype.ends_with("u1") || (shape[3] != 3 && shape[3] != 4))
      throw Error(path.string(), "header",
                  "an array of four axes must be uint8 of shape (X, Y, Z, 3) or (X, Y, Z, 4)");
    volume.channels = static_cast<int>(shape[3]);
  }
  const bool is_planar = volume.channels > 1 && start.header.fortran_order;
  Grid grid;
  grid.levels = levels_of(volume.size);
  return make_dense_source({.volume = volume,
                            .map = VolumeMap(grid),
                            .channels = channels,
                            .path = path,
                            .data = MappedFile(path, MappedFile::Access::kSequential),
                            .begin = start.data,
                            .encoding = is_planar ? Encoding::kPlanar : Encoding::kRaw});
}

}  // namespace

std::unique_ptr<VoxelSource> open_npy(const std::filesystem::path& path,
                                      std::optional<double> threshold, const LabelRequest& labels,
                                      const std::vector<ChannelRequest>& channels) {
  const NpyStart start = read_npy_start(path);
  const std::size_t axes = start.header.shape.size();
  if (axes == 3 || axes == 4)
    return open_volume(path, start, threshold, wants_labels(labels), channels);
  if (threshold) throw Error(path.string(), "", "has no values to compare with a threshold");
  return open_npy_points(path, start, labels, channels);
}

}  // namespace voxdag

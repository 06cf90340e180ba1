#include <string_view>

#include "voxdag/core/error.hpp"
#include "voxdag/core/printable.hpp"
#include "voxdag/file/npy.hpp"
#include "voxdag/formats/imports/points/point_sources.hpp"
#include "voxdag/formats/imports/volumes/dense_source.hpp"
#include "voxdag/formats/imports/volumes/volume_sources.hpp"

namespace voxdag {
namespace {

struct NamedType {
  std::string_view dtype;  ///< Without the byte order.
  ValueType type;
};

constexpr NamedType kNpyTypes[] = {
    {"b1", ValueType::kUint8},  {"i1", ValueType::kInt8},   {"u1", ValueType::kUint8},
    {"i2", ValueType::kInt16},  {"u2", ValueType::kUint16}, {"i4", ValueType::kInt32},
    {"u4", ValueType::kUint32}, {"i8", ValueType::kInt64},  {"u8", ValueType::kUint64},
    {"f4", ValueType::kFloat},  {"f8", ValueType::kDouble}};

void parse_dtype(const std::filesystem::path& path, std::string_view dtype, DenseVolume& volume) {
  const char order = dtype.empty() ? '\0' : dtype[0];
  if (order == '<' || order == '>' || order == '|')
    for (const NamedType& named : kNpyTypes)
      if (dtype.substr(1) == named.dtype && (order != '|' || bytes_of(named.type) == 1)) {
        volume.type = named.type;
        volume.is_big_endian = order == '>';
        return;
      }
  throw Error(
      path.string(), "header",
      "the items of a volume must be bools, integers, float32 or float64, not " + in_quotes(dtype));
}

std::unique_ptr<VoxelSource> open_volume(const std::filesystem::path& path, const NpyStart& start,
                                         std::optional<double> threshold) {
  DenseVolume volume;
  volume.threshold = threshold;
  parse_dtype(path, start.header.dtype, volume);
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
  Grid grid;
  grid.levels = levels_of(volume.size);
  const bool is_planar = volume.channels > 1 && start.header.fortran_order;
  return make_dense_source({volume,
                            grid,
                            {},
                            path,
                            MappedFile(path, MappedFile::Access::kSequential),
                            start.data,
                            is_planar ? Encoding::kPlanar : Encoding::kRaw});
}

}  // namespace

std::unique_ptr<VoxelSource> open_npy(const std::filesystem::path& path,
                                      std::optional<double> threshold) {
  const NpyStart start = read_npy_start(path);
  const std::size_t axes = start.header.shape.size();
  if (axes == 3 || axes == 4) return open_volume(path, start, threshold);
  if (threshold) throw Error(path.string(), "", "has no values to compare with a threshold");
  return open_npy_points(path);
}

}  // namespace voxdag

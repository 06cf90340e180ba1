#include "voxdag/formats/exports/export_arrays.hpp"

#include <algorithm>
#include <span>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/atomic_file.hpp"
#include "voxdag/file/npy.hpp"
#include "voxdag/formats/exports/channel_fields.hpp"
#include "voxdag/formats/exports/export_common.hpp"
#include "voxdag/formats/exports/volume_file.hpp"
#include "voxdag/stored/attributes/look_reader.hpp"

namespace voxdag {
namespace {

constexpr std::int64_t kStripBytes = std::int64_t{32} << 20;
constexpr std::size_t kRowsAtOnce = 16384;

const ArrayLayout kNpyDense{"1 where the voxel is set", "uint8", "xyz"};
const ArrayLayout kRawDense{"1 where the voxel is set", "uint8", "zyx"};

/// The type of a row of coordinates. It is a structured type if the look has attributes.
struct CoordinateRows {
  CoordinateRows(const LookReader& look, const ChannelFields& channels) {
    if (look.is_empty() && channels.is_empty()) return;
    layout = {"voxels with their attributes, in Morton order", "", ""};
    dtype = "[('voxel', '<i4', (3,))";
    if (look.has_normals()) add(", ('normal', '<f4', (3,))", sizeof(Vec3f));
    if (look.has_colors()) add(", ('color', '|u1', (3,))", sizeof(Value8));
    if (look.has_materials()) add(", ('material', '<u2')", sizeof(std::uint16_t));
    constexpr const char* kTaken[] = {"voxel", "normal", "color", "material"};
    for (std::size_t i = 0; i < channels.count(); ++i)
      add(ChannelFields::npy_field(look.channels(), i, kTaken),
          ChannelFields::size_of(channels.kind(i)));
    dtype += "]";
    layout.dtype = dtype;
    shape = {};
    item_bytes = bytes;
  }

  std::string dtype = "<i4";  ///< Type of an item, in the syntax of NumPy.
  std::vector<std::uint64_t> shape{3};
  std::size_t item_bytes = sizeof(std::int32_t);
  std::size_t bytes = sizeof(Vec3i);  ///< Size of a row.
  ArrayLayout layout{"voxel coordinates (x, y, z), in Morton order", "int32", ""};

 private:
  void add(const std::string& field, std::size_t size) {
    dtype += field;
    bytes += size;
  }
};

template <class T>
void append(std::vector<std::byte>& rows, const T& value) {
  const auto bytes = std::as_bytes(std::span(&value, 1));
  rows.insert(rows.end(), bytes.begin(), bytes.end());
}

Vec3l size_of(const Box3i& window) { return Vec3l(window.hi) - Vec3l(window.lo); }

void refuse_too_large(const std::filesystem::path& path, const Box3i& window,
                      const ExportOptions& options) {
  const Vec3l size = size_of(window);
  const auto bytes = static_cast<std::uint64_t>(size.x * size.y * size.z);  // at most 2^60
  if (bytes > options.most_dense_bytes)
    throw Error(path.string(), "",
                "a dense array of " + std::to_string(size.x) + " x " + std::to_string(size.y) +
                    " x " + std::to_string(size.z) + " voxels has " + std::to_string(bytes) +
                    " bytes, more than the limit of " + std::to_string(options.most_dense_bytes) +
                    ": choose a smaller window");
  check_disk_space(path, bytes);
}

/// Calls write(bytes) for one part of the dense array after the other. A part is a range of layers
/// on the slowest axis, or a range on the middle axis if a single layer is too large.
template <class Write>
void for_each_dense_strip(const VoxelSet& voxels, const Box3i& window, const std::string& axes,
                          const ExportOptions& options, const Write& write) {
  const int slow = axes[0] - 'x', mid = axes[1] - 'x', fast = axes[2] - 'x';
  const Vec3l size = size_of(window);
  const std::int64_t layer = size[mid] * size[fast];
  const std::int64_t layers = std::clamp<std::int64_t>(kStripBytes / layer, 1, size[slow]);
  const std::int64_t lines =
      layers > 1 ? size[mid] : std::clamp<std::int64_t>(kStripBytes / size[fast], 1, size[mid]);

  std::vector<std::uint8_t> bytes;
  std::uint64_t done = 0;
  for (std::int64_t a = window.lo[slow]; a < window.hi[slow]; a += layers)
    for (std::int64_t b = window.lo[mid]; b < window.hi[mid]; b += lines) {
      Box3i strip = window;
      strip.lo[slow] = static_cast<std::int32_t>(a);
      strip.hi[slow] =
          static_cast<std::int32_t>(std::min<std::int64_t>(a + layers, window.hi[slow]));
      strip.lo[mid] = static_cast<std::int32_t>(b);
      strip.hi[mid] = static_cast<std::int32_t>(std::min<std::int64_t>(b + lines, window.hi[mid]));
      const Vec3l strip_size = size_of(strip);
      bytes.assign(static_cast<std::size_t>(strip_size.x * strip_size.y * strip_size.z), 0);
      voxels.for_each_voxel(strip, [&](Vec3i voxel) {
        const Vec3l at = Vec3l(voxel - strip.lo);
        bytes[(at[slow] * strip_size[mid] + at[mid]) * strip_size[fast] + at[fast]] = 1;
        ++done;
      });
      write(bytes);
      const auto strips_done = static_cast<double>((a - window.lo[slow]) * size[mid] +
                                                   (b - window.lo[mid] + 1) * layers);
      if (options.progress)
        options.progress(std::min(1.0, strips_done / static_cast<double>(size[slow] * size[mid])),
                         done);
    }
}

}  // namespace

void export_npy_coordinates(const std::filesystem::path& path, const VoxelSet& voxels,
                            const Grid& grid, const ExportOptions& options) {
  const Box3i window = export_window(path, voxels, options);
  LookReader look = options.look_reader();
  ChannelFields channels(look);
  const CoordinateRows row(look, channels);
  const std::uint64_t count = count_for_export(path, voxels, window, row.bytes, options);
  NpyWriter writer(path, row.dtype, row.shape, row.item_bytes, count);
  std::vector<std::byte> rows;
  export_leaf_blocks(voxels, window, count, options, [&](Vec3i origin, std::uint64_t mask) {
    for (; mask != 0; mask &= mask - 1) {
      const Vec3i voxel =
          origin + morton_decode(static_cast<std::uint64_t>(std::countr_zero(mask)));
      append(rows, voxel);
      if (!look.is_empty()) {
        const VoxelLook of_voxel = look.read(voxel, voxels.levels());
        if (look.has_normals()) append(rows, of_voxel.normal);
        if (look.has_colors()) append(rows, of_voxel.color);
        if (look.has_materials()) append(rows, of_voxel.material);
      }
      if (channels.is_empty()) continue;
      const std::span<const std::byte> fields = channels.row(voxel, voxels.levels());
      rows.insert(rows.end(), fields.begin(), fields.end());
    }
    if (rows.size() < kRowsAtOnce * row.bytes) return;
    writer.write_bytes(rows.data(), rows.size());
    rows.clear();
  });
  writer.write_bytes(rows.data(), rows.size());
  writer.commit();
  write_placement(path, grid, window, row.layout, options);
}

void export_npy_dense(const std::filesystem::path& path, const VoxelSet& voxels, const Grid& grid,
                      const ExportOptions& options) {
  const Box3i window = export_window(path, voxels, options);
  refuse_too_large(path, window, options);
  const Vec3l size = size_of(window);
  const Vec3<std::uint64_t> shape(size);
  NpyWriter writer(path, "|u1", {shape.y, shape.z}, 1, shape.x);
  for_each_dense_strip(voxels, window, kNpyDense.axes, options,
                       [&](const std::vector<std::uint8_t>& bytes) {
                         writer.write_bytes(bytes.data(), bytes.size());
                       });
  writer.commit();
  write_placement(path, grid, window, kNpyDense, options);
}

void export_raw(const std::filesystem::path& path, const VoxelSet& voxels, const Grid& grid,
                const ExportOptions& options) {
  const Box3i window = export_window(path, voxels, options);
  refuse_too_large(path, window, options);
  AtomicFile file(path);
  for_each_dense_strip(voxels, window, kRawDense.axes, options,
                       [&](const std::vector<std::uint8_t>& bytes) {
                         file.write(std::span<const std::uint8_t>(bytes));
                       });
  file.commit();
  write_placement(path, grid, window, kRawDense, options);
}

void export_volume(const std::filesystem::path& path, const std::string& format,
                   const VoxelSet& voxels, const Grid& grid, const ExportOptions& options) {
  const Box3i window = export_window(path, voxels, options);
  refuse_too_large(path, window, options);
  VolumeFile file(path, format, grid, window, VolumeFile::Values::kUint8);
  for_each_dense_strip(
      voxels, window, kRawDense.axes, options,
      [&](const std::vector<std::uint8_t>& bytes) { file.write(bytes.data(), bytes.size()); });
  file.commit();
}

}  // namespace voxdag

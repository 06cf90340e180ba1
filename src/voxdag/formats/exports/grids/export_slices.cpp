#include "voxdag/formats/exports/grids/export_slices.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/temporary_folder.hpp"
#include "voxdag/formats/exports/bit_planes.hpp"
#include "voxdag/formats/exports/export_common.hpp"
#include "voxdag/image/png_rows.hpp"
#include "voxdag/stored/attributes/look_reader.hpp"

namespace voxdag {
namespace {

std::string slice_name(std::int32_t slice, std::size_t digits) {
  const std::string number = std::to_string(slice);
  return "slice_" + std::string(digits - number.size(), '0') + number + ".png";
}

/// Packs bits with the first in the highest bit of a byte.
void pack_bits(std::span<const std::uint64_t> bits, std::vector<std::uint8_t>& row) {
  std::fill(row.begin(), row.end(), std::uint8_t{0});
  for_each_run(bits, [&](std::int32_t begin, std::int32_t end) {
    for (std::int32_t i = begin; i < end; ++i)
      row[static_cast<std::size_t>(i) / 8] |= static_cast<std::uint8_t>(0x80 >> (i & 7));
  });
}

bool has_bits(std::span<const std::uint64_t> bits) {
  return std::any_of(bits.begin(), bits.end(), [](std::uint64_t word) { return word != 0; });
}

/// Returns the axes of slices across `axis`.
PlaneAxes axes_of(int axis) {
  const int column = axis == 0 ? 1 : 0, row = axis == 2 ? 1 : 2;
  return {axis, row, column};
}

/// Returns the folder that a path names. Throws Error if it exists and is not empty.
std::filesystem::path new_folder(const std::filesystem::path& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  fs::path folder = path.has_filename() ? path : path.parent_path();
  // Renaming needs the folder itself, not "." or a symbolic link to it.
  if (fs::path canonical = fs::weakly_canonical(folder, error); !error) folder = canonical;
  if (fs::exists(folder, error) &&
      !(fs::is_directory(folder, error) && fs::is_empty(folder, error)))
    throw Error(folder.string(), "",
                error ? error.message() : "exists and is not an empty folder: choose another name");
  return folder;
}

}  // namespace

void export_slices(const std::filesystem::path& folder, int axis, const VoxelSet& voxels,
                   const Grid& grid, const ExportOptions& options) {
  const Box3i window = export_window(folder, voxels, options);
  const PlaneAxes axes = axes_of(axis);
  const Vec3i size = window.hi - window.lo;
  const auto width = static_cast<std::uint32_t>(size[axes.column]);
  const auto height = static_cast<std::uint32_t>(size[axes.row]);
  LookReader look = options.look_reader();
  const bool has_colors = look.has_colors();
  const std::size_t digits = std::max<std::size_t>(4, std::to_string(size[axis] - 1).size());

  const TemporaryFolder output(new_folder(folder));
  std::vector<std::uint8_t> row(has_colors ? std::size_t{width} * 4 : (std::size_t{width} + 7) / 8);
  const std::vector<std::uint8_t> empty_row(row.size());
  std::unique_ptr<PngRowWriter> file;
  bool has_files = false;
  std::uint64_t done = 0;
  for_each_row(voxels, window, axes,
               [&](std::int32_t k, std::int32_t at, std::span<const std::uint64_t> bits) {
                 if ((at & 255) == 0 && options.progress)
                   options.progress(static_cast<double>(k - window.lo[axis]) / size[axis], done);
                 if (at == 0) file.reset();
                 if (file == nullptr) {
                   if (options.skip_empty && !has_bits(bits)) return;
                   file = std::make_unique<PngRowWriter>(
                       output.path() / slice_name(k - window.lo[axis], digits), width, height,
                       has_colors ? PngPixels::kRgba : PngPixels::kBits);
                   has_files = true;
                   for (std::int32_t skipped = 0; skipped < at; ++skipped) file->write(empty_row);
                 }
                 if (has_colors) {
                   std::fill(row.begin(), row.end(), std::uint8_t{0});
                   for_each_run(bits, [&](std::int32_t begin, std::int32_t end) {
                     for (std::int32_t i = begin; i < end; ++i) {
                       Vec3i voxel = window.lo;
                       voxel[axis] = k;
                       voxel[axes.row] += at;
                       voxel[axes.column] += i;
                       const Value8 color = look.read(voxel, voxels.levels()).color;
                       const std::array<std::uint8_t, 4> pixel{color.x, color.y, color.z, 255};
                       std::copy(pixel.begin(), pixel.end(), row.begin() + 4 * std::ptrdiff_t{i});
                     }
                   });
                 } else {
                   pack_bits(bits, row);
                 }
                 for_each_run(bits, [&](std::int32_t begin, std::int32_t end) {
                   done += static_cast<std::uint64_t>(end - begin);
                 });
                 file->write(row);
                 if (at == size[axes.row] - 1) file->commit();
               });
  file.reset();
  if (!has_files) throw Error(folder.string(), "", "no slice is left: all are without voxels");
  const std::string names = "xyz";
  ArrayLayout layout{
      has_colors ? "RGBA, opaque where the voxel is set" : "1 where the voxel is set",
      has_colors ? "RGBA of 8 bits" : "1 bit",
      {names[axis], names[axes.row], names[axes.column]}};
  layout.has_numbered_slices = options.skip_empty;
  write_placement_file(output.path() / "placement.json", grid, window, layout, options);
  output.take_name();
}

}  // namespace voxdag

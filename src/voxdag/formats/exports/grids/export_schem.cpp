#include "voxdag/formats/exports/grids/export_schem.hpp"

#include <algorithm>
#include <bit>
#include <span>
#include <string>
#include <unordered_map>

#include "voxdag/formats/exports/bit_planes.hpp"
#include "voxdag/formats/exports/export_common.hpp"
#include "voxdag/formats/exports/grids/block_palette.hpp"
#include "voxdag/formats/exports/grids/gzip_file.hpp"
#include "voxdag/stored/attributes/look_reader.hpp"

namespace voxdag {
namespace {

constexpr std::int64_t kMaxSchemSide = 32767, kMaxBlocks = 0x7FFFFFFF;

/// Writes named binary tags (NBT), big-endian.
class NbtWriter {
 public:
  explicit NbtWriter(GzipFile& file) : file_(file) {}

  void begin_compound(std::string_view name) { head(10, name); }
  void end_compound() { file_.write(std::string_view("\0", 1)); }
  void add_short(std::string_view name, std::int16_t value) {
    head(2, name);
    number(value);
  }
  void add_int(std::string_view name, std::int32_t value) {
    head(3, name);
    number(value);
  }
  void add_ints(std::string_view name, std::span<const std::int32_t> values) {
    head(11, name);
    number(static_cast<std::int32_t>(values.size()));
    for (const std::int32_t value : values) number(value);
  }
  void add_empty_list(std::string_view name) {
    head(9, name);
    file_.write(std::string_view("\0", 1));
    number(std::int32_t{0});
  }
  /// `count` bytes must follow.
  void begin_bytes(std::string_view name, std::int32_t count) {
    head(7, name);
    number(count);
  }

 private:
  void head(char type, std::string_view name) {
    file_.write({&type, 1});
    number(static_cast<std::int16_t>(name.size()));
    file_.write(name);
  }
  template <class T>
  void number(T value) {
    char bytes[sizeof(T)];
    for (std::size_t i = 0; i < sizeof(T); ++i)
      bytes[i] = static_cast<char>(value >> (8 * (sizeof(T) - 1 - i)) & 0xFF);
    file_.write({bytes, sizeof bytes});
  }

  GzipFile& file_;
};

/// Finds the blocks of colours, and remembers them.
class BlockOfColor {
 public:
  /// Returns the number of the block in the palette, which begins with air.
  char operator()(Value8 color) {
    const std::uint32_t key = color.x | std::uint32_t{color.y} << 8 | std::uint32_t{color.z} << 16;
    if (known_.size() > kMaxKnown) known_.clear();
    const auto [place, is_new] = known_.try_emplace(key);
    if (is_new) place->second = static_cast<char>(1 + nearest_block(color));
    return place->second;
  }

 private:
  static constexpr std::size_t kMaxKnown = std::size_t{1} << 18;
  std::unordered_map<std::uint32_t, char> known_;
};

void check_size(const std::filesystem::path& path, Vec3i size) {
  for (int axis = 0; axis < 3; ++axis)
    if (size[axis] > kMaxSchemSide)
      refuse_export(path, std::to_string(size[axis]) +
                              " blocks along an axis are more than the 32767 of a schematic");
  const std::int64_t blocks = std::int64_t{size.x} * size.y * size.z;  // at most 2^45
  if (blocks > kMaxBlocks)
    refuse_export(path, std::to_string(blocks) +
                            " blocks, with air, are more than the 2147483647 of a schematic");
}

void write_palette(NbtWriter& nbt, bool has_colors) {
  const std::string space = "minecraft:";
  std::int32_t index = 0;
  nbt.begin_compound("Palette");
  nbt.add_int(space + "air", index++);
  if (has_colors)
    for (const ColoredBlock& block : kColoredBlocks) nbt.add_int(space + block.name, index++);
  else
    nbt.add_int(space + "stone", index++);
  nbt.end_compound();
  nbt.add_int("PaletteMax", index);
}

}  // namespace

void export_schem(const std::filesystem::path& path, const VoxelSet& voxels, const Grid& grid,
                  const ExportOptions& options) {
  const Box3i window = export_window(path, voxels, options);
  const Vec3i size = window.hi - window.lo;
  check_size(path, size);
  LookReader look = options.look_reader();
  const bool has_colors = look.has_colors();

  constexpr std::int32_t kMinecraft1_16_5 = 2586;
  GzipFile file(path);
  NbtWriter nbt(file);
  nbt.begin_compound("Schematic");
  nbt.add_int("Version", 2);
  nbt.add_int("DataVersion", kMinecraft1_16_5);
  nbt.add_short("Width", static_cast<std::int16_t>(size.x));
  nbt.add_short("Height", static_cast<std::int16_t>(size.y));
  nbt.add_short("Length", static_cast<std::int16_t>(size.z));
  nbt.add_ints("Offset", std::array<std::int32_t, 3>{});
  write_palette(nbt, has_colors);
  nbt.begin_bytes("BlockData", size.x * size.y * size.z);
  // x runs fastest, then z, then y.
  const PlaneAxes axes{1, 2, 0};
  std::string row;
  BlockOfColor block_of;
  std::uint64_t done = 0;
  for_each_row(voxels, window, axes,
               [&](std::int32_t y, std::int32_t at, std::span<const std::uint64_t> bits) {
                 if ((at & 255) == 0 && options.progress)
                   options.progress(static_cast<double>(y - window.lo.y) / size.y, done);
                 row.assign(static_cast<std::size_t>(size.x), '\0');
                 for_each_run(bits, [&](std::int32_t begin, std::int32_t end) {
                   done += static_cast<std::uint64_t>(end - begin);
                   for (std::int32_t i = begin; i < end; ++i) {
                     const Vec3i voxel{window.lo.x + i, y, window.lo.z + at};
                     row[i] = has_colors ? block_of(look.read(voxel, voxels.levels()).color) : '\1';
                   }
                 });
                 file.write(row);
               });
  nbt.add_empty_list("BlockEntities");
  nbt.end_compound();
  file.commit();
  write_placement(path, grid, window, {"blocks: place 0 is air", "uint8", "yzx"}, options);
}

}  // namespace voxdag

/// Reads the files of Minecraft's editors. Formats: the Sponge schematic, versions 1 to 3
/// (github.com/SpongePowered/Schematic-Specification); MCEdit's .schematic; Litematica's
/// .litematic; the structures that Minecraft saves (minecraft.wiki/w/Structure_file).
#include <algorithm>
#include <bit>
#include <limits>
#include <string>
#include <vector>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/mapped_file.hpp"
#include "voxdag/formats/imports/batched_voxels.hpp"
#include "voxdag/formats/imports/labels/label_value.hpp"
#include "voxdag/formats/imports/volumes/block_color.hpp"
#include "voxdag/formats/imports/volumes/nbt.hpp"
#include "voxdag/formats/imports/volumes/volume_grid.hpp"
#include "voxdag/formats/imports/volumes/volume_sources.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {
namespace {

/// The meaning of a number in the palette: whether it sets a voxel, and the colour.
struct BlockLook {
  bool is_set = false;
  Rgb8 color{};
  Label label = 0;  ///< The number of the name in Schematic::names_.
};

/// A box of blocks. x runs fastest, then z, then y.
struct BlockBox {
  enum class Form : std::uint8_t {
    kVarints,  ///< Numbers of the palette, 7 bits in a byte, the lowest first; bit 7: more follow.
    kPacked,   ///< Numbers of the palette, `bits` each, from the lowest bit of longs on.
    kBytes,    ///< Numbers of MCEdit, of which 0 is air; `more` may hold 4 more bits of each.
    kList      ///< A list of blocks with their places.
  };
  Form form = Form::kVarints;
  Vec3l lo;    ///< Least coordinates in the file.
  Vec3l size;  ///< Blocks along x, y and z, 0 to 1,048,576 each.
  std::vector<BlockLook> palette = {};
  std::string_view data = {}, more = {};
  int bits = 0;
  NbtTag list = {};    ///< Of kList.
  std::size_t at = 0;  ///< Byte of the data, for errors.

  std::uint64_t blocks() const { return static_cast<std::uint64_t>(size.x * size.y * size.z); }
  Vec3d place(std::uint64_t i) const {
    const auto x = static_cast<std::uint64_t>(size.x), z = static_cast<std::uint64_t>(size.z);
    return {static_cast<double>(i % x), static_cast<double>(i / (x * z)),
            static_cast<double>(i / x % z)};
  }
};

class Schematic final : public VoxelSource {
 public:
  Schematic(const std::filesystem::path& path, bool has_labels)
      : path_(path), mapping_(path), nbt_(path, mapping_.text()), has_labels_(has_labels) {
    read(nbt_.root());
    if (boxes_.empty()) nbt_.fail(0, "has no blocks");
    find_extent();
  }

  bool has_points() const override { return false; }
  bool has_colors() const override { return boxes_[0].form != BlockBox::Form::kBytes; }
  bool has_palette() const override { return true; }
  bool has_labels() const override { return has_labels_; }
  std::map<Label, std::string> label_names() const override {
    std::map<Label, std::string> names;
    for (const auto& [name, label] : names_) names.emplace(label, name);
    return names;
  }
  std::optional<Grid> grid() const override { return grid_; }
  std::optional<char> up() const override { return 'y'; }
  Vec3l first_voxel() const override { return lo_; }

  void visit_all(const VisitBatch& visit) const override {
    BatchedVoxels voxels(visit);
    for (const BlockBox& box : boxes_) {
      const auto from = static_cast<Vec3d>(box.lo - lo_);
      const auto add = [&](std::uint64_t number, Vec3d place) {
        if (number >= box.palette.size())
          nbt_.fail(box.at, "block " + std::to_string(number) + " is not in the palette of " +
                                std::to_string(box.palette.size()));
        const BlockLook look = box.palette[static_cast<std::size_t>(number)];
        if (!look.is_set) return;
        if (has_labels_) voxels.add_label(look.label);
        voxels.add(from + place, look.color);
      };
      switch (box.form) {
        case BlockBox::Form::kVarints:
          visit_varints(box, add);
          break;
        case BlockBox::Form::kPacked:
          visit_packed(box, add);
          break;
        case BlockBox::Form::kBytes:
          for (std::size_t i = 0; i < box.blocks(); ++i)
            if (const Label number = number_in(box, i); number != 0) {
              if (has_labels_) voxels.add_label(number);
              voxels.add(from + box.place(i));
            }
          break;
        case BlockBox::Form::kList:
          nbt_.for_each_item(box.list, [&](NbtTag block) {
            const Vec3l place = triple(nbt_.get(block, "pos"));
            for (int axis = 0; axis < 3; ++axis)
              if (place[axis] < 0 || place[axis] >= box.size[axis])
                nbt_.fail(block.at, "the block lies outside of the structure");
            add(static_cast<std::uint64_t>(nbt_.integer(nbt_.get(block, "state"))),
                static_cast<Vec3d>(place));
          });
      }
    }
    voxels.finish();
  }

 private:
  /// Returns the number of a block of MCEdit.
  static Label number_in(const BlockBox& box, std::size_t i) {
    const Label more = i / 2 < box.more.size() ? static_cast<unsigned char>(box.more[i / 2]) : 0;
    return (i % 2 == 0 ? more & 0xF : more >> 4) << 8 | static_cast<unsigned char>(box.data[i]);
  }

  template <class Add>
  void visit_varints(const BlockBox& box, const Add& add) const {
    std::size_t at = 0;
    for (std::uint64_t i = 0; i < box.blocks(); ++i) {
      std::uint64_t number = 0;
      for (int shift = 0;; shift += 7) {
        if (at == box.data.size())
          nbt_.fail(box.at,
                    "has " + std::to_string(i) + " of " + std::to_string(box.blocks()) + " blocks");
        if (shift > 28) nbt_.fail(box.at + at, "the number of a block is longer than 5 bytes");
        const auto byte = static_cast<unsigned char>(box.data[at++]);
        number |= std::uint64_t{byte & 0x7Fu} << shift;
        if (byte < 0x80) break;
      }
      add(number, box.place(i));
    }
    if (at != box.data.size())
      nbt_.fail(box.at, "has more than " + std::to_string(box.blocks()) + " blocks");
  }

  template <class Add>
  static void visit_packed(const BlockBox& box, const Add& add) {
    const std::uint64_t mask = (std::uint64_t{1} << box.bits) - 1;
    for (std::uint64_t i = 0; i < box.blocks(); ++i) {
      const std::uint64_t bit = i * static_cast<std::uint64_t>(box.bits);
      const auto word = static_cast<std::size_t>(bit / 64);
      const int shift = static_cast<int>(bit % 64);
      std::uint64_t number = Nbt::item(box.data, 8, word) >> shift;
      if (shift + box.bits > 64) number |= Nbt::item(box.data, 8, word + 1) << (64 - shift);
      add(number & mask, box.place(i));
    }
  }

  void read(NbtTag root) {
    if (const auto regions = nbt_.find(root, "Regions")) return read_regions(*regions);
    if (const auto blocks = nbt_.find(root, "blocks")) return read_structure(root, *blocks);
    if (const auto inner = nbt_.find(root, "Schematic")) return read_box(*inner);
    read_box(root);
  }

  /// Reads a schematic of Sponge or MCEdit.
  void read_box(NbtTag root) {
    BlockBox box;
    constexpr const char* kSides[] = {"Width", "Height", "Length"};
    for (int axis = 0; axis < 3; ++axis)  // A side is an unsigned short.
      box.size[axis] = nbt_.integer(nbt_.get(root, kSides[axis])) & 0xFFFF;
    if (const auto offset = nbt_.find(root, "Offset")) box.lo = triple(*offset);
    const NbtTag blocks = nbt_.find(root, "Blocks").value_or(root);
    NbtTag data = blocks;
    if (const auto palette = nbt_.find(root, "Palette")) {  // versions 1 and 2
      read_palette(*palette, box);
      data = nbt_.get(root, "BlockData");
    } else if (nbt_.is_compound(blocks) && blocks.at != root.at) {  // version 3
      read_palette(nbt_.get(blocks, "Palette"), box);
      data = nbt_.get(blocks, "Data");
    } else if (blocks.at != root.at) {
      box.form = BlockBox::Form::kBytes;
      if (const auto more = nbt_.find(root, "AddBlocks")) box.more = nbt_.array(*more, 1);
    } else {
      nbt_.fail(root.at, "is neither a schematic nor a structure");
    }
    box.at = data.at;
    box.data = nbt_.array(data, 1);
    // Each block takes a byte or more.
    if (box.data.size() < box.blocks())
      nbt_.fail(data.at, "has " + std::to_string(box.data.size()) + " bytes for " +
                             std::to_string(box.blocks()) + " blocks");
    boxes_.push_back(std::move(box));
  }

  /// The palette of Sponge has a number for each name. Numbers may be left out.
  void read_palette(NbtTag palette, BlockBox& box) {
    nbt_.for_each_entry(palette, [&](std::string_view name, NbtTag entry) {
      const std::int64_t number = nbt_.integer(entry);
      if (number < 0 || number > kMaxPalette)
        nbt_.fail(entry.at,
                  "the number of a block is not from 0 to " + std::to_string(kMaxPalette));
      const auto index = static_cast<std::size_t>(number);
      if (index >= box.palette.size()) box.palette.resize(index + 1);
      box.palette[index] = look_of(name);
    });
  }

  /// The palettes of Litematica and of structures are lists of blocks with names.
  void read_names(NbtTag palette, BlockBox& box) {
    nbt_.for_each_item(palette, [&](NbtTag block) {
      if (box.palette.size() > kMaxPalette) nbt_.fail(palette.at, "has more than 1048576 blocks");
      box.palette.push_back(look_of(nbt_.text(nbt_.get(block, "Name"))));
    });
  }

  void read_regions(NbtTag regions) {
    nbt_.for_each_entry(regions, [&](std::string_view, NbtTag region) {
      BlockBox box;
      box.form = BlockBox::Form::kPacked;
      box.lo = triple(nbt_.get(region, "Position"));
      box.size = triple(nbt_.get(region, "Size"));
      for (int axis = 0; axis < 3; ++axis) {
        if (box.size[axis] < 0) {  // The position is then the upper corner.
          box.lo[axis] += box.size[axis] + 1;
          box.size[axis] = -box.size[axis];
        }
      }
      check_size(region.at, box.size);
      read_names(nbt_.get(region, "BlockStatePalette"), box);
      box.bits = std::max(
          2, static_cast<int>(std::bit_width(std::max<std::size_t>(box.palette.size(), 1) - 1)));
      const NbtTag data = nbt_.get(region, "BlockStates");
      box.at = data.at;
      box.data = nbt_.array(data, 8);
      if (box.data.size() * 8 / static_cast<std::size_t>(box.bits) < box.blocks())
        nbt_.fail(data.at, "has " + std::to_string(box.data.size() / 8) + " longs for " +
                               std::to_string(box.blocks()) + " blocks of " +
                               std::to_string(box.bits) + " bits");
      boxes_.push_back(std::move(box));
    });
  }

  void read_structure(NbtTag root, NbtTag blocks) {
    BlockBox box;
    box.form = BlockBox::Form::kList;
    box.size = triple(nbt_.get(root, "size"));
    check_size(root.at, box.size);
    box.list = blocks;
    box.at = blocks.at;
    auto palette = nbt_.find(root, "palette");
    // A structure may have several palettes, of which Minecraft takes one by chance.
    if (const auto palettes = palette ? std::nullopt : nbt_.find(root, "palettes"))
      nbt_.for_each_item(*palettes, [&](NbtTag item) { palette = palette ? palette : item; });
    if (!palette) nbt_.fail(root.at, "has no entry palette");
    read_names(*palette, box);
    boxes_.push_back(std::move(box));
  }

  BlockLook look_of(std::string_view name) {
    if (is_air(name)) return {};
    const auto label = names_.try_emplace(std::string(name.substr(0, name.find('['))),
                                          static_cast<Label>(names_.size()) + 1);
    return {true, color_of_block(name), label.first->second};
  }

  /// Reads three numbers: entries x, y and z of a compound, the items of a list, or an array.
  Vec3l triple(NbtTag tag) const {
    Vec3l result;
    int count = 0;
    if (nbt_.is_compound(tag)) {
      constexpr const char* kNames[] = {"x", "y", "z"};
      for (; count < 3; ++count) result[count] = nbt_.integer(nbt_.get(tag, kNames[count]));
    } else if (nbt_.is_list(tag)) {
      nbt_.for_each_item(tag, [&](NbtTag item) {
        if (count < 3) result[count] = nbt_.integer(item);
        ++count;
      });
    } else {
      const std::string_view numbers = nbt_.array(tag, 4);
      count = static_cast<int>(std::min<std::size_t>(numbers.size() / 4, 4));
      for (int axis = 0; axis < std::min(count, 3); ++axis)
        result[axis] =
            static_cast<std::int32_t>(Nbt::item(numbers, 4, static_cast<std::size_t>(axis)));
    }
    if (count != 3) nbt_.fail(tag.at, "is not three numbers");
    constexpr std::int64_t kFarthest = std::int64_t{1} << 31;
    for (int axis = 0; axis < 3; ++axis)
      if (result[axis] < -kFarthest || result[axis] > kFarthest)
        nbt_.fail(tag.at, "lies farther than 2147483648 blocks from the origin");
    return result;
  }

  void check_size(std::size_t byte, Vec3l size) const {
    for (int axis = 0; axis < 3; ++axis)
      if (size[axis] < 0 || size[axis] > kMaxSide)
        nbt_.fail(byte, "a side is not from 0 to 1048576 blocks");
  }

  void find_extent() {
    constexpr std::int64_t kNone = std::numeric_limits<std::int64_t>::max();
    Vec3l lo{kNone, kNone, kNone}, hi{-kNone, -kNone, -kNone};
    for (const BlockBox& box : boxes_) {
      lo = min(lo, box.lo);
      hi = max(hi, box.lo + box.size);
    }
    grid_ = grid_of_scene(path_, lo, hi);
    lo_ = lo;
  }

  static constexpr std::int64_t kMaxSide = std::int64_t{1} << kMaxLevels, kMaxPalette = 1 << 20;

  std::filesystem::path path_;
  MappedFile mapping_;
  Nbt nbt_;
  bool has_labels_;
  std::map<std::string, Label> names_;  ///< Of blocks, without their states.
  std::vector<BlockBox> boxes_;
  Grid grid_;
  Vec3l lo_;
};

}  // namespace

std::unique_ptr<VoxelSource> open_schematic(const std::filesystem::path& path,
                                            const LabelRequest& labels) {
  return std::make_unique<Schematic>(path, wants_labels(labels));
}

}  // namespace voxdag

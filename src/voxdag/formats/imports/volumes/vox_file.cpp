#include "voxdag/formats/imports/volumes/vox_file.hpp"

#include <charconv>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "voxdag/core/error.hpp"
#include "voxdag/core/printable.hpp"

namespace voxdag {
namespace {

/// A place in the bytes of a file, and the end that must not be passed. All functions throw Error
/// with the byte.
class VoxCursor {
 public:
  VoxCursor(const std::filesystem::path& path, std::string_view bytes)
      : path_(path), bytes_(bytes), end_(bytes.size()) {}

  std::uint64_t at() const { return at_; }
  std::uint64_t left() const { return end_ - at_; }

  [[noreturn]] void fail(const std::string& reason) const { fail_at(at_, reason); }
  [[noreturn]] void fail_at(std::uint64_t byte, const std::string& reason) const {
    throw Error(path_.string(), ErrorPlace::byte(byte), reason);
  }

  std::string_view bytes(std::uint64_t count) {
    if (count > left())
      fail("truncated: needs " + std::to_string(count) + " bytes, has " + std::to_string(left()));
    at_ += count;
    return bytes_.substr(at_ - count, count);
  }
  std::uint32_t uint32() {
    std::uint32_t value = 0;
    for (int i = 0; const char c : bytes(4))
      value |= std::uint32_t{static_cast<unsigned char>(c)} << 8 * i++;
    return value;
  }
  std::int32_t int32() { return static_cast<std::int32_t>(uint32()); }
  /// Reads a count of items of at least `item_bytes` each, which must fit before the end.
  std::uint32_t count(std::uint64_t item_bytes, const char* items) {
    const std::uint64_t byte = at_;
    const std::uint32_t value = uint32();
    if (value > left() / item_bytes)
      fail_at(byte, "has " + std::to_string(value) + " " + items + ", more than fit");
    return value;
  }
  std::string_view string() { return bytes(count(1, "characters")); }
  /// Calls entry(key, value) for all entries of a dictionary.
  template <class Entry>
  void dictionary(const Entry& entry) {
    for (std::uint32_t i = count(8, "entries"); i > 0; --i) {
      const std::string_view key = string();
      entry(key, string());
    }
  }

  /// Returns a cursor for the next `count` bytes, and passes them.
  VoxCursor part(std::uint64_t count) {
    VoxCursor inner = *this;
    bytes(count);
    inner.end_ = at_;
    return inner;
  }

 private:
  std::filesystem::path path_;
  std::string_view bytes_;
  std::uint64_t at_ = 0, end_;
};

constexpr std::int32_t kMaxModelSide = 256;

/// Returns the palette of files without one: the colours with components 00, 33, ... FF except
/// black, then ten darker shades of red, green, blue and grey.
std::array<Rgb8, 256> default_palette() {
  std::array<Rgb8, 256> palette{};
  std::size_t next = 1;
  for (int red = 255; red >= 0; red -= 51)
    for (int green = 255; green >= 0; green -= 51)
      for (int blue = 255; blue >= 0; blue -= 51)
        if (red + green + blue > 0)
          palette[next++] = {static_cast<std::uint8_t>(red), static_cast<std::uint8_t>(green),
                             static_cast<std::uint8_t>(blue)};
  for (const Rgb8 mask : {Rgb8{1, 0, 0}, Rgb8{0, 1, 0}, Rgb8{0, 0, 1}, Rgb8{1, 1, 1}})
    for (const int shade : {0xEE, 0xDD, 0xBB, 0xAA, 0x88, 0x77, 0x55, 0x44, 0x22, 0x11}) {
      for (std::size_t c = 0; c < 3; ++c)
        palette[next][c] = static_cast<std::uint8_t>(shade * mask[c]);
      ++next;
    }
  return palette;
}

/// Returns the whole text as a number; none if it is not one.
std::optional<std::int32_t> number_of(std::string_view text) {
  std::int32_t value = 0;
  const char* const end = text.data() + text.size();
  const auto [next, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || next != end) return std::nullopt;
  return value;
}

VoxRotation parse_rotation(const VoxCursor& cursor, std::string_view text) {
  const std::optional<std::int32_t> value = number_of(text);
  const int first = value.value_or(0) & 3, second = value.value_or(0) >> 2 & 3;
  if (!value || *value < 0 || *value > 127 || first == 3 || second == 3 || first == second)
    cursor.fail("the rotation " + in_quotes(text) + " is not a permutation of the axes with signs");
  VoxRotation rotation;
  rotation.axis = {static_cast<std::uint8_t>(first), static_cast<std::uint8_t>(second),
                   static_cast<std::uint8_t>(3 - first - second)};
  for (std::size_t row = 0; row < 3; ++row)
    rotation.is_negative[row] = (*value >> (4 + row) & 1) != 0;
  return rotation;
}

Vec3i parse_translation(const VoxCursor& cursor, std::string_view text) {
  Vec3i translation;
  std::string_view rest = text;
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t end = axis < 2 ? rest.find(' ') : rest.size();
    const std::optional<std::int32_t> value = number_of(rest.substr(0, end));
    if (end == std::string_view::npos || !value)
      cursor.fail("the translation " + in_quotes(text) + " is not three whole numbers");
    translation[axis] = *value;
    rest.remove_prefix(axis < 2 ? end + 1 : end);
  }
  return translation;
}

class VoxParser {
 public:
  VoxParser(const std::filesystem::path& path, std::string_view bytes) : cursor_(path, bytes) {
    file_.palette = default_palette();
  }

  VoxFile parse() {
    if (cursor_.left() < 8 || cursor_.bytes(4) != "VOX ") cursor_.fail_at(0, "is not a .vox file");
    cursor_.uint32();  // The version: 150 or 200.
    if (cursor_.bytes(4) != "MAIN") cursor_.fail_at(8, "the first chunk is not MAIN");
    const std::uint32_t content = cursor_.uint32(), children = cursor_.uint32();
    cursor_.bytes(content);
    VoxCursor chunks = cursor_.part(children);
    if (cursor_.left() > 0)
      file_.warnings.push_back("bytes after the MAIN chunk are left out: " +
                               std::to_string(cursor_.left()));
    while (chunks.left() > 0) parse_chunk(chunks);
    if (size_) chunks.fail("a SIZE chunk has no XYZI chunk");
    if (declared_models_ && *declared_models_ > file_.models.size())
      chunks.fail("has " + std::to_string(file_.models.size()) +
                  " models, but the PACK chunk says " + std::to_string(*declared_models_));
    if (outside_ > 0)
      file_.warnings.push_back("voxels outside of their models are left out: " +
                               std::to_string(outside_));
    return std::move(file_);
  }

 private:
  void parse_chunk(VoxCursor& chunks) {
    const std::uint64_t begin = chunks.at();
    const std::string_view id = chunks.bytes(4);
    const std::uint32_t size = chunks.uint32();
    // Chunks below MAIN have no children, but some writers give them a size of children, or put the
    // chunks of a model into PACK. What follows is a chunk in all cases.
    chunks.uint32();
    VoxCursor content = chunks.part(size);
    if (id == "PACK") declared_models_ = content.uint32();
    if (id == "SIZE") parse_size(content);
    if (id == "XYZI") parse_voxels(content);
    if (id == "RGBA") parse_palette(content);
    if (id == "nTRN") parse_transform(content, begin);
    if (id == "nGRP") parse_group(content, begin);
    if (id == "nSHP") parse_shape(content, begin);
    if (id == "LAYR") parse_layer(content);
  }

  void parse_size(VoxCursor& content) {
    if (size_) content.fail("a SIZE chunk has no XYZI chunk");
    size_ = Vec3i{};
    for (int axis = 0; axis < 3; ++axis) {
      const std::int32_t side = (*size_)[axis] = content.int32();
      if (side < 1 || side > kMaxModelSide)
        content.fail("the model is " + std::to_string(side) + " voxels long; 1 to 256 are allowed");
    }
  }

  void parse_voxels(VoxCursor& content) {
    if (!size_) content.fail("an XYZI chunk has no SIZE chunk");
    VoxModel model;
    model.size = *size_;
    size_.reset();
    model.count = content.count(4, "voxels");
    if (content.left() != 4 * std::uint64_t{model.count})
      content.fail("the chunk is longer than its " + std::to_string(model.count) + " voxels");
    model.first_voxel = content.at();
    while (content.left() > 0) {
      const std::string_view voxel = content.bytes(4);
      const Vec3i at{static_cast<unsigned char>(voxel[0]), static_cast<unsigned char>(voxel[1]),
                     static_cast<unsigned char>(voxel[2])};
      if (voxel[3] == 0) continue;
      if (!model.contains(at)) {
        ++outside_;
        continue;
      }
      model.lo = min(model.lo, at);
      model.hi = max(model.hi, at);
    }
    file_.models.push_back(model);
  }

  /// The colours in the file are those of the indices 1 to 255, and one that is not used. Some
  /// writers stop after the last colour that they use.
  void parse_palette(VoxCursor& content) {
    for (std::size_t i = 1; i <= 256 && content.left() > 0; ++i) {
      const std::string_view color = content.bytes(4);
      for (std::size_t c = 0; i < 256 && c < 3; ++c)
        file_.palette[i][c] = static_cast<std::uint8_t>(color[c]);
    }
  }

  VoxNode& add_node(VoxCursor& content, std::uint64_t begin, VoxNode::Kind kind) {
    const std::int32_t id = content.int32();
    const auto [place, is_new] = file_.nodes.try_emplace(id);
    if (!is_new) content.fail_at(begin, "node " + std::to_string(id) + " is there twice");
    VoxNode& node = place->second;
    node.kind = kind;
    node.byte = begin;
    content.dictionary([&](std::string_view key, std::string_view value) {
      if (key == "_hidden") node.is_hidden = value == "1";
    });
    return node;
  }

  void parse_transform(VoxCursor& content, std::uint64_t begin) {
    VoxNode& node = add_node(content, begin, VoxNode::Kind::kTransform);
    node.children.push_back(content.int32());
    content.int32();  // Reserved.
    node.layer = content.int32();
    if (content.uint32() == 0) content.fail("the transform has no frame");
    // Only the first frame.
    content.dictionary([&](std::string_view key, std::string_view value) {
      if (key == "_r") node.rotation = parse_rotation(content, value);
      if (key == "_t") node.translation = parse_translation(content, value);
    });
  }

  void parse_group(VoxCursor& content, std::uint64_t begin) {
    VoxNode& node = add_node(content, begin, VoxNode::Kind::kGroup);
    for (std::uint32_t i = content.count(4, "children"); i > 0; --i)
      node.children.push_back(content.int32());
  }

  void parse_shape(VoxCursor& content, std::uint64_t begin) {
    VoxNode& node = add_node(content, begin, VoxNode::Kind::kShape);
    if (content.uint32() == 0) content.fail("the shape has no model");
    node.children.push_back(content.int32());  // Only the first model.
  }

  void parse_layer(VoxCursor& content) {
    const std::int32_t id = content.int32();
    content.dictionary([&](std::string_view key, std::string_view value) {
      if (key == "_hidden" && value == "1") file_.hidden_layers.insert(id);
    });
  }

  VoxCursor cursor_;
  VoxFile file_;
  std::optional<Vec3i> size_;  ///< Of the model whose voxels come next.
  std::optional<std::uint32_t> declared_models_;
  std::uint64_t outside_ = 0;  ///< Voxels.
};

}  // namespace

VoxFile parse_vox(const std::filesystem::path& path, std::string_view bytes) {
  return VoxParser(path, bytes).parse();
}

}  // namespace voxdag

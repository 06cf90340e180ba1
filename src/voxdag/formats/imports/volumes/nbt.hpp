#pragma once
/// Reads named binary tags (NBT) in place, as Minecraft and its editors write them.
///
/// Format: minecraft.wiki/w/NBT_format. Numbers are big-endian.
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace voxdag {

/// A value in the file: its type, and the byte at which it begins.
struct NbtTag {
  std::uint8_t type = 0;
  std::size_t at = 0;
};

/// The bytes of a file of tags. It allocates nothing: each lookup passes over the tags before. All
/// functions throw Error with the byte if the file is damaged or a value has another type.
class Nbt {
 public:
  /// The bytes must outlive the object.
  Nbt(std::filesystem::path path, std::string_view bytes) : path_(std::move(path)), bytes_(bytes) {}

  /// Returns the compound that is the file. Checks that all its tags are whole.
  NbtTag root() const;
  /// Returns the entry of a compound, if it has one of this name.
  std::optional<NbtTag> find(NbtTag compound, std::string_view name) const;
  /// Returns find(), and throws Error if there is none.
  NbtTag get(NbtTag compound, std::string_view name) const;
  void for_each_entry(NbtTag compound,
                      const std::function<void(std::string_view name, NbtTag)>& visit) const;
  void for_each_item(NbtTag list, const std::function<void(NbtTag)>& visit) const;
  static bool is_compound(NbtTag tag);
  static bool is_list(NbtTag tag);
  /// Returns a byte, short, int or long.
  std::int64_t integer(NbtTag tag) const;
  std::string_view text(NbtTag tag) const;
  /// Returns the bytes of an array whose items have 1, 4 or 8 bytes.
  std::string_view array(NbtTag tag, int item_bytes) const;
  /// Returns item `index` of array(tag, 4 or 8).
  static std::uint64_t item(std::string_view array, int item_bytes, std::size_t index);
  [[noreturn]] void fail(std::size_t byte, const std::string& reason) const;

 private:
  static constexpr int kMaxDepth = 512;  ///< The format's own limit.

  void expect(NbtTag tag, std::uint8_t type, const char* name) const;
  std::uint64_t bits(std::size_t at, int count) const;
  /// Returns the byte after a value.
  std::size_t end_of(NbtTag tag, int depth = 0) const;
  /// Calls visit(name, entry) until it returns false.
  template <class Visit>
  std::size_t walk_entries(NbtTag compound, int depth, Visit visit) const;

  std::filesystem::path path_;
  std::string_view bytes_;
};

}  // namespace voxdag

#include "voxdag/formats/imports/volumes/nbt.hpp"

#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

/// The numbers of the types of tags.
enum NbtType : std::uint8_t {
  kNbtEnd = 0,
  kNbtByte = 1,
  kNbtLong = 4,
  kNbtDouble = 6,
  kNbtBytes = 7,
  kNbtText = 8,
  kNbtList = 9,
  kNbtCompound = 10,
  kNbtInts = 11,
  kNbtLongs = 12
};

/// Bytes of the numbers of type byte, short, int, long, float and double; 0 for other types.
constexpr int nbt_number_bytes(std::uint8_t type) {
  constexpr int kBytes[] = {0, 1, 2, 4, 8, 4, 8};
  return type <= kNbtDouble ? kBytes[type] : 0;
}

/// Bytes of an array's item; 0 for other types.
constexpr int nbt_item_bytes(std::uint8_t type) {
  return type == kNbtBytes ? 1 : type == kNbtInts ? 4 : type == kNbtLongs ? 8 : 0;
}

}  // namespace

void Nbt::fail(std::size_t byte, const std::string& reason) const {
  throw Error(path_.string(), ErrorPlace::byte(byte), reason);
}

std::uint64_t Nbt::bits(std::size_t at, int count) const {
  if (at > bytes_.size() || bytes_.size() - at < static_cast<std::size_t>(count))
    fail(bytes_.size(), "truncated: ends inside a tag");
  std::uint64_t value = 0;
  for (int i = 0; i < count; ++i) value = value << 8 | static_cast<unsigned char>(bytes_[at++]);
  return value;
}

void Nbt::expect(NbtTag tag, std::uint8_t type, const char* name) const {
  if (tag.type != type) fail(tag.at, std::string("is not ") + name);
}

template <class Visit>
std::size_t Nbt::walk_entries(NbtTag compound, int depth, Visit visit) const {
  std::size_t at = compound.at;
  for (;;) {
    const auto type = static_cast<std::uint8_t>(bits(at, 1));
    if (type == kNbtEnd) return at + 1;
    const std::size_t length = bits(at + 1, 2);
    at += 3;
    if (bytes_.size() - at < length) fail(bytes_.size(), "truncated: ends inside a name");
    const std::string_view name = bytes_.substr(at, length);
    const NbtTag entry{type, at + length};
    if (!visit(name, entry)) return at;
    at = end_of(entry, depth + 1);
  }
}

std::size_t Nbt::end_of(NbtTag tag, int depth) const {
  if (depth > kMaxDepth) fail(tag.at, "tags are nested more than 512 deep");
  if (const int number = nbt_number_bytes(tag.type)) {
    bits(tag.at, number);
    return tag.at + static_cast<std::size_t>(number);
  }
  if (const int item = nbt_item_bytes(tag.type)) return tag.at + 4 + array(tag, item).size();
  switch (tag.type) {
    case kNbtText:
      return tag.at + 2 + text(tag).size();
    case kNbtCompound:
      return walk_entries(tag, depth, [](std::string_view, NbtTag) { return true; });
    case kNbtList: {
      const auto type = static_cast<std::uint8_t>(bits(tag.at, 1));
      const auto count = static_cast<std::int32_t>(bits(tag.at + 1, 4));
      std::size_t at = tag.at + 5;
      if (type == kNbtEnd && count > 0) fail(tag.at, "a list has items without a type");
      for (std::int32_t i = 0; i < count; ++i) at = end_of({type, at}, depth + 1);
      return at;
    }
    default:
      fail(tag.at, "there is no type of tags " + std::to_string(tag.type));
  }
}

NbtTag Nbt::root() const {
  if (bytes_.empty() || bits(0, 1) != kNbtCompound) fail(0, "is not a file of named binary tags");
  const NbtTag root{kNbtCompound, 3 + static_cast<std::size_t>(bits(1, 2))};
  end_of(root);
  return root;
}

std::optional<NbtTag> Nbt::find(NbtTag compound, std::string_view name) const {
  expect(compound, kNbtCompound, "a compound");
  std::optional<NbtTag> found;
  walk_entries(compound, 0, [&](std::string_view other, NbtTag entry) {
    if (other == name) found = entry;
    return !found;
  });
  return found;
}

NbtTag Nbt::get(NbtTag compound, std::string_view name) const {
  const std::optional<NbtTag> found = find(compound, name);
  if (!found) fail(compound.at, "has no entry " + std::string(name));
  return *found;
}

void Nbt::for_each_entry(NbtTag compound,
                         const std::function<void(std::string_view, NbtTag)>& visit) const {
  expect(compound, kNbtCompound, "a compound");
  walk_entries(compound, 0, [&](std::string_view name, NbtTag entry) {
    visit(name, entry);
    return true;
  });
}

void Nbt::for_each_item(NbtTag list, const std::function<void(NbtTag)>& visit) const {
  expect(list, kNbtList, "a list");
  const auto type = static_cast<std::uint8_t>(bits(list.at, 1));
  const auto count = static_cast<std::int32_t>(bits(list.at + 1, 4));
  if (type == kNbtEnd && count > 0) fail(list.at, "a list has items without a type");
  std::size_t at = list.at + 5;
  for (std::int32_t i = 0; i < count; ++i) {
    visit({type, at});
    at = end_of({type, at});
  }
}

bool Nbt::is_compound(NbtTag tag) { return tag.type == kNbtCompound; }

bool Nbt::is_list(NbtTag tag) { return tag.type == kNbtList; }

std::int64_t Nbt::integer(NbtTag tag) const {
  if (tag.type < kNbtByte || tag.type > kNbtLong) fail(tag.at, "is not a whole number");
  const int bytes = nbt_number_bytes(tag.type), unused = 64 - 8 * bytes;
  return static_cast<std::int64_t>(bits(tag.at, bytes) << unused) >> unused;
}

std::string_view Nbt::text(NbtTag tag) const {
  expect(tag, kNbtText, "a text");
  const std::size_t length = bits(tag.at, 2);
  if (bytes_.size() - tag.at - 2 < length) fail(bytes_.size(), "truncated: ends inside a text");
  return bytes_.substr(tag.at + 2, length);
}

std::string_view Nbt::array(NbtTag tag, int item_bytes) const {
  if (nbt_item_bytes(tag.type) != item_bytes)
    fail(tag.at, "is not an array of items of " + std::to_string(item_bytes) + " bytes");
  const auto count = static_cast<std::int32_t>(bits(tag.at, 4));
  if (count < 0) fail(tag.at, "an array has fewer than 0 items");
  const std::uint64_t length =
      static_cast<std::uint64_t>(count) * static_cast<std::uint64_t>(item_bytes);
  if (bytes_.size() - tag.at - 4 < length) fail(bytes_.size(), "truncated: ends inside an array");
  return bytes_.substr(tag.at + 4, static_cast<std::size_t>(length));
}

std::uint64_t Nbt::item(std::string_view array, int item_bytes, std::size_t index) {
  std::uint64_t value = 0;
  for (int i = 0; i < item_bytes; ++i)
    value = value << 8 |
            static_cast<unsigned char>(
                array[index * static_cast<std::size_t>(item_bytes) + static_cast<std::size_t>(i)]);
  return value;
}

}  // namespace voxdag

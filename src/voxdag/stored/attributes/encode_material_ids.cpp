#include "voxdag/stored/attributes/encode_material_ids.hpp"

#include <algorithm>
#include <bit>

namespace voxdag {
namespace {

constexpr std::uint64_t kChunkWords = 1 << 12;  ///< Words that are reserved at a time.

}  // namespace

MaterialEncoder::MaterialEncoder(std::uint32_t materials, MemoryBudget* memory)
    : counted_(memory, 0) {
  ids_.materials = materials;
  id_bits_ = ids_.view().id_bits();
}

void MaterialEncoder::add(std::uint32_t id, std::uint64_t count) {
  ids_.values += count;
  while (count > 0) {
    const std::size_t part = std::min<std::uint64_t>(count, kPageValues - count_);
    std::fill_n(page_.begin() + static_cast<std::ptrdiff_t>(count_), part,
                static_cast<std::uint16_t>(id));
    count_ += part;
    count -= part;
    if (count_ == kPageValues) write_page();
  }
}

void MaterialEncoder::write(std::uint64_t value, int bits) {
  if (bits == 0) return;
  const std::uint64_t words = (at_ + static_cast<std::uint64_t>(bits) + 63) / 64;
  if (words > ids_.words.size()) ids_.words.resize(words);
  write_bits(ids_.words.data(), at_, bits, value);
  at_ += static_cast<std::uint64_t>(bits);
}

void MaterialEncoder::write_page() {
  if (ids_.words.capacity() < ids_.words.size() + kChunkWords) {
    // Twice the bytes: the old array lives until the new one is filled.
    const std::uint64_t words = 2 * ids_.words.size() + kChunkWords;
    counted_.resize(8 * (words + ids_.words.size()) + 3 * ids_.pages.size());
    ids_.words.reserve(words);
  }
  at_ = (at_ + 7) / 8 * 8;
  ids_.add_page(at_ / 8);
  for (std::size_t begin = 0; begin < count_;) {
    std::size_t end = begin + 1;
    while (end < count_ && page_[end] == page_[begin]) ++end;
    write(page_[begin], id_bits_);
    write(end == count_ ? 1 : 0, MaterialRun::kLastBits);
    if (end < count_) {
      const auto length = static_cast<std::uint64_t>(end - begin);
      const int below = static_cast<int>(std::bit_width(length)) - 1;
      write(static_cast<std::uint64_t>(below), MaterialRun::kLengthBits);
      write(length & ((std::uint64_t{1} << below) - 1), below);
    }
    begin = end;
  }
  count_ = 0;
}

MaterialIds MaterialEncoder::finish() {
  if (count_ > 0) write_page();
  counted_.resize(0);
  return std::move(ids_);
}

}  // namespace voxdag

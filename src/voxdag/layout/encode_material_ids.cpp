#include "voxdag/layout/encode_material_ids.hpp"

#include <algorithm>
#include <bit>
#include <string>

#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

constexpr std::uint64_t kChunkWords = 1 << 12;  ///< Words that are reserved at a time.

[[noreturn]] void fail(std::uint64_t page, const std::string& reason) {
  throw Error("", "page " + std::to_string(page), reason);
}

/// Returns the first bit after the page of `values` ids that begins at bit `at`.
std::uint64_t page_end(const MaterialIdsView& view, std::uint64_t page, std::uint64_t at,
                       std::uint64_t values) {
  const std::uint64_t end = view.word_count * 64;
  const int id_bits = view.id_bits();
  std::uint64_t before = view.materials;  // no id
  for (std::uint64_t done = 0;;) {
    // The words that hold the last bit of a short run may be the last ones.
    if (at + static_cast<std::uint64_t>(id_bits) + MaterialRun::kLastBits > end)
      fail(page, "ends after the last word");
    const bool is_last = read_bits(view.words, at + static_cast<std::uint64_t>(id_bits),
                                   MaterialRun::kLastBits) != 0;
    const std::uint64_t most_bits = static_cast<std::uint64_t>(id_bits) + MaterialRun::kLastBits +
                                    (is_last ? 0 : MaterialRun::kLengthBits);
    if (at + most_bits > end) fail(page, "ends after the last word");
    if (!is_last) {
      const std::uint64_t below = read_bits(view.words, at + most_bits - MaterialRun::kLengthBits,
                                            MaterialRun::kLengthBits);
      if (at + most_bits + below > end) fail(page, "ends after the last word");
    }
    const MaterialRun run = read_material_run(view, at, id_bits);
    if (run.id >= view.materials)
      fail(page,
           "has material " + std::to_string(run.id) + " of " + std::to_string(view.materials));
    if (run.id == before) fail(page, "has two runs of one material in succession");
    before = run.id;
    at += static_cast<std::uint64_t>(run.bits);
    if (is_last) return at;
    done += run.length;
    if (done >= values) fail(page, "has more than its " + std::to_string(values) + " cells");
  }
}

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
  if (ids_.pages.size() % kGroupPages == 0) ids_.groups.push_back(at_ / 8);
  ids_.pages.push_back(static_cast<std::uint16_t>(at_ / 8 - ids_.groups.back()));
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

void validate_material_ids(const MaterialIdsView& view) {
  if (view.materials < 1 || view.materials > kMostMaterials)
    throw Error("", "",
                "has " + std::to_string(view.materials) + " materials: 1 to " +
                    std::to_string(kMostMaterials) + " are allowed");
  std::uint64_t at = 0;
  for (std::uint64_t page = 0; page < view.page_count(); ++page) {
    const std::uint64_t group = view.groups[page / kGroupPages];
    // The first test keeps page_begin() from an overflow.
    if (group > view.word_count * 8 || view.page_begin(page) != at ||
        (page % kGroupPages == 0 && view.pages[page] != 0))
      fail(page, "does not begin where the page before it ends");
    const std::uint64_t values =
        std::min<std::uint64_t>(kPageValues, view.values - page * kPageValues);
    const std::uint64_t end = page_end(view, page, at, values);
    at = (end + 7) / 8 * 8;
    if (read_bits(view.words, end, static_cast<int>(at - end)) != 0)
      fail(page, "padding is not zero");
  }
  if ((at + 63) / 64 != view.word_count) throw Error("", "", "has words after the last page");
  if (at % 64 != 0 && view.words[at / 64] >> (at % 64) != 0)
    throw Error("", "", "padding is not zero");
}

}  // namespace voxdag

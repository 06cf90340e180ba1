#include "voxdag/stored/attributes/validate_pages.hpp"

#include <algorithm>
#include <string>

#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

[[noreturn]] void fail_page(std::uint64_t page, const std::string& reason) {
  throw Error("", "page " + std::to_string(page), reason);
}

/// Throws Error unless pages follow each other without gaps, both tables have the pages' first
/// bytes, and all unused bits are zero. Calls page_end(page, at, values) for each page in order. It
/// returns the first bit after the page that begins at bit `at` and holds `values` cells, or throws
/// if the page is wrong or ends after the last word. The arrays of `view` must be as long as it
/// says.
template <class PageEnd>
void validate_cell_pages(const CellPagesView& view, const PageEnd& page_end) {
  std::uint64_t at = 0;
  for (std::uint64_t page = 0; page < view.page_count(); ++page) {
    const std::uint64_t group = view.groups[page / kGroupPages];
    // The first test keeps page_begin() from an overflow.
    if (group > view.word_count * 8 || view.page_begin(page) != at ||
        (page % kGroupPages == 0 && view.pages[page] != 0))
      fail_page(page, "does not begin where the page before it ends");
    const std::uint64_t end =
        page_end(page, at, std::min<std::uint64_t>(kPageValues, view.values - page * kPageValues));
    at = (end + 7) / 8 * 8;
    if (read_bits(view.words, end, static_cast<int>(at - end)) != 0)
      fail_page(page, "padding is not zero");
  }
  if ((at + 63) / 64 != view.word_count) throw Error("", "", "has words after the last page");
  if (at % 64 != 0 && view.words[at / 64] >> (at % 64) != 0)
    throw Error("", "", "padding is not zero");
}

/// Returns the first bit after the page that begins at bit `at`.
std::uint64_t page_end(const ValuePagesView& view, std::uint64_t page, std::uint64_t at) {
  const std::uint64_t end = view.word_count * 64;
  for (int values = 0; values < kPageValues;) {
    const int header_bits = view.precision.header_bits();
    if (at + static_cast<std::uint64_t>(header_bits) > end)
      fail_page(page, "ends after the last word");
    const ValueBlock block = view.precision.unpack_header(read_bits(view.words, at, header_bits));
    values += block.length;
    if (values > kPageValues) fail_page(page, "has more than 256 values");
    at += static_cast<std::uint64_t>(view.precision.bits_of(block));
    if (at > end) fail_page(page, "ends after the last word");
  }
  return at;
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
      fail_page(page, "ends after the last word");
    const bool is_last = read_bits(view.words, at + static_cast<std::uint64_t>(id_bits),
                                   MaterialRun::kLastBits) != 0;
    const std::uint64_t most_bits = static_cast<std::uint64_t>(id_bits) + MaterialRun::kLastBits +
                                    (is_last ? 0 : MaterialRun::kLengthBits);
    if (at + most_bits > end) fail_page(page, "ends after the last word");
    if (!is_last) {
      const std::uint64_t below = read_bits(view.words, at + most_bits - MaterialRun::kLengthBits,
                                            MaterialRun::kLengthBits);
      if (at + most_bits + below > end) fail_page(page, "ends after the last word");
    }
    const MaterialRun run = read_material_run(view, at, id_bits);
    if (run.id >= view.materials)
      fail_page(page,
                "has material " + std::to_string(run.id) + " of " + std::to_string(view.materials));
    if (run.id == before) fail_page(page, "has two runs of one material in succession");
    before = run.id;
    at += static_cast<std::uint64_t>(run.bits);
    if (is_last) return at;
    done += run.length;
    if (done >= values) fail_page(page, "has more than its " + std::to_string(values) + " cells");
  }
}

}  // namespace

void validate_value_pages(const ValuePagesView& view) {
  if (view.precision.code < 0 || view.precision.code > PagePrecision::kMaxCode)
    throw Error("", "", "unknown precision " + std::to_string(view.precision.code));
  // Even the last page holds 256 values.
  validate_cell_pages(view, [&](std::uint64_t page, std::uint64_t at, std::uint64_t) {
    return page_end(view, page, at);
  });
}

void validate_material_ids(const MaterialIdsView& view) {
  if (view.materials < 1 || view.materials > kMaxMaterials)
    throw Error("", "",
                "has " + std::to_string(view.materials) + " materials: 1 to " +
                    std::to_string(kMaxMaterials) + " are allowed");
  validate_cell_pages(view, [&](std::uint64_t page, std::uint64_t at, std::uint64_t values) {
    return page_end(view, page, at, values);
  });
}

}  // namespace voxdag

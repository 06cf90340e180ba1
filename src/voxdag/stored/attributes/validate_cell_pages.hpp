#pragma once
/// Checks the tables of pages from an untrusted file.
#include <algorithm>
#include <string>

#include "voxdag/core/error.hpp"
#include "voxdag/stored/attributes/cell_pages.hpp"

namespace voxdag {

[[noreturn]] inline void fail_page(std::uint64_t page, const std::string& reason) {
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

}  // namespace voxdag

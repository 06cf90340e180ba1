#include "voxdag/layout/validate_value_pages.hpp"

#include <string>

#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

[[noreturn]] void fail(std::uint64_t page, const std::string& reason) {
  throw Error("", "page " + std::to_string(page), reason);
}

/// Returns the first bit after the page that begins at bit `at`.
std::uint64_t page_end(const ValuePagesView& view, std::uint64_t page, std::uint64_t at) {
  const std::uint64_t end = view.word_count * 64;
  for (int values = 0; values < kPageValues;) {
    if (at + ValueBlock::kHeaderBits > end) fail(page, "ends after the last word");
    const ValueBlock block = ValueBlock::unpack(read_bits(view.words, at, ValueBlock::kHeaderBits));
    values += block.length;
    if (values > kPageValues) fail(page, "has more than 256 values");
    at += static_cast<std::uint64_t>(block.bits(view.precision.bits()));
    if (at > end) fail(page, "ends after the last word");
  }
  return at;
}

}  // namespace

void validate_value_pages(const ValuePagesView& view) {
  if (view.precision.code < 0 || view.precision.code > 3)
    throw Error("", "", "unknown precision " + std::to_string(view.precision.code));
  std::uint64_t at = 0;
  for (std::uint64_t page = 0; page < view.page_count(); ++page) {
    const std::uint64_t group = view.groups[page / kGroupPages];
    // The first test keeps page_begin() from an overflow.
    if (group > view.word_count * 8 || view.page_begin(page) != at ||
        (page % kGroupPages == 0 && view.pages[page] != 0))
      fail(page, "does not begin where the page before it ends");
    const std::uint64_t end = page_end(view, page, at);
    at = (end + 7) / 8 * 8;
    if (read_bits(view.words, end, static_cast<int>(at - end)) != 0)
      fail(page, "padding is not zero");
  }
  if ((at + 63) / 64 != view.word_count) throw Error("", "", "has words after the last page");
  if (at % 64 != 0 && view.words[at / 64] >> (at % 64) != 0)
    throw Error("", "", "padding is not zero");
}

}  // namespace voxdag

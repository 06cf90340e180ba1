#include "voxdag/stored/attributes/validate_value_pages.hpp"

#include <string>

#include "voxdag/stored/attributes/validate_cell_pages.hpp"

namespace voxdag {
namespace {

/// Returns the first bit after the page that begins at bit `at`.
std::uint64_t page_end(const ValuePagesView& view, std::uint64_t page, std::uint64_t at) {
  const std::uint64_t end = view.word_count * 64;
  for (int values = 0; values < kPageValues;) {
    if (at + ValueBlock::kHeaderBits > end) fail_page(page, "ends after the last word");
    const ValueBlock block = ValueBlock::unpack(read_bits(view.words, at, ValueBlock::kHeaderBits));
    values += block.length;
    if (values > kPageValues) fail_page(page, "has more than 256 values");
    at += static_cast<std::uint64_t>(block.bits(view.precision.bits()));
    if (at > end) fail_page(page, "ends after the last word");
  }
  return at;
}

}  // namespace

void validate_value_pages(const ValuePagesView& view) {
  if (view.precision.code < 0 || view.precision.code > 3)
    throw Error("", "", "unknown precision " + std::to_string(view.precision.code));
  // Even the last page holds 256 values.
  validate_cell_pages(view, [&](std::uint64_t page, std::uint64_t at, std::uint64_t) {
    return page_end(view, page, at);
  });
}

}  // namespace voxdag

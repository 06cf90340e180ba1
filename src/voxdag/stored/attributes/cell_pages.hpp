#pragma once
/// Pages of packed values of cells, by number, and the tables that find them.
///
/// A page holds 256 values with consecutive numbers. Pages begin at bytes. A group is 64 pages.
///
///   groups    64-bit: the first byte of the group
///   pages     16-bit: the first byte of the page, counted from that of its group
///   words     64-bit: the pages, from the lowest bit of each word up
///
/// value_pages.hpp and material_ids.hpp describe the bits of a page.
#include <cstdint>
#include <vector>

#include "voxdag/stored/svdag/bit_words.hpp"

namespace voxdag {

inline constexpr int kPageValues = 256;
inline constexpr int kGroupPages = 64;

/// A view for kernels and readers.
struct CellPagesView {
  const std::uint64_t* groups = nullptr;
  const std::uint16_t* pages = nullptr;
  const std::uint64_t* words = nullptr;
  std::uint64_t word_count = 0;
  std::uint64_t values = 0;  ///< Number of values: cells of the DAG.

  VOXDAG_HD bool is_empty() const { return values == 0; }
  VOXDAG_HD std::uint64_t page_count() const { return (values + kPageValues - 1) / kPageValues; }
  VOXDAG_HD std::uint64_t group_count() const {
    return (page_count() + kGroupPages - 1) / kGroupPages;
  }
  /// Returns the bytes of both tables and of the pages.
  VOXDAG_HD std::uint64_t bytes() const {
    return group_count() * 8 + page_count() * 2 + word_count * 8;
  }
  /// Returns the bit at which a page begins.
  VOXDAG_HD std::uint64_t page_begin(std::uint64_t page) const {
    return 8 * (groups[page / kGroupPages] + pages[page]);
  }
};

/// Pages in memory. The view is valid while this object lives unchanged.
struct CellPages {
  std::vector<std::uint64_t> groups;
  std::vector<std::uint16_t> pages;
  std::vector<std::uint64_t> words;
  std::uint64_t values = 0;

  CellPagesView view() const {
    return {groups.data(), pages.data(), words.data(), words.size(), values};
  }
  /// Adds the next page to both tables. It begins at byte `begin` of `words`.
  void add_page(std::uint64_t begin) {
    if (pages.size() % kGroupPages == 0) groups.push_back(begin);
    pages.push_back(static_cast<std::uint16_t>(begin - groups.back()));
  }
};

}  // namespace voxdag

#pragma once
/// The wire form of pages of cells: a quarter smaller or more, lossless, but without random access.
///
/// It codes the blocks or runs of pages one after the other, each field in a context of those
/// before it (ValueModel, MaterialModel). Every 1024 pages are a segment, which begins
/// with fresh contexts.
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "voxdag/stored/attributes/material_ids.hpp"
#include "voxdag/stored/attributes/value_pages.hpp"
#include "voxdag/stored/wire/value_model.hpp"

namespace voxdag::wire {

inline constexpr int kSegmentPages = 1024;

/// Where a segment ends.
struct WireSegment {
  std::uint64_t coded_end;  ///< Its bytes end here in WireValues::bytes.
  std::uint64_t page_end;   ///< Its last page ends at this byte of CellPages::words.
};

struct WireValues {
  std::vector<WireSegment> segments;
  std::vector<std::byte> bytes;
};

/// Returns the number of segments of so many pages.
constexpr std::uint64_t segment_count(std::uint64_t pages) {
  return (pages + kSegmentPages - 1) / kSegmentPages;
}

/// Encode valid pages (validate_value_pages(), validate_material_ids()).
WireValues encode_wire_values(const ValuePagesView& pages, ValueKind kind);
WireValues encode_wire_materials(const MaterialIdsView& pages);

/// Memory for decoded pages, whose sizes are those of a CellPagesView.
struct PagesTarget {
  std::uint64_t* groups;
  std::uint16_t* pages;
  std::uint64_t* words;  ///< Zeros.
  std::uint64_t word_count;
  std::uint64_t values;
};

/// Decode pages. Throw Error unless the bytes hold exactly these pages, whatever they contain. The
/// result may still be invalid.
void decode_wire_values(std::span<const WireSegment> segments, std::span<const std::byte> bytes,
                        PagePrecision precision, ValueKind kind, const PagesTarget& target);
void decode_wire_materials(std::span<const WireSegment> segments, std::span<const std::byte> bytes,
                           std::uint32_t materials, const PagesTarget& target);

}  // namespace voxdag::wire

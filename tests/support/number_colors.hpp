#pragma once
/// Colours and normals that tell the numbers of a DAG's cells.
#include "voxdag/stored/attributes/build_cell_index.hpp"
#include "voxdag/stored/attributes/encode_material_ids.hpp"
#include "voxdag/stored/attributes/stored_attributes.hpp"

namespace voxdag {

/// Returns a colour that belongs to one number, if numbers are below 2^24.
inline Value8 color_of_number(std::uint64_t number) {
  return {static_cast<std::uint8_t>(number), static_cast<std::uint8_t>(number >> 8),
          static_cast<std::uint8_t>(number >> 16)};
}

/// Returns a material that belongs to a number, one of kNumberMaterials. Runs have 1 to 8 cells.
inline constexpr std::uint32_t kNumberMaterials = 5;
inline std::uint32_t material_of_number(std::uint64_t number) {
  return static_cast<std::uint32_t>((number / 8 + (number % 8 > number / 8 % 8 ? 1 : 0)) %
                                    kNumberMaterials);
}

/// Attributes of a DAG: the colour of each cell tells its number, and so do the normal and the
/// material. Values are stored in blocks of 4, each by itself.
class NumberColors {
 public:
  NumberColors(const SvdagView& dag, int finest_level)
      : dag_(dag), index_(build_cell_index(dag, finest_level)) {
    pages_.values = index_.cells;
    pages_.precision = {3};
    const std::uint64_t pages = pages_.view().page_count();
    // 256 values of 24 bits in blocks of 4 with headers of 9 bits.
    constexpr std::uint64_t kBits = 64 * (9 + 4 * 24);
    static_assert(kBits % 64 == 0);
    pages_.words.assign(pages * kBits / 64, 0);
    std::uint64_t at = 0;
    for (std::uint64_t i = 0; i < pages * kPageValues; ++i) {
      if (i % kPageValues == 0) pages_.add_page(at / 8);
      if (i % 4 == 0) {
        write_bits(pages_.words.data(), at, 9, pages_.precision.pack_header({ValueBlock::kRaw, 4}));
        at += 9;
      }
      const Value8 color = color_of_number(i);
      write_bits(pages_.words.data(), at, 24,
                 color.x | std::uint64_t{color.y} << 8 | std::uint64_t{color.z} << 16);
      at += 24;
    }
    MaterialEncoder encoder(kNumberMaterials);
    for (std::uint64_t i = 0; i < index_.cells; ++i) encoder.add(material_of_number(i), 1);
    materials_ = encoder.finish();
  }

  /// Returns a view that is valid while this object and the DAG live.
  ColoredDagView view() const {
    return {dag_, {index_.view(), pages_.view(), pages_.view(), materials_.view()}};
  }

 private:
  SvdagView dag_;
  CellIndex index_;
  ValuePages pages_;
  MaterialIds materials_;
};

}  // namespace voxdag

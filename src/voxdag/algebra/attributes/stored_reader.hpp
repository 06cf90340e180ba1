#pragma once
/// Reads all values of a cell from stored attributes.
#include <span>
#include <vector>

#include "voxdag/algebra/attributes/cell_mean.hpp"
#include "voxdag/stored/attributes/page_reader.hpp"

namespace voxdag {

/// Stored attributes that cells of another DAG take over.
struct StoredValues {
  DagAttributesView attributes;
  std::span<const std::uint16_t> material_ids;  ///< The new id of each; empty: ids stay.
};

/// Reads values, faster if the numbers lie in a few pages. Each thread needs its own. Refers to the
/// stored bytes.
class StoredReader {
 public:
  explicit StoredReader(const StoredValues& stored)
      : stored_(stored),
        colors_(kPages, PageReader(stored.attributes.colors)),
        normals_(kPages, PageReader(stored.attributes.normals)) {}

  /// Returns the values of the cell with number `number`, less than the number of cells.
  CellValues values(std::uint64_t number) {
    const DagAttributesView& of = stored_.attributes;
    const std::size_t place = number / kPageValues % kPages;
    CellValues values;
    if (of.has_colors()) values.color = colors_[place].value(number);
    if (of.has_normals()) values.normal = normals_[place].value(number);
    if (of.has_materials()) values.material = material(number);
    return values;
  }
  /// Returns the material of a cell. There must be materials.
  std::uint16_t material(std::uint64_t number) const {
    const std::uint32_t id = read_material(stored_.attributes.materials, number);
    return stored_.material_ids.empty() ? static_cast<std::uint16_t>(id) : stored_.material_ids[id];
  }

 private:
  static constexpr std::size_t kPages = 8;

  StoredValues stored_;
  std::vector<PageReader> colors_, normals_;  ///< A page is in the reader page % kPages.
};

}  // namespace voxdag

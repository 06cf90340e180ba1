#include "lab/compact/symmetry.hpp"

namespace voxdag::lab {
namespace {

SymmetryGroup make_group() {
  SymmetryGroup group;
  for (int s = 0; s < kSymmetries; ++s)
    for (int i = 0; i < 8; ++i)
      group.octant[s][i] = static_cast<std::uint8_t>(image_of_octant(s, i));
  // The images of octants 0, 1, 2 and 4 tell symmetries apart, so those of all octants do.
  for (int s = 0; s < kSymmetries; ++s)
    for (int t = 0; t < kSymmetries; ++t) {
      std::array<std::uint8_t, 8> both{};
      for (int i = 0; i < 8; ++i) both[i] = group.octant[s][group.octant[t][i]];
      for (int u = 0; u < kSymmetries; ++u)
        if (group.octant[u] == both) group.product[s][t] = static_cast<std::uint8_t>(u);
      if (group.product[s][t] == 0) group.inverse[s] = static_cast<std::uint8_t>(t);
    }
  return group;
}

using MaskTable = std::array<std::array<std::uint8_t, 256>, kSymmetries>;

MaskTable make_masks() {
  MaskTable table{};
  for (int s = 0; s < kSymmetries; ++s)
    for (int mask = 0; mask < 256; ++mask)
      for (int i = 0; i < 8; ++i)
        if (((mask >> i) & 1) != 0)
          table[s][mask] = static_cast<std::uint8_t>(table[s][mask] | 1 << image_of_octant(s, i));
  return table;
}

}  // namespace

const SymmetryGroup& symmetry_group() {
  static const SymmetryGroup group = make_group();
  return group;
}

std::uint8_t image_of_mask(int symmetry, std::uint8_t mask) {
  static const MaskTable table = make_masks();
  return table[symmetry][mask];
}

std::uint64_t image_of_block(int symmetry, std::uint64_t block) {
  std::uint64_t image = 0;
  for (int octant = 0; octant < 8; ++octant) {
    const auto mask = static_cast<std::uint8_t>(block >> (8 * octant));
    image |= std::uint64_t{image_of_mask(symmetry, mask)}
             << (8 * image_of_octant(symmetry, octant));
  }
  return image;
}

}  // namespace voxdag::lab

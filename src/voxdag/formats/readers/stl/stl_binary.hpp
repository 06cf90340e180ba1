#pragma once
/// The facets of a binary STL file.
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "voxdag/core/vec.hpp"
#include "voxdag/formats/readers/chunks.hpp"

namespace voxdag {

inline constexpr std::size_t kStlHeaderBytes = 84, kStlFacetBytes = 50;
inline constexpr std::size_t kMaxStlFacets = 0xFFFFFFFF / 3;

inline std::uint32_t load_stl_word(const char* p) {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 4; ++i)
    word |= std::uint32_t{static_cast<unsigned char>(p[i])} << 8 * i;
  return word;
}

/// Returns the number of facets in the header of a file.
inline std::uint32_t stl_facet_count(std::string_view bytes) {
  return load_stl_word(bytes.data() + 80);
}

/// Calls body(Vec3f) for each corner of a run of facets. Throws Fault for a vertex that is not
/// finite.
template <class Body>
void parse_stl_binary(std::string_view facets, const Body& body) {
  for (std::size_t facet = 0; facet < facets.size(); facet += kStlFacetBytes)
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const char* p = facets.data() + facet + 12 * (corner + 1);
      const Vec3f position{std::bit_cast<float>(load_stl_word(p)),
                           std::bit_cast<float>(load_stl_word(p + 4)),
                           std::bit_cast<float>(load_stl_word(p + 8))};
      if (!is_finite(position)) throw Fault{p, "vertex is not finite"};
      body(position);
    }
}

}  // namespace voxdag

#pragma once
/// A colour block: sixteen colours in 64 bits.
///
/// Source: Laine and Karras, "Efficient Sparse Voxel Octrees", I3D 2010, section 3.5: DXT1 without
/// its mode for transparency.
///
///   bits  0..15   c0 as RGB-565: red 15..11, green 10..5, blue 4..0
///   bits 16..31   c1 in the same form
///   bits 32..63   sixteen selectors of 2 bits; that of value i is at bit 32 + 2i:
///                 0 is c0, 1 is c1, 2 is 2/3 c0 + 1/3 c1, 3 is 1/3 c0 + 2/3 c1
///
/// Unlike in DXT1, the order of c0 and c1 has no meaning. A channel with the field k of n steps
/// (31, 63, 31) has exactly the value k / n. Colours are stored and interpolated in sRGB encoding,
/// as in textures: a renderer decodes a value first, then converts it to linear light.
#include <cassert>
#include <cstdint>
#include <type_traits>

#include "voxdag/core/vec.hpp"
#include "voxdag/stored/attributes/attribute_values.hpp"

namespace voxdag {

/// A colour in steps of RGB-565.
struct Rgb565 {
  int r = 0;  ///< [0, 31]
  int g = 0;  ///< [0, 63]
  int b = 0;  ///< [0, 31]

  VOXDAG_HD constexpr std::uint32_t pack() const {
    assert(r >= 0 && r < 32 && g >= 0 && g < 64 && b >= 0 && b < 32);
    return static_cast<std::uint32_t>(r << 11 | g << 5 | b);
  }
  /// Reads the low 16 bits.
  VOXDAG_HD static constexpr Rgb565 unpack(std::uint32_t bits) {
    return {static_cast<int>(bits >> 11 & 31), static_cast<int>(bits >> 5 & 63),
            static_cast<int>(bits & 31)};
  }
  friend bool operator==(const Rgb565&, const Rgb565&) = default;
};

struct ColorBlock {
  std::uint64_t bits = 0;

  /// Packs a block; `selectors` is the content of bits 32..63.
  VOXDAG_HD static constexpr ColorBlock pack(Rgb565 c0, Rgb565 c1, std::uint32_t selectors) {
    return {static_cast<std::uint64_t>(selectors) << 32 | c1.pack() << 16 | c0.pack()};
  }

  VOXDAG_HD constexpr Rgb565 c0() const {
    return Rgb565::unpack(static_cast<std::uint32_t>(bits) & 0xFFFFu);
  }
  VOXDAG_HD constexpr Rgb565 c1() const {
    return Rgb565::unpack(static_cast<std::uint32_t>(bits) >> 16);
  }
  /// Returns the selector of value `index` in [0, 16).
  VOXDAG_HD constexpr int selector(int index) const {
    assert(index >= 0 && index < kValuesPerBlock);
    return static_cast<int>(bits >> (32 + 2 * index) & 3u);
  }

  /// Returns value `index` in [0, 16): red, green and blue in [0,1], sRGB-encoded.
  VOXDAG_HD constexpr Vec3f color(int index) const {
    const int chosen = selector(index);
    const int thirds_of_c1 = chosen < 2 ? 3 * chosen : chosen - 1;
    const int thirds_of_c0 = 3 - thirds_of_c1;
    const Rgb565 a = c0(), b = c1();
    return {static_cast<float>(thirds_of_c0 * a.r + thirds_of_c1 * b.r) / 93.0f,
            static_cast<float>(thirds_of_c0 * a.g + thirds_of_c1 * b.g) / 189.0f,
            static_cast<float>(thirds_of_c0 * a.b + thirds_of_c1 * b.b) / 93.0f};
  }
  friend bool operator==(const ColorBlock&, const ColorBlock&) = default;
};

static_assert(sizeof(ColorBlock) == 8 && std::is_trivially_copyable_v<ColorBlock>);

}  // namespace voxdag

#pragma once
/// A unit vector packed into 32 bits.
///
/// Source: Meyer, Süßmuth, Sußner, Stamminger and Greiner, "On Floating-Point Normal Vectors", EGSR
/// 2010. The octahedron |x| + |y| + |z| = 1 becomes a square if its lower half is folded outwards.
#include <cmath>
#include <cstdint>

#include "voxdag/core/vec.hpp"

namespace voxdag {

/// The low 16 bits hold x, the high 16 bits y, as signed integers: +-32767 stands for +-1. The
/// error is at most 0.004 degrees. The default is the vector (0,0,1).
class PackedNormal {
 public:
  constexpr PackedNormal() = default;

  /// Packs `v`, which must be finite and not zero; its length does not matter.
  explicit PackedNormal(Vec3f v) {
    const float scale = 1 / (std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z));
    float x = v.x * scale, y = v.y * scale;
    if (v.z < 0) fold(x, y);
    bits_ = pack(x) | pack(y) << 16;
  }

  /// Returns a vector of unit length.
  Vec3f unpack() const {
    float x = unpack(bits_ & 0xFFFFu), y = unpack(bits_ >> 16);
    const float z = 1 - std::fabs(x) - std::fabs(y);
    if (z < 0) fold(x, y);
    return normalized(Vec3f{x, y, z});
  }

  friend bool operator==(PackedNormal, PackedNormal) = default;

 private:
  static constexpr float kOne = 32767;

  static void fold(float& x, float& y) {
    const float folded_x = std::copysign(1 - std::fabs(y), x);
    y = std::copysign(1 - std::fabs(x), y);
    x = folded_x;
  }
  static std::uint32_t pack(float x) {
    return static_cast<std::uint16_t>(static_cast<std::int16_t>(std::lround(x * kOne)));
  }
  static float unpack(std::uint32_t bits) {
    return static_cast<float>(static_cast<std::int16_t>(bits)) * (1 / kOne);
  }

  std::uint32_t bits_ = 0;
};
static_assert(sizeof(PackedNormal) == 4);

}  // namespace voxdag

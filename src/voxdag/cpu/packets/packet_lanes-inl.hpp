// Sets of rays or beams, and vectors of their values: the base class of all packet walks. Included
// once for each instruction set.
#if defined(VOXDAG_PACKET_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXDAG_PACKET_LANES_INL
#undef VOXDAG_PACKET_LANES_INL
#else
#define VOXDAG_PACKET_LANES_INL
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

#include "voxdag/core/bits.hpp"

// Whether vectors have at least 8 lanes, for rays, or for the children or voxels of one ray.
#undef VOXDAG_PACKET_LANES
#if HWY_MAX_BYTES >= 32 && HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
#define VOXDAG_PACKET_LANES 1
#else
#define VOXDAG_PACKET_LANES 0
#endif

HWY_BEFORE_NAMESPACE();
namespace voxdag {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Up to 64 rays or beams, in vectors of up to 16.
class PacketLanes {
 protected:
  using DF = hn::CappedTag<float, 16>;
  using VF = hn::Vec<DF>;
  using Set = std::uint64_t;  ///< Bit i: ray or beam i.
  static constexpr std::size_t kWidth = hn::MaxLanes(DF());
  static constexpr Set kVector = (Set{1} << kWidth) - 1;

  static Set first(std::size_t count) { return count == 64 ? ~Set{0} : (Set{1} << count) - 1; }

  /// Removes the vector of the set's first member from the set. Returns the index at which it
  /// begins.
  static HWY_INLINE std::size_t take_vector(Set& set) {
    const std::size_t at = static_cast<std::size_t>(lowest_bit64(set)) & ~(kWidth - 1);
    set &= ~(kVector << at);
    return at;
  }

  /// Returns the mask of the lanes whose bits are set; lane 0 has the lowest bit.
  template <class D>
  static HWY_INLINE hn::Mask<D> lanes_of(D d, Set bits) {
    const std::uint8_t bytes[8] = {static_cast<std::uint8_t>(bits),
                                   static_cast<std::uint8_t>(bits >> 8)};
    return hn::LoadMaskBits(d, bytes);
  }
  template <class M>
  static HWY_INLINE Set bits_of(M mask) {
    std::uint8_t bytes[8];
    hn::StoreMaskBits(DF(), mask, bytes);
    if constexpr (kWidth <= 8) return bytes[0];
    return bytes[0] | static_cast<Set>(bytes[1]) << 8;
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace voxdag
HWY_AFTER_NAMESPACE();

#endif

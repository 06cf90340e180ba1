// The walk of up to 64 rays of like direction through an ESVO: what its parts share. Included once
// for each instruction set, by cast_esvo_packet.cpp, which says how it goes.
#if defined(VOXDAG_ESVO_PACKET_WALK_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXDAG_ESVO_PACKET_WALK_INL
#undef VOXDAG_ESVO_PACKET_WALK_INL
#else
#define VOXDAG_ESVO_PACKET_WALK_INL
#endif

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <array>
#include <cmath>

#include "voxdag/cpu/esvo_packet.hpp"

// The lanes are 8 or 16 rays, or 8 children: smaller vectors are not worth it.
#undef VOXDAG_ESVO_PACKET_LANES
#if HWY_MAX_BYTES >= 32 && HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
#define VOXDAG_ESVO_PACKET_LANES 1
#else
#define VOXDAG_ESVO_PACKET_LANES 0
#endif

HWY_BEFORE_NAMESPACE();
namespace voxdag {
namespace HWY_NAMESPACE {

#if VOXDAG_ESVO_PACKET_LANES

namespace hn = hwy::HWY_NAMESPACE;

template <bool kWithContours>
class EsvoPacketWalk {
  using DF = hn::CappedTag<float, 16>;
  using DI = hn::RebindToSigned<DF>;
  using VF = hn::Vec<DF>;
  using VI = hn::Vec<DI>;
  using DF8 = hn::CappedTag<float, 8>;  ///< Of a voxel's children.
  using DI8 = hn::RebindToSigned<DF8>;
  using VF8 = hn::Vec<DF8>;
  using VI8 = hn::Vec<DI8>;
  using Rays = std::uint64_t;  ///< Bit i: ray i.
  static constexpr std::size_t kWidth = hn::MaxLanes(DF());
  static constexpr Rays kVectorRays = (Rays{1} << kWidth) - 1;
  /// Rays closer together than this many sides of a cell are taken for one wide one.
  static constexpr float kNarrow = 1.0f;
  /// So many rays at most are looked at one after the other, against all children at once.
  static constexpr int kFew = 6;
  static constexpr std::uint32_t kOne = 0x3F800000u;  ///< The bits of 1.0f.

 public:
  EsvoPacketWalk(const EsvoView& esvo, EsvoPacket& packet) : esvo_(esvo), packet_(packet) {}

  Rays cast();

 private:
  static constexpr std::uint64_t kLeaf = ~std::uint64_t{0};

  /// A voxel to visit.
  struct alignas(16) Visit {
    std::uint32_t corner[3];  ///< Float bits.
    std::uint32_t level;
    Rays rays;
    std::uint64_t slot;  ///< Of its descriptor, or kLeaf.
    Contour contour;
    bool is_exact;  ///< Whether the rays are known to meet its cube.
  };
  /// What contours have left of each ray's range of T, and of all rays together.
  struct Spans {
    alignas(64) float enter[RayPacket::kMaxRays], leave[RayPacket::kMaxRays];
    /// Of the voxel by whose contour the ray came to `enter`; 0: by the side of a cube, or none.
    alignas(64) std::int32_t enter_level[RayPacket::kMaxRays];
    float first, last;
  };
  /// By mirrored child index, the rays that meet the child.
  struct ChildRays {
    Rays meet[8];
  };

  template <class M>
  static HWY_INLINE Rays bits_of(M mask) {
    std::uint8_t bytes[8];
    hn::StoreMaskBits(DF(), mask, bytes);
    if constexpr (kWidth <= 8) return bytes[0];
    return bytes[0] | static_cast<Rays>(bytes[1]) << 8;
  }
  /// Bit i of the result is bit i ^ mirrored of the mask.
  static constexpr std::uint32_t mirrored_mask(std::uint32_t mask, std::uint32_t mirrored) {
    if ((mirrored & 1u) != 0) mask = (mask & 0x55u) << 1 | (mask >> 1 & 0x55u);
    if ((mirrored & 2u) != 0) mask = (mask & 0x33u) << 2 | (mask >> 2 & 0x33u);
    if ((mirrored & 4u) != 0) mask = (mask & 0x0Fu) << 4 | mask >> 4;
    return mask;
  }
  using ByteTable = std::array<std::array<std::uint8_t, 8>, 256>;
  /// By mask, then by what is mirrored.
  static constexpr ByteTable mirrored_masks() {
    ByteTable table{};
    for (std::uint32_t mask = 0; mask < 256; ++mask)
      for (std::uint32_t mirrored = 0; mirrored < 8; ++mirrored)
        table[mask][mirrored] = static_cast<std::uint8_t>(mirrored_mask(mask, mirrored));
    return table;
  }
  static HWY_INLINE float side_of(std::uint32_t level) {
    return float_from_bits((127u - level) << 23);
  }
  alignas(32) static constexpr std::int32_t kChildBits[8] = {1, 2, 4, 8, 16, 32, 64, 128};
  /// By mask and child: how many bits of the mask stand before the child's.
  static constexpr ByteTable bits_before() {
    ByteTable table{};
    for (std::size_t mask = 0; mask < 256; ++mask)
      for (std::size_t child = 1; child < 8; ++child)
        table[mask][child] =
            static_cast<std::uint8_t>(table[mask][child - 1] + (mask >> (child - 1) & 1u));
    return table;
  }
  static constexpr ByteTable kBefore = bits_before();
  /// The spans that the rays in a child of the path's voxel of `level` have.
  const Spans& spans_below(std::uint32_t level) const {
    return kWithContours ? spans_[span_at_[level]] : spans_[0];
  }

  std::uint32_t mirrored(std::uint32_t mask) const {
    static constexpr ByteTable kMasks = mirrored_masks();
    return kMasks[mask][packet_.mirrored];
  }
  /// The contours of a descriptor's children; without any, some word of the octree.
  const std::uint32_t* contours_of(const Visit& visit, ChildDescriptor descriptor) const {
    const auto* const own = reinterpret_cast<const std::uint32_t*>(esvo_.slots) + 2 * visit.slot;
    return own + (descriptor.contour_mask() != 0 ? descriptor.contour_pointer() : 0);
  }
  struct ChildShapes;
  void set_child_shapes(const Visit& visit, ChildDescriptor descriptor, ChildShapes& shapes) const;
  Rays end_at_children(const Visit& visit, ChildDescriptor descriptor, Rays rays,
                       ChildRays& children);
  template <class VFloat, class VInt>
  static void cut(VInt position, VInt speed, VFloat exit, VInt low, VInt high, VInt length1,
                  VFloat& enter, VFloat& leave);
  /// Whether they fill more than two vectors: fewer are told apart as fast.
  static bool may_go_by_hull(Rays rays) { return (rays >> (2 * kWidth - 1) >> 1) != 0; }

  void pad();
  void bound();
  Rays walk(Rays all);
  Rays clip(const Visit& visit, Rays rays, Rays& stopped);
  template <bool kCut, bool kWithStop>
  Rays clip(const Visit& visit, Rays rays, Rays& stopped);
  bool is_narrow(const Visit& visit, const Spans& spans) const;
  std::uint32_t children_met_by_hull(const Visit& visit, const Spans& spans) const;
  void intersect(const Visit& visit, const Spans& spans, Rays rays, ChildRays& children) const;
  void push_children(const Visit& visit, ChildDescriptor descriptor, std::uint32_t met,
                     const ChildRays& children, bool is_exact);
  void record(const Visit& visit, Rays rays);
  ContourPlane plane_at(std::uint32_t level, std::size_t ray, float t) const;

  const EsvoView& esvo_;
  EsvoPacket& packet_;
  /// Positions and directions as ContourRay has them, by axis, then by ray.
  alignas(64) std::int32_t position_[3][RayPacket::kMaxRays], direction_[3][RayPacket::kMaxRays];
  /// Least and greatest of all rays, by axis.
  float origin_range_[3][2], inverse_range_[3][2];
  float width_at_start_, width_per_t_;  ///< About how far apart the rays are at T.
  std::uint32_t stop_level_;            ///< Rays end at voxels of this level or finer ones.
  std::size_t top_ = 0;
  Visit stack_[8 * kMaxLevels];
  /// The path to the voxel that is visited, by level: its descriptors' slots and its contours;
  /// where the spans are that its contours have left, of which 0 is the rays' own.
  std::uint64_t slots_[kMaxLevels + 1];
  Contour contours_[kMaxLevels + 1];
  std::uint32_t span_at_[kMaxLevels + 1];
  Spans spans_[kWithContours ? kMaxLevels + 1 : 1];
};

#endif  // VOXDAG_ESVO_PACKET_LANES

}  // namespace HWY_NAMESPACE
}  // namespace voxdag
HWY_AFTER_NAMESPACE();

#endif

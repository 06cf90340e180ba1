// The walk of a packet of rays at an ESVO: its state, and the functions that its parts share. See
// cast_esvo_packet.cpp for the algorithm. Included once for each instruction set.
#if defined(VOXDAG_ESVO_PACKET_WALK_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXDAG_ESVO_PACKET_WALK_INL
#undef VOXDAG_ESVO_PACKET_WALK_INL
#else
#define VOXDAG_ESVO_PACKET_WALK_INL
#endif

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <array>

#include "voxdag/core/morton.hpp"
#include "voxdag/cpu/packets/esvo_packet.hpp"
#include "voxdag/cpu/packets/packet_rays-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace voxdag {
namespace HWY_NAMESPACE {

#if VOXDAG_PACKET_LANES

/// kOneOrigin means that all rays start at one point, so that a plane has one distance for all of
/// them.
template <bool kWithContours, bool kOneOrigin>
class EsvoPacketWalk : PacketRays {
  using DI = hn::RebindToSigned<DF>;
  using VI = hn::Vec<DI>;
  using DI8 = hn::RebindToSigned<DF8>;
  using VF8 = hn::Vec<DF8>;
  using VI8 = hn::Vec<DI8>;

 public:
  /// `hits` is null if the caller only wants to know which rays meet anything.
  EsvoPacketWalk(const EsvoView& esvo, EsvoHits* hits) : esvo_(esvo), hits_(hits) {}

  Rays cast(const RayPacket& packet);

 private:
  static constexpr std::uint64_t kLeaf = ~std::uint64_t{0};

  /// A voxel to visit.
  struct Visit : Cell {
    Rays rays;
    std::uint64_t slot;   ///< Slot of its descriptor, or kLeaf.
    std::uint32_t known;  ///< Flags, see below.
  };
  /// Flags of a visit: the rays meet the voxel's cube; they also meet its shape (found by
  /// end_at_children()); the level of detail may end some rays here; the voxel has a contour.
  static constexpr std::uint32_t kMeetCube = 1, kMeetShape = 2, kMayStop = 4, kHasContour = 8;
  /// The ranges of T that remain after cuts by contours: per ray, and for all rays together.
  struct Spans {
    alignas(64) float enter[RayPacket::kMaxRays], leave[RayPacket::kMaxRays];
    /// The level of the voxel whose contour the ray crosses at `enter`; 0 if it crosses the side of
    /// a cube or nothing.
    alignas(64) std::int32_t enter_level[RayPacket::kMaxRays];
    float first, last;
  };
  /// The rays that meet each child, by mirrored child index.
  struct ChildRays {
    Rays meet[8];
    std::uint32_t met;  ///< The children that any ray meets, by mirrored index.
  };
  /// The contours of a voxel's children, in the order of its descriptor. The planes are
  /// ContourSlab's, but relative to the origin of the grid or of all rays.
  struct ChildContours {
    alignas(32) std::int32_t words[8];  ///< Contour::bits.
    alignas(32) std::int32_t normal[3][8], length1[8], low[8], high[8];
  };
  /// The results of end_at_children(), per ray and child.
  struct Tried {
    alignas(32) float enter[kFew][8], leave[kFew][8];
    std::uint32_t by_contour[kFew], by_cube[kFew];  ///< The plane at `enter`, by child.
    Rays rays;
  };

  using ByteTable = std::array<std::array<std::uint8_t, 8>, 256>;
  alignas(32) static constexpr std::int32_t kChildBits[8] = {1, 2, 4, 8, 16, 32, 64, 128};
  /// Returns the table of the number of set bits below a child's bit, indexed by mask and child.
  static constexpr ByteTable bits_before() {
    ByteTable table{};
    for (std::size_t mask = 0; mask < 256; ++mask)
      for (std::size_t child = 1; child < 8; ++child)
        table[mask][child] =
            static_cast<std::uint8_t>(table[mask][child - 1] + (mask >> (child - 1) & 1u));
    return table;
  }
  static constexpr ByteTable kBefore = bits_before();
  /// Returns the spans of the rays in a child of the path's voxel of `level`.
  const Spans& spans_below(std::uint32_t level) const {
    return kWithContours ? spans_[span_at_[level]] : spans_[0];
  }

  /// Returns the child index, in its parent's descriptor, of the voxel of `level` at this corner.
  std::uint32_t child_of(const std::uint32_t corner[3], std::uint32_t level) const {
    const auto word = [&](int axis) { return static_cast<std::int32_t>(corner[axis]); };
    const int child = child_index({word(0), word(1), word(2)}, static_cast<int>(23 - level));
    return static_cast<std::uint32_t>(child) ^ rays_.mirrored;
  }
  /// Returns the argument of distance() for a plane at the float bits `position`: the plane's
  /// distance from the common origin, or its position if there is none.
  HWY_INLINE VF to_plane(DF d, int axis, std::uint32_t position) const {
    const float at = float_from_bits(position);
    return hn::Set(d, kOneOrigin ? origins_.least[axis] - at : at);
  }
  /// Returns the distances from the origins of rays to a plane, for the vector of rays at `first`.
  HWY_INLINE VF distance(int axis, std::size_t first, VF plane) const {
    if constexpr (kOneOrigin) return plane;
    return hn::Sub(hn::Load(DF(), rays_.origin[axis] + first), plane);
  }
  struct ChildCubes;
  void set_child_cubes(const Visit& visit, ChildCubes& cubes) const;
  void set_child_contours(const Visit& visit, ChildDescriptor descriptor, const ChildCubes& cubes);
  Rays end_at_children(const Visit& visit, ChildDescriptor descriptor, const ChildCubes& cubes,
                       Rays rays, bool may_stop, ChildRays& children);
  template <class VFloat, class VInt>
  static VInt slack_of(VInt length1, VFloat exit);
  template <class VFloat, class VInt>
  static void cut(VInt position, VInt speed, VFloat exit, VInt low, VInt high, VInt length1,
                  VFloat& enter, VFloat& leave);
  void prepare_rays();
  void recall_spans(const Visit& visit, Rays rays);
  bool may_stop_below(const Visit& visit) const;
  Rays walk(Rays all);
  Rays visit_children(const Visit& visit, Rays rays);
  Rays clip(const Visit& visit, Rays rays, Rays& stopped);
  template <bool kCut, bool kWithStop>
  Rays clip(const Visit& visit, Rays rays, Rays& stopped);
  std::uint32_t cubes_met_by_hull(const Visit& visit, const Spans& spans) const;
  std::uint32_t shapes_met_by_hull(const Visit& visit, std::uint32_t with_contour,
                                   const ChildCubes& cubes, const Spans& spans) const;
  void intersect(const Visit& visit, const Spans& spans, Rays rays, ChildRays& children) const;
  void push_children(const Visit& visit, ChildDescriptor descriptor, const ChildRays& children,
                     std::uint32_t known);
  void record(const Visit& visit, Rays rays);
  ContourPlane plane_at(const Visit& visit, std::size_t ray, float t) const;

  const EsvoView& esvo_;
  EsvoHits* hits_;
  /// Positions and directions in the form of ContourRay, by axis, then by ray.
  alignas(64) std::int32_t position_[3][RayPacket::kMaxRays], direction_[3][RayPacket::kMaxRays];
  /// The least and greatest positions and directions, by axis.
  std::int32_t position_range_[3][2], direction_range_[3][2];
  std::int32_t sign_[3];  ///< Per axis: -1 if mirrored, else 0.
  std::size_t top_ = 0;
  Visit stack_[8 * kMaxLevels];
  /// The path to the visited voxel, by level: the slots of the descriptors, and the indices of the
  /// spans that remain after the contours. spans_[0] has the uncut rays.
  std::uint64_t slots_[kMaxLevels + 1];
  std::uint32_t span_at_[kMaxLevels + 1];
  Spans spans_[kWithContours ? kMaxLevels + 1 : 1];
  /// Indexed by the level of the parent.
  ChildContours child_contours_[kWithContours ? kMaxLevels : 1];
  Tried tried_[kWithContours ? kMaxLevels : 1];
};

#endif  // VOXDAG_PACKET_LANES

}  // namespace HWY_NAMESPACE
}  // namespace voxdag
HWY_AFTER_NAMESPACE();

#endif

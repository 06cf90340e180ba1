#pragma once
/// A window of a stream of rays, sorted so that consecutive rays are similar.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <new>
#include <type_traits>

#include "voxdag/cpu/packets/ray_packet.hpp"

namespace voxdag {

/// Up to kMaxRays rays. The rays of a packet must have the same GridRay::mirrored; the more similar
/// they are, the faster the packet is. Neighbours in a stream of primary or shadow rays are
/// similar. The window takes few of them, so that they stay in the L1 cache. Rays of ambient
/// occlusion are not similar. The window can sort them by direction, in cells of about a hundredth
/// of the sphere, so that a packet has rays of many neighbouring pixels with similar directions.
class RayWindow {
 public:
  static constexpr int kMaxRays = 4096;

  RayWindow() = default;
  RayWindow(const RayWindow&) = delete;
  RayWindow& operator=(const RayWindow&) = delete;

  /// Takes make_ray(0), make_ray(1) and so on: at least one, at most `available`. If make_ray
  /// returns references, they must stay valid while the window holds the rays. Calls on_miss(i,
  /// ray) for rays that miss. Sorts the others by their octant (GridRay::mirrored) and, with
  /// `by_direction`, by their direction too.
  template <class MakeRay, class OnMiss>
  void fill(int available, bool by_direction, const MakeRay& make_ray, const OnMiss& on_miss) {
    const auto take_one = [&](int i) {
      if constexpr (std::is_lvalue_reference_v<std::invoke_result_t<const MakeRay&, int>>)
        rays_[i] = &make_ray(i);
      else
        rays_[i] = ::new (static_cast<void*>(made_ + sizeof(CastRay) * i)) CastRay(make_ray(i));
    };
    taken_ = size_ = 0;
    if (take(std::min(available, kAlike), on_miss, take_one)) return;
    take(std::min(available, kMaxRays), on_miss, take_one);
    sort(by_direction && are_incoherent() ? 0 : kCellBits);
  }

  /// Returns how many rays fill() took.
  int taken() const { return taken_; }
  /// Returns the number of rays in the window: those that did not miss.
  int size() const { return size_; }
  /// Returns the argument i of make_ray() for the ray at this place, 0 <= place < size().
  int index(int place) const { return order_[place]; }
  /// Fills a packet with the rays from this place on that share its octant.
  void set_packet(int place, RayPacket& packet) const {
    const int most = std::min(size_ - place, static_cast<int>(RayPacket::kMaxRays));
    const std::uint32_t mirrored = rays_[order_[place]]->ray.mirrored;
    packet.size = 0;
    for (int end = place + most; place < end; ++place) {
      const CastRay* next = rays_[order_[place]];
      if (next->ray.mirrored != mirrored) return;
      packet.rays[packet.size++] = next;
    }
  }

 private:
  static constexpr int kCellBits = 6, kKeys = 8 << kCellBits;
  /// The number of rays that the window takes if they are similar.
  static constexpr int kAlike = 256;

  /// Takes rays with take_one(i) until the window has taken `end` rays. Returns whether the new
  /// rays all have the same octant.
  template <class OnMiss, class TakeOne>
  bool take(int end, const OnMiss& on_miss, const TakeOne& take_one) {
    std::uint32_t octants = 0;  // bit m is set if a ray has `mirrored` == m
    for (; taken_ < end; ++taken_) {
      take_one(taken_);
      const GridRay& taken = rays_[taken_]->ray;
      if (taken.misses()) {
        on_miss(taken_, taken);
        continue;
      }
      octants |= 1u << taken.mirrored;
      order_[size_++] = static_cast<std::uint16_t>(taken_);
    }
    return (octants & (octants - 1)) == 0;
  }

  /// Returns the sort key: the octant, then the Morton code of the direction's cell in the cube
  /// [0,1]³, with the largest component of the direction scaled to 1.
  static std::uint32_t key_of(const GridRay& ray) {
    std::uint32_t key = ray.mirrored << kCellBits;
    for (int axis = 0; axis < 3; ++axis) {
      // Quantises 1 / component in steps of 1, 1.5, 2, 3.
      const std::uint32_t steps = (bits_of_float(ray.inverse[axis]) - bits_of_float(1.0f)) >> 22;
      const std::uint32_t cell = steps < 3 ? steps : 3;
      key |= ((cell & 1u) | (cell & 2u) << 2) << axis;
    }
    return key;
  }

  /// Returns whether neighbours are often in different octants, judged by a sample.
  bool are_incoherent() const {
    constexpr int kStep = 16;
    int unlike = 0, pairs = 0;
    for (int i = 1; i < size_; i += kStep, ++pairs)
      unlike += rays_[order_[i]]->ray.mirrored != rays_[order_[i - 1]]->ray.mirrored ? 1 : 0;
    return 4 * unlike > pairs;
  }

  /// Sorts stably by the key without its lowest bits.
  void sort(int ignored_bits) {
    std::uint16_t begin[kKeys + 1] = {}, keys[kMaxRays];
    for (int i = 0; i < size_; ++i) {
      keys[i] = static_cast<std::uint16_t>(key_of(rays_[order_[i]]->ray) >> ignored_bits);
      ++begin[keys[i] + 1];
    }
    for (int key = 0; key < kKeys >> ignored_bits; ++key)
      begin[key + 1] = static_cast<std::uint16_t>(begin[key + 1] + begin[key]);
    std::uint16_t sorted[kMaxRays];
    for (int i = 0; i < size_; ++i) sorted[begin[keys[i]]++] = order_[i];
    std::copy_n(sorted, size_, order_);
  }

  alignas(CastRay) std::byte made_[kMaxRays * sizeof(CastRay)];  // rays returned by value
  const CastRay* rays_[kMaxRays];
  std::uint16_t order_[kMaxRays];
  int taken_ = 0, size_ = 0;
};

}  // namespace voxdag

#pragma once
/// A part of a stream of rays, put in an order in which those that follow one another are alike.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>

#include "voxdag/trace/scalar_caster.hpp"

namespace voxdag {

/// Up to kMaxRays rays. Rays of a packet must be mirrored alike; more likeness makes it faster.
/// Neighbours in a stream of primary or shadow rays are alike as they are. Those of ambient
/// occlusion are not: they may be put in the order of their directions, in cells of about a
/// hundredth of the sphere, so that a packet has rays of many neighbouring pixels that run about
/// the same way.
class RayWindow {
 public:
  static constexpr int kMaxRays = 4096;

  RayWindow() = default;
  RayWindow(const RayWindow&) = delete;
  RayWindow& operator=(const RayWindow&) = delete;

  int size() const { return size_; }
  const CastRay& operator[](int i) const { return rays()[i]; }
  /// Rays that miss are not in the order.
  int ordered() const { return ordered_; }
  int at(int place) const { return order_[place]; }

  /// Takes make_ray(0) to make_ray(size - 1). Without `by_direction` all keep their order but for
  /// what mirrors them.
  template <class MakeRay>
  void fill(int size, bool by_direction, const MakeRay& make_ray) {
    size_ = size;
    ordered_ = 0;
    std::uint32_t octants = 0;
    for (int i = 0; i < size; ++i) {
      const CastRay& ray = *::new (static_cast<void*>(rays() + i)) CastRay(make_ray(i));
      if (ray.ray.misses()) continue;
      order_[ordered_++] = static_cast<std::uint16_t>(i);
      octants |= 1u << ray.ray.mirrored;
    }
    if (by_direction && are_unlike())
      sort(0);
    else if ((octants & (octants - 1)) != 0)
      sort(kCellBits);
  }

 private:
  static constexpr int kCellBits = 6, kKeys = 8 << kCellBits;

  CastRay* rays() { return reinterpret_cast<CastRay*>(bytes_); }
  const CastRay* rays() const { return std::launder(reinterpret_cast<const CastRay*>(bytes_)); }

  /// The octant, then along a Morton curve the cell of the direction in the cube [0,1]³, where its
  /// largest component is 1.
  static std::uint32_t key_of(const GridRay& ray) {
    std::uint32_t key = ray.mirrored << kCellBits;
    for (int axis = 0; axis < 3; ++axis) {
      // 1 / component in steps of 1, 1.5, 2, 3.
      const std::uint32_t steps = (bits_of_float(ray.inverse[axis]) - bits_of_float(1.0f)) >> 22;
      const std::uint32_t cell = steps < 3 ? steps : 3;
      key |= ((cell & 1u) | (cell & 2u) << 2) << axis;
    }
    return key;
  }

  /// Whether neighbours are often in different octants, going by some of them.
  bool are_unlike() const {
    constexpr int kStep = 16;
    int unlike = 0, pairs = 0;
    for (int i = 1; i < ordered_; i += kStep, ++pairs)
      unlike += (*this)[order_[i]].ray.mirrored != (*this)[order_[i - 1]].ray.mirrored ? 1 : 0;
    return 4 * unlike > pairs;
  }

  /// By all of the key but its lowest bits; equal ones stay in order.
  void sort(int ignored_bits) {
    std::uint16_t begin[kKeys + 1] = {}, keys[kMaxRays];
    for (int i = 0; i < ordered_; ++i) {
      keys[i] = static_cast<std::uint16_t>(key_of(rays()[order_[i]].ray) >> ignored_bits);
      ++begin[keys[i] + 1];
    }
    for (int key = 0; key < kKeys >> ignored_bits; ++key)
      begin[key + 1] = static_cast<std::uint16_t>(begin[key + 1] + begin[key]);
    std::uint16_t sorted[kMaxRays];
    for (int i = 0; i < ordered_; ++i) sorted[begin[keys[i]]++] = order_[i];
    std::copy_n(sorted, ordered_, order_);
  }

  alignas(CastRay) std::byte bytes_[kMaxRays * sizeof(CastRay)];  // made as they come
  std::uint16_t order_[kMaxRays];
  int size_ = 0, ordered_ = 0;
};

}  // namespace voxdag

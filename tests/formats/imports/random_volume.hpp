#pragma once
/// Dense volumes of random values, and the voxels that they set.
#include <bit>
#include <cmath>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "volume_files.hpp"

namespace voxdag {

/// Values at [x + size.x * (y + size.y * z)].
template <class T>
struct RandomVolume {
  Vec3i size;
  std::vector<T> values;

  RandomVolume(Vec3i side, unsigned seed) : size(side) {
    std::mt19937 rng(seed);
    for (int i = size.x * size.y * size.z; i > 0; --i) {
      const auto small = static_cast<int>(rng() % 7) - 3;
      T value = static_cast<T>(small);
      if (rng() % 3 == 0) value = 0;
      if constexpr (std::is_floating_point_v<T>) {
        if (rng() % 8 == 0) value = std::nan("");
        if (rng() % 8 == 0) value = static_cast<T>(-0.0);
        if (rng() % 8 == 0) value = static_cast<T>(0.5);
      }
      values.push_back(value);
    }
  }

  T at(Vec3i v) const {
    return values[static_cast<std::size_t>(v.x + size.x * (v.y + size.y * v.z))];
  }
  template <class Visit>
  void for_each(bool is_z_fastest, const Visit& visit) const {
    if (is_z_fastest) {
      for (int x = 0; x < size.x; ++x)
        for (int y = 0; y < size.y; ++y)
          for (int z = 0; z < size.z; ++z) visit(Vec3i{x, y, z});
    } else {
      for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
          for (int x = 0; x < size.x; ++x) visit(Vec3i{x, y, z});
    }
  }
  std::string bytes(bool is_big_endian = false, bool is_z_fastest = false) const {
    std::string text;
    for_each(is_z_fastest, [&](Vec3i v) {
      std::uint64_t bits = 0;
      const T value = at(v);
      std::memcpy(&bits, &value, sizeof value);
      append(text, bits, sizeof value, is_big_endian);
    });
    return text;
  }
  /// Returns the voxels with keep(value), in the order of the bytes.
  template <class Keep>
  std::vector<Vec3i> voxels(const Keep& keep, bool is_z_fastest = false) const {
    std::vector<Vec3i> set;
    for_each(is_z_fastest, [&](Vec3i v) {
      if (keep(at(v))) set.push_back(v);
    });
    return set;
  }
  /// Returns the values of voxels.
  template <class To>
  std::vector<To> values_at(const std::vector<Vec3i>& places) const {
    std::vector<To> result;
    for (const Vec3i place : places) result.push_back(static_cast<To>(at(place)));
    return result;
  }
  std::vector<Vec3i> voxels_not_0(bool is_z_fastest = false) const {
    return voxels([](T v) { return v == v && v != 0; }, is_z_fastest);
  }
};

}  // namespace voxdag

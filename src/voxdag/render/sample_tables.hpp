#pragma once
/// Sample points of areas and hemispheres. The host computes them once. Kernels call neither sine
/// nor cosine, so that all machines cast identical rays.
///
/// Each set is a prefix of the Sobol sequence with its own Owen scrambling, so that its first 2^k
/// points are well distributed for every k. A hash of the pixel's coordinates selects a set and a
/// rotation or shift: neighbouring pixels differ, and the remaining error looks like grain.
/// Sources: B. Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020; T. Kollig and A.
/// Keller, "Efficient Multidimensional Sampling", 2002.
#include <cstdint>
#include <vector>

#include "voxdag/core/vec.hpp"

namespace voxdag {

struct Point2f {
  float x = 0, y = 0;
};

/// A ray of ambient occlusion around the normal (0,0,1), or a facet of the mirrored sky.
struct HemisphereSample {
  Vec3f direction;  ///< Unit length; cosine-weighted.
  float reach = 0;  ///< Length of the ray, as a fraction of the longest.
};

/// `sets` * `count` points each; point i of set s is at s * count + i.
struct SampleTables {
  static constexpr int kSets = 64, kRotations = 256;  // powers of two

  const Point2f* square = nullptr;  ///< In [0,1)².
  const Point2f* disc = nullptr;    ///< In the unit disc, uniform, never the centre.
  int light_count = 0;
  const HemisphereSample* hemisphere = nullptr;
  int hemisphere_count = 0;
  const Point2f* rotations = nullptr;  ///< kRotations unit vectors around the circle.
};

/// The set and rotation that one pixel uses.
struct PixelSamples {
  int set = 0;
  Point2f rotation{1, 0};
  Point2f shift{};

  VOXDAG_HD Point2f rotated(Point2f p) const {
    return {p.x * rotation.x - p.y * rotation.y, p.x * rotation.y + p.y * rotation.x};
  }
  VOXDAG_HD Point2f shifted(Point2f p) const {
    const float x = p.x + shift.x, y = p.y + shift.y;
    return {x < 1 ? x : x - 1, y < 1 ? y : y - 1};
  }
};

/// Returns a hash of 32 bits. Source: C. Wellons, "lowbias32".
VOXDAG_HD inline std::uint32_t hash_bits(std::uint32_t v) {
  v ^= v >> 16;
  v *= 0x7FEB352Du;
  v ^= v >> 15;
  v *= 0x846CA68Bu;
  return v ^ v >> 16;
}

/// Returns the set and rotation that random bits select.
VOXDAG_HD inline PixelSamples samples_of_hash(const SampleTables& tables, std::uint32_t bits) {
  const std::uint32_t more = hash_bits(bits);
  constexpr float kScale = 1.0f / 65536;
  return {static_cast<int>(bits % SampleTables::kSets),
          tables.rotations[bits / SampleTables::kSets % SampleTables::kRotations],
          {static_cast<float>(more & 0xFFFFu) * kScale, static_cast<float>(more >> 16) * kScale}};
}

/// Returns the set and rotation of a pixel for a `purpose`: 0 is occlusion, 1 + i is light i, and 1
/// + kMaxLights the mirrored sky.
VOXDAG_HD inline PixelSamples pixel_samples(const SampleTables& tables, int x, int y, int purpose) {
  const std::uint32_t column = hash_bits(static_cast<std::uint32_t>(x));
  const std::uint32_t row = hash_bits(column + static_cast<std::uint32_t>(y));
  return samples_of_hash(tables,
                         hash_bits(row + static_cast<std::uint32_t>(purpose) * 0x9E3779B9u));
}

/// Owns the tables.
class SampleSets {
 public:
  /// Makes sets of `light_count` points on a light and `hemisphere_count` hemisphere samples, at
  /// least 1 each.
  SampleSets(int light_count, int hemisphere_count);

  SampleTables view() const;
  const std::vector<Point2f>& square() const { return square_; }
  const std::vector<Point2f>& disc() const { return disc_; }
  const std::vector<HemisphereSample>& hemisphere() const { return hemisphere_; }
  const std::vector<Point2f>& rotations() const { return rotations_; }

 private:
  std::vector<Point2f> square_, disc_;
  std::vector<HemisphereSample> hemisphere_;
  std::vector<Point2f> rotations_;
};

}  // namespace voxdag

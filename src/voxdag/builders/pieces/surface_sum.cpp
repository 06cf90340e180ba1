#include "voxdag/builders/pieces/surface_sum.hpp"

#include <algorithm>
#include <cmath>

#include "voxdag/core/bits.hpp"
#include "voxdag/image/color.hpp"

namespace voxdag {
namespace {

/// sRGB codes, looked up by the leading bits of a float. 256 steps in each of the 13 octaves below
/// 1 give an error of at most half a code, even where the curve is steepest.
class SrgbTable {
 public:
  SrgbTable() {
    for (std::uint32_t i = 0; i < kSize; ++i)
      codes_[i] = linear_to_srgb8(float_from_bits(kFirst + (i << kShift) + (1u << (kShift - 1))));
  }
  std::uint8_t operator()(float linear) const {
    if (!(linear > float_from_bits(kFirst))) return 0;
    if (linear >= 1) return 255;
    return codes_[(bits_of_float(linear) - kFirst) >> kShift];
  }

 private:
  static constexpr std::uint32_t kFirst = (127 - 13) << 23, kShift = 15, kSize = 13 * 256;
  std::uint8_t codes_[kSize];
};

}  // namespace

Vec3f SurfaceSum::direction() const {
  if (4 * dot(normal, normal) >= length * length) return normal;
  const Vec3f axis = axes.principal_axis();
  const float axis_length = std::sqrt(dot(axis, axis));
  if (!(axis_length > 0)) return normal;
  // If the difference is smaller, rounding would decide which side is larger.
  constexpr float kEqualSides = 1e-4f;
  const float along = dot(normal, axis) / axis_length;
  bool is_turned = along < 0;
  if (std::abs(along) <= kEqualSides * length)
    is_turned = axis.z != 0 ? axis.z < 0 : axis.y != 0 ? axis.y < 0 : axis.x < 0;
  return axis * ((is_turned ? -1 : 1) * length / axis_length);
}

VoxelValue voxel_value(const SurfaceSum& sum) {
  static const SrgbTable encode;
  VoxelValue value;
  const float scale = sum.area > 0 ? 1 / sum.area : 0;
  for (int i = 0; i < 3; ++i) value.color[i] = encode(sum.color[i] * scale);
  const auto byte_of = [&](float total) {
    const float mean = total * scale;
    return static_cast<std::uint8_t>(mean > 0 ? std::min(mean, 1.0f) * 255 + 0.5f : 0.0f);
  };
  value.metallic = byte_of(sum.metallic);
  value.roughness = byte_of(sum.roughness);
  const Vec3f normal = sum.direction();
  const float length2 = dot(normal, normal);
  value.normal = length2 > 0 ? normal * (1 / std::sqrt(length2)) : Vec3f{0, 1, 0};
  return value;
}

void add_piece(SurfaceSum& sum, const Cell& cell, const TrianglePiece& piece,
               const SurfaceSample& sample) {
  // A triangle that only touches the cell has a small weight, so that every voxel has a colour. An
  // almost transparent piece has a small weight too, because part of it may pass the alpha test.
  const float area = static_cast<float>(cell.area(piece) + 1e-6) * std::max(sample.coverage, 1e-3f);
  sum.add(sample.color, sample.normal, area, sample.metallic_roughness);
}

SurfaceSum sum_pieces(const Cell& cell, const PieceSampler& sampler) {
  SurfaceSum sum;
  for (const TrianglePiece& piece : cell.pieces)
    add_piece(sum, cell, piece, sampler.sample(cell, piece));
  return sum;
}

}  // namespace voxdag

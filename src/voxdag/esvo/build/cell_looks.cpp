/// What the cells of a CellBuilder look like.
#include <algorithm>
#include <array>
#include <cmath>

#include "voxdag/core/bits.hpp"
#include "voxdag/esvo/build/cell_builder.hpp"
#include "voxdag/image/color.hpp"

namespace voxdag {
namespace {

/// What surfaces look like that have no colour: linear light.
constexpr Vec3f kGrey{0.62f, 0.60f, 0.57f};

/// sRGB codes by the leading bits of a float: 13 octaves below 1, 256 steps each, half a code off
/// at most where the curve is steepest.
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

VoxelValue voxel_value(const SurfaceSum& sum) {
  static const SrgbTable encode;
  VoxelValue value;
  const float scale = sum.area > 0 ? 1 / sum.area : 0;
  for (int i = 0; i < 3; ++i) value.color[i] = encode(sum.color[i] * scale);
  const float length2 = dot(sum.normal, sum.normal);
  value.normal = length2 > 0 ? sum.normal * (1 / std::sqrt(length2)) : Vec3f{0, 1, 0};
  return value;
}

void CellBuilder::set_look(SurfaceTriangle& triangle) const {
  if (shading_ == nullptr)
    triangle.look = {kGrey, 1, static_cast<Vec3f>(triangle.normal)};
  else if (shading_->has_one_color(triangle.source) &&
           (triangle.is_displaced || shading_->has_one_normal(triangle.source)))
    triangle.look =
        shading_->mean(triangle.source, std::array<Vec2f, 1>{Vec2f{1.0f / 3, 1.0f / 3}});
  if (triangle.look && triangle.is_displaced)
    triangle.look->normal = static_cast<Vec3f>(triangle.normal);
}

CellBuilder::Piece CellBuilder::piece(const Item& item, int log2_size, Vec3i cell) const {
  Piece piece;
  const SurfaceTriangle& triangle = triangles_[item.triangle];
  if (triangle.look) return piece;
  const double half = 0.5 * static_cast<double>(std::int64_t{1} << log2_size);
  const Vec3d centre = static_cast<Vec3d>(cell) + Vec3d{half, half, half};
  piece.count = static_cast<std::size_t>(item.polygon.count);
  for (int i = 0; i < item.polygon.count; ++i)
    piece.points[i] = triangle.barycentric(centre + item.polygon.corners[i] * half);
  return piece;
}

SurfaceSample CellBuilder::sample(const Item& item, const Piece& piece) const {
  const SurfaceTriangle& triangle = triangles_[item.triangle];
  if (triangle.look) return *triangle.look;
  SurfaceSample sample = shading_->mean(triangle.source, piece.corners());
  if (triangle.is_displaced) sample.normal = static_cast<Vec3f>(triangle.normal);
  return sample;
}

void CellBuilder::add_to(SurfaceSum& sum, const Item& item, int log2_size,
                         const SurfaceSample& sample) const {
  // A touch counts a little, so that every voxel looks like something, and so does a surface of
  // which the alpha test may leave something.
  const float area =
      static_cast<float>(area_of(item, log2_size) + 1e-6) * std::max(sample.coverage, 1e-3f);
  sum.add({sample.color * area, sample.normal * area, area});
}

SurfaceSum CellBuilder::sum_of(std::size_t begin, int log2_size, Vec3i cell) const {
  SurfaceSum sum;
  for (std::size_t i = begin; i < items_.size(); ++i)
    add_to(sum, items_[i], log2_size, sample(items_[i], piece(items_[i], log2_size, cell)));
  return sum;
}

void CellBuilder::drop_cut_away(std::size_t begin, int log2_size, Vec3i cell) {
  if (shading_ == nullptr) return;
  const auto is_cut_away = [&](const Item& item) {
    const std::uint32_t source = triangles_[item.triangle].source;
    return shading_->may_be_cut(source) &&
           shading_->is_cut_away(source, piece(item, log2_size, cell).corners());
  };
  const auto first = items_.begin() + static_cast<std::ptrdiff_t>(begin);
  items_.erase(std::remove_if(first, items_.end(), is_cut_away), items_.end());
}

bool CellBuilder::is_of_one_look(std::size_t begin) const {
  const auto look = [&](std::size_t i) -> const std::optional<SurfaceSample>& {
    return triangles_[items_[i].triangle].look;
  };
  if (!look(begin)) return false;
  for (std::size_t i = begin + 1; i < items_.size(); ++i)
    if (!look(i) || look(i)->color != look(begin)->color || look(i)->normal != look(begin)->normal)
      return false;
  return true;
}

bool CellBuilder::is_uniform(std::size_t begin, int log2_size, Vec3i cell, SurfaceSum& sum) const {
  if (!settings_.attributes || is_of_one_look(begin)) {
    sum = sum_of(begin, log2_size, cell);
    return put_in_light(begin, log2_size, cell, sum);
  }
  // The normals of what is grey or displaced are its own; of the rest `shading_` knows.
  constexpr float kAnyNormal = 4;
  const auto own_normal = [&](const Item& item) {
    return shading_ == nullptr || triangles_[item.triangle].is_displaced;
  };
  const auto normal_error = [&](const Item& item) {
    return own_normal(item) ? kAnyNormal : settings_.normal_error;
  };
  Piece pieces[kMostNearPolygons];
  // Most that are not uniform are not by themselves: the mean need not be known.
  for (std::size_t i = begin; i < items_.size(); ++i) {
    const SurfaceTriangle& triangle = triangles_[items_[i].triangle];
    if (triangle.look) continue;
    pieces[i - begin] = piece(items_[i], log2_size, cell);
    if (!shading_->may_be_uniform(triangle.source, pieces[i - begin].corners(),
                                  settings_.color_error, normal_error(items_[i])))
      return false;
  }
  SurfaceSum all;
  for (std::size_t i = begin; i < items_.size(); ++i)
    add_to(all, items_[i], log2_size, sample(items_[i], pieces[i - begin]));
  if (!(all.area > 0)) return false;
  const SurfaceSample mean{all.color * (1 / all.area), 1, all.normal * (1 / all.area)};
  const float least = std::cos(std::min(settings_.normal_error, 3.14159265f)) *
                      std::sqrt(dot(mean.normal, mean.normal));
  for (std::size_t i = begin; i < items_.size(); ++i) {
    const SurfaceTriangle& triangle = triangles_[items_[i].triangle];
    if (own_normal(items_[i]) && triangle.normal != Vec3d{} &&
        dot(static_cast<Vec3f>(triangle.normal), mean.normal) < least)
      return false;
    if (shading_ != nullptr &&
        !shading_->is_uniform(triangle.source, pieces[i - begin].corners(), settings_.color_error,
                              normal_error(items_[i]), mean))
      return false;
  }
  sum = all;
  return put_in_light(begin, log2_size, cell, sum);
}

}  // namespace voxdag

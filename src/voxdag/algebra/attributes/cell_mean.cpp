#include "voxdag/algebra/attributes/cell_mean.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "voxdag/core/srgb.hpp"

namespace voxdag {
namespace {

/// Linear light of each sRGB code.
const std::array<double, 256> kLinear = [] {
  std::array<double, 256> linear{};
  for (std::size_t code = 0; code < linear.size(); ++code)
    linear[code] = static_cast<double>(srgb_to_linear(static_cast<float>(code) / 255));
  return linear;
}();

Vec3d vector_of(Value8 normal) { return {normal.x - 128.0, normal.y - 128.0, normal.z - 128.0}; }

}  // namespace

void CellMean::add(const CellValues& values, std::uint64_t weight) {
  if (weight_ == 0) first_ = values;
  weight_ += weight;
  if (weight > most_) heaviest_ = values, most_ = weight;
  const auto w = static_cast<double>(weight);
  if (kinds_.colors) {
    has_one_color_ &= values.color == first_.color;
    for (int c = 0; c < 3; ++c) color_[c] += w * kLinear[values.color[c]];
  }
  if (kinds_.normals) {
    has_one_normal_ &= values.normal == first_.normal;
    normal_ = normal_ + vector_of(values.normal) * w;
  }
  if (kinds_.materials != 0 && (!materials_.empty() || values.material != first_.material)) {
    if (materials_.empty()) materials_.emplace_back(first_.material, weight_ - weight);
    const auto at = std::find_if(materials_.begin(), materials_.end(),
                                 [&](const auto& of) { return of.first == values.material; });
    if (at == materials_.end())
      materials_.emplace_back(values.material, weight);
    else
      at->second += weight;
  }
}

CellValues CellMean::result() const {
  CellValues mean = first_;
  if (!has_one_color_) mean.color = mean_color();
  if (!has_one_normal_) mean.normal = mean_normal();
  if (!materials_.empty()) mean.material = largest_material();
  return mean;
}

Value8 CellMean::mean_color() const {
  Value8 color{};
  for (int c = 0; c < 3; ++c) {
    const auto mean = static_cast<float>(color_[c] / static_cast<double>(weight_));
    color[c] =
        static_cast<std::uint8_t>(std::lround(255 * std::clamp(linear_to_srgb(mean), 0.0f, 1.0f)));
  }
  return color;
}

Value8 CellMean::mean_normal() const {
  constexpr double kUnit = 127;  // the length of a normal, in steps of 8 bits
  const double length = std::sqrt(dot(normal_, normal_));
  if (!(2 * length >= kUnit * static_cast<double>(weight_))) return heaviest_.normal;
  return pack_normal(static_cast<Vec3f>(normal_ * (1 / length)));
}

std::uint16_t CellMean::largest_material() const {
  return std::min_element(materials_.begin(), materials_.end(),
                          [](const auto& a, const auto& b) {
                            return a.second != b.second ? a.second > b.second : a.first < b.first;
                          })
      ->first;
}

}  // namespace voxdag

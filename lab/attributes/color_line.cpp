#include "lab/attributes/color_line.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace voxdag::lab {
namespace {

/// Rounds each channel to a number of bits.
Vec3f rounded(Vec3f color, Vec3i bits) {
  Vec3f result;
  for (int i = 0; i < 3; ++i) {
    const float most = static_cast<float>((1 << bits[i]) - 1);
    result[i] = std::round(std::clamp(color[i], 0.0f, 1.0f) * most) / most;
  }
  return result;
}

constexpr Vec3i kEndBits{5, 6, 5}, kSingleBits{10, 12, 10};

Vec3f mean_of(std::span<const Vec3f> colors) {
  Vec3d sum;
  for (const Vec3f color : colors) sum = sum + Vec3d(color);
  return Vec3f(sum * (1.0 / static_cast<double>(colors.size())));
}

/// Returns the principal axis of colors around their mean, or 0 if all are equal: 20 steps of the
/// power method, as in the authors' program.
Vec3f principal_axis(std::span<const Vec3f> colors, Vec3f mean) {
  Vec3f rows[3];
  for (const Vec3f color : colors) {
    const Vec3f from_mean = color - mean;
    for (int i = 0; i < 3; ++i) rows[i] = rows[i] + from_mean * from_mean[i];
  }
  const float trace = rows[0].x + rows[1].y + rows[2].z;
  if (trace == 0) return {};
  for (const Vec3f start : {Vec3f{0.95f, 0.97f, 0.25f}, Vec3f{1, -1, 0.5f}, Vec3f{-0.5f, 1, 1}}) {
    Vec3f axis = start;
    for (int step = 0; step < 20 && axis != Vec3f{}; ++step) {
      const Vec3f unit = axis * (1 / length(axis));
      axis = {dot(rows[0], unit), dot(rows[1], unit), dot(rows[2], unit)};
    }
    if (axis != Vec3f{}) return axis * (1 / length(axis));
  }
  return {};
}

/// Returns the weight nearest to the projection of `color` on the line.
int projected_weight(const ColorLine& line, Vec3f color) {
  const Vec3f along = line.b - line.a;
  if (length(along) <= 1e-4f) return 0;
  const int most = (1 << line.weight_bits) - 1;
  const float place = dot(color - line.a, along) / dot(along, along);
  return static_cast<int>(std::lround(std::clamp(place, 0.0f, 1.0f) * static_cast<float>(most)));
}

}  // namespace

Vec3f color_of_bytes(ColorBytes bytes) {
  return {static_cast<float>(bytes & 0xFF) / 255, static_cast<float>(bytes >> 8 & 0xFF) / 255,
          static_cast<float>(bytes >> 16 & 0xFF) / 255};
}

ColorBytes bytes_of_color(Vec3f color) {
  ColorBytes bytes = 0;
  for (int i = 0; i < 3; ++i)
    bytes |= static_cast<ColorBytes>(std::lround(std::clamp(color[i], 0.0f, 1.0f) * 255))
             << (8 * i);
  return bytes;
}

Vec3f ColorLine::color(int weight) const {
  if (weight_bits == 0) return a;
  return a + (b - a) * (static_cast<float>(weight) / static_cast<float>((1 << weight_bits) - 1));
}

int ColorLine::weight_of(Vec3f wanted) const {
  if (weight_bits == 0) return 0;
  const int near = projected_weight(*this, wanted);
  int best = near;
  for (const int weight : {near - 1, near + 1})
    if (weight >= 0 && weight < 1 << weight_bits &&
        color_error(wanted, color(weight)) < color_error(wanted, color(best)))
      best = weight;
  return best;
}

ColorLine fit_line(std::span<const Vec3f> colors, int weight_bits) {
  if (weight_bits == 0) {
    const Vec3f single = rounded(mean_of(colors), kSingleBits);
    return {single, single, 0};
  }
  Vec3f a = colors.front(), b = colors.back();
  if (colors.size() > 2) {
    const Vec3f mean = mean_of(colors), axis = principal_axis(colors, mean);
    float least = std::numeric_limits<float>::max(), most = -least;
    for (const Vec3f color : colors) {
      const float place = dot(color - mean, axis);
      least = std::min(least, place);
      most = std::max(most, place);
    }
    a = mean + axis * least;
    b = mean + axis * most;
  }
  return {rounded(a, kEndBits), rounded(b, kEndBits), weight_bits};
}

float color_error(Vec3f a, Vec3f b) {
  return length(color_of_bytes(bytes_of_color(a)) - color_of_bytes(bytes_of_color(b)));
}

float line_score(std::span<const Vec3f> colors, int weight_bits, float error_threshold) {
  const ColorLine line = fit_line(colors, weight_bits);
  if (weight_bits > 0 && colors.size() <= 2) {
    if (color_error(line.a, colors.front()) > error_threshold ||
        color_error(line.b, colors.back()) > error_threshold)
      return -1;
    return 1 / (length(colors.front() - colors.back()) + 1);
  }
  double squares = 0;
  for (const Vec3f color : colors) {
    const float error =
        color_error(color, line.color(weight_bits == 0 ? 0 : projected_weight(line, color)));
    if (error > error_threshold) return -1;
    squares += static_cast<double>(error) * error;
  }
  return static_cast<float>(1 / (squares / (3 * static_cast<double>(colors.size())) + 1));
}

}  // namespace voxdag::lab

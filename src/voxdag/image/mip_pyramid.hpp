#pragma once
/// An image with its mip levels: means and bounds of regions in constant time.
///
/// Mip maps after L. Williams, "Pyramidal Parametrics" (1983). Elongated regions take several taps
/// along their long axis. The taps match the region's centre and covariance; so the variance of the
/// mip level's own filter is subtracted from the variance of the taps.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include "voxdag/core/memory_budget.hpp"
#include "voxdag/core/texture_wrap.hpp"
#include "voxdag/core/vec2.hpp"

namespace voxdag {

/// Mean position and covariance of a region of texture space.
struct UvRegion {
  Vec2f center;
  float uu = 0, uv = 0, vv = 0;
};

/// `channels` values of 16 bits per texel. Level 0 is the image, sampled bilinearly; each level
/// after it has half the width and height, rounded down, to 1 x 1. Texture coordinates are (0,0) at
/// the image's upper left corner and (1,1) at its lower right corner.
template <std::size_t channels>
class MipPyramid {
 public:
  using Texel = std::array<std::uint16_t, channels>;
  using Texels = CountedVector<Texel>;
  using Value = std::array<float, channels>;  ///< On the scale of texels, 0..65535.
  struct Bounds {
    Texel lo, hi;
  };

  /// Makes the levels of an image with at least one texel; `texels` has its rows. Needs as much
  /// memory again as `texels` and takes it from the budget of `texels`. Throws OverMemory. Calls
  /// poll() once per row.
  template <class Poll>
  MipPyramid(int width, int height, Texels texels, TextureWrap wrap_u, TextureWrap wrap_v,
             const Poll& poll)
      : wrap_u_(wrap_u), wrap_v_(wrap_v) {
    MemoryBudget* const memory = texels.get_allocator().budget();
    levels_.push_back({width, height, std::move(texels), CountedVector<Bounds>(memory)});
    while (levels_.back().width > 1 || levels_.back().height > 1)
      levels_.push_back(halve(levels_.back(), memory, poll));
  }
  MipPyramid(int width, int height, Texels texels, TextureWrap wrap_u = TextureWrap::kRepeat,
             TextureWrap wrap_v = TextureWrap::kRepeat)
      : MipPyramid(width, height, std::move(texels), wrap_u, wrap_v, [] {}) {}

  int width() const { return levels_[0].width; }
  int height() const { return levels_[0].height; }
  int level_count() const { return static_cast<int>(levels_.size()); }

  /// Returns the bilinearly interpolated value of a level.
  Value sample(int level, Vec2f uv) const {
    const Level& l = levels_[level];
    return bilinear(l, reduced(uv.x, wrap_u_) * static_cast<float>(l.width) - 0.5f,
                    reduced(uv.y, wrap_v_) * static_cast<float>(l.height) - 0.5f);
  }

  /// Interpolates between the two levels around `level`, which may be any number.
  Value sample_between(float level, Vec2f uv) const {
    const float clamped =
        std::clamp(level, 0.0f, static_cast<float>(level_count() - 1));  // clamp() keeps NaN
    const int lower = clamped > 0 ? static_cast<int>(clamped) : 0;
    const float weight = clamped > 0 ? clamped - static_cast<float>(lower) : 0;
    Value value = sample(lower, uv);
    if (weight == 0) return value;
    const Value upper = sample(lower + 1, uv);
    for (std::size_t c = 0; c < channels; ++c) value[c] += (upper[c] - value[c]) * weight;
    return value;
  }

  /// Returns the mean over a region.
  Value mean(const UvRegion& region) const {
    constexpr float kMaxTaps = 8,
                    kTapDistance = 1.2f;  // distance in texels of the level that is read
    const auto w = static_cast<float>(width()), h = static_cast<float>(height());
    const float a = region.uu * w * w, b = region.uv * w * h, c = region.vv * h * h;
    const float middle = (a + c) / 2;
    const float spread = std::sqrt((a - c) * (a - c) / 4 + b * b);
    const float major = middle + spread, minor = std::max(middle - spread, 0.0f);
    // A region of variance s^2 / 12 is s wide. The level's texels are s / 3.46 to s / 1.73 wide, so
    // the filter alone is never wider than the region.
    const float texel =
        std::max(std::sqrt(4 * minor), std::sqrt(12 * major) / (kMaxTaps * kTapDistance));
    if (major < 0.05f) return sample(0, region.center);
    if (!(major < 1e18f)) return sample(level_count() - 1, region.center);
    const int level = std::clamp(texel >= 1.0f ? exponent_of(texel) : 0, 0, level_count() - 1);
    const auto size = static_cast<float>(1 << level);
    const float own = (size * size - 1) / 4;  // variance that the level's filter adds to level 0's
    const auto taps = [&](float variance, float& distance) {
      const float left = 12 * std::max(variance - own, 0.0f);
      const float count = std::sqrt(left / (kTapDistance * kTapDistance * size * size) + 1);
      const float n = std::clamp(floor_of(count + 0.9f), 1.0f, kMaxTaps + 2);
      distance = n > 1 ? std::sqrt(left / (n * n - 1)) : 0;
      return static_cast<int>(n);
    };
    float step1 = 0, step2 = 0;
    const int n1 = taps(major, step1), n2 = taps(minor, step2);
    if (n1 * n2 == 1) return sample(level, region.center);
    // The major axis, from the larger column of the covariance: exact if the axis is a coordinate
    // axis.
    Vec2f axis = a >= c ? Vec2f{major - c, b} : Vec2f{b, major - a};
    const float length = std::sqrt(axis.x * axis.x + axis.y * axis.y);
    axis = length > 0 ? axis * (1 / length) : Vec2f{1, 0};
    // From here on, lengths are in texels of the level.
    const Level& l = levels_[level];
    const auto lw = static_cast<float>(l.width), lh = static_cast<float>(l.height);
    const Vec2f along{axis.x * step1 * (lw / w), axis.y * step1 * (lh / h)};
    const Vec2f across{-axis.y * step2 * (lw / w), axis.x * step2 * (lh / h)};
    const Vec2f first = Vec2f{reduced(region.center.x, wrap_u_) * lw - 0.5f,
                              reduced(region.center.y, wrap_v_) * lh - 0.5f} -
                        along * (static_cast<float>(n1 - 1) * 0.5f) -
                        across * (static_cast<float>(n2 - 1) * 0.5f);
    Value sum{};
    for (int i = 0; i < n1; ++i)
      for (int j = 0; j < n2; ++j) {
        const Vec2f p = first + along * static_cast<float>(i) + across * static_cast<float>(j);
        const Value tap = bilinear(l, p.x, p.y);
        for (std::size_t k = 0; k < channels; ++k) sum[k] += tap[k];
      }
    const float share = 1 / static_cast<float>(n1 * n2);
    for (float& value : sum) value *= share;
    return sum;
  }

  /// The half width of the bilinear filter, and of none, in texels, with a slack for rounding.
  static constexpr float kBilinear = 0.51f, kUnfiltered = -0x1p-6f;

  /// Returns conservative bounds on the values of level 0 at all points of a box. A box that is not
  /// finite stands for the whole image. With `reach` kUnfiltered, each texel is a square.
  Bounds bounds(Vec2f lo, Vec2f hi, float reach = kBilinear) const {
    Range x = texels_between(lo.x, hi.x, width(), wrap_u_, reach);
    Range y = texels_between(lo.y, hi.y, height(), wrap_v_, reach);
    // Chooses the level in which the box covers at most three texels per side.
    const auto extent = static_cast<unsigned>(std::max(x.last - x.first, y.last - y.first));
    const int wanted = extent > 2 ? static_cast<int>(std::bit_width((extent - 1) / 2)) : 0;
    const int level = std::min(wanted, level_count() - 1);
    const Level& l = levels_[level];
    if (level > 0) {
      x = at_level(x, width(), l.width);
      y = at_level(y, height(), l.height);
    }
    Bounds bounds{filled(65535), filled(0)};
    for (int j = y.first; j <= y.last; ++j) {
      const std::size_t row = static_cast<std::size_t>(wrapped(j, l.height, wrap_v_)) *
                              static_cast<std::size_t>(l.width);
      for (int i = x.first; i <= x.last; ++i)
        include(bounds, l, row + static_cast<std::size_t>(wrapped(i, l.width, wrap_u_)));
    }
    return bounds;
  }

  std::uint64_t bytes() const {
    std::uint64_t sum = 0;
    for (const Level& level : levels_)
      sum += level.texels.size() * sizeof(Texel) + level.bounds.size() * sizeof(Bounds);
    return sum;
  }

 private:
  struct Level {
    int width = 0, height = 0;
    Texels texels;
    CountedVector<Bounds> bounds;  ///< Bounds of level 0 under each texel; empty at level 0.

    const Texel* row(int y) const {
      return texels.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
    }
  };
  /// The texels from first to last, before wrapping.
  struct Range {
    int first, last;
  };
  /// The texels of the next finer level that a texel covers, and the fraction of each.
  struct Cover {
    int first = 0;
    std::vector<float> weights;
  };

  static Texel filled(std::uint16_t value) {
    Texel texel;
    texel.fill(value);
    return texel;
  }

  /// Returns the value at (x, y), in texels from the centre of texel (0, 0); x and y must fit into
  /// an int.
  Value bilinear(const Level& l, float x, float y) const {
    const int ix = floor_int(x), iy = floor_int(y);
    const int x0 = wrapped(ix, l.width, wrap_u_), x1 = wrapped(ix + 1, l.width, wrap_u_);
    const Texel* const row0 = l.row(wrapped(iy, l.height, wrap_v_));
    const Texel* const row1 = l.row(wrapped(iy + 1, l.height, wrap_v_));
    const float wx = x - static_cast<float>(ix), wy = y - static_cast<float>(iy);
    const float w11 = wx * wy, w10 = wx - w11, w01 = wy - w11, w00 = 1 - wx - w01;
    const Texel &t00 = row0[x0], &t10 = row0[x1], &t01 = row1[x0], &t11 = row1[x1];
    Value value;
    if constexpr (channels == 4) {
      // Compilers do not vectorise the loop below by themselves.
      const Lanes sum =
          lanes_of(t00) * w00 + lanes_of(t10) * w10 + lanes_of(t01) * w01 + lanes_of(t11) * w11;
      std::memcpy(value.data(), &sum, sizeof sum);
    } else {
      for (std::size_t c = 0; c < channels; ++c)
        value[c] = static_cast<float>(t00[c]) * w00 + static_cast<float>(t10[c]) * w10 +
                   static_cast<float>(t01[c]) * w01 + static_cast<float>(t11[c]) * w11;
    }
    return value;
  }

  /// Four floats, in the vector extension of g++ and clang.
  using Lanes [[gnu::vector_size(16)]] = float;
  static Lanes lanes_of(const Texel& texel) {
    using Words [[gnu::vector_size(8)]] = std::uint16_t;
    Words words;
    std::memcpy(&words, texel.data(), sizeof words);
    return __builtin_convertvector(words, Lanes);
  }

  static int floor_int(float x) {
    const int truncated = static_cast<int>(x);
    return truncated - (x < static_cast<float>(truncated));
  }
  /// Computes std::ilogb of a positive, normal number.
  static int exponent_of(float x) {
    return static_cast<int>(std::bit_cast<std::uint32_t>(x) >> 23) - 127;
  }
  /// Computes std::floor, which is a function call on processors without SSE 4.1.
  static float floor_of(float x) {
    return std::abs(x) < 1e6f ? static_cast<float>(floor_int(x)) : std::floor(x);
  }

  /// Returns the equivalent coordinate within one period, small enough for an index, even if `u` is
  /// not finite.
  static float reduced(float u, TextureWrap wrap) {
    if (wrap == TextureWrap::kClamp) return u > -1 ? std::min(u, 2.0f) : -1.0f;
    const float rest = wrap == TextureWrap::kRepeat ? u - floor_of(u) : u - 2 * floor_of(u / 2);
    return rest >= 0 ? rest : 0;
  }

  static int wrapped(int i, int size, TextureWrap wrap) {
    if (wrap == TextureWrap::kClamp) return std::clamp(i, 0, size - 1);
    if (wrap == TextureWrap::kRepeat) {
      if (static_cast<unsigned>(i) < static_cast<unsigned>(size)) return i;
      const int rest = i % size;
      return rest < 0 ? rest + size : rest;
    }
    const int rest = (i % (2 * size) + 2 * size) % (2 * size);
    return rest < size ? rest : 2 * size - 1 - rest;
  }

  /// Returns the texels of level 0 that the values between lo and hi depend on: at most one period.
  static Range texels_between(float lo, float hi, int size, TextureWrap wrap, float reach) {
    const int period = wrap == TextureWrap::kMirror ? 2 * size : size;
    const float start = reduced(lo, wrap);
    const float end = wrap == TextureWrap::kClamp ? reduced(hi, wrap) : start + (hi - lo);
    const float first = floor_of(start * static_cast<float>(size) - reach);
    const float last = floor_of(end * static_cast<float>(size) - (1 - reach)) + 1;
    if (!(last - first < static_cast<float>(period)) && wrap != TextureWrap::kClamp)
      return {0, period - 1};
    if (!(last >= first)) return {0, size - 1};
    if (wrap != TextureWrap::kClamp) return {static_cast<int>(first), static_cast<int>(last)};
    return {wrapped(static_cast<int>(first), size, wrap),
            wrapped(static_cast<int>(last), size, wrap)};
  }

  /// Returns the texels of a level of `size` texels that cover a range of level 0.
  static Range at_level(Range range, int size0, int size) {
    const auto floor_div = [](std::int64_t a, std::int64_t b) {
      return a >= 0 ? a / b : -((b - 1 - a) / b);
    };
    return {static_cast<int>(floor_div(std::int64_t{range.first} * size, size0)),
            static_cast<int>(floor_div((std::int64_t{range.last} + 1) * size - 1, size0))};
  }

  static void include(Bounds& bounds, const Level& level, std::size_t texel) {
    const Texel& lo = level.bounds.empty() ? level.texels[texel] : level.bounds[texel].lo;
    const Texel& hi = level.bounds.empty() ? level.texels[texel] : level.bounds[texel].hi;
    for (std::size_t c = 0; c < channels; ++c) {
      bounds.lo[c] = std::min(bounds.lo[c], lo[c]);
      bounds.hi[c] = std::max(bounds.hi[c], hi[c]);
    }
  }

  /// Returns the texels of the next finer level that each texel covers. If that level's size is
  /// odd, texels cover parts of finer texels.
  static std::vector<Cover> covers(int size, int half) {
    std::vector<Cover> covers(static_cast<std::size_t>(half));
    const double ratio = static_cast<double>(size) / half;
    for (int i = 0; i < half; ++i) {
      Cover& cover = covers[i];
      const double lo = i * ratio, hi = i + 1 == half ? size : (i + 1) * ratio;
      cover.first = static_cast<int>(lo);
      for (int k = cover.first; k < hi; ++k)
        cover.weights.push_back(
            static_cast<float>((std::min(hi, k + 1.0) - std::max(lo, double(k))) / (hi - lo)));
    }
    return covers;
  }

  template <class Poll>
  static Level halve(const Level& fine, MemoryBudget* memory, const Poll& poll) {
    Level level{std::max(fine.width / 2, 1), std::max(fine.height / 2, 1), Texels(memory),
                CountedVector<Bounds>(memory)};
    const std::vector<Cover> columns = covers(fine.width, level.width);
    const std::vector<Cover> rows = covers(fine.height, level.height);
    level.texels.reserve(columns.size() * rows.size());
    level.bounds.reserve(columns.size() * rows.size());
    for (const Cover& row : rows) {
      poll();
      for (const Cover& column : columns) {
        Value sum{};
        Bounds bounds{filled(65535), filled(0)};
        for (std::size_t j = 0; j < row.weights.size(); ++j)
          for (std::size_t i = 0; i < column.weights.size(); ++i) {
            const std::size_t texel =
                (static_cast<std::size_t>(row.first) + j) * static_cast<std::size_t>(fine.width) +
                static_cast<std::size_t>(column.first) + i;
            include(bounds, fine, texel);
            const float weight = row.weights[j] * column.weights[i];
            for (std::size_t c = 0; c < channels; ++c)
              sum[c] += weight * static_cast<float>(fine.texels[texel][c]);
          }
        Texel mean;
        for (std::size_t c = 0; c < channels; ++c)
          mean[c] = static_cast<std::uint16_t>(std::min(sum[c] + 0.5f, 65535.0f));
        level.texels.push_back(mean);
        level.bounds.push_back(bounds);
      }
    }
    return level;
  }

  TextureWrap wrap_u_, wrap_v_;
  std::vector<Level> levels_;
};

}  // namespace voxdag

#include "voxdag/render/post_filter.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace voxdag {
namespace {

constexpr int kReach = static_cast<int>(kFilterRadius);

float length(float x, float y) { return std::sqrt(x * x + y * y); }

/// Returns the relative spacing of samples at this distance from the centre.
float spacing(float distance) { return std::sqrt(std::sqrt(std::max(distance, 0.25f))); }

FilterSample sample_at(int x, int y) {
  return {x, y, length(static_cast<float>(x), static_cast<float>(y)), 0.0f};
}

/// Returns the distance of a pixel from the closest sample so far, relative to the spacing there.
float room(const FilterTable& table, int count, const FilterSample& at) {
  float least = INFINITY;
  for (int i = 0; i < count; ++i) {
    const FilterSample& other = table[i];
    const float apart =
        length(static_cast<float>(at.x - other.x), static_cast<float>(at.y - other.y));
    least = std::min(least, apart / spacing(0.5f * (at.distance + other.distance)));
  }
  return least;
}

/// Returns the pixel with most room() among the pixels at about this distance from the centre.
/// Considers only the upper half, because opposite pixels have equal room.
FilterSample roomiest(const FilterTable& table, int count, float distance) {
  FilterSample best{};
  float most = -1.0f;
  for (int y = 0; y <= kReach; ++y)
    for (int x = -kReach; x <= kReach; ++x) {
      if (y == 0 && x <= 0) continue;
      const FilterSample candidate = sample_at(x, y);
      if (std::fabs(candidate.distance - distance) > 0.6f || candidate.distance >= kFilterRadius)
        continue;
      const float space =
          std::min(room(table, count, candidate),
                   2.0f * candidate.distance / spacing(candidate.distance));  // to the opposite
      if (space <= most) continue;
      most = space;
      best = candidate;
    }
  return best;
}

/// Sets the weights: assigns every quarter of a pixel in the disc to its closest sample.
void weigh(FilterTable& table) {
  constexpr int kPerPixel = 2;
  constexpr int kSteps = kReach * kPerPixel;
  for (int iy = -kSteps; iy < kSteps; ++iy)
    for (int ix = -kSteps; ix < kSteps; ++ix) {
      const float x = (static_cast<float>(ix) + 0.5f) / kPerPixel;
      const float y = (static_cast<float>(iy) + 0.5f) / kPerPixel;
      if (length(x, y) >= kFilterRadius) continue;
      FilterSample* nearest = table.data();
      float least = INFINITY;
      for (FilterSample& sample : table) {
        const float apart =
            length(x - static_cast<float>(sample.x), y - static_cast<float>(sample.y));
        if (apart >= least) continue;
        least = apart;
        nearest = &sample;
      }
      nearest->weight += 1.0f / (kPerPixel * kPerPixel);
    }
}

FilterTable make_filter_table() {
  // If the density falls with the square root of the distance, the number of samples within a
  // distance is proportional to distance^(3/2).
  FilterTable table{};
  table[0] = sample_at(0, 0);
  for (int count = 1; count < kFilterSamples; count += 2) {
    const float within = (static_cast<float>(count) + 1.0f) / kFilterSamples;
    const FilterSample sample =
        roomiest(table, count, kFilterRadius * std::pow(within, 2.0f / 3.0f) - 0.2f);
    table[count] = sample;
    if (count + 1 < kFilterSamples)
      table[static_cast<std::size_t>(count) + 1] = sample_at(-sample.x, -sample.y);
  }
  weigh(table);
  std::stable_sort(table.begin(), table.end(), [](const FilterSample& a, const FilterSample& b) {
    return a.distance < b.distance;
  });
  return table;
}

}  // namespace

const FilterTable& filter_table() {
  static const FilterTable kTable = make_filter_table();
  return kTable;
}

}  // namespace voxdag

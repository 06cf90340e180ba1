/// Source: the cluster fit of Simon Brown's libsquish. An optimal block gives the colours selectors
/// in their order along the principal axis, so the candidates are the ways to cut the sorted list
/// into four. Prefix sums give each cut's best ends, as real numbers, and the remaining error in
/// closed form. For the best cuts, the ends are then rounded to whole steps, and selectors are
/// chosen by distance. The best of these blocks is refined: new ends, then new selectors, while the
/// error decreases.
#include "voxdag/builders/esvo/encode/encode_color_block.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "voxdag/builders/pieces/principal_axis.hpp"
#include "voxdag/core/lanes.hpp"

namespace voxdag {
namespace {

constexpr std::size_t kPadded = kValuesPerBlock + kLanes;
constexpr FloatLanes kSteps = {31.0f, 63.0f, 31.0f, 1.0f};

/// The distinct used values. Entries past `count`, up to the next multiple of kLanes, have
/// weight 0.
struct Values {
  std::size_t count = 0;
  float total_weight = 0.0f;
  FloatLanes mean = {}, low = all_lanes(1.0f), high = all_lanes(0.0f);
  std::size_t of_slot[kValuesPerBlock];  ///< index of a used slot's value
  float weight[kValuesPerBlock] = {};
  FloatLanes color[kValuesPerBlock];
  float channel[3][kValuesPerBlock] = {};
};

void gather(std::span<const Vec3f, kValuesPerBlock> colors, std::uint32_t used,
            const float* weights, Values& values) {
  FloatLanes sum = {};
  for (int i = 0; i < kValuesPerBlock; ++i) {
    if ((used >> i & 1u) == 0) continue;
    const FloatLanes given = lanes_of(colors[static_cast<std::size_t>(i)]);
    const FloatLanes color = given > 0.0f ? min(given, all_lanes(1.0f)) : all_lanes(0.0f);
    const float weight = weights != nullptr ? weights[i] : 1.0f;
    std::size_t k = 0;
    while (k < values.count && vec_of(values.color[k]) != vec_of(color)) ++k;
    if (k == values.count) {
      ++values.count;
      values.color[k] = color;
      for (int c = 0; c < 3; ++c) values.channel[c][k] = color[c];
      values.low = min(values.low, color);
      values.high = max(values.high, color);
    }
    values.of_slot[i] = k;
    values.weight[k] += weight;
    values.total_weight += weight;
    sum += color * weight;
  }
  values.mean = sum / values.total_weight;
}

/// A block that is being fitted: its ends in steps, and each value's weight of c0 in thirds.
struct Fit {
  FloatLanes c0, c1;
  float thirds[kValuesPerBlock];
  float error;
};

/// Returns the ends, in whole steps, that fit the values best with the given selectors.
void fit_ends(const Values& values, Fit& fit) {
  float aa = 0, ab = 0, bb = 0;
  FloatLanes a_sum = {};
  for (std::size_t i = 0; i < values.count; ++i) {
    const float a = fit.thirds[i], b = 3.0f - a, wa = values.weight[i] * a;
    aa += wa * a;
    ab += wa * b;
    bb += values.weight[i] * b * b;
    a_sum += values.color[i] * wa;
  }
  const FloatLanes scale = kSteps * 3.0f, mean = values.mean * kSteps;
  const FloatLanes a = a_sum * scale;
  const FloatLanes b = values.mean * (3.0f * values.total_weight) * scale - a;
  // A channel's error is aa p² + 2 ab p q + bb q² - 2 a p - 2 b q and a constant.
  const float det = aa * bb - ab * ab;
  // With a single selector, any p and q with the right mix would fit; equal ones come closest to
  // it.
  const bool line = det <= 1e-5f * (aa + bb) * (aa + bb);
  const FloatLanes real_p = line ? mean : (a * bb - b * ab) / det;
  const FloatLanes real_q = line ? mean : (b * aa - a * ab) / det;
  const auto whole = [](FloatLanes v) { return truncated(min(max(v, all_lanes(0.0f)), kSteps)); };
  FloatLanes least = all_lanes(INFINITY);
  const auto consider = [&](FloatLanes p, FloatLanes q) {
    const FloatLanes error = p * (p * aa + (q * ab - a) * 2.0f) + q * (q * bb - b * 2.0f);
    const IntLanes better = error < least;
    least = better ? error : least;
    fit.c0 = better ? p : fit.c0;
    fit.c1 = better ? q : fit.c1;
  };
  const auto q_for = [&](FloatLanes p) { return bb > 0.0f ? whole((b - p * ab) / bb + 0.5f) : p; };
  const auto p_for = [&](FloatLanes q) { return aa > 0.0f ? whole((a - q * ab) / aa + 0.5f) : q; };
  const FloatLanes p = whole(real_p), q = whole(real_q);
  const FloatLanes next_p = min(p + 1.0f, kSteps), next_q = min(q + 1.0f, kSteps);
  consider(p, q_for(p));
  consider(next_p, q_for(next_p));
  consider(p_for(q), q);
  consider(p_for(next_q), next_q);
}

/// Assigns the nearest of the four colours to each value and sets the error.
void fit_selectors(const Values& values, Fit& fit) {
  FloatLanes palette[4];
  for (int thirds = 0; thirds < 4; ++thirds) {
    const auto a = static_cast<float>(thirds);
    palette[thirds] = (fit.c0 * a + fit.c1 * (3.0f - a)) / (kSteps * 3.0f);
  }
  FloatLanes error = {};
  for (std::size_t first = 0; first < values.count; first += kLanes) {
    const FloatLanes r = load_lanes(&values.channel[0][first]);
    const FloatLanes g = load_lanes(&values.channel[1][first]);
    const FloatLanes b = load_lanes(&values.channel[2][first]);
    FloatLanes least = all_lanes(INFINITY), thirds = {};
    for (int a = 0; a < 4; ++a) {
      const FloatLanes dr = r - palette[a][0], dg = g - palette[a][1], db = b - palette[a][2];
      const FloatLanes distance = dr * dr + dg * dg + db * db;
      const IntLanes nearer = distance < least;
      least = nearer ? distance : least;
      thirds = nearer ? all_lanes(static_cast<float>(a)) : thirds;
    }
    error += least * load_lanes(&values.weight[first]);
    std::memcpy(&fit.thirds[first], &thirds, sizeof thirds);
  }
  fit.error = error[0] + error[1] + error[2] + error[3];
}

/// The values sorted along their axis, and prefix sums of their weights and of their weighted
/// differences from the mean. The last sum repeats past the end.
struct Sorted {
  std::size_t order[kValuesPerBlock];
  float weight[kPadded + 1], x[kPadded + 1], y[kPadded + 1], z[kPadded + 1];
};

void sort_along_axis(const Values& values, Sorted& sorted) {
  OuterProductSum spread;
  for (std::size_t i = 0; i < values.count; ++i)
    spread.add(vec_of(values.color[i] - values.mean), values.weight[i]);
  const Vec3f axis = spread.principal_axis();
  float along[kValuesPerBlock];
  for (std::size_t i = 0; i < values.count; ++i) {
    const float position = dot(vec_of(values.color[i]), axis);
    std::size_t at = i;
    for (; at > 0 && along[at - 1] > position; --at) {
      along[at] = along[at - 1];
      sorted.order[at] = sorted.order[at - 1];
    }
    along[at] = position;
    sorted.order[at] = i;
  }
  FloatLanes sum = {};
  for (std::size_t i = 0; i <= kPadded; ++i) {
    sorted.x[i] = sum[0], sorted.y[i] = sum[1], sorted.z[i] = sum[2], sorted.weight[i] = sum[3];
    if (i >= values.count) continue;
    const std::size_t value = sorted.order[i];
    FloatLanes difference = values.color[value] - values.mean;
    difference[3] = 1.0f;
    sum += difference * values.weight[value];
  }
}

/// Cuts of the sorted values: values before `a` take c0, those before `b` 2/3 of it, those before
/// `c` 1/3.
struct Cuts {
  int a = 0, b = 0, c = 0;
  float gain = 0.0f;  ///< reduction of the sum of squared differences by the best ends
};

/// The best cuts of each lane.
struct BestCuts {
  FloatLanes gain = {};
  IntLanes code = {};  ///< a << 16 | b << 8 | c
};

class CutSearch {
 public:
  CutSearch(const Sorted& sorted, std::size_t count)
      : sorted_(sorted),
        count_(static_cast<int>(count)),
        nine_weight_(9.0f * sorted.weight[count]),
        least_det_(1e-5f * sorted.weight[count] * sorted.weight[count]) {}

  /// Returns the best cut in each of eight disjoint sets, which contain all cuts except those with
  /// a single selector. The first four use both ends. The last four leave one end unused, which may
  /// then lie outside the colours; the gain does not account for that.
  std::array<Cuts, 2 * kLanes> run() const {
    BestCuts inner, outer;
    for (int a = 1; a < count_; ++a)
      for (int b = a; b < count_; ++b)
        for (int c = b; c < count_; c += kLanes) consider(a, b, c, count_, inner);
    for (int b = 0; b < count_; ++b)
      for (int c = b; c <= count_; c += kLanes) consider(0, b, c, count_ + 1, outer);
    // All values lie before the last cut. Here the lanes hold different `b`.
    for (int a = 1; a < count_; ++a)
      for (int b = a; b <= count_; b += kLanes) consider_whole(a, b, outer);
    std::array<Cuts, 2 * kLanes> cuts;
    for (int lane = 0; lane < kLanes; ++lane) {
      cuts[static_cast<std::size_t>(lane)] = of_lane(inner, lane);
      cuts[static_cast<std::size_t>(lane) + kLanes] = of_lane(outer, lane);
    }
    return cuts;
  }

 private:
  static constexpr IntLanes kOffsets = {0, 1, 2, 3};

  static Cuts of_lane(const BestCuts& best, int lane) {
    const int code = best.code[lane];
    return {code >> 16, code >> 8 & 255, code & 255, best.gain[lane]};
  }

  /// Tries the cuts `c`, `c` + 1, ... below `end`, one per lane.
  void consider(int a, int b, int c, int end, BestCuts& best) const {
    const Sorted& s = sorted_;
    const FloatLanes w3 = load_lanes(&s.weight[c]);
    update(w3 + (5.0f * s.weight[a] + 3.0f * s.weight[b]), (w3 - s.weight[a]) * 2.0f,
           load_lanes(&s.x[c]) + (s.x[a] + s.x[b]), load_lanes(&s.y[c]) + (s.y[a] + s.y[b]),
           load_lanes(&s.z[c]) + (s.z[a] + s.z[b]), kOffsets + (a << 16 | b << 8 | c),
           kOffsets < end - c, best);
  }

  void consider_whole(int a, int b, BestCuts& best) const {
    const Sorted& s = sorted_;
    const float w3 = s.weight[count_];
    update(load_lanes(&s.weight[b]) * 3.0f + (5.0f * s.weight[a] + w3),
           all_lanes((w3 - s.weight[a]) * 2.0f), load_lanes(&s.x[b]) + s.x[a],
           load_lanes(&s.y[b]) + s.y[a], load_lanes(&s.z[b]) + s.z[a],
           (kOffsets << 8) + (a << 16 | b << 8 | count_), kOffsets <= count_ - b, best);
  }

  /// Updates the best cuts of the lanes. Let W be the weight of all values, S = (x, y, z) the sum
  /// of the three prefix sums of differences from the mean, and aa, ab, bb the sums of products of
  /// the selectors in thirds. The best ends then reduce the error by 9 W |S|² / (aa bb - ab²).
  void update(FloatLanes aa, FloatLanes ab, FloatLanes x, FloatLanes y, FloatLanes z, IntLanes code,
              IntLanes valid, BestCuts& best) const {
    const FloatLanes bb = nine_weight_ - aa - ab * 2.0f;
    const FloatLanes det = max(aa * bb - ab * ab, all_lanes(least_det_));
    const FloatLanes gain = nine_weight_ * (x * x + y * y + z * z) / det;
    const IntLanes better = (gain > best.gain) & valid;
    best.gain = better ? gain : best.gain;
    best.code = better ? code : best.code;
  }

  const Sorted& sorted_;
  int count_;
  float nine_weight_, least_det_;
};

/// Assigns the thirds of c0 by the cuts, and keeps the fit if it is better.
void try_cuts(const Values& values, const Sorted& sorted, int a, int b, int c, Fit& best) {
  Fit fit;
  for (int i = 0; i < static_cast<int>(values.count); ++i)
    fit.thirds[sorted.order[i]] = i < a ? 3.0f : i < b ? 2.0f : i < c ? 1.0f : 0.0f;
  fit_ends(values, fit);
  fit_selectors(values, fit);
  if (fit.error < best.error) best = fit;
}

/// Returns a fit in which all values are 2/3 c0 + 1/3 c1, which reaches every third of a step.
Fit one_color(const Values& values) {
  Fit fit;
  std::fill_n(fit.thirds, kValuesPerBlock, 2.0f);
  const FloatLanes thirds = truncated(values.mean * kSteps * 3.0f + 0.5f);
  fit.c0 = truncated((thirds + 1.5f) / 3.0f);
  fit.c1 = thirds - fit.c0 * 2.0f;
  return fit;
}

/// Returns the block of the best cuts.
Fit fit_cuts(const Values& values) {
  Sorted sorted;
  sort_along_axis(values, sorted);
  Fit best = one_color(values);
  fit_selectors(values, best);
  const int count = static_cast<int>(values.count);
  if (count <= 3) {
    // Many cuts fit a few values exactly. Then only the rounding to whole steps decides.
    for (int a = 0; a <= count; ++a)
      for (int b = a; b <= count; ++b)
        for (int c = b; c <= count; ++c) try_cuts(values, sorted, a, b, c, best);
  } else {
    // Rounding to whole steps costs about a twelfth of a squared step for each value and channel:
    // cuts that are worse by more than that are not tried.
    constexpr float kStepError = (2.0f / (31.0f * 31.0f) + 1.0f / (63.0f * 63.0f)) / 12.0f;
    const std::array<Cuts, 2 * kLanes> cuts = CutSearch(sorted, values.count).run();
    float enough = 0.0f;
    for (std::size_t i = 0; i < kLanes; ++i) enough = std::max(enough, cuts[i].gain);
    enough -= values.total_weight * kStepError;
    for (const Cuts& cut : cuts)
      if (cut.gain >= enough) try_cuts(values, sorted, cut.a, cut.b, cut.c, best);
  }
  for (int round = 0; round < 4; ++round) {
    Fit next = best;
    fit_ends(values, next);
    fit_selectors(values, next);
    if (!(next.error < best.error)) break;
    best = next;
  }
  return best;
}

Rgb565 steps_of(FloatLanes end) {
  return {static_cast<int>(end[0]), static_cast<int>(end[1]), static_cast<int>(end[2])};
}

}  // namespace

ColorBlock encode_color_block(std::span<const Vec3f, kValuesPerBlock> colors, std::uint32_t used,
                              const float* weights) {
  Values values;
  gather(colors, used, weights, values);
  if (values.count == 0) return {};
  const FloatLanes range = values.high - values.low;
  const bool uniform = std::max(range[0], std::max(range[1], range[2])) < 1e-4f;
  const Fit fit = uniform ? one_color(values) : fit_cuts(values);

  constexpr std::uint32_t kSelectorOfThirds[] = {1, 3, 2, 0};
  std::uint32_t selectors = 0;
  for (int i = 0; i < kValuesPerBlock; ++i)
    if ((used >> i & 1u) != 0)
      selectors |= kSelectorOfThirds[static_cast<int>(fit.thirds[values.of_slot[i]])] << (2 * i);
  return ColorBlock::pack(steps_of(fit.c0), steps_of(fit.c1), selectors);
}

}  // namespace voxdag

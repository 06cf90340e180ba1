#pragma once
/// Tone mapping: maps the light of a scene to the range of a display.
#include <cmath>

#include "voxdag/core/vec.hpp"

namespace voxdag {

/// The curves of tone_map(). The order is that of the viewer's page.
enum class ToneMap : std::int32_t {
  kNeutral,  ///< Keeps hues, and the saturation of colours up to three quarters of white.
  kAgx,      ///< Keeps hues less; bright colours turn pale, as on film.
  kFilmic    ///< Works on each channel alone; raises the contrast.
};

/// The curve (a x² + b x) / (c x² + d x + e).
struct ToneCurve {
  static constexpr float kA = 2.51f, kB = 0.03f, kC = 2.43f, kD = 0.59f, kE = 0.14f;
};

/// The numbers of tone_map_neutral().
struct NeutralCurve {
  static constexpr float kFloor = 0.04f;  ///< Dark colours lose up to this much.
  static constexpr float kStart = 0.76f;  ///< Brighter colours are compressed.
  static constexpr float kDesaturation = 0.15f;
};

/// The numbers of tone_map_agx(): rows of the matrices, and the range in stops.
struct AgxCurve {
  static constexpr Vec3f kInRed{0.842479062253094f, 0.0784335999999992f, 0.0792237451477643f},
      kInGreen{0.0423282422610123f, 0.878468636469772f, 0.0791661274605434f},
      kInBlue{0.0423756549057051f, 0.0784336f, 0.879142973793104f};
  static constexpr Vec3f kOutRed{1.19687900512017f, -0.0980208811401368f, -0.0990297440797205f},
      kOutGreen{-0.0528968517574562f, 1.15190312990417f, -0.0989611768448433f},
      kOutBlue{-0.0529716355144438f, -0.0980434501171241f, 1.15107367264116f};
  static constexpr float kLowest = -12.47393f, kHighest = 4.026069f;
};

VOXDAG_HD inline float clamped_to_display(float x) { return !(x > 0) ? 0.0f : x > 1 ? 1.0f : x; }

/// Source: K. Narkowicz, "ACES Filmic Tone Mapping Curve", 2016.
VOXDAG_HD inline float tone_map_filmic(float x) {
  return clamped_to_display((x * (ToneCurve::kA * x + ToneCurve::kB)) /
                            (x * (ToneCurve::kC * x + ToneCurve::kD) + ToneCurve::kE));
}

/// Source: Khronos Group, "Khronos PBR Neutral Tone Mapper", 2024. Its first step subtracts the 4%
/// of the light that dielectrics mirror from each channel. Diffuse surfaces do not mirror, so here
/// the colour is scaled to lose this much: dark colours keep their hue and saturation.
VOXDAG_HD inline Vec3f tone_map_neutral(Vec3f rgb) {
  using Curve = NeutralCurve;
  const float brightest = std::fmax(rgb.x, std::fmax(rgb.y, rgb.z));
  const float peak = brightest < 2 * Curve::kFloor ? brightest * brightest / (4 * Curve::kFloor)
                                                   : brightest - Curve::kFloor;
  rgb = rgb * (brightest > 0 ? peak / brightest : 0.0f);
  if (peak < Curve::kStart) return rgb;
  const float room = 1 - Curve::kStart;
  const float to = 1 - room * room / (peak + room - Curve::kStart);
  const float keep = 1 / (Curve::kDesaturation * (peak - to) + 1);
  const Vec3f white{to, to, to};
  return white + (rgb * (to / peak) - white) * keep;
}

/// Source: T. Sobotka, "AgX", 2022; the polynomial is that of B. Wrensch, "Minimal AgX
/// Implementation", 2023.
VOXDAG_HD inline Vec3f tone_map_agx(Vec3f rgb) {
  using Curve = AgxCurve;
  Vec3f v{dot(Curve::kInRed, rgb), dot(Curve::kInGreen, rgb), dot(Curve::kInBlue, rgb)};
  for (int i = 0; i < 3; ++i) {
    const float stops = std::log2(std::fmax(v[i], 1e-10f));
    const float x =
        clamped_to_display((stops - Curve::kLowest) / (Curve::kHighest - Curve::kLowest));
    v[i] =
        ((((((15.5f * x - 40.14f) * x + 31.96f) * x - 6.868f) * x + 0.4298f) * x + 0.1191f) * x) -
        0.00232f;
  }
  const Vec3f out{dot(Curve::kOutRed, v), dot(Curve::kOutGreen, v), dot(Curve::kOutBlue, v)};
  return {std::pow(clamped_to_display(out.x), 2.2f), std::pow(clamped_to_display(out.y), 2.2f),
          std::pow(clamped_to_display(out.z), 2.2f)};
}

/// Maps linear light to linear light in [0,1].
VOXDAG_HD inline Vec3f tone_map(ToneMap kind, Vec3f rgb) {
  if (kind == ToneMap::kAgx) return tone_map_agx(rgb);
  const Vec3f mapped =
      kind == ToneMap::kNeutral
          ? tone_map_neutral(rgb)
          : Vec3f{tone_map_filmic(rgb.x), tone_map_filmic(rgb.y), tone_map_filmic(rgb.z)};
  return {clamped_to_display(mapped.x), clamped_to_display(mapped.y), clamped_to_display(mapped.z)};
}

}  // namespace voxdag

#pragma once
/// Vectors of four floats or integers. They have four lanes on every machine, so that the results
/// of the block encoders do not depend on the instruction set. They use the compilers' vector
/// extension: arithmetic, comparisons (-1 where true) and `mask ? a : b` work lane by lane.
#include <cstdint>
#include <cstring>
#if defined(__SSE__)
#include <xmmintrin.h>
#endif

#include "voxdag/core/vec.hpp"

namespace voxdag {

using FloatLanes = float __attribute__((vector_size(16)));
using IntLanes = std::int32_t __attribute__((vector_size(16)));
inline constexpr int kLanes = 4;

/// Loads four floats; `from` need not be aligned.
inline FloatLanes load_lanes(const float* from) {
  FloatLanes lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}
inline void store_lanes(float* to, FloatLanes lanes) { std::memcpy(to, &lanes, sizeof lanes); }
inline FloatLanes all_lanes(float value) { return FloatLanes{value, value, value, value}; }
inline IntLanes all_lanes(std::int32_t value) { return IntLanes{value, value, value, value}; }
/// Returns x, y, z and 0 as lanes.
inline FloatLanes lanes_of(Vec3f v) { return FloatLanes{v.x, v.y, v.z, 0.0f}; }
inline Vec3f vec_of(FloatLanes lanes) { return {lanes[0], lanes[1], lanes[2]}; }

inline FloatLanes min(FloatLanes a, FloatLanes b) { return a < b ? a : b; }
inline FloatLanes max(FloatLanes a, FloatLanes b) { return a < b ? b : a; }
/// Rounds toward zero. The values must fit into an int.
inline FloatLanes truncated(FloatLanes v) {
  return __builtin_convertvector(__builtin_convertvector(v, IntLanes), FloatLanes);
}

/// Returns a bit mask: bit i is set if `mask` is true in lane i.
inline unsigned lane_bits(IntLanes mask) {
#if defined(__SSE__)
  return static_cast<unsigned>(_mm_movemask_ps(reinterpret_cast<__m128>(mask)));
#else
  unsigned bits = 0;
  for (int lane = 0; lane < kLanes; ++lane) bits |= mask[lane] != 0 ? 1u << lane : 0u;
  return bits;
#endif
}
inline bool any_lane(IntLanes mask) { return lane_bits(mask) != 0; }

}  // namespace voxdag

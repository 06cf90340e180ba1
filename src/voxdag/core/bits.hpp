#pragma once
/// Bit counts that compile on host and device.
#include <cstdint>

#include "voxdag/core/host_device.hpp"

#if !defined(__CUDA_ARCH__)
#include <bit>
#include <cstring>
#endif

namespace voxdag {

VOXDAG_HD inline int popcount(std::uint32_t v) {
#if defined(__CUDA_ARCH__)
  return __popc(v);
#else
  return std::popcount(v);
#endif
}

/// Returns the number of set bits of v < 256. Needs no library call, even if the instruction set
/// has no population count.
VOXDAG_HD inline int popcount8(std::uint32_t v) {
#if defined(__CUDA_ARCH__) || defined(__POPCNT__)
  return popcount(v);
#else
  return static_cast<int>(((v * 0x08040201u >> 3) & 0x11111111u) * 0x11111111u >> 28);
#endif
}

VOXDAG_HD inline int popcount64(std::uint64_t v) {
#if defined(__CUDA_ARCH__)
  return __popcll(v);
#else
  return std::popcount(v);
#endif
}

/// Returns the index of the highest set bit; v must not be zero.
VOXDAG_HD inline int highest_bit(std::uint32_t v) {
#if defined(__CUDA_ARCH__)
  return 31 - __clz(static_cast<int>(v));
#else
  return 31 - std::countl_zero(v);
#endif
}

/// Returns the index of the lowest set bit; v must not be zero.
VOXDAG_HD inline int lowest_bit64(std::uint64_t v) {
#if defined(__CUDA_ARCH__)
  return __ffsll(static_cast<long long>(v)) - 1;
#else
  return std::countr_zero(v);
#endif
}

/// Returns the float whose IEEE 754 bits are v.
VOXDAG_HD inline float float_from_bits(std::uint32_t v) {
#if defined(__CUDA_ARCH__)
  return __uint_as_float(v);
#else
  float f;
  std::memcpy(&f, &v, sizeof f);
  return f;
#endif
}

/// Returns the IEEE 754 bits of f.
VOXDAG_HD inline std::uint32_t bits_of_float(float f) {
#if defined(__CUDA_ARCH__)
  return __float_as_uint(f);
#else
  std::uint32_t v;
  std::memcpy(&v, &f, sizeof v);
  return v;
#endif
}

}  // namespace voxdag

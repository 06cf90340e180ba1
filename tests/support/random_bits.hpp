#pragma once
/// A generator of random bits whose sequence is the same on every machine.
#include <cstdint>
#include <random>

namespace voxdag {

/// A generator of 32 random bits.
class Random {
 public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}
  std::uint32_t operator()() { return static_cast<std::uint32_t>(engine_()); }

 private:
  std::mt19937 engine_;
};

}  // namespace voxdag

#include "voxdag/render/sample_tables.hpp"

#include <cmath>
#include <numbers>

namespace voxdag {
namespace {

std::uint32_t reverse_bits(std::uint32_t v) {
  v = v << 16 | v >> 16;
  v = (v & 0x00FF00FFu) << 8 | (v & 0xFF00FF00u) >> 8;
  v = (v & 0x0F0F0F0Fu) << 4 | (v & 0xF0F0F0F0u) >> 4;
  v = (v & 0x33333333u) << 2 | (v & 0xCCCCCCCCu) >> 2;
  return (v & 0x55555555u) << 1 | (v & 0xAAAAAAAAu) >> 1;
}

/// Returns an Owen scrambling: a hash of the bits above each bit decides whether to flip it.
/// Source: S. Laine and T. Karras, "Stratified Sampling for Stochastic Transparency", EGSR 2011;
/// constants by N. Vegdahl.
std::uint32_t scramble(std::uint32_t v, std::uint32_t seed) {
  v = reverse_bits(v);
  v ^= v * 0x3D20ADEAu;
  v += seed;
  v *= (seed >> 16) | 1;
  v ^= v * 0x05526C56u;
  v ^= v * 0x53A22864u;
  return reverse_bits(v);
}

/// Computes point `index` of the Sobol sequence in its first three dimensions.
void sobol(std::uint32_t index, std::uint32_t point[3]) {
  // Direction numbers: single bits for dimension 0; polynomial x + 1 and m = {1} for 1; x² + x + 1
  // and m = {1, 3} for 2 (S. Joe and F. Kuo).
  std::uint32_t v1 = 1u << 31, v2[2] = {1u << 31, 3u << 30};
  point[0] = reverse_bits(index);
  point[1] = point[2] = 0;
  for (; index != 0; index >>= 1) {
    if ((index & 1u) != 0) {
      point[1] ^= v1;
      point[2] ^= v2[0];
    }
    v1 ^= v1 >> 1;
    const std::uint32_t next = v2[1] ^ v2[0] ^ v2[0] >> 2;
    v2[0] = v2[1];
    v2[1] = next;
  }
}

/// Calls body(set, i, u) for all points of all sets; u are three numbers in (0,1).
template <class Body>
void for_each_point(int count, std::uint32_t seed, const Body& body) {
  for (int set = 0; set < SampleTables::kSets; ++set) {
    const std::uint32_t set_seed = hash_bits(seed + static_cast<std::uint32_t>(set));
    for (int i = 0; i < count; ++i) {
      std::uint32_t point[3];
      sobol(static_cast<std::uint32_t>(i), point);
      double u[3];
      for (std::uint32_t axis = 0; axis < 3; ++axis) {
        const std::uint32_t bits = scramble(point[axis], hash_bits(set_seed + 7919 * (axis + 1)));
        u[axis] = ((bits >> 8) + 0.5) * 0x1p-24;
      }
      body(set, i, u);
    }
  }
}

}  // namespace

SampleSets::SampleSets(int light_count, int hemisphere_count) {
  for_each_point(light_count, 1, [&](int, int, const double* u) {
    square_.push_back({static_cast<float>(u[0]), static_cast<float>(u[1])});
    const double r = std::sqrt(u[0]), angle = 2 * std::numbers::pi * u[1];
    disc_.push_back(
        {static_cast<float>(r * std::cos(angle)), static_cast<float>(r * std::sin(angle))});
  });
  for_each_point(hemisphere_count, 2, [&](int, int, const double* u) {
    const double r = std::sqrt(u[0]), angle = 2 * std::numbers::pi * u[1];
    // A hit at distance d, as a fraction of the maximum, has the weight (1 - d)². A ray of random
    // length with P(length > d) = (1 - d)² meets it with that probability.
    const double reach = 1 - std::sqrt(u[2]);
    hemisphere_.push_back(
        {{static_cast<float>(r * std::cos(angle)), static_cast<float>(r * std::sin(angle)),
          static_cast<float>(std::sqrt(1 - u[0]))},
         static_cast<float>(reach)});
  });
  for (int i = 0; i < SampleTables::kRotations; ++i) {
    const double angle = 2 * std::numbers::pi * i / SampleTables::kRotations;
    rotations_.push_back(
        {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))});
  }
}

SampleTables SampleSets::view() const {
  SampleTables tables;
  tables.square = square_.data();
  tables.disc = disc_.data();
  tables.light_count = static_cast<int>(square_.size()) / SampleTables::kSets;
  tables.hemisphere = hemisphere_.data();
  tables.hemisphere_count = static_cast<int>(hemisphere_.size()) / SampleTables::kSets;
  tables.rotations = rotations_.data();
  return tables;
}

}  // namespace voxdag

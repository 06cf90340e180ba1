#pragma once
/// The colour and the normal of a cell as a leaf, and whether it is uniform enough to be one.
#include <optional>

#include "voxdag/builders/esvo/build/esvo_settings.hpp"
#include "voxdag/builders/pieces/piece_sampler.hpp"
#include "voxdag/builders/pieces/surface_sum.hpp"

namespace voxdag {

class CellAppearance {
 public:
  /// Refers to both arguments. `shading` may be null: see PieceSampler.
  CellAppearance(const EsvoSettings& settings, const SurfaceShading* shading)
      : settings_(settings), sampler_(shading) {}

  /// Sums the colours, with the baked light, and the normals of a cell that is a leaf.
  SurfaceSum sum(const Cell& cell) const;

  /// Returns sum() if colours, normals and baked light differ in the cell by no more than the
  /// settings allow; nothing otherwise.
  std::optional<SurfaceSum> sum_if_uniform(const Cell& cell) const;

  const PieceSampler& sampler() const { return sampler_; }

 private:
  std::optional<float> light(const Cell& cell, const SurfaceSum& sum) const;
  std::optional<SurfaceSum> unlit_sum_if_uniform(const Cell& cell) const;

  const EsvoSettings& settings_;
  PieceSampler sampler_;
};

}  // namespace voxdag

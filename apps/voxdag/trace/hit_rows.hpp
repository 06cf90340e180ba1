#pragma once
/// The rows that `voxdag trace` writes.
#include <cstddef>
#include <span>
#include <string>

#include "cli/channel_columns.hpp"
#include "voxdag/stored/attributes/look.hpp"
#include "voxdag/trace/hit.hpp"

namespace voxdag::cli {

/// Rows of a structured array without padding: t, voxel, face, hit, and the normal, the colour,
/// the material and the channels of the voxel if `look` stores them. They are looked up by voxel,
/// so they do not depend on the device that cast the ray.
class HitRows {
 public:
  /// The hits are in a grid of 2^levels voxels per side. `look` may be empty.
  HitRows(int levels, const LookView& look);

  /// Returns the dtype for NpyHeader.
  const std::string& dtype() const { return dtype_; }
  std::size_t row_bytes() const { return row_bytes_; }

  /// Writes hits.size() * row_bytes() bytes to `rows`, on all threads.
  void pack(std::span<const Hit> hits, std::byte* rows) const;

 private:
  void pack_one(const Hit& hit, std::byte* row) const;

  int levels_;
  LookView look_;
  ChannelColumns channels_;
  bool normals_ = false, colors_ = false;
  std::string dtype_;
  std::size_t row_bytes_ = 0;
};

}  // namespace voxdag::cli

#pragma once
/// What an ESVO's bytes are for.
#include <span>

#include "voxdag/layout/esvo.hpp"
#include "voxdag/layout/esvo_directory.hpp"

namespace voxdag {

/// Of all blocks; the sum is 8 * EsvoView::slot_count.
struct EsvoBytes {
  std::uint64_t descriptors = 0;
  std::uint64_t far_pointers = 0;
  /// Of the descriptor array: unpaired slots, page headers, ends of pages.
  std::uint64_t gaps = 0;
  std::uint64_t info = 0;
  std::uint64_t contours = 0;
  std::uint64_t colors = 0;
  std::uint64_t normals = 0;
  std::uint64_t padding = 0;  ///< Up to whole pages.

  std::uint64_t total() const {
    return descriptors + far_pointers + gaps + info + contours + colors + normals + padding;
  }
};

/// The view must be valid.
EsvoBytes esvo_bytes(const EsvoView& view, std::span<const EsvoBlockEntry> directory);

}  // namespace voxdag

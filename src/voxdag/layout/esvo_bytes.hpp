#pragma once
/// How an ESVO's bytes divide into its parts.
#include <span>

#include "voxdag/layout/esvo.hpp"
#include "voxdag/layout/esvo_directory.hpp"

namespace voxdag {

/// Bytes of all blocks; the total is 8 * EsvoView::slot_count.
struct EsvoBytes {
  std::uint64_t descriptors = 0;
  std::uint64_t far_pointers = 0;
  /// Unused slots among the descriptors: unpaired slots, page headers, ends of pages.
  std::uint64_t gaps = 0;
  std::uint64_t info = 0;
  std::uint64_t contours = 0;
  std::uint64_t colors = 0;
  std::uint64_t normals = 0;
  std::uint64_t padding = 0;  ///< Fills blocks up to whole pages.

  std::uint64_t total() const {
    return descriptors + far_pointers + gaps + info + contours + colors + normals + padding;
  }
  EsvoBytes& operator+=(const EsvoBytes& other);
};

/// Counts the bytes of whole blocks that follow each other.
EsvoBytes esvo_bytes(std::span<const std::uint64_t> blocks);

/// The view must be valid.
EsvoBytes esvo_bytes(const EsvoView& view, std::span<const EsvoBlockEntry> directory);

}  // namespace voxdag

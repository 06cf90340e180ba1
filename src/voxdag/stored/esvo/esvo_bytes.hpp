#pragma once
/// The bytes of an ESVO, by purpose.
#include <span>

#include "voxdag/stored/esvo/esvo.hpp"
#include "voxdag/stored/esvo/esvo_directory.hpp"

namespace voxdag {

/// The bytes of all blocks; the sum is 8 * EsvoView::slot_count.
struct EsvoBytes {
  std::uint64_t descriptors = 0;
  std::uint64_t far_pointers = 0;
  /// Descriptor slots without a descriptor: unpaired slots, page headers, ends of pages.
  std::uint64_t gaps = 0;
  std::uint64_t info = 0;
  std::uint64_t contours = 0;
  std::uint64_t colors = 0;
  std::uint64_t normals = 0;
  std::uint64_t padding = 0;  ///< Zeros up to the end of the last page.

  std::uint64_t total() const {
    return descriptors + far_pointers + gaps + info + contours + colors + normals + padding;
  }
  EsvoBytes& operator+=(const EsvoBytes& other);
};

/// Counts the bytes of whole blocks that follow each other.
EsvoBytes esvo_bytes(std::span<const std::uint64_t> blocks);

/// Counts the bytes of all blocks of a valid view.
EsvoBytes esvo_bytes(const EsvoView& view, std::span<const EsvoBlockEntry> directory);

}  // namespace voxdag

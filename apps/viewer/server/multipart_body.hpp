#pragma once
/// The body of an answer with several ranges of a scene: multipart/byteranges, RFC 9110, section
/// 14.6. The HTTP library has one, too, but writes a wrong size of the whole.
#include <sys/types.h>

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "viewer/scene/scene_bytes.hpp"

namespace voxdag {

/// First and last byte. In a request of the HTTP library, -1 is a byte that the client left out.
using ByteRange = std::pair<ssize_t, ssize_t>;

/// Makes the ranges explicit for a content of `size` bytes: 0 <= first <= last < size. Removes the
/// ranges behind its end. Returns false if no range is left, or if all together have more than
/// `size` bytes.
bool resolve_ranges(std::vector<ByteRange>& ranges, std::uint64_t size);

class MultipartBody {
 public:
  /// `ranges` are those of resolve_ranges(). `scene` must outlive this object. `type` is the
  /// content type of the scene; `boundary` must not occur in its bytes.
  MultipartBody(const SceneBytes& scene, const std::vector<ByteRange>& ranges,
                const std::string& type, const std::string& boundary);

  std::uint64_t size() const { return size_; }
  /// Reads bytes of the body into all of `out`, within size(). Returns false if the scene cannot be
  /// read.
  bool read(std::uint64_t offset, std::span<std::byte> out) const;

 private:
  /// Text, and bytes of the scene behind it.
  struct Part {
    std::uint64_t begin;  // in the body
    std::string text;
    std::uint64_t first, bytes;
  };

  void add(const std::string& text, std::uint64_t first, std::uint64_t bytes);

  const SceneBytes& scene_;
  std::vector<Part> parts_;
  std::uint64_t size_ = 0;
};

}  // namespace voxdag

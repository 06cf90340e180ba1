#pragma once
/// What a mesh reader reads: the bytes of one file, in memory or mapped.
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "voxdag/core/error.hpp"
#include "voxdag/io/mapped_file.hpp"
#include "voxdag/parallel/progress.hpp"

namespace voxdag {

struct MeshBytes {
  std::string_view bytes;            ///< The whole file; must stay valid during the call.
  std::string name;                  ///< For error messages.
  std::filesystem::path folder;      ///< Where relative references (glTF buffers) start.
  Progress* progress = nullptr;      ///< May be null.
  const MappedFile* file = nullptr;  ///< Where `bytes` is mapped, if it is.

  /// Marks a part as read for now: its pages need not stay in memory. Reports progress and throws
  /// Cancelled when asked to stop.
  void done_with(std::string_view part, std::string_view stage) const {
    if (file != nullptr) file->release(part);
    if (progress == nullptr) return;
    progress->throw_if_cancelled();
    const auto end = static_cast<std::size_t>(part.data() + part.size() - bytes.data());
    progress->report(stage, static_cast<double>(end) / static_cast<double>(bytes.size()), end);
  }

  Error error(const std::string& reason) const { return {name, "", reason}; }
  Error error_at_byte(std::size_t offset, const std::string& reason) const {
    return {name, ErrorPlace::byte(offset), reason};
  }
};

}  // namespace voxdag

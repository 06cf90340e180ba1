#include "viewer/scene/scene_bytes.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cinttypes>
#include <cstdio>
#include <cstring>
#include <system_error>
#include <vector>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/checksum.hpp"
#include "voxdag/core/io/mapped_file.hpp"
#include "voxdag/core/io/open_input.hpp"
#include "voxdag/file/vdag_bytes.hpp"
#include "voxdag/file/vdag_format.hpp"
#include "voxdag/file/vdag_parse.hpp"

namespace voxdag {
namespace {

std::string tag_of(const VdagHeader& header) {
  char text[17];
  std::snprintf(text, sizeof text, "%016" PRIx64, header.checksum);
  return text;
}

/// The size and the time of the last change of an open file.
struct FileState {
  off_t size = 0;
  timespec changed{};

  static FileState of(int descriptor) {
    struct stat status {};
    if (fstat(descriptor, &status) != 0) return {-1, {}};
    return {status.st_size, status.st_mtim};
  }
  friend bool operator==(const FileState& a, const FileState& b) {
    return a.size == b.size && a.changed.tv_sec == b.changed.tv_sec &&
           a.changed.tv_nsec == b.changed.tv_nsec;
  }
};

/// The bytes of a file on the disk.
class FileBytes final : public SceneBytes {
 public:
  explicit FileBytes(const std::filesystem::path& path)
      : input_(open_input(path)), state_(FileState::of(input_.descriptor.get())) {
    try {
      if (state_.size < 0) throw Error("", "", "cannot read: " + system_reason());
      if (size() <= kWholeCheckBytes)
        check_all();
      else
        check_outline(path);
    } catch (const Error& error) {
      throw error.in_file(path.string());
    }
  }

  std::uint64_t size() const override { return static_cast<std::uint64_t>(state_.size); }
  std::string tag() const override { return tag_of(header_); }
  bool is_unchanged() const override { return FileState::of(input_.descriptor.get()) == state_; }
  bool read(std::uint64_t offset, std::span<std::byte> out) const override {
    return is_unchanged() && read_all(offset, out);
  }

 private:
  bool read_all(std::uint64_t offset, std::span<std::byte> out) const {
    while (!out.empty()) {
      const ssize_t got =
          pread(input_.descriptor.get(), out.data(), out.size(), static_cast<off_t>(offset));
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) return false;
      out = out.subspan(static_cast<std::size_t>(got));
      offset += static_cast<std::uint64_t>(got);
    }
    return true;
  }

  /// Reads the file and checks all of it.
  void check_all() {
    // The parser needs bytes that are aligned to 8.
    std::vector<std::uint64_t> words((size() + 7) / 8);
    const std::span<std::byte> bytes = std::as_writable_bytes(std::span(words)).first(size());
    errno = 0;
    if (!read_all(0, bytes))
      throw Error("", "",
                  errno == 0 ? "changed while it was opened" : "cannot read: " + system_reason());
    parse_vdag(bytes);
    std::memcpy(&header_, bytes.data(), sizeof header_);
  }

  /// Checks the header, the chunk table and META, and reads no more.
  void check_outline(const std::filesystem::path& path) {
    const MappedFile mapping(path, MappedFile::Access::kRandom);
    const std::vector<VdagChunk> chunks = read_vdag_chunks(mapping.bytes());
    const VdagChunk* const meta = find_chunk(chunks, kChunkMeta);
    if (meta != nullptr && meta->bytes.size() <= kVdagMaxMetadataBytes)
      check_vdag_checksums({*meta});
    read_vdag_svdag(chunks, read_vdag_metadata(chunks).grid.levels);
    if (!read_all(0, std::as_writable_bytes(std::span(&header_, 1))) ||
        std::memcmp(&header_, mapping.bytes().data(), sizeof header_) != 0)
      throw Error("", "", "changed while it was opened");
  }

  static std::string system_reason() { return std::system_category().message(errno); }

  OpenInput input_;
  FileState state_;
  VdagHeader header_{};
};

/// The bytes of the file for a DAG in memory.
class DagBytes final : public SceneBytes {
 public:
  DagBytes(const SvdagView& dag, const VdagMetadata& metadata, const DagAttributesView& attributes,
           AttributeForm form)
      : bytes_(dag, metadata, attributes, form) {
    std::memcpy(&header_, bytes_.parts().front().data(), sizeof header_);
    for (const auto& part : bytes_.parts()) {
      begins_.push_back(end_);
      end_ += part.size();
    }
  }

  std::uint64_t size() const override { return end_; }
  std::string tag() const override { return tag_of(header_); }
  bool is_unchanged() const override { return true; }
  bool read(std::uint64_t offset, std::span<std::byte> out) const override {
    auto part = static_cast<std::size_t>(std::upper_bound(begins_.begin(), begins_.end(), offset) -
                                         begins_.begin() - 1);
    for (; !out.empty(); ++part) {
      const auto bytes = bytes_.parts()[part].subspan(offset - begins_[part]);
      const std::size_t count = std::min(out.size(), bytes.size());
      std::memcpy(out.data(), bytes.data(), count);
      out = out.subspan(count);
      offset += count;
    }
    return true;
  }

 private:
  PlainVdagBytes bytes_;
  VdagHeader header_{};
  std::vector<std::uint64_t> begins_;  // The offset of each part.
  std::uint64_t end_ = 0;
};

}  // namespace

std::unique_ptr<SceneBytes> open_scene_bytes(const std::filesystem::path& path) {
  return std::make_unique<FileBytes>(path);
}

std::unique_ptr<SceneBytes> make_scene_bytes(const SvdagView& dag, const VdagMetadata& metadata,
                                             const DagAttributesView& attributes,
                                             AttributeForm form) {
  return std::make_unique<DagBytes>(dag, metadata, attributes, form);
}

}  // namespace voxdag

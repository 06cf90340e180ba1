#pragma once
/// The bytes of the scene that a page shows: a .vdag file in the plain form.
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "voxdag/file/attribute_form.hpp"
#include "voxdag/file/vdag_metadata.hpp"
#include "voxdag/stored/attributes/stored_attributes.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// The bytes, wherever they are. Thread-safe.
class SceneBytes {
 public:
  virtual ~SceneBytes() = default;

  virtual std::uint64_t size() const = 0;
  /// Returns a text that differs for different bytes: the checksum of the header and the chunk
  /// table, which hold the checksums of all chunks.
  virtual std::string tag() const = 0;
  /// Returns whether the bytes are still those of tag().
  virtual bool is_unchanged() const = 0;
  /// Reads the bytes from `offset` on into all of `out`, within size(). Returns false if the file
  /// has changed or cannot be read any more.
  virtual bool read(std::uint64_t offset, std::span<std::byte> out) const = 0;
};

/// The scene of a page that begins without one.
class NoScene final : public SceneBytes {
 public:
  std::uint64_t size() const override { return 0; }
  std::string tag() const override { return "none"; }
  bool is_unchanged() const override { return true; }
  bool read(std::uint64_t, std::span<std::byte>) const override { return false; }
};

/// Files up to this size are checked completely before they are shown. For larger files, only the
/// header, the chunk table and META are checked; the page checks the levels that it uses.
inline constexpr std::uint64_t kWholeCheckBytes = std::uint64_t{32} << 20;

/// Opens a .vdag file in the plain form, and keeps it open: if another file takes its name, the
/// bytes stay those of the first. read() uses pread(), not a mapping: if another program truncates
/// the file, read() fails and no signal ends the program. Throws Error(path, place, reason).
std::unique_ptr<SceneBytes> open_scene_bytes(const std::filesystem::path& path);

/// Returns the bytes that write_vdag() would write for a DAG in memory, which must outlive the
/// result. Throws what write_vdag() throws.
std::unique_ptr<SceneBytes> make_scene_bytes(const SvdagView& dag, const VdagMetadata& metadata,
                                             const DagAttributesView& attributes = {},
                                             AttributeForm form = AttributeForm::kPages);

}  // namespace voxdag

#pragma once
/// The container of a glTF 2.0 asset: its JSON, and the bytes of its buffers.
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string_view>

#include "voxdag/core/io/mapped_file.hpp"
#include "voxdag/formats/readers/gltf/gltf_uri.hpp"
#include "voxdag/formats/readers/gltf/gltf_value.hpp"
#include "voxdag/formats/readers/named_files.hpp"
#include "voxdag/formats/readers/warnings.hpp"

namespace voxdag {

/// The arrays of the asset that this library reads.
enum class GltfArray {
  kBuffers,
  kBufferViews,
  kAccessors,
  kMeshes,
  kNodes,
  kScenes,
  kMaterials,
  kImages,
  kTextures,
  kSamplers,
  kSkins
};

class GltfFile {
 public:
  /// Parses the container (JSON text or GLB) and checks version and extensions: an unknown one is
  /// an Error if the asset requires it, and one of textures if `with_appearance` is set, else a
  /// warning. Maps buffers in other files and decodes those in `data:` URIs; opens no images.
  /// Throws Error, OverMemory, Cancelled.
  GltfFile(const MeshSource& source, Warnings& warnings, bool with_appearance);
  GltfFile(const GltfFile&) = delete;
  GltfFile& operator=(const GltfFile&) = delete;

  const MeshSource& source() const { return source_; }
  const NamedFiles& named_files() const { return named_files_; }
  GltfValue root() const { return {source_, *json_, json_->root()}; }
  const GltfItems& array(GltfArray array) const { return arrays_[static_cast<std::size_t>(array)]; }
  /// Returns item `index` of an array. If there is none, throws Error with the place of `user`.
  GltfValue item(GltfArray array, std::uint64_t index, const GltfValue& user) const;

  /// Returns the name of the file that the URI of `value` stands for: the one that exists of the
  /// decoded URI, the URI as it stands, and the URI without query and fragment, else the first.
  std::string file_name(const GltfValue& value, std::string_view uri) const;

  /// Returns the bytes of the buffer view that `user` refers to, which lie inside their buffer, or
  /// are decoded once (EXT_ and KHR_meshopt_compression). Sets `view` to the buffer view, which has
  /// the stride. Throws Error and OverMemory.
  std::string_view view_bytes(const GltfValue& user, std::optional<GltfValue>& view) const;

  /// Returns the total size of all buffers, in bytes.
  std::uint64_t buffer_bytes() const { return buffer_bytes_; }
  /// Drops the pages of mapped buffers from memory.
  void release_pages() const;

 private:
  struct Buffer {
    std::string_view bytes;
    std::optional<MappedFile> file;
    std::optional<DecodedUri> decoded;
  };

  void parse(std::string_view text);
  void check_version() const;
  void check_extensions(Warnings& warnings, bool with_appearance) const;
  void open_buffers(std::optional<std::string_view> binary_chunk, Warnings& warnings);
  std::string_view buffer_part(const GltfValue& part) const;
  void open_uri(const GltfValue& value, std::string_view uri, Buffer& buffer) const;

  const MeshSource& source_;
  const NamedFiles named_files_;
  std::unique_ptr<JsonDocument> json_;
  std::array<GltfItems, 11> arrays_;
  CountedVector<Buffer> buffers_;
  std::uint64_t buffer_bytes_ = 0;
  mutable std::map<std::uint64_t, CountedVector<char>> decoded_views_;
};

}  // namespace voxdag

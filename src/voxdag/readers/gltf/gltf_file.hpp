#pragma once
/// The container of a glTF 2.0 asset: its JSON, and the bytes of its buffers.
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "voxdag/readers/mesh_source.hpp"

namespace voxdag {

/// A JSON value and its path in the asset, for error messages: "accessors[3].sparse".
/// Members that are absent have a null value.
class GltfValue {
 public:
  GltfValue(const MeshSource& source, const nlohmann::json& value, std::string path)
      : source_(&source), value_(&value), path_(std::move(path)) {}

  /// The member of an object; throws Error if this is there but is no object.
  GltfValue operator[](const char* key) const;
  /// The items of an array, none if absent; throws Error if this is there but is no array.
  std::vector<GltfValue> items() const;
  bool exists() const { return !value_->is_null(); }

  /// A whole number from 0 to 2^53, the default if absent; throws Error for anything else.
  std::uint64_t whole(std::uint64_t absent) const;
  std::uint64_t whole() const;  ///< As above; throws Error if absent.
  bool boolean(bool absent) const;
  std::string text(const std::string& absent = "") const;
  /// `count` finite numbers, or nothing if absent; throws Error for anything else.
  std::vector<double> numbers(std::size_t count) const;
  /// A finite number, or the default if absent; throws Error for anything else.
  double number(double absent) const;

  Error error(const std::string& reason) const { return {source_->name, path_, reason}; }

 private:
  const MeshSource* source_;
  const nlohmann::json* value_;
  std::string path_;
};

/// The bytes of a buffer, and what owns them.
struct GltfBuffer {
  std::string_view bytes;
  std::unique_ptr<MappedFile> file;
  std::string decoded;
};

class GltfFile {
 public:
  /// Parses the container (JSON text or GLB) and checks version and required extensions. Buffers
  /// are opened too: files beside the asset are mapped, `data:` URIs are decoded. Images are not.
  explicit GltfFile(const MeshSource& source);
  GltfFile(const GltfFile&) = delete;
  GltfFile& operator=(const GltfFile&) = delete;

  GltfValue root() const { return {source_, json_, ""}; }
  /// Item `index` of a top-level array; throws Error, on behalf of `user`, if there is none.
  const GltfValue& item(const char* array, std::uint64_t index, const GltfValue& user) const;
  /// All items of a top-level array.
  const std::vector<GltfValue>& array(const char* name) const;
  /// The bytes of a `data:` URI; nothing if the URI is another or malformed.
  static std::optional<std::string> decode_data_uri(std::string_view uri);
  /// A relative URI as the path of a file.
  static std::string decode_uri(std::string_view uri);

  const GltfBuffer& buffer(std::uint64_t index) const { return buffers_[index]; }

 private:
  void parse_json(std::string_view text);
  void check_version() const;
  void open_buffers(std::string_view binary_chunk, bool has_chunk);

  const MeshSource& source_;
  nlohmann::json json_;
  std::vector<std::pair<std::string, std::vector<GltfValue>>> arrays_;
  std::vector<GltfBuffer> buffers_;
};

}  // namespace voxdag

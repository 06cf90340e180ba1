#include "voxdag/formats/readers/gltf/gltf_file.hpp"

#include <algorithm>

#include "voxdag/core/printable.hpp"
#include "voxdag/formats/readers/gltf/gltf_meshopt.hpp"

namespace voxdag {
namespace {

constexpr std::array kArrayNames = {"buffers",  "bufferViews", "accessors", "meshes",
                                    "nodes",    "scenes",      "materials", "images",
                                    "textures", "samplers",    "skins"};

/// The extensions that are read.
constexpr std::string_view kReadExtensions[] = {"EXT_mesh_gpu_instancing",
                                                "EXT_meshopt_compression",
                                                "EXT_texture_webp",
                                                "KHR_draco_mesh_compression",
                                                "KHR_materials_emissive_strength",
                                                "KHR_materials_pbrSpecularGlossiness",
                                                "KHR_mesh_quantization",
                                                "KHR_meshopt_compression",
                                                "KHR_node_visibility",
                                                "KHR_texture_transform"};
/// The extensions that change neither shape nor colour of the surface at rest.
constexpr std::string_view kHarmlessExtensions[] = {"EXT_lights_ies",
                                                    "EXT_lights_image_based",
                                                    "EXT_mesh_features",
                                                    "EXT_mesh_manifold",
                                                    "EXT_structural_metadata",
                                                    "FB_ngon_encoding",
                                                    "KHR_animation_pointer",
                                                    "KHR_lights_punctual",
                                                    "KHR_materials_anisotropy",
                                                    "KHR_materials_clearcoat",
                                                    "KHR_materials_diffuse_transmission",
                                                    "KHR_materials_dispersion",
                                                    "KHR_materials_ior",
                                                    "KHR_materials_iridescence",
                                                    "KHR_materials_sheen",
                                                    "KHR_materials_specular",
                                                    "KHR_materials_transmission",
                                                    "KHR_materials_unlit",
                                                    "KHR_materials_variants",
                                                    "KHR_materials_volume",
                                                    "KHR_node_hoverability",
                                                    "KHR_node_selectability",
                                                    "KHR_xmp",
                                                    "KHR_xmp_json_ld",
                                                    "MSFT_lod",
                                                    "MSFT_packing_normalRoughnessMetallic",
                                                    "MSFT_packing_occlusionRoughnessMetallic"};
/// The extensions of textures that are not read: the shape does not need them.
constexpr std::string_view kTextureExtensions[] = {"EXT_texture_avif", "KHR_texture_basisu",
                                                   "KHR_texture_procedurals", "MSFT_texture_dds"};

template <std::size_t n>
bool is_among(const std::string_view (&names)[n], std::string_view name) {
  return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

/// Returns whether the array may be malformed, which counts as empty.
bool is_optional(GltfArray array) { return array >= GltfArray::kImages; }

std::uint32_t load_u32(std::string_view bytes, std::size_t offset) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i)
    value |= std::uint32_t{static_cast<unsigned char>(bytes[offset + i])} << 8 * i;
  return value;
}

/// Returns JSON without NULs at its end: some programs do not pad with blanks.
std::string_view without_padding(std::string_view json) {
  while (json.ends_with('\0')) json.remove_suffix(1);
  return json;
}

/// Returns what a buffer or buffer view has of meshopt's extensions, which share one format.
GltfValue meshopt_of(const GltfValue& value) {
  const GltfValue extensions = value["extensions"], older = extensions["EXT_meshopt_compression"];
  return older.exists() ? older : extensions["KHR_meshopt_compression"];
}

Error short_buffer(const GltfValue& buffer, std::size_t bytes) {
  return buffer.error("buffer of " + std::to_string(bytes) + " bytes, but " +
                      std::to_string(buffer["byteLength"].whole()) + " are declared");
}

/// Returns whether chunks of a GLB file follow its header, and the last one ends with the bytes.
bool is_chunk_list(std::string_view bytes) {
  std::size_t at = 12;
  while (at < bytes.size() && bytes.size() - at >= 8) {
    const std::size_t size = load_u32(bytes, at);
    if (size > bytes.size() - at - 8) return false;
    at += 8 + size;
  }
  return at == bytes.size();
}

}  // namespace

GltfFile::GltfFile(const MeshSource& source, Warnings& warnings, bool with_appearance)
    : source_(source), named_files_(source), buffers_(source.work().memory) {
  const std::string_view bytes = source.bytes;
  if (!bytes.starts_with("glTF")) {
    parse(without_padding(bytes));
    check_extensions(warnings, with_appearance);
    open_buffers(std::nullopt, warnings);
    return;
  }
  if (bytes.size() < 20)
    throw source.error_at_byte(bytes.size(), "the file ends inside its header");
  if (load_u32(bytes, 4) != 2)
    throw source.error_at_byte(
        4, "GLB version " + std::to_string(load_u32(bytes, 4)) + ": only version 2 is read");
  const std::uint32_t length = load_u32(bytes, 8);
  std::string_view chunks = bytes.substr(0, length);
  if ((length > bytes.size() || !is_chunk_list(chunks)) && is_chunk_list(bytes)) {
    warnings.add(source.name + ": the header states a length of " + counted(length, "byte") +
                 ", but the last chunk ends with the file, at byte " +
                 std::to_string(bytes.size()) + ": all chunks are read");
    chunks = bytes;
  } else if (length > bytes.size()) {
    throw source.error_at_byte(
        bytes.size(),
        "the file ends before the end that its header states, byte " + std::to_string(length));
  }
  const std::size_t json_bytes = load_u32(bytes, 12);
  if (chunks.size() < 20 || json_bytes > chunks.size() - 20 || chunks.substr(16, 4) != "JSON")
    throw source.error_at_byte(12, "the first chunk must be JSON and end inside the file");
  parse(without_padding(chunks.substr(20, json_bytes)));
  check_extensions(warnings, with_appearance);
  const std::size_t second = 20 + json_bytes;
  if (chunks.size() - second < 8) {
    open_buffers(std::nullopt, warnings);
    return;
  }
  const std::size_t binary_bytes = load_u32(chunks, second);
  if (binary_bytes > chunks.size() - second - 8)
    throw source.error_at_byte(second, "the binary chunk goes beyond the end of the file");
  const bool is_binary = chunks.substr(second + 4, 4) == std::string_view("BIN\0", 4);
  open_buffers(is_binary ? std::optional(chunks.substr(second + 8, binary_bytes)) : std::nullopt,
               warnings);
}

void GltfFile::parse(std::string_view text) {
  json_ = std::make_unique<JsonDocument>(source_, text);
  source_.done_with(text, "parse");
  if (json_->node(json_->root()).kind != JsonKind::kObject)
    throw source_.error("not glTF: the JSON is not an object");
  for (std::size_t i = 0; i < arrays_.size(); ++i) try {
      arrays_[i] = root()[kArrayNames[i]].items();
    } catch (const Error&) {
      if (!is_optional(static_cast<GltfArray>(i))) throw;
    }
  check_version();
}

void GltfFile::check_version() const {
  const std::string version = root()["asset"]["version"].text();
  if (version.empty()) throw source_.error("not glTF: 'asset.version' is missing");
  if (!version.starts_with("2."))
    throw source_.error("glTF version " + name_in_quotes(version) + ": only version 2 is read");
}

void GltfFile::check_extensions(Warnings& warnings, bool with_appearance) const {
  const auto is_known = [](std::string_view name) {
    return is_among(kReadExtensions, name) || is_among(kHarmlessExtensions, name);
  };
  for (const GltfValue extension : root()["extensionsRequired"].items()) {
    const std::string name = extension.text();
    if (!is_known(name) && (with_appearance || !is_among(kTextureExtensions, name)))
      throw extension.error("extension " + name_in_quotes(name) + " is not supported");
  }
  CancelPoll poll(source_.work());
  for (const GltfValue extension : root()["extensionsUsed"].items()) {
    poll.step();
    const std::string name = extension.text();
    if (!is_known(name) && (with_appearance || !is_among(kTextureExtensions, name)))
      warnings.add(extension.error("extension " + name_in_quotes(name) + " is not read").what());
  }
}

void GltfFile::open_buffers(std::optional<std::string_view> binary_chunk, Warnings& warnings) {
  CancelPoll poll(source_.work());
  for (const GltfValue value : array(GltfArray::kBuffers)) {
    poll.step();
    Buffer& buffer = buffers_.emplace_back();
    std::string unescaped;
    const std::string_view uri = value["uri"].text_view(unescaped);
    if (meshopt_of(value)["fallback"].boolean(false)) {
      continue;  // Views are compressed elsewhere, and this buffer may be missing.
    } else if (!uri.empty()) {
      open_uri(value, uri, buffer);
    } else {
      if (!binary_chunk || buffers_.size() > 1) throw value.error("the buffer has no URI");
      buffer.bytes = *binary_chunk;
    }
    const std::uint64_t size = value["byteLength"].whole();
    if (size > buffer.bytes.size()) warnings.add(short_buffer(value, buffer.bytes.size()).what());
    buffer.bytes = buffer.bytes.substr(0, size);
    buffer_bytes_ += buffer.bytes.size();
  }
  // A short decoded string has moved with its buffer object, so its view must be set again.
  for (Buffer& buffer : buffers_)
    if (buffer.decoded)
      buffer.bytes = std::string_view(buffer.decoded->bytes).substr(0, buffer.bytes.size());
}

void GltfFile::open_uri(const GltfValue& value, std::string_view uri, Buffer& buffer) const {
  if (is_data_uri(uri)) {
    buffer.decoded = decode_data_uri(uri, source_.work());
    if (!buffer.decoded)
      throw value.error(uri.find(',') == uri.npos ? "malformed data URI"
                                                  : "data URI is not base64");
    buffer.bytes = buffer.decoded->bytes;
    return;
  }
  if (source_.file == nullptr)
    throw value.error("a buffer must be in the glTF file, in a data URI or in a file beside it");
  const std::string name = file_name(value, uri);
  const std::filesystem::path path = named_files_.find(
      source_.folder, name, {source_.name, value.path()}, NamedFiles::ByBaseName::kIfAbsolute);
  try {
    buffer.file.emplace(path, MappedFile::Access::kSequential);
  } catch (const Error& fault) {
    throw value.error("buffer " + name_in_quotes(name) + ": " + fault.reason());
  }
  buffer.bytes = buffer.file->text();
}

std::string GltfFile::file_name(const GltfValue& value, std::string_view uri) const {
  std::string name = decode_percent(uri);
  if (name.find('\0') != name.npos) throw value.error("malformed URI");
  // Some programs write names of files as they are, others add a query.
  const std::string before_query = decode_percent(uri.substr(0, uri.find_first_of("?#")));
  for (const std::string& each : {name, std::string(uri), before_query})
    if (named_files_.existing(source_.folder, each, NamedFiles::ByBaseName::kNever)) return each;
  return name;
}

GltfValue GltfFile::item(GltfArray array, std::uint64_t index, const GltfValue& user) const {
  const GltfItems& values = this->array(array);
  if (index >= values.size())
    throw user.error(std::string(kArrayNames[static_cast<std::size_t>(array)]) + "[" +
                     std::to_string(index) + "] does not exist");
  return values[index];
}

std::string_view GltfFile::view_bytes(const GltfValue& user, std::optional<GltfValue>& view) const {
  const std::uint64_t index = user["bufferView"].whole();
  view = item(GltfArray::kBufferViews, index, user);
  const GltfValue packed = meshopt_of(*view);
  if (!packed.exists()) return buffer_part(*view);
  auto decoded = decoded_views_.find(index);
  if (decoded == decoded_views_.end())
    decoded =
        decoded_views_
            .emplace(index, decode_meshopt(packed, buffer_part(packed), source_.work().memory))
            .first;
  return {decoded->second.data(), decoded->second.size()};
}

/// Returns the bytes between `byteOffset` and `byteLength` of a buffer.
std::string_view GltfFile::buffer_part(const GltfValue& part) const {
  const std::uint64_t index = part["buffer"].whole();
  const GltfValue value = item(GltfArray::kBuffers, index, part);
  const std::string_view buffer = buffers_[index].bytes;
  const std::uint64_t offset = part["byteOffset"].whole(0);
  const std::uint64_t length = part["byteLength"].whole();
  if (offset > buffer.size() || length > buffer.size() - offset) {
    if (buffer.size() < value["byteLength"].whole()) throw short_buffer(value, buffer.size());
    throw part.error("buffer view goes beyond its buffer");
  }
  return buffer.substr(offset, length);
}

void GltfFile::release_pages() const {
  if (source_.file != nullptr) source_.file->release(source_.bytes);
  for (const Buffer& buffer : buffers_)
    if (buffer.file) buffer.file->release(buffer.bytes);
}

}  // namespace voxdag

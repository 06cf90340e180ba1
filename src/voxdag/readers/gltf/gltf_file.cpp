#include "voxdag/readers/gltf/gltf_file.hpp"

#include <cmath>
#include <cstring>
#include <optional>

#include "voxdag/readers/named_files.hpp"
#include "voxdag/readers/quoted.hpp"

namespace voxdag {
namespace {

using Json = nlohmann::json;

const Json kNull;

std::uint32_t load_u32(std::string_view bytes, std::size_t offset) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i)
    value |= std::uint32_t{static_cast<unsigned char>(bytes[offset + i])} << 8 * i;
  return value;
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::string decode_percent(std::string_view uri) {
  std::string out;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const bool escaped = uri[i] == '%' && i + 2 < uri.size() && hex_digit(uri[i + 1]) >= 0 &&
                         hex_digit(uri[i + 2]) >= 0;
    if (!escaped) {
      out += uri[i];
    } else {
      out += static_cast<char>(hex_digit(uri[i + 1]) * 16 + hex_digit(uri[i + 2]));
      i += 2;
    }
  }
  return out;
}

/// Nothing if the text is not base64.
std::optional<std::string> decode_base64(std::string_view text) {
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  std::string out;
  out.reserve(text.size() / 4 * 3 + 3);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    std::uint32_t digit = 0;
    if (c >= 'A' && c <= 'Z')
      digit = static_cast<std::uint32_t>(c - 'A');
    else if (c >= 'a' && c <= 'z')
      digit = static_cast<std::uint32_t>(c - 'a' + 26);
    else if (c >= '0' && c <= '9')
      digit = static_cast<std::uint32_t>(c - '0' + 52);
    else if (c == '+' || c == '-')
      digit = 62;
    else if (c == '/' || c == '_')
      digit = 63;
    else
      return std::nullopt;
    bits = bits << 6 | digit;
    count += 6;
    if (count >= 8) {
      count -= 8;
      out += static_cast<char>(bits >> count & 0xFF);
    }
  }
  return out;
}

/// Extensions that do not change where the triangles are.
bool is_harmless_extension(const std::string& name) {
  for (const std::string_view prefix :
       {"KHR_materials_", "KHR_texture_", "EXT_texture_", "MSFT_texture_", "KHR_lights_",
        "EXT_lights_", "KHR_xmp", "KHR_animation_pointer", "KHR_mesh_quantization"})
    if (std::string_view(name).starts_with(prefix)) return true;
  return false;
}

}  // namespace

GltfValue GltfValue::operator[](const char* key) const {
  if (!exists()) return {*source_, kNull, path_};
  if (!value_->is_object()) throw error("is not a JSON object");
  const auto found = value_->find(key);
  return {*source_, found == value_->end() ? kNull : *found,
          path_.empty() ? key : path_ + "." + key};
}

std::vector<GltfValue> GltfValue::items() const {
  std::vector<GltfValue> items;
  if (!exists()) return items;
  if (!value_->is_array()) throw error("is not a JSON array");
  items.reserve(value_->size());
  for (std::size_t i = 0; i < value_->size(); ++i)
    items.push_back({*source_, (*value_)[i], path_ + "[" + std::to_string(i) + "]"});
  return items;
}

std::uint64_t GltfValue::whole(std::uint64_t absent) const { return exists() ? whole() : absent; }

std::uint64_t GltfValue::whole() const {
  constexpr std::uint64_t kLimit = std::uint64_t{1} << 53;
  if (!exists()) throw error("is missing");
  if (value_->is_number_unsigned() && value_->get<std::uint64_t>() <= kLimit)
    return value_->get<std::uint64_t>();
  if (value_->is_number_float()) {  // Some writers put 3.0 for 3.
    const double number = value_->get<double>();
    if (number >= 0 && number <= static_cast<double>(kLimit) && number == std::floor(number))
      return static_cast<std::uint64_t>(number);
  }
  throw error("is not a whole number from 0 on");
}

bool GltfValue::boolean(bool absent) const {
  if (!exists()) return absent;
  if (!value_->is_boolean()) throw error("is neither true nor false");
  return value_->get<bool>();
}

std::string GltfValue::text(const std::string& absent) const {
  if (!exists()) return absent;
  if (!value_->is_string()) throw error("is not a string");
  return value_->get<std::string>();
}

std::vector<double> GltfValue::numbers(std::size_t count) const {
  std::vector<double> numbers;
  if (!exists()) return numbers;
  if (value_->is_array())
    for (const Json& number : *value_)
      if (number.is_number() && std::isfinite(number.get<double>()))
        numbers.push_back(number.get<double>());
  if (!value_->is_array() || numbers.size() != count || value_->size() != count)
    throw error("is not an array of " + std::to_string(count) + " numbers");
  return numbers;
}

double GltfValue::number(double absent) const {
  if (!exists()) return absent;
  if (!value_->is_number() || !std::isfinite(value_->get<double>())) throw error("is not a number");
  return value_->get<double>();
}

GltfFile::GltfFile(const MeshSource& source) : source_(source) {
  const std::string_view bytes = source.bytes;
  if (!bytes.starts_with("glTF")) {
    parse_json(bytes);
    check_version();
    open_buffers({}, false);
    return;
  }
  if (bytes.size() < 20)
    throw source.error_at_byte(bytes.size(), "the file ends inside its header");
  if (load_u32(bytes, 4) != 2)
    throw source.error_at_byte(
        4, "GLB version " + std::to_string(load_u32(bytes, 4)) + ": only version 2 is known");
  const std::string_view chunks = bytes.substr(0, load_u32(bytes, 8));
  if (load_u32(bytes, 8) > bytes.size())
    throw source.error_at_byte(bytes.size(), "the file ends before its length of " +
                                                 std::to_string(load_u32(bytes, 8)) + " bytes");
  const std::size_t json_bytes = load_u32(bytes, 12);
  if (chunks.size() < 20 || json_bytes > chunks.size() - 20 || chunks.substr(16, 4) != "JSON")
    throw source.error_at_byte(12, "the first chunk is not JSON inside the file");
  parse_json(chunks.substr(20, json_bytes));
  check_version();
  const std::size_t second = 20 + json_bytes;
  if (chunks.size() - second < 8) {
    open_buffers({}, false);
    return;
  }
  const std::size_t binary_bytes = load_u32(chunks, second);
  if (binary_bytes > chunks.size() - second - 8)
    throw source.error_at_byte(second, "the binary chunk goes beyond the file");
  open_buffers(chunks.substr(second + 8, binary_bytes),
               chunks.substr(second + 4, 4) == std::string_view("BIN\0", 4));
}

void GltfFile::parse_json(std::string_view text) {
  try {
    json_ = Json::parse(text.begin(), text.end());
  } catch (const Json::parse_error& fault) {
    const auto start = static_cast<std::size_t>(text.data() - source_.bytes.data());
    throw source_.error_at_byte(start + (fault.byte > 0 ? fault.byte - 1 : 0),
                                "not glTF: the JSON is malformed here");
  } catch (const Json::exception&) {
    throw source_.error("not glTF: the JSON has a number out of range");
  }
  if (!json_.is_object()) throw source_.error("not glTF: the JSON is not an object");
  for (const char* name :
       {"buffers", "bufferViews", "accessors", "meshes", "nodes", "scenes", "materials"})
    arrays_.emplace_back(name, root()[name].items());
  for (const char* name : {"images", "textures", "samplers"}) {
    arrays_.emplace_back(name, std::vector<GltfValue>());
    try {
      arrays_.back().second = root()[name].items();
    } catch (const Error&) {  // They make no geometry: who looks for an item finds none.
    }
  }
}

void GltfFile::check_version() const {
  const std::string version = root()["asset"]["version"].text();
  if (version.empty()) throw source_.error("not glTF: 'asset.version' is missing");
  if (!version.starts_with("2."))
    throw source_.error("glTF version '" + version + "': only version 2 is known");
  for (const GltfValue& extension : root()["extensionsRequired"].items())
    if (!is_harmless_extension(extension.text()))
      throw extension.error("extension '" + extension.text() + "' is not supported");
}

void GltfFile::open_buffers(std::string_view binary_chunk, bool has_chunk) {
  for (const GltfValue& value : array("buffers")) {
    GltfBuffer buffer;
    const std::string uri = value["uri"].text();
    if (uri.empty()) {
      if (!has_chunk || !buffers_.empty()) throw value.error("buffer without a URI");
      buffer.bytes = binary_chunk;
    } else if (uri.starts_with("data:")) {
      auto decoded = decode_data_uri(uri);
      if (!decoded)
        throw value.error(uri.find(',') == uri.npos ? "malformed data URI"
                                                    : "data URI is not base64");
      buffer.decoded = std::move(*decoded);
      buffer.bytes = buffer.decoded;
    } else {
      if (uri.find("://") != uri.npos || source_.file == nullptr)
        throw value.error("buffer in another place than beside the file");
      const std::string name = decode_percent(uri);
      if (name.find('\0') != name.npos) throw value.error("malformed URI");
      const Error place = value.error("");
      const std::filesystem::path path =
          NamedFiles(source_).find(source_.folder, name, {place.file(), place.place()});
      try {
        buffer.file = std::make_unique<MappedFile>(path, MappedFile::Access::kSequential);
      } catch (const Error& fault) {
        throw value.error("buffer " + name_in_quotes(name) + ": " + fault.reason());
      }
      buffer.bytes = buffer.file->text();
    }
    const std::uint64_t size = value["byteLength"].whole();
    if (size > buffer.bytes.size())
      throw value.error("buffer of " + std::to_string(buffer.bytes.size()) + " bytes, but " +
                        std::to_string(size) + " are declared");
    const bool owned = !buffer.decoded.empty();
    buffer.bytes = buffer.bytes.substr(0, size);
    buffers_.push_back(std::move(buffer));
    // A short string moves its bytes along.
    if (owned) buffers_.back().bytes = std::string_view(buffers_.back().decoded).substr(0, size);
  }
}

std::optional<std::string> GltfFile::decode_data_uri(std::string_view uri) {
  const std::size_t comma = uri.find(',');
  if (!uri.starts_with("data:") || comma == uri.npos) return std::nullopt;
  const std::string_view data = uri.substr(comma + 1);
  if (uri.substr(0, comma).ends_with(";base64")) return decode_base64(data);
  return decode_percent(data);
}

std::string GltfFile::decode_uri(std::string_view uri) { return decode_percent(uri); }

const std::vector<GltfValue>& GltfFile::array(const char* name) const {
  for (const auto& [known, values] : arrays_)
    if (known == name) return values;
  throw std::logic_error("no such array in glTF");
}

const GltfValue& GltfFile::item(const char* name, std::uint64_t index,
                                const GltfValue& user) const {
  const std::vector<GltfValue>& values = array(name);
  if (index >= values.size())
    throw user.error(std::string(name) + "[" + std::to_string(index) + "] does not exist");
  return values[index];
}

}  // namespace voxdag

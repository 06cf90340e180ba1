#include "voxdag/readers/gltf/gltf_accessor.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>

namespace voxdag {
namespace {

enum : std::uint64_t { kInt8 = 5120, kUint8, kInt16, kUint16, kUint32 = 5125, kFloat };

std::size_t component_bytes(std::uint64_t type, const GltfValue& user) {
  switch (type) {
    case kInt8:
    case kUint8:
      return 1;
    case kInt16:
    case kUint16:
      return 2;
    case kUint32:
    case kFloat:
      return 4;
    default:
      throw user.error("component type " + std::to_string(type) + " is unknown");
  }
}

template <class T>
T load(const char* p) {
  T value;
  std::memcpy(&value, p, sizeof(T));
  return value;
}

/// Elements in a buffer view, all of them inside their buffer.
struct Elements {
  const char* first = nullptr;
  std::size_t count = 0, stride = 0;
  const char* operator[](std::size_t i) const { return first + i * stride; }
};

Elements find_elements(const GltfFile& file, const GltfValue& user, std::size_t count,
                       std::size_t element_bytes, bool may_have_stride) {
  const GltfValue& view = file.item("bufferViews", user["bufferView"].whole(), user);
  const std::uint64_t buffer_index = view["buffer"].whole();
  file.item("buffers", buffer_index, view);
  const std::string_view buffer = file.buffer(buffer_index).bytes;
  const std::uint64_t offset = view["byteOffset"].whole(0), length = view["byteLength"].whole();
  if (offset > buffer.size() || length > buffer.size() - offset)
    throw view.error("buffer view goes beyond its buffer");
  const std::uint64_t stride = view["byteStride"].whole(element_bytes);
  if (stride < element_bytes || stride > 1024 || (!may_have_stride && stride != element_bytes))
    throw view.error("byte stride " + std::to_string(stride) + " does not fit elements of " +
                     std::to_string(element_bytes) + " bytes");
  const std::uint64_t start = user["byteOffset"].whole(0);
  if (start > length || element_bytes > length - start ||
      count - 1 > (length - start - element_bytes) / stride)
    throw user.error("accessor of " + std::to_string(count) +
                     " elements goes beyond its buffer view");
  return {buffer.data() + offset + start, count, stride};
}

std::uint32_t load_index(std::uint64_t type, const char* p) {
  return type == kUint8    ? load<std::uint8_t>(p)
         : type == kUint16 ? load<std::uint16_t>(p)
                           : load<std::uint32_t>(p);
}

void check_index_type(std::uint64_t type, const GltfValue& user) {
  if (type != kUint8 && type != kUint16 && type != kUint32)
    throw user.error("indices of component type " + std::to_string(type) +
                     ", which is not unsigned");
}

float load_component(std::uint64_t type, bool normalized, const char* p) {
  const auto scaled = [&](auto value) {
    const auto number = static_cast<double>(value);
    if (!normalized) return static_cast<float>(number);
    // Divided in double, so that the result is the nearest float32.
    return static_cast<float>(
        std::max(-1.0, number / static_cast<double>(std::numeric_limits<decltype(value)>::max())));
  };
  switch (type) {
    case kInt8:
      return scaled(load<std::int8_t>(p));
    case kUint8:
      return scaled(load<std::uint8_t>(p));
    case kInt16:
      return scaled(load<std::int16_t>(p));
    case kUint16:
      return scaled(load<std::uint16_t>(p));
    default:
      return load<float>(p);
  }
}

/// Calls put(element, bytes) for the dense elements, then for the sparse ones.
template <class Put>
void read_elements(const GltfFile& file, const GltfValue& accessor, std::size_t count,
                   std::size_t element_bytes, bool may_have_stride, const Put& put) {
  if (accessor["bufferView"].exists()) {
    const Elements dense = find_elements(file, accessor, count, element_bytes, may_have_stride);
    for (std::size_t i = 0; i < count; ++i) put(i, dense[i]);
  }
  const GltfValue sparse = accessor["sparse"];
  if (!sparse.exists()) return;
  const std::uint64_t changes = sparse["count"].whole();
  if (changes == 0 || changes > count)
    throw sparse.error(std::to_string(changes) + " sparse values for " + std::to_string(count) +
                       " elements");
  const std::uint64_t type = sparse["indices"]["componentType"].whole();
  check_index_type(type, sparse);
  const Elements indices =
      find_elements(file, sparse["indices"], changes, component_bytes(type, sparse), false);
  const Elements values = find_elements(file, sparse["values"], changes, element_bytes, false);
  for (std::size_t i = 0; i < changes; ++i) {
    const std::uint32_t target = load_index(type, indices[i]);
    if (target >= count)
      throw sparse.error("sparse index " + std::to_string(target) +
                         " is out of range: " + std::to_string(count) + " elements");
    put(target, values[i]);
  }
}

/// A number of elements with nothing behind it must not ask for much memory.
void check_backed(const GltfValue& accessor, std::size_t count) {
  constexpr std::size_t kMaxUnbacked = std::size_t{1} << 24;
  if (accessor["bufferView"].exists()) return;
  if (!accessor["sparse"].exists()) throw accessor.error("accessor without a buffer view");
  if (count > kMaxUnbacked)
    throw accessor.error(std::to_string(count) + " elements without a buffer view");
}

/// Elements of `n` components as vectors of floats.
template <class Vector, std::size_t n>
std::vector<Vector> read_gltf_vectors(const GltfFile& file, const GltfValue& accessor) {
  static_assert(sizeof(Vector) == n * sizeof(float));
  const std::uint64_t type = accessor["componentType"].whole();
  const std::size_t bytes = component_bytes(type, accessor);
  const bool normalized = accessor["normalized"].boolean(false);
  const std::size_t count = gltf_count(accessor);
  check_backed(accessor, count);
  // The first pass only checks, so that nothing is allocated for what is not there.
  read_elements(file, accessor, count, n * bytes, true, [](std::size_t, const char*) {});
  std::vector<Vector> vectors(count);
  read_elements(file, accessor, count, n * bytes, true, [&](std::size_t i, const char* p) {
    std::array<float, n> components;
    for (std::size_t c = 0; c < n; ++c)
      components[c] = load_component(type, normalized, p + c * bytes);
    vectors[i] = std::bit_cast<Vector>(components);
  });
  return vectors;
}

}  // namespace

std::uint32_t gltf_count(const GltfValue& accessor) {
  const std::uint64_t count = accessor["count"].whole();
  if (count == 0 || count >= std::numeric_limits<std::uint32_t>::max())
    throw accessor.error("accessor of " + std::to_string(count) + " elements");
  return static_cast<std::uint32_t>(count);
}

std::vector<Vec3f> read_gltf_positions(const GltfFile& file, const GltfValue& accessor) {
  if (accessor["type"].text() != "VEC3") throw accessor.error("positions that are not VEC3");
  const std::uint64_t type = accessor["componentType"].whole();
  component_bytes(type, accessor);
  if (type != kFloat) {
    const auto used = file.root()["extensionsUsed"].items();
    const bool quantized = std::any_of(used.begin(), used.end(), [](const GltfValue& name) {
      return name.text() == "KHR_mesh_quantization";
    });
    if (!quantized || type == kUint32)
      throw accessor.error("positions of component type " + std::to_string(type) +
                           ", which is not float");
  }
  return read_gltf_vectors<Vec3f, 3>(file, accessor);
}

std::vector<Vec2f> read_gltf_uvs(const GltfFile& file, const GltfValue& accessor) {
  if (accessor["type"].text() != "VEC2") throw accessor.error("texture coordinates not VEC2");
  return read_gltf_vectors<Vec2f, 2>(file, accessor);
}

std::vector<Vec3f> read_gltf_normals(const GltfFile& file, const GltfValue& accessor) {
  if (accessor["type"].text() != "VEC3") throw accessor.error("normals that are not VEC3");
  return read_gltf_vectors<Vec3f, 3>(file, accessor);
}

std::vector<std::array<float, 4>> read_gltf_colors(const GltfFile& file,
                                                   const GltfValue& accessor) {
  if (accessor["type"].text() == "VEC4")
    return read_gltf_vectors<std::array<float, 4>, 4>(file, accessor);
  if (accessor["type"].text() != "VEC3") throw accessor.error("colours neither VEC3 nor VEC4");
  std::vector<std::array<float, 4>> colors;
  for (const Vec3f& color : read_gltf_vectors<Vec3f, 3>(file, accessor))
    colors.push_back({color.x, color.y, color.z, 1});
  return colors;
}

std::vector<std::uint32_t> read_gltf_indices(const GltfFile& file, const GltfValue& accessor) {
  if (accessor["type"].text() != "SCALAR") throw accessor.error("indices that are not SCALAR");
  const std::uint64_t type = accessor["componentType"].whole();
  check_index_type(type, accessor);
  const std::size_t bytes = component_bytes(type, accessor);
  const std::size_t count = gltf_count(accessor);
  check_backed(accessor, count);
  read_elements(file, accessor, count, bytes, false, [](std::size_t, const char*) {});
  std::vector<std::uint32_t> indices(count);
  read_elements(file, accessor, count, bytes, false,
                [&](std::size_t i, const char* p) { indices[i] = load_index(type, p); });
  return indices;
}

}  // namespace voxdag

#include "voxdag/formats/readers/gltf/gltf_accessor.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

#include "voxdag/core/checked_size.hpp"

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

/// Returns the number of components of an accessor's elements; 0 for other types.
int component_count(const GltfValue& accessor) {
  const std::string type = accessor["type"].text();
  if (type == "SCALAR") return 1;
  if (type == "VEC2") return 2;
  if (type == "VEC3") return 3;
  if (type == "VEC4") return 4;
  // Columns of smaller components would be padded.
  return type == "MAT4" && accessor["componentType"].whole() == kFloat ? 16 : 0;
}

template <class T>
T load(const char* p) {
  T value;
  std::memcpy(&value, p, sizeof(T));
  return value;
}

std::uint32_t load_index(std::uint64_t type, const char* p) {
  return type == kUint8    ? load<std::uint8_t>(p)
         : type == kUint16 ? load<std::uint16_t>(p)
                           : load<std::uint32_t>(p);
}

void check_index_type(std::uint64_t type, const GltfValue& user) {
  if (type != kUint8 && type != kUint16 && type != kUint32)
    throw user.error("indices must have an unsigned component type, not " + std::to_string(type));
}

/// Elements in a buffer view, all of them inside their buffer.
struct Elements {
  const char* first = nullptr;
  std::size_t stride = 0;
};

Elements find_elements(const GltfFile& file, const GltfValue& user, std::size_t count,
                       std::size_t element_bytes, bool may_have_stride) {
  std::optional<GltfValue> view;
  const std::string_view bytes = file.view_bytes(user, view);
  std::uint64_t stride = (*view)["byteStride"].whole(element_bytes);
  if (stride == 0) stride = element_bytes;  // Some programs write 0 for "without gaps".
  if (stride < element_bytes || stride > 1024 || (!may_have_stride && stride != element_bytes))
    throw view->error("byte stride " + std::to_string(stride) + " does not fit elements of " +
                      std::to_string(element_bytes) + " bytes");
  const std::uint64_t start = user["byteOffset"].whole(0), length = bytes.size();
  if (start > length || element_bytes > length - start ||
      count - 1 > (length - start - element_bytes) / stride)
    throw user.error("accessor of " + std::to_string(count) +
                     " elements goes beyond its buffer view");
  return {bytes.data() + start, checked_size(stride)};
}

}  // namespace

std::uint32_t gltf_count(const GltfValue& accessor) {
  const std::uint64_t count = accessor["count"].whole();
  if (count == 0 || count >= std::numeric_limits<std::uint32_t>::max())
    throw accessor.error("an accessor must have 1 to 4294967294 elements, not " +
                         std::to_string(count));
  return static_cast<std::uint32_t>(count);
}

void GltfAccessor::read_type(const GltfValue& value) {
  type_ = value["componentType"].whole();
  component_bytes_ = voxdag::component_bytes(type_, value);
  if (components_ == 0)
    throw value.error("the elements must be scalars, vectors or MAT4 of floats");
  is_normalized_ = value["normalized"].boolean(false);
  count_ = gltf_count(value);
}

GltfAccessor::GltfAccessor(const GltfFile& file, const GltfValue& value, CountedVector<char> bytes)
    : components_(component_count(value)),
      changes_(file.source().work().memory),
      bytes_(std::move(bytes)) {
  read_type(value);
  dense_ = bytes_.data();
  stride_ = static_cast<std::size_t>(components_) * component_bytes_;
  if (bytes_.size() != count_ * stride_)
    throw value.error(std::to_string(bytes_.size()) + " bytes are decoded for " +
                      std::to_string(count_) + " elements");
}

GltfAccessor::GltfAccessor(const GltfFile& file, const GltfValue& value)
    : components_(component_count(value)),
      changes_(file.source().work().memory),
      bytes_(file.source().work().memory) {
  read_type(value);
  const bool has_view = value["bufferView"].exists();
  if (!has_view && !value["sparse"].exists())
    throw value.error("the accessor has neither a buffer view nor sparse values");
  constexpr std::size_t kMaxZeros = std::size_t{1} << 24;
  if (!has_view && count_ > kMaxZeros)
    throw value.error(std::to_string(count_) + " elements without a buffer view: at most " +
                      std::to_string(kMaxZeros) + " are read");
  if (has_view) {
    const std::size_t bytes = static_cast<std::size_t>(components_) * component_bytes_;
    const Elements dense = find_elements(file, value, count_, bytes, components_ > 1);
    dense_ = dense.first;
    stride_ = dense.stride;
  }
  if (value["sparse"].exists()) read_sparse(file, value["sparse"]);
}

void GltfAccessor::read_sparse(const GltfFile& file, const GltfValue& sparse) {
  const std::uint64_t count = sparse["count"].whole();
  if (count == 0 || count > count_)
    throw sparse.error("the number of sparse values must be 1 to " + std::to_string(count_) +
                       ", the number of elements, not " + std::to_string(count));
  const std::uint64_t type = sparse["indices"]["componentType"].whole();
  check_index_type(type, sparse);
  const Elements indices =
      find_elements(file, sparse["indices"], count, voxdag::component_bytes(type, sparse), false);
  const Elements values =
      find_elements(file, sparse["values"], count,
                    static_cast<std::size_t>(components_) * component_bytes_, false);
  changes_.reserve(count);
  CancelPoll poll(file.source().work());
  for (std::size_t i = 0; i < count; ++i) {
    poll.step();
    const std::uint32_t target = load_index(type, indices.first + i * indices.stride);
    if (target >= count_)
      throw sparse.error("sparse index " + std::to_string(target) +
                         " is out of range: " + std::to_string(count_) + " elements");
    changes_.emplace_back(target, values.first + i * values.stride);
  }
  // If an element has several values, the last one counts: it has the greatest address.
  std::sort(changes_.begin(), changes_.end());
}

const char* GltfAccessor::find(std::size_t i) const {
  if (!changes_.empty()) {
    const auto after = std::upper_bound(
        changes_.begin(), changes_.end(), i,
        [](std::size_t element, const Change& change) { return element < change.first; });
    if (after != changes_.begin() && (after - 1)->first == i) return (after - 1)->second;
  }
  return dense_ == nullptr ? nullptr : dense_ + i * stride_;
}

float GltfAccessor::load_component(const char* p) const {
  const auto scaled = [&](auto value) {
    const auto number = static_cast<double>(value);
    if (!is_normalized_) return static_cast<float>(number);
    // Divides in double, so that the result is the nearest float32.
    return static_cast<float>(
        std::max(-1.0, number / static_cast<double>(std::numeric_limits<decltype(value)>::max())));
  };
  switch (type_) {
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

std::uint32_t GltfAccessor::index(std::size_t i) const {
  const char* const p = find(i);
  return p == nullptr ? 0 : load_index(type_, p);
}

const GltfAccessor& GltfAccessors::find(std::uint64_t index, const GltfValue& user) {
  const auto known = accessors_.find(index);
  if (known != accessors_.end()) return known->second;
  return accessors_
      .emplace(index, GltfAccessor(file_, file_.item(GltfArray::kAccessors, index, user)))
      .first->second;
}

bool GltfAccessors::is_quantized() {
  if (!is_quantized_) {
    is_quantized_ = false;
    for (const GltfValue name : file_.root()["extensionsUsed"].items())
      if (name.text() == "KHR_mesh_quantization") is_quantized_ = true;
  }
  return *is_quantized_;
}

const GltfAccessor& GltfAccessors::positions(std::uint64_t index, const GltfValue& user) {
  const GltfValue value = file_.item(GltfArray::kAccessors, index, user);
  if (value["type"].text() != "VEC3") throw value.error("positions must be VEC3");
  const std::uint64_t type = value["componentType"].whole();
  component_bytes(type, value);
  if (type != kFloat && type != kUint32 && !is_quantized()) {
    warnings_.add(value
                      .error("positions are integers, which KHR_mesh_quantization allows, but the "
                             "file does not declare it: they are read")
                      .what());
    is_quantized_ = true;
  }
  if (type == kUint32)
    throw value.error("positions must have component type 5126 (float), not " +
                      std::to_string(type));
  return find(index, user);
}

const GltfAccessor& GltfAccessors::indices(std::uint64_t index, const GltfValue& user) {
  const GltfValue value = file_.item(GltfArray::kAccessors, index, user);
  if (value["type"].text() != "SCALAR") throw value.error("indices must be SCALAR");
  check_index_type(value["componentType"].whole(), value);
  return find(index, user);
}

const GltfAccessor& GltfAccessors::attributes(std::uint64_t index, const GltfValue& user,
                                              int components, int or_components, const char* what) {
  const GltfAccessor& accessor = find(index, user);
  if (accessor.components() == components || accessor.components() == or_components)
    return accessor;
  const auto type = [](int n) { return n == 16 ? "MAT4" : "VEC" + std::to_string(n); };
  throw file_.item(GltfArray::kAccessors, index, user)
      .error(std::string(what) + " must be " + type(components) +
             (components == or_components ? "" : " or " + type(or_components)));
}

}  // namespace voxdag

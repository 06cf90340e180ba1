#pragma once
/// The elements of a glTF accessor.
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "voxdag/formats/readers/gltf/gltf_file.hpp"

namespace voxdag {

/// Decodes elements one at a time from the file's bytes. So it needs no array of elements, and
/// using many accessors needs no memory. Refers to the file.
class GltfAccessor {
 public:
  /// Checks that every element is inside its buffer. Throws Error, OverMemory.
  GltfAccessor(const GltfFile& file, const GltfValue& value);
  /// Takes the bytes of all elements, which have no gaps between them.
  GltfAccessor(const GltfFile& file, const GltfValue& value, CountedVector<char> bytes);

  std::size_t size() const { return count_; }
  /// Returns 1 for SCALAR, 2 to 4 for VEC2 to VEC4, 16 for MAT4.
  int components() const { return components_; }
  std::uint64_t component_type() const { return type_; }

  /// Returns `n` components of element `i` as floats; n <= components().
  template <std::size_t n>
  std::array<float, n> floats(std::size_t i) const {
    std::array<float, n> values{};
    if (const char* const p = find(i))
      for (std::size_t c = 0; c < n; ++c) values[c] = load_component(p + c * component_bytes_);
    return values;
  }
  /// Returns element `i` of an accessor of unsigned integers.
  std::uint32_t index(std::size_t i) const;

 private:
  /// A sparse value and the element that it replaces.
  using Change = std::pair<std::uint32_t, const char*>;

  void read_type(const GltfValue& value);
  void read_sparse(const GltfFile& file, const GltfValue& sparse);
  /// Returns the bytes of an element, or null if the element is zero.
  const char* find(std::size_t i) const;
  float load_component(const char* p) const;

  std::size_t count_ = 0;
  int components_ = 0;
  std::uint64_t type_ = 0;
  std::size_t component_bytes_ = 0;
  bool is_normalized_ = false;
  const char* dense_ = nullptr;  ///< The first dense element, if there are any.
  std::size_t stride_ = 0;
  CountedVector<Change> changes_;  ///< Sorted by element.
  CountedVector<char> bytes_;      ///< The dense elements, if they are not in a buffer.
};

/// The accessors of a file, each checked once.
class GltfAccessors {
 public:
  GltfAccessors(const GltfFile& file, Warnings& warnings)
      : file_(file), warnings_(warnings), accessors_(file.source().work().memory) {}

  /// Decodes the accessors of a primitive of KHR_draco_mesh_compression that have no bytes of their
  /// own. Throws Error, OverMemory.
  void decode_draco(const GltfValue& primitive);

  /// The functions below return the accessor that `user` refers to, for one purpose. The references
  /// stay valid. They throw Error and OverMemory.
  ///
  /// Returns positions: VEC3 of float, or of 8- or 16-bit integers (KHR_mesh_quantization; a
  /// warning if the asset does not declare it).
  const GltfAccessor& positions(std::uint64_t index, const GltfValue& user);
  /// Returns indices: SCALAR of unsigned 8, 16 or 32 bits. Does not check their values.
  const GltfAccessor& indices(std::uint64_t index, const GltfValue& user);
  /// Returns attributes of `components` or `or_components` numbers: VEC2 texture coordinates, VEC3
  /// normals, VEC3 or VEC4 colours, 16 for MAT4 of float. `what` names them in errors.
  const GltfAccessor& attributes(std::uint64_t index, const GltfValue& user, int components,
                                 int or_components, const char* what);

 private:
  const GltfAccessor& find(std::uint64_t index, const GltfValue& user);
  bool is_quantized();

  using Entry = std::pair<const std::uint64_t, GltfAccessor>;
  const GltfFile& file_;
  Warnings& warnings_;
  std::map<std::uint64_t, GltfAccessor, std::less<>, CountedAllocator<Entry>> accessors_;
  std::optional<bool> is_quantized_;
};

/// Returns the number of elements that an accessor declares. Throws Error if it is 0 or over 2^32
/// - 2.
std::uint32_t gltf_count(const GltfValue& accessor);

}  // namespace voxdag

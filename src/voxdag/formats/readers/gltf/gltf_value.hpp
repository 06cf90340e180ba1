#pragma once
/// A value of a glTF asset's JSON.
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "voxdag/formats/readers/gltf/json_document.hpp"
#include "voxdag/formats/readers/mesh_source.hpp"

namespace voxdag {

class GltfItems;

/// A JSON value that knows its place for error messages, or an absent member. A JSON null counts as
/// absent. Cheap to copy. Its functions throw Error if the value has another type.
class GltfValue {
 public:
  GltfValue(const MeshSource& source, const JsonDocument& document, std::uint32_t node)
      : source_(&source), document_(&document), node_(node) {}

  /// Returns a member of an object. `key` must stay valid as long as the result.
  GltfValue operator[](const char* key) const;
  /// Returns the items of an array; none if it is absent.
  GltfItems items() const;
  bool exists() const { return absent_count_ == 0 && json().kind != JsonKind::kNull; }

  /// Returns a whole number from 0 to 2^53, or the argument `absent` if the value is absent.
  std::uint64_t whole(std::uint64_t absent) const;
  /// Returns a whole number from 0 to 2^53. Throws Error if it is absent.
  std::uint64_t whole() const;
  bool boolean(bool absent) const;
  std::string text(const std::string& absent = "") const;
  /// Returns a string, empty if absent, as a view of the file or of `unescaped`, which it sets only
  /// if the string has escape sequences.
  std::string_view text_view(std::string& unescaped) const;
  /// Returns `count` finite numbers, or nothing if absent.
  std::vector<double> numbers(std::size_t count) const;
  /// Returns a finite number, or the argument `absent` if the value is absent.
  double number(double absent) const;

  /// Returns the place of the value: "accessors[3].sparse".
  std::string path() const;
  Error error(const std::string& reason) const { return {source_->name, path(), reason}; }

 private:
  const JsonNode& json() const { return document_->node(node_); }

  static constexpr std::size_t kMaxAbsent = 6;

  const MeshSource* source_;
  const JsonDocument* document_;
  std::uint32_t node_;              ///< The value; if absent, the object without the member.
  std::uint32_t absent_count_ = 0;  ///< Number of keys that lead from `node_` to an absent value.
  std::array<const char*, kMaxAbsent> absent_{};
};

/// The items of an array.
class GltfItems {
 public:
  GltfItems() = default;
  GltfItems(const MeshSource& source, const JsonDocument& document, std::uint32_t first,
            std::size_t count)
      : source_(&source), document_(&document), first_(first), count_(count) {}

  std::size_t size() const { return count_; }
  bool empty() const { return count_ == 0; }
  GltfValue operator[](std::size_t i) const {
    return {*source_, *document_, first_ + static_cast<std::uint32_t>(i)};
  }

  struct Iterator {
    const GltfItems* items;
    std::size_t i;
    GltfValue operator*() const { return (*items)[i]; }
    Iterator& operator++() {
      ++i;
      return *this;
    }
    friend bool operator==(const Iterator& a, const Iterator& b) { return a.i == b.i; }
  };
  Iterator begin() const { return {this, 0}; }
  Iterator end() const { return {this, count_}; }

 private:
  const MeshSource* source_ = nullptr;
  const JsonDocument* document_ = nullptr;
  std::uint32_t first_ = 0;
  std::size_t count_ = 0;
};

}  // namespace voxdag

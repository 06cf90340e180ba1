#pragma once
/// JSON (RFC 8259), parsed into a flat array of values that refer to the text.
#include <cstdint>
#include <string>
#include <string_view>

#include "voxdag/core/memory_budget.hpp"
#include "voxdag/formats/readers/mesh_source.hpp"

namespace voxdag {

enum class JsonKind : std::uint8_t { kNull, kFalse, kTrue, kNumber, kString, kArray, kObject };

/// A value. Offsets are in the text.
struct JsonNode {
  std::uint32_t start = 0, size = 0;  ///< A number, or a string between its quotes.
  std::uint32_t key_start = 0, key_size = 0;
  std::uint32_t first = 0, count = 0;  ///< Items or members: consecutive nodes.
  std::uint32_t parent = 0;
  JsonKind kind = JsonKind::kNull;
  bool has_unescaped_key = false;  ///< The key is in the document's own text.
};

/// The values of a JSON text, which must stay valid. Members of objects are sorted by key; if
/// several have the same key, the last one counts. Strings stay in the text, so memory is about 32
/// bytes per value.
class JsonDocument {
 public:
  /// Parses `text`, which is part of source.bytes. Throws Error with the byte, OverMemory,
  /// Cancelled.
  JsonDocument(const MeshSource& source, std::string_view text);

  std::uint32_t root() const { return static_cast<std::uint32_t>(nodes_.size() - 1); }
  const JsonNode& node(std::uint32_t index) const { return nodes_[index]; }
  /// Returns the text of a number, or of a string with its escape sequences.
  std::string_view text(const JsonNode& node) const { return text_.substr(node.start, node.size); }
  std::string_view key(const JsonNode& node) const;

  static constexpr std::uint32_t kAbsent = ~std::uint32_t{0};
  /// Returns the index of a member of an object, or kAbsent.
  std::uint32_t member(const JsonNode& object, std::string_view key) const;

  /// Returns the place of a value in the document: "accessors[3].sparse". Empty for the root.
  std::string path(std::uint32_t index) const;

 private:
  class Parser;

  std::string_view text_;
  CountedVector<JsonNode> nodes_;
  CountedVector<char> unescaped_keys_;
};

/// Resolves the escape sequences of a string that JsonDocument has accepted.
std::string unescape_json(std::string_view text);

}  // namespace voxdag

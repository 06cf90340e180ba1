#pragma once
/// An XML document in memory.
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "voxdag/core/memory_budget.hpp"
#include "voxdag/formats/readers/mesh_source.hpp"

namespace voxdag {

/// An element. Names have no prefixes.
struct XmlElement {
  std::string name, text;
  std::vector<std::pair<std::string, std::string>> attributes;
  std::vector<XmlElement> children;

  /// Returns the value of an attribute; empty if there is none.
  std::string_view operator[](std::string_view attribute) const;
  /// Returns the first child of this name, or null.
  const XmlElement* child(std::string_view of_name) const;
  /// Returns the element at the end of a path of child(), or null.
  const XmlElement* at(std::initializer_list<std::string_view> path) const;
};

/// A document; its memory stays reserved while it lives.
struct XmlTree {
  XmlElement root;
  MemoryReservation memory;
};

/// Parses the document. Throws the errors of XmlParser, and OverMemory.
XmlTree parse_xml_tree(const MeshSource& source);

}  // namespace voxdag

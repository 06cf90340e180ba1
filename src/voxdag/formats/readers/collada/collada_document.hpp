#pragma once
/// A COLLADA document in memory: its elements by id, and places in errors.
#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "voxdag/core/error.hpp"
#include "voxdag/core/memory_budget.hpp"
#include "voxdag/formats/readers/mesh_source.hpp"
#include "voxdag/formats/readers/xml/xml_tree.hpp"

namespace voxdag {

class ColladaDocument {
 public:
  /// Throws the errors of parse_xml_tree(), and Error if the root is not COLLADA.
  explicit ColladaDocument(const MeshSource& source);

  const MeshSource& source() const { return source_; }
  const XmlElement& root() const { return tree_.root; }

  /// Returns the element that a reference "#id" names, or null.
  const XmlElement* find(std::string_view reference) const;
  /// Returns the element that a reference of `from` names. Throws Error unless it is a <name>.
  const XmlElement& named(const XmlElement& from, std::string_view reference,
                          std::string_view name) const;

  [[noreturn]] void fail(const XmlElement& element, const std::string& reason) const;
  /// Calls body(). Errors without a file get `element` as their place.
  template <class Body>
  void in(const XmlElement& element, const Body& body) const {
    try {
      body();
    } catch (const Cancelled&) {
      throw;
    } catch (const OverMemory&) {
      throw;
    } catch (const Error& error) {
      if (!error.file().empty()) throw;
      fail(element, error.reason());
    }
  }

 private:
  void collect_ids(const XmlElement& element);

  const MeshSource& source_;
  XmlTree tree_;
  std::unordered_map<std::string_view, const XmlElement*, std::hash<std::string_view>,
                     std::equal_to<>,
                     CountedAllocator<std::pair<const std::string_view, const XmlElement*>>>
      by_id_;
};

/// Sentences about parts of a document that are not read.
using LeftOut = std::set<std::string>;

}  // namespace voxdag

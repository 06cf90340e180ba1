#include "voxdag/formats/readers/collada/collada_document.hpp"

#include "voxdag/core/printable.hpp"

namespace voxdag {

ColladaDocument::ColladaDocument(const MeshSource& source)
    : source_(source),
      tree_(parse_xml_tree(source)),
      by_id_(0, std::hash<std::string_view>(), std::equal_to<>(), source.work().memory) {
  if (tree_.root.name != "COLLADA") throw source.error("is no COLLADA document");
  collect_ids(tree_.root);
}

void ColladaDocument::collect_ids(const XmlElement& element) {
  if (const std::string_view id = element["id"]; !id.empty()) by_id_.emplace(id, &element);
  for (const XmlElement& child : element.children) collect_ids(child);
}

const XmlElement* ColladaDocument::find(std::string_view reference) const {
  const auto found = by_id_.find(reference.substr(reference.starts_with('#') ? 1 : 0));
  return found == by_id_.end() ? nullptr : found->second;
}

const XmlElement& ColladaDocument::named(const XmlElement& from, std::string_view reference,
                                         std::string_view name) const {
  const XmlElement* const element = find(reference);
  if (element == nullptr || element->name != name)
    fail(from, "names " + in_quotes(reference) + ", and there is no <" + std::string(name) +
                   "> of that id");
  return *element;
}

void ColladaDocument::fail(const XmlElement& element, const std::string& reason) const {
  const std::string_view id = element["id"];
  throw Error(source_.name,
              "<" + printable(element.name) + ">" + (id.empty() ? "" : " " + name_in_quotes(id)),
              reason);
}

}  // namespace voxdag

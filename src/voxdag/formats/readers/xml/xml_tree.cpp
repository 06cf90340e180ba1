#include "voxdag/formats/readers/xml/xml_tree.hpp"

#include "voxdag/formats/readers/xml/xml_parser.hpp"

namespace voxdag {
namespace {

class TreeHandler : public XmlHandler {
 public:
  explicit TreeHandler(XmlTree& tree) : tree_(tree), open_{&document_} {}

  void open(std::string_view name, const XmlAttributes& attributes) override {
    // Vectors that grow hold up to twice their items, and copy them.
    std::uint64_t bytes = 3 * sizeof(XmlElement) + name.size();
    std::vector<XmlElement>& siblings = open_.back()->children;
    XmlElement& element = siblings.emplace_back();
    element.name = name;
    attributes.for_each([&](std::string_view key, std::string_view value) {
      element.attributes.emplace_back(key, value);
      bytes += 3 * sizeof(element.attributes[0]) + key.size() + value.size();
    });
    tree_.memory.resize(tree_.memory.bytes() + bytes);
    open_.push_back(&element);
  }
  void close(std::string_view) override {
    open_.pop_back();
    if (open_.size() == 1) tree_.root = std::move(document_.children.back());
  }
  void text(std::string_view part) override {
    std::string& text = open_.back()->text;
    if (text.size() + part.size() > text.capacity()) {
      const std::size_t more = 2 * (text.size() + part.size());
      tree_.memory.resize(tree_.memory.bytes() + more - text.capacity());
      text.reserve(more);
    }
    text += part;
  }

 private:
  XmlTree& tree_;
  XmlElement document_;
  std::vector<XmlElement*> open_;
};

}  // namespace

std::string_view XmlElement::operator[](std::string_view attribute) const {
  for (const auto& [key, value] : attributes)
    if (key == attribute) return value;
  return {};
}

const XmlElement* XmlElement::child(std::string_view of_name) const {
  for (const XmlElement& element : children)
    if (element.name == of_name) return &element;
  return nullptr;
}

const XmlElement* XmlElement::at(std::initializer_list<std::string_view> path) const {
  const XmlElement* element = this;
  for (const std::string_view step : path)
    if (element != nullptr) element = element->child(step);
  return element;
}

XmlTree parse_xml_tree(const MeshSource& source) {
  XmlTree tree;
  tree.memory = MemoryReservation(source.work().memory, 0);
  TreeHandler handler(tree);
  XmlParser parser(source, "", handler);
  parser.parse(source.bytes);
  parser.finish();
  return tree;
}

}  // namespace voxdag

#include "voxdag/formats/readers/ply/ply_header.hpp"

#include <algorithm>
#include <limits>
#include <set>

#include "voxdag/core/lower_case.hpp"
#include "voxdag/formats/readers/text_scan.hpp"

namespace voxdag {
namespace {

/// The maximum number of elements in a file, and of properties in an element: far more than real
/// headers have.
constexpr std::size_t kMaxDeclared = 1000;

std::optional<PlyType> parse_type(std::string_view name) {
  constexpr std::pair<std::string_view, PlyType> types[] = {
      {"char", PlyType::kInt8},     {"int8", PlyType::kInt8},     {"uchar", PlyType::kUint8},
      {"uint8", PlyType::kUint8},   {"short", PlyType::kInt16},   {"int16", PlyType::kInt16},
      {"ushort", PlyType::kUint16}, {"uint16", PlyType::kUint16}, {"int", PlyType::kInt32},
      {"int32", PlyType::kInt32},   {"uint", PlyType::kUint32},   {"uint32", PlyType::kUint32},
      {"float", PlyType::kFloat},   {"float32", PlyType::kFloat}, {"double", PlyType::kDouble},
      {"float64", PlyType::kDouble}};
  for (const auto& [known, type] : types)
    if (known == name) return type;
  return std::nullopt;
}

class PlyHeaderParser {
 public:
  explicit PlyHeaderParser(const MeshSource& source)
      : source_(source), rest_(without_byte_order_mark(source.bytes)) {
    header_.materials = CountedVector<std::string_view>(source.work().memory);
    header_.textures = CountedVector<std::string_view>(source.work().memory);
  }

  PlyHeader parse(PlyUse use) {
    if (rest_.empty()) throw source_.error("the file is empty");
    find_line_end();
    std::string_view magic = line();
    if (next_token(magic) != "ply") fail("not a PLY file: it does not start with 'ply'");
    while (parse_line(line_or_fail())) {
    }
    if (!has_format_) fail("PLY header without a 'format' line");
    header_.body = source_.bytes.size() - rest_.size();
    check_elements();
    check_vertices(use);
    if (use == PlyUse::kMesh) check_mesh();
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const {
    throw Error(source_.name, ErrorPlace::line(line_), reason);
  }

  /// Finds the line end from the first line: "\n" (also "\r\n") or "\r".
  void find_line_end() {
    const std::size_t end = rest_.find_first_of("\r\n");
    if (end != rest_.npos && rest_[end] == '\r' && !rest_.substr(end).starts_with("\r\n"))
      header_.line_end = '\r';
  }

  std::string_view line() {
    ++line_;
    poll_.step();
    return next_line(rest_, header_.line_end);
  }

  std::string_view line_or_fail() {
    if (rest_.empty()) fail("the file ends before 'end_header'");
    return line();
  }

  /// Returns false for the last line of the header.
  bool parse_line(std::string_view text) {
    const std::string_view keyword = next_token(text);
    if (keyword == "end_header") return false;
    if (keyword == "comment")
      parse_comment(text);
    else if (keyword == "format")
      parse_format(text);
    else if (keyword == "element")
      parse_element(text);
    else if (keyword == "property")
      parse_property(text);
    else if (keyword != "obj_info" && !keyword.empty() && !header_.elements.empty())
      // Lines before the first element may be anything: old versions of Blender write "Created by".
      fail("unknown PLY header keyword " + in_quotes(keyword));
    return true;
  }

  void parse_comment(std::string_view text) {
    std::int64_t number = 0;
    const std::string_view keyword = next_token(text);
    if (keyword == "TextureFile" || keyword == "texturefile")
      header_.textures.emplace_back(trim(text));
    if (keyword != "material" || !parse_int(next_token(text), number)) return;
    if (number == static_cast<std::int64_t>(header_.materials.size()))
      header_.materials.emplace_back(trim(text));
  }

  void parse_format(std::string_view text) {
    has_format_ = true;
    const std::string_view name = next_token(text), version = next_token(text);
    if (name == "ascii")
      header_.format = PlyFormat::kAscii;
    else if (name == "binary_little_endian")
      header_.format = PlyFormat::kLittleEndian;
    else if (name == "binary_big_endian")
      header_.format = PlyFormat::kBigEndian;
    else
      fail("unknown PLY format " + in_quotes(name));
    if (!version.empty() && version != "1.0") header_.version = version;
    if (!header_.version.empty() && !version.starts_with("1."))
      fail("unknown PLY version " + in_quotes(version));
  }

  void parse_element(std::string_view text) {
    const std::string_view name = next_token(text), count_text = next_token(text);
    std::int64_t count = 0;
    if (!parse_int(count_text, count) || count < 0)
      fail("count " + in_quotes(count_text) + " of element " + in_quotes(name) +
           " is not a number");
    if (header_.elements.size() >= kMaxDeclared)
      fail("more than " + std::to_string(kMaxDeclared) + " elements");
    for (const PlyElement& known : header_.elements)
      if (known.name == name) fail("element " + in_quotes(name) + " is declared twice");
    property_names_.clear();
    header_.elements.push_back({name, static_cast<std::uint64_t>(count),
                                CountedVector<PlyProperty>(source_.work().memory)});
  }

  void parse_property(std::string_view text) {
    if (header_.elements.empty()) fail("property before any element");
    std::string_view type_name = next_token(text);
    std::optional<PlyType> count_type;
    if (type_name == "list") {
      const std::string_view count_name = next_token(text);
      count_type = parse_type(count_name);
      if (!count_type || !is_integer(*count_type))
        fail("a list count must have an integer type, not " + in_quotes(count_name));
      type_name = next_token(text);
    }
    const auto type = parse_type(type_name);
    if (!type) fail("unknown PLY type " + in_quotes(type_name));
    const std::string_view name = next_token(text);
    if (name.empty()) fail("property without a name");
    PlyElement& element = header_.elements.back();
    if (element.properties.size() >= kMaxDeclared)
      fail("more than " + std::to_string(kMaxDeclared) + " properties");
    if (!property_names_.insert(name).second)
      fail("property " + in_quotes(name) + " is declared twice");
    element.properties.push_back({name, *type, count_type});
  }

  void check_elements() {
    for (std::size_t i = 0; i < header_.elements.size(); ++i) {
      const PlyElement& element = header_.elements[i];
      if (element.name == "vertex") header_.vertex = static_cast<int>(i);
      if (element.name == "face") header_.face = static_cast<int>(i);
      check_size(element);
    }
    for (std::size_t i = 0; i < header_.elements.size(); ++i)
      if (is_strips(header_.elements[i]) &&
          (header_.face < 0 || header_.elements[header_.face].count == 0)) {
        header_.face = static_cast<int>(i);
        header_.has_strips = true;
      }
  }

  static bool is_strips(const PlyElement& element) {
    return element.name == "tristrips" && element.count > 0;
  }

  void check_vertices(PlyUse use) {
    if (header_.vertex < 0) fail("PLY without a 'vertex' element");
    const PlyElement& vertex = header_.elements[header_.vertex];
    if (use == PlyUse::kPoints && vertex.find({"packed_position"}) >= 0) return;
    for (const std::string_view axis : {"x", "y", "z"}) {
      const int found = vertex.find({axis});
      if (found < 0) fail("PLY vertices without property " + in_quotes(axis));
      if (vertex.properties[found].count_type)
        fail("PLY vertex property " + in_quotes(axis) + " is a list");
    }
  }

  void check_mesh() {
    for (const PlyElement& element : header_.elements)
      if (is_strips(element) && !header_.has_strips)
        fail("PLY with faces and triangle strips: save it with faces only");
    if (header_.elements[header_.vertex].count >= std::numeric_limits<std::uint32_t>::max())
      fail("the mesh has more than 4,294,967,294 vertices");
    if (header_.face < 0) fail("PLY without a 'face' element: there is no surface to read");
    const PlyElement& face = header_.elements[header_.face];
    if (face.count == 0) fail("PLY with 0 faces: there is no surface to read");
    const int indices = face.find({"vertex_indices", "vertex_index"});
    if (indices < 0) fail("PLY faces without property 'vertex_indices'");
    const PlyProperty& list = face.properties[indices];
    if (!list.count_type || !is_integer(list.type))
      fail("the vertex indices of PLY faces must be a list of integers");
    if (header_.textures.size() < 2 || !header_.materials.empty() || face.find({"texnumber"}) < 0)
      return;
    header_.has_texture_numbers = true;
    header_.materials = header_.textures;
    header_.materials.emplace_back();
  }

  /// Refuses a count that is too large for the rest of the file, before memory is reserved for it.
  void check_size(const PlyElement& element) const {
    const std::size_t rest = source_.bytes.size() - header_.body;
    // A row of text has a digit and a separator per property. The last separator may be missing.
    const std::size_t least = header_.format == PlyFormat::kAscii ? 2 * element.properties.size()
                                                                  : element.least_row_bytes();
    if (least > 0 && element.count > (rest + 1) / least)
      fail("the file is too short for " + std::to_string(element.count) + " rows of element " +
           in_quotes(element.name));
  }

  const MeshSource& source_;
  std::string_view rest_;
  std::size_t line_ = 0;
  bool has_format_ = false;
  CancelPoll poll_{source_.work()};
  std::set<std::string_view> property_names_;  ///< Names in the last element.
  PlyHeader header_;
};

}  // namespace

int PlyElement::find(std::initializer_list<std::string_view> names) const {
  for (std::size_t i = 0; i < properties.size(); ++i)
    if (std::find(names.begin(), names.end(), properties[i].name) != names.end())
      return static_cast<int>(i);
  for (std::size_t i = 0; i < properties.size(); ++i)
    if (std::find(names.begin(), names.end(), lower_case(properties[i].name)) != names.end())
      return static_cast<int>(i);
  return -1;
}

std::size_t PlyElement::least_row_bytes() const {
  std::size_t bytes = 0;
  for (const PlyProperty& property : properties)
    bytes += size_of(property.count_type.value_or(property.type));
  return bytes;
}

PlyHeader parse_ply_header(const MeshSource& source, PlyUse use) {
  return PlyHeaderParser(source).parse(use);
}

}  // namespace voxdag

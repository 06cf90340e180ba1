#include "voxdag/formats/readers/collada/collada_geometry.hpp"

#include <algorithm>
#include <utility>

#include "voxdag/formats/readers/face_writer.hpp"
#include "voxdag/formats/readers/text_scan.hpp"
#include "voxdag/formats/readers/xml/xml_mesh.hpp"

namespace voxdag {

const ColladaGeometry& ColladaGeometries::read(const XmlElement& element) {
  const auto [geometry, is_new] =
      geometries_.try_emplace(&element, document_.source().work().memory);
  if (is_new) read_mesh(element, geometry->second);
  return geometry->second;
}

void ColladaGeometries::read_mesh(const XmlElement& element, ColladaGeometry& geometry) {
  const XmlElement* const mesh = element.child("mesh");
  if (mesh == nullptr) {
    left_out_shapes_.insert("geometries that are no meshes are left out");
    return;
  }
  const XmlElement* const vertices = mesh->child("vertices");
  if (vertices == nullptr) document_.fail(element, "has no <vertices>");
  for (const XmlElement& input : vertices->children)
    if (input["semantic"] == "POSITION")
      read_positions(document_.named(input, input["source"], "source"), geometry.vertices);
  for (const XmlElement& primitive : mesh->children)
    document_.in(primitive, [&] { read_primitive(primitive, geometry); });
}

void ColladaGeometries::read_positions(const XmlElement& element,
                                       CountedVector<Vec3d>& positions) const {
  const XmlElement* const accessor = element.at({"technique_common", "accessor"});
  if (accessor == nullptr) document_.fail(element, "has no <accessor>");
  const XmlElement& array = document_.named(*accessor, (*accessor)["source"], "float_array");
  document_.in(element, [&] {
    const auto whole = [&](const char* name, std::uint64_t absent) -> std::uint64_t {
      std::string_view text = (*accessor)[name];
      return text.empty() ? absent : take_index(text, std::uint64_t{1} << 32, name);
    };
    const std::uint64_t stride = whole("stride", 1), offset = whole("offset", 0),
                        count = whole("count", 0);
    if (stride < 3) throw Error("positions must have three coordinates");
    if (count > array.text.size() / (2 * stride) + 1)
      throw Error("its array is too short for " + std::to_string(count) + " positions");
    positions.reserve(count);
    std::string_view text = array.text;
    const auto next = [&] {
      double value = 0;
      const std::string_view token = take_word(text);
      if (!parse_float(token, value)) throw Error("number " + in_quotes(token) + " is none");
      return value;
    };
    for (std::uint64_t i = 0; i < offset; ++i) next();
    for (std::uint64_t i = 0; i < count; ++i) {
      Vec3d& position = positions.emplace_back();
      for (int axis = 0; axis < 3; ++axis) position[axis] = next();
      for (std::uint64_t rest = 3; rest < stride && i + 1 < count; ++rest) next();
      document_.source().work().poll_seldom(i);
    }
  });
}

void ColladaGeometries::read_primitive(const XmlElement& primitive, ColladaGeometry& geometry) {
  enum Kind { kTriangles, kPolylist, kPolygons, kStrips, kFans };
  constexpr std::pair<std::string_view, Kind> kKinds[] = {{"triangles", kTriangles},
                                                          {"polylist", kPolylist},
                                                          {"polygons", kPolygons},
                                                          {"tristrips", kStrips},
                                                          {"trifans", kFans}};
  const auto* const kind = std::find_if(std::begin(kKinds), std::end(kKinds),
                                        [&](const auto& k) { return k.first == primitive.name; });
  if (kind == std::end(kKinds)) return;
  const IndexLayout layout = layout_of(primitive);
  symbol_ = materials_.symbol(primitive["material"]);
  const XmlElement* const counts = primitive.child("vcount");
  std::string_view sizes = counts == nullptr ? std::string_view() : counts->text;
  for (const XmlElement& list : primitive.children) {
    const XmlElement* const p = list.name == "ph" ? list.child("p") : &list;
    if (list.name == "ph") left_out_shapes_.insert("holes of polygons are not read");
    if (p == nullptr || p->name != "p") continue;
    CountedVector<std::uint32_t> corners(document_.source().work().memory);
    read_corners(p->text, layout, geometry.vertices.size(), corners);
    const std::span<const std::uint32_t> all(corners);
    if (kind->second == kPolygons) {
      add_polygon(geometry, all);
    } else if (kind->second == kPolylist) {
      std::size_t at = 0;
      while (!trim(sizes).empty() && at < all.size()) {
        const std::size_t size = take_index(sizes, all.size() - at + 1, "the size of a polygon");
        add_polygon(geometry, all.subspan(at, size));
        at += size;
      }
    } else if (kind->second == kTriangles) {
      for (std::size_t i = 0; i + 2 < all.size(); i += 3)
        add_triangle(geometry, {all[i], all[i + 1], all[i + 2]});
    } else {
      for (std::size_t i = 2; i < all.size(); ++i)
        add_triangle(geometry, kind->second == kFans ? Triangle{all[0], all[i - 1], all[i]}
                               : i % 2 == 0          ? Triangle{all[i - 2], all[i - 1], all[i]}
                                                     : Triangle{all[i - 1], all[i - 2], all[i]});
    }
  }
}

ColladaGeometries::IndexLayout ColladaGeometries::layout_of(const XmlElement& primitive) {
  IndexLayout layout;
  for (const XmlElement& input : primitive.children) {
    if (input.name != "input") continue;
    std::string_view text = input["offset"];
    const std::uint64_t offset = take_index(text, 64, "offset");
    layout.stride = std::max(layout.stride, offset + 1);
    if (input["semantic"] == "VERTEX") layout.vertex = offset;
    if (input["semantic"] == "TEXCOORD") left_out_looks_.insert("textures are not read");
    if (input["semantic"] == "COLOR") left_out_looks_.insert("colours of vertices are not read");
  }
  return layout;
}

void ColladaGeometries::read_corners(std::string_view text, const IndexLayout& layout,
                                     std::uint64_t vertices,
                                     CountedVector<std::uint32_t>& corners) const {
  for (std::uint64_t i = 0;; ++i) {
    document_.source().work().poll_seldom(i);
    while (!text.empty() && (is_blank(text.front()) || text.front() == '\n')) text.remove_prefix(1);
    if (text.empty()) return;
    if (i % layout.stride == layout.vertex)
      corners.push_back(take_index(text, vertices, "vertex"));
    else
      take_word(text);
  }
}

void ColladaGeometries::add_triangle(ColladaGeometry& geometry, Triangle corners) const {
  geometry.triangles.push_back(corners);
  geometry.symbols.push_back(symbol_);
}

void ColladaGeometries::add_polygon(ColladaGeometry& geometry,
                                    std::span<const std::uint32_t> corners) const {
  if (corners.size() == 3) return add_triangle(geometry, {corners[0], corners[1], corners[2]});
  if (corners.size() < 3) return;
  const AllVertices vertices{0, geometry.vertices.size(), [&](std::uint32_t vertex) {
                               return Vec3f(geometry.vertices[vertex]);
                             }};
  const std::size_t first = geometry.triangles.size();
  geometry.triangles.resize(first + corners.size() - 2);
  geometry.symbols.resize(geometry.triangles.size(), symbol_);
  FaceWriter writer(document_.source(), vertices,
                    std::span<Triangle>(geometry.triangles).subspan(first));
  for (const std::uint32_t corner : corners) writer.add_corner(corner);
  writer.finish_face(nullptr);
  geometry.triangles.resize(first + writer.written());
  geometry.symbols.resize(geometry.triangles.size());
}

}  // namespace voxdag

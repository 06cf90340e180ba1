/// A pass over the nodes lists the instances of meshes. Then each is written into arrays of their
/// final size.
#include "voxdag/formats/readers/collada/collada_reader.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <unordered_map>
#include <utility>

#include "voxdag/core/srgb.hpp"
#include "voxdag/formats/readers/face_writer.hpp"
#include "voxdag/formats/readers/text_scan.hpp"
#include "voxdag/formats/readers/xml/xml_mesh.hpp"
#include "voxdag/formats/readers/xml/xml_tree.hpp"

namespace voxdag {
namespace {

constexpr int kMaxNodeDepth = 200;  ///< Of nodes in nodes, with those that they name.

AffineTransform rotation_about(Vec3d axis, double degrees) {
  const Vec3d u = normalized_or(axis, {0, 0, 1});
  const double angle = degrees * std::numbers::pi / 180, c = std::cos(angle), s = std::sin(angle);
  AffineTransform turn;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3d e = turn.columns[i];
    turn.columns[i] = e * c + cross(u, e) * s + u * (dot(u, e) * (1 - c));
  }
  return turn;
}

AffineTransform collada_matrix_of(std::string_view text) {
  std::array<double, 16> m;
  parse_exact_numbers(text, m, "matrix");
  AffineTransform transform;
  for (std::size_t c = 0; c < 4; ++c) transform.columns[c] = {m[c], m[4 + c], m[8 + c]};
  return transform;
}

/// Returns the transform of an element of a node; the identity for other elements.
AffineTransform node_transform_of(const XmlElement& element) {
  AffineTransform transform;
  std::array<double, 4> v{};
  const std::span<double> three(v.data(), 3);
  if (element.name == "matrix") return collada_matrix_of(element.text);
  if (element.name == "translate") {
    parse_exact_numbers(element.text, three, "translate");
    transform.columns[3] = {v[0], v[1], v[2]};
  } else if (element.name == "scale") {
    parse_exact_numbers(element.text, three, "scale");
    for (std::size_t c = 0; c < 3; ++c) transform.columns[c] = transform.columns[c] * v[c];
  } else if (element.name == "rotate") {
    parse_exact_numbers(element.text, v, "rotate");
    return rotation_about({v[0], v[1], v[2]}, v[3]);
  } else if (element.name == "skew" || element.name == "lookat") {
    throw Error("a node has the transform " + in_quotes(element.name) + ", which is not read");
  }
  return transform;
}

/// Finds the numbers of vertices in a primitive's list of indices.
struct IndexLayout {
  std::uint64_t vertex = 0, stride = 1;
};

/// A mesh of the file, checked.
struct ColladaGeometry {
  explicit ColladaGeometry(MemoryBudget* memory) : vertices(memory), triangles(memory) {}
  CountedVector<Vec3d> vertices;
  CountedVector<Triangle> triangles;
  CountedVector<std::uint32_t> symbols{triangles.get_allocator()};  ///< Of each triangle.
};

struct ColladaInstance {
  const ColladaGeometry* geometry;
  const XmlElement* element;  ///< instance_geometry or instance_controller.
  AffineTransform transform;
};

class ColladaReader {
 public:
  explicit ColladaReader(const MeshSource& source)
      : source_(source),
        tree_(parse_xml_tree(source)),
        by_id_(0, std::hash<std::string_view>(), std::equal_to<>(), source.work().memory),
        instances_(source.work().memory) {
    if (tree_.root.name != "COLLADA") throw source.error("is no COLLADA document");
  }

  MeshWithAppearance read(ReadParts parts) {
    collect_ids(tree_.root);
    find_instances();
    std::uint64_t vertices = 0, triangles = 0;
    for (const ColladaInstance& instance : instances_) {
      vertices += instance.geometry->vertices.size();
      triangles += instance.geometry->triangles.size();
    }
    InstancedMesh mesh(source_, vertices, triangles);
    for (const ColladaInstance& instance : instances_) {
      mesh.begin_instance(instance.transform);
      for (const Vec3d vertex : instance.geometry->vertices) mesh.add_vertex(vertex);
      const std::vector<std::uint32_t> materials = materials_of(*instance.element);
      for (std::size_t i = 0; i < instance.geometry->triangles.size(); ++i)
        mesh.add_triangle(instance.geometry->triangles[i],
                          materials[instance.geometry->symbols[i]]);
    }
    MeshWithAppearance result;
    result.mesh = mesh.take();
    for (const Material& material : materials_) result.mesh.materials.push_back(material.name);
    if (parts == ReadParts::kMesh) return result;
    result.appearance.materials = materials_;
    for (const std::string& warning : left_out_)
      result.warnings.push_back(source_.name + ": " + warning);
    return result;
  }

 private:
  [[noreturn]] void fail(const XmlElement& element, const std::string& reason) const {
    const std::string_view id = element["id"];
    throw Error(source_.name,
                "<" + printable(element.name) + ">" + (id.empty() ? "" : " " + name_in_quotes(id)),
                reason);
  }
  /// Calls body() and returns its result. Errors without a file get this element as their place.
  template <class Body>
  auto in(const XmlElement& element, const Body& body) const {
    try {
      return body();
    } catch (const Cancelled&) {
      throw;
    } catch (const OverMemory&) {
      throw;
    } catch (const Error& error) {
      if (!error.file().empty()) throw;
      fail(element, error.reason());
    }
  }

  void collect_ids(const XmlElement& element) {
    if (const std::string_view id = element["id"]; !id.empty()) by_id_.emplace(id, &element);
    for (const XmlElement& child : element.children) collect_ids(child);
  }

  /// Returns the element that a reference "#id" names. Throws Error if it has another name.
  const XmlElement& named(const XmlElement& from, std::string_view reference,
                          std::string_view name) const {
    const auto found = by_id_.find(reference.substr(reference.starts_with('#') ? 1 : 0));
    if (found == by_id_.end() || found->second->name != name)
      fail(from, "names " + in_quotes(reference) + ", and there is no <" + std::string(name) +
                     "> of that id");
    return *found->second;
  }

  void find_instances() {
    AffineTransform unit;
    if (const XmlElement* const asset = tree_.root.at({"asset", "unit"}); asset != nullptr)
      in(*asset, [&] {
        double metres = 1;
        if (const std::string_view text = (*asset)["meter"]; !text.empty())
          parse_exact_numbers(text, {&metres, 1}, "the unit");
        if (!(metres > 0)) throw Error("the unit must be greater than 0");
        for (std::size_t c = 0; c < 3; ++c) unit.columns[c] = unit.columns[c] * metres;
      });
    const XmlElement* const scene = tree_.root.at({"scene", "instance_visual_scene"});
    if (scene == nullptr) throw source_.error("has no scene");
    visit_node(named(*scene, (*scene)["url"], "visual_scene"), unit, 0);
  }

  void visit_node(const XmlElement& node, const AffineTransform& parent, int depth) {
    source_.work().poll();
    if (depth > kMaxNodeDepth) fail(node, "nodes are nested more than 200 deep");
    if (++visited_ > kMaxXmlInstances) fail(node, "the scene has more than 16777216 nodes");
    AffineTransform transform = parent;
    for (const XmlElement& child : node.children)
      in(child, [&] { transform = transform * node_transform_of(child); });
    for (const XmlElement& child : node.children) {
      const std::string_view url = child["url"];
      if (child.name == "node")
        visit_node(child, transform, depth + 1);
      else if (child.name == "instance_node")
        visit_node(named(child, url, "node"), transform, depth + 1);
      else if (child.name == "instance_geometry")
        add_instance(child, named(child, url, "geometry"), transform);
      else if (child.name == "instance_controller")
        add_controller(child, named(child, url, "controller"), transform, 0);
    }
  }

  void add_controller(const XmlElement& instance, const XmlElement& controller,
                      AffineTransform transform, int depth) {
    const XmlElement* deformer = controller.child("skin");
    if (deformer == nullptr) deformer = controller.child("morph");
    if (deformer == nullptr || depth > 1) fail(controller, "is neither a skin nor a morph");
    if (const XmlElement* const shape = deformer->child("bind_shape_matrix"); shape != nullptr)
      in(*shape, [&] { transform = transform * collada_matrix_of(shape->text); });
    left_out_.insert("meshes with bones or morphs are read in their bind pose");
    const std::string_view of = (*deformer)["source"];
    const auto found = by_id_.find(of.substr(of.starts_with('#') ? 1 : 0));
    if (found != by_id_.end() && found->second->name == "controller")
      return add_controller(instance, *found->second, transform, depth + 1);
    add_instance(instance, named(*deformer, of, "geometry"), transform);
  }

  void add_instance(const XmlElement& instance, const XmlElement& element,
                    const AffineTransform& transform) {
    const auto [geometry, is_new] = geometries_.try_emplace(&element, source_.work().memory);
    if (is_new) read_geometry(element, geometry->second);
    if (!geometry->second.triangles.empty())
      instances_.push_back({&geometry->second, &instance, transform});
  }

  void read_geometry(const XmlElement& element, ColladaGeometry& geometry) {
    const XmlElement* const mesh = element.child("mesh");
    if (mesh == nullptr) {
      left_out_.insert("geometries that are no meshes are left out");
      return;
    }
    const XmlElement* const vertices = mesh->child("vertices");
    if (vertices == nullptr) fail(element, "has no <vertices>");
    for (const XmlElement& input : vertices->children)
      if (input["semantic"] == "POSITION")
        read_positions(named(input, input["source"], "source"), geometry.vertices);
    for (const XmlElement& primitive : mesh->children)
      in(primitive, [&] { read_primitive(primitive, geometry); });
  }

  void read_positions(const XmlElement& element, CountedVector<Vec3d>& positions) {
    const XmlElement* const accessor = element.at({"technique_common", "accessor"});
    if (accessor == nullptr) fail(element, "has no <accessor>");
    const XmlElement& array = named(*accessor, (*accessor)["source"], "float_array");
    in(element, [&] {
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
        const std::string_view token = take_number(text);
        if (!parse_float(token, value)) throw Error("number " + in_quotes(token) + " is none");
        return value;
      };
      for (std::uint64_t i = 0; i < offset; ++i) next();
      for (std::uint64_t i = 0; i < count; ++i) {
        Vec3d& position = positions.emplace_back();
        for (int axis = 0; axis < 3; ++axis) position[axis] = next();
        for (std::uint64_t rest = 3; rest < stride && i + 1 < count; ++rest) next();
        source_.work().poll_seldom(i);
      }
    });
  }

  static std::string_view take_number(std::string_view& text) {
    const auto is_gap = [](char c) { return is_blank(c) || c == '\n'; };
    while (!text.empty() && is_gap(text.front())) text.remove_prefix(1);
    std::size_t size = 0;
    while (size < text.size() && !is_gap(text[size])) ++size;
    const std::string_view token = text.substr(0, size);
    text.remove_prefix(size);
    return token;
  }

  void read_primitive(const XmlElement& primitive, ColladaGeometry& geometry) {
    enum Kind { kTriangles, kPolylist, kPolygons, kStrips, kFans };
    constexpr std::pair<std::string_view, Kind> kKinds[] = {{"triangles", kTriangles},
                                                            {"polylist", kPolylist},
                                                            {"polygons", kPolygons},
                                                            {"tristrips", kStrips},
                                                            {"trifans", kFans}};
    const auto* const kind = std::find_if(std::begin(kKinds), std::end(kKinds),
                                          [&](const auto& k) { return k.first == primitive.name; });
    if (kind == std::end(kKinds)) return;
    IndexLayout layout;
    for (const XmlElement& input : primitive.children) {
      if (input.name != "input") continue;
      std::string_view text = input["offset"];
      const std::uint64_t offset = take_index(text, 64, "offset");
      layout.stride = std::max(layout.stride, offset + 1);
      if (input["semantic"] == "VERTEX") layout.vertex = offset;
      if (input["semantic"] == "TEXCOORD") left_out_.insert("textures are not read");
      if (input["semantic"] == "COLOR") left_out_.insert("colours of vertices are not read");
    }
    symbol_ = symbol_of(primitive["material"]);
    const XmlElement* const counts = primitive.child("vcount");
    std::string_view sizes = counts == nullptr ? std::string_view() : counts->text;
    for (const XmlElement& list : primitive.children) {
      const XmlElement* const p = list.name == "ph" ? list.child("p") : &list;
      if (list.name == "ph") left_out_.insert("holes of polygons are not read");
      if (p == nullptr || p->name != "p") continue;
      CountedVector<std::uint32_t> corners(source_.work().memory);
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

  void read_corners(std::string_view text, const IndexLayout& layout, std::uint64_t vertices,
                    CountedVector<std::uint32_t>& corners) const {
    for (std::uint64_t i = 0;; ++i) {
      source_.work().poll_seldom(i);
      while (!text.empty() && (is_blank(text.front()) || text.front() == '\n'))
        text.remove_prefix(1);
      if (text.empty()) return;
      if (i % layout.stride == layout.vertex)
        corners.push_back(take_index(text, vertices, "vertex"));
      else
        take_number(text);
    }
  }

  void add_triangle(ColladaGeometry& geometry, Triangle corners) const {
    geometry.triangles.push_back(corners);
    geometry.symbols.push_back(symbol_);
  }

  void add_polygon(ColladaGeometry& geometry, std::span<const std::uint32_t> corners) const {
    if (corners.size() == 3) return add_triangle(geometry, {corners[0], corners[1], corners[2]});
    if (corners.size() < 3) return;
    const AllVertices vertices{0, geometry.vertices.size(), [&](std::uint32_t vertex) {
                                 return Vec3f(geometry.vertices[vertex]);
                               }};
    const std::size_t first = geometry.triangles.size();
    geometry.triangles.resize(first + corners.size() - 2);
    geometry.symbols.resize(geometry.triangles.size(), symbol_);
    FaceWriter writer(source_, vertices, std::span<Triangle>(geometry.triangles).subspan(first));
    for (const std::uint32_t corner : corners) writer.add_corner(corner);
    writer.finish_face(nullptr);
    geometry.triangles.resize(first + writer.written());
    geometry.symbols.resize(geometry.triangles.size());
  }

  /// Returns the number of a symbol, which instances bind to a material.
  std::uint32_t symbol_of(std::string_view symbol) {
    return symbols_.try_emplace(std::string(symbol), static_cast<std::uint32_t>(symbols_.size()))
        .first->second;
  }

  /// Returns the material of each symbol in an instance.
  std::vector<std::uint32_t> materials_of(const XmlElement& instance) {
    std::vector<std::uint32_t> materials(symbols_.size(), 0);
    const XmlElement* const bound = instance.at({"bind_material", "technique_common"});
    if (bound == nullptr) return materials;
    for (const XmlElement& binding : bound->children) {
      const auto symbol = symbols_.find(std::string(binding["symbol"]));
      if (symbol != symbols_.end() && binding.name == "instance_material")
        materials[symbol->second] = material_number(named(binding, binding["target"], "material"));
    }
    return materials;
  }

  std::uint32_t material_number(const XmlElement& element) {
    const auto [number, is_new] =
        material_numbers_.try_emplace(&element, static_cast<std::uint32_t>(materials_.size()));
    if (!is_new) return number->second;
    Material& material = materials_.emplace_back();
    const std::string_view name = element["name"];
    material.name = name.empty() ? element["id"] : name;
    material.base_color = kDefaultColor;
    const XmlElement* const use = element.child("instance_effect");
    if (use == nullptr) return number->second;
    const XmlElement* const technique =
        named(*use, (*use)["url"], "effect").at({"profile_COMMON", "technique"});
    for (const char* shader : {"phong", "lambert", "blinn", "constant"}) {
      if (technique == nullptr) break;
      const XmlElement* const diffuse =
          technique->at({shader, shader == std::string_view("constant") ? "emission" : "diffuse"});
      if (diffuse == nullptr) continue;
      if (const XmlElement* const color = diffuse->child("color"); color != nullptr)
        in(*color, [&] {
          std::array<double, 4> rgba;
          parse_exact_numbers(color->text, rgba, "a colour");
          for (int c = 0; c < 3; ++c)
            material.base_color[c] = srgb_to_linear(
                static_cast<float>(std::clamp(rgba[static_cast<std::size_t>(c)], 0.0, 1.0)));
        });
      else
        left_out_.insert("textures are not read");
    }
    return number->second;
  }

  using Ids =
      std::unordered_map<std::string_view, const XmlElement*, std::hash<std::string_view>,
                         std::equal_to<>,
                         CountedAllocator<std::pair<const std::string_view, const XmlElement*>>>;

  const MeshSource& source_;
  XmlTree tree_;
  Ids by_id_;
  std::map<const XmlElement*, ColladaGeometry> geometries_;
  CountedVector<ColladaInstance> instances_;
  std::uint64_t visited_ = 0;
  std::map<std::string, std::uint32_t> symbols_{{"", 0}};
  std::uint32_t symbol_ = 0;  ///< Of the primitive that is read.
  std::vector<Material> materials_ = std::vector<Material>(1, [] {
    Material none;
    none.base_color = kDefaultColor;
    return none;
  }());
  std::map<const XmlElement*, std::uint32_t> material_numbers_;
  std::set<std::string> left_out_;
};

}  // namespace

MeshWithAppearance read_collada(const MeshSource& source, ReadParts parts) {
  return ColladaReader(source).read(parts);
}

}  // namespace voxdag

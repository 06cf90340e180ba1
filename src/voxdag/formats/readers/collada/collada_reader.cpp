/// A pass over the nodes lists the instances of meshes. Then each is written into arrays of their
/// final size.
#include "voxdag/formats/readers/collada/collada_reader.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "voxdag/core/angles.hpp"
#include "voxdag/formats/readers/collada/collada_document.hpp"
#include "voxdag/formats/readers/collada/collada_geometry.hpp"
#include "voxdag/formats/readers/collada/collada_materials.hpp"
#include "voxdag/formats/readers/text_scan.hpp"
#include "voxdag/formats/readers/xml/xml_mesh.hpp"
#include "voxdag/formats/readers/xml/xml_parser.hpp"

namespace voxdag {
namespace {

constexpr int kMaxNodeDepth = 200;  ///< Of nodes in nodes, with those that they name.

AffineTransform rotation_about(Vec3d axis, double degrees) {
  const Vec3d u = normalized_or(axis, {0, 0, 1});
  const auto [s, c] = sine_and_cosine(degrees * std::numbers::pi / 180);
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

struct ColladaInstance {
  const ColladaGeometry* geometry;
  const XmlElement* element;  ///< instance_geometry or instance_controller.
  AffineTransform transform;
};

class ColladaReader {
 public:
  explicit ColladaReader(const MeshSource& source)
      : source_(source),
        document_(source),
        materials_(document_),
        geometries_(document_, materials_),
        instances_(source.work().memory) {}

  MeshWithAppearance read(ReadParts parts) {
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
      const std::vector<std::uint32_t> materials = materials_.bound_by(*instance.element);
      for (std::size_t i = 0; i < instance.geometry->triangles.size(); ++i)
        mesh.add_triangle(instance.geometry->triangles[i],
                          materials[instance.geometry->symbols[i]]);
    }
    MeshWithAppearance result;
    result.mesh = mesh.take();
    for (const Material& material : materials_.materials())
      result.mesh.materials.push_back(material.name);
    warn_of(left_out_, result);
    warn_of(geometries_.left_out_shapes(), result);
    if (parts == ReadParts::kMesh) return result;
    result.appearance.materials = materials_.materials();
    LeftOut looks = geometries_.left_out_looks();
    looks.insert(materials_.left_out().begin(), materials_.left_out().end());
    warn_of(looks, result);
    return result;
  }

 private:
  void warn_of(const LeftOut& left_out, MeshWithAppearance& result) const {
    for (const std::string& sentence : left_out)
      result.warnings.push_back(source_.name + ": " + sentence);
  }

  void find_instances() {
    AffineTransform unit;
    if (const XmlElement* const asset = document_.root().at({"asset", "unit"}); asset != nullptr)
      document_.in(*asset, [&] {
        double metres = 1;
        if (const std::string_view text = (*asset)["meter"]; !text.empty())
          parse_exact_numbers(text, {&metres, 1}, "the unit");
        if (!(metres > 0)) throw Error("the unit must be greater than 0");
        for (std::size_t c = 0; c < 3; ++c) unit.columns[c] = unit.columns[c] * metres;
      });
    const XmlElement* const scene = document_.root().at({"scene", "instance_visual_scene"});
    if (scene == nullptr) throw source_.error("has no scene");
    visit_node(document_.named(*scene, (*scene)["url"], "visual_scene"), unit, 0);
  }

  void visit_node(const XmlElement& node, const AffineTransform& parent, int depth) {
    source_.work().poll();
    if (depth > kMaxNodeDepth) document_.fail(node, "nodes are nested more than 200 deep");
    if (++visited_ > kMaxXmlInstances)
      document_.fail(node, "the scene has more than 16777216 nodes");
    AffineTransform transform = parent;
    for (const XmlElement& child : node.children)
      document_.in(child, [&] { transform = transform * node_transform_of(child); });
    for (const XmlElement& child : node.children) {
      const std::string_view url = child["url"];
      if (child.name == "node")
        visit_node(child, transform, depth + 1);
      else if (child.name == "instance_node")
        visit_node(document_.named(child, url, "node"), transform, depth + 1);
      else if (child.name == "instance_geometry")
        add_instance(child, document_.named(child, url, "geometry"), transform);
      else if (child.name == "instance_controller")
        add_controller(child, document_.named(child, url, "controller"), transform, 0);
    }
  }

  void add_controller(const XmlElement& instance, const XmlElement& controller,
                      AffineTransform transform, int depth) {
    const XmlElement* deformer = controller.child("skin");
    if (deformer == nullptr) deformer = controller.child("morph");
    if (deformer == nullptr || depth > 1)
      document_.fail(controller, "is neither a skin nor a morph");
    if (const XmlElement* const shape = deformer->child("bind_shape_matrix"); shape != nullptr)
      document_.in(*shape, [&] { transform = transform * collada_matrix_of(shape->text); });
    left_out_.insert("meshes with bones or morphs are read in their bind pose");
    const std::string_view of = (*deformer)["source"];
    const XmlElement* const base = document_.find(of);
    if (base != nullptr && base->name == "controller")
      return add_controller(instance, *base, transform, depth + 1);
    add_instance(instance, document_.named(*deformer, of, "geometry"), transform);
  }

  void add_instance(const XmlElement& instance, const XmlElement& element,
                    const AffineTransform& transform) {
    const ColladaGeometry& geometry = geometries_.read(element);
    if (!geometry.triangles.empty()) instances_.push_back({&geometry, &instance, transform});
  }

  const MeshSource& source_;
  ColladaDocument document_;
  ColladaMaterials materials_;
  ColladaGeometries geometries_;
  CountedVector<ColladaInstance> instances_;
  std::uint64_t visited_ = 0;
  LeftOut left_out_;  ///< Of the nodes' shapes.
};

/// Finds the text of <up_axis>, which is in the <asset> of the document or of a part of it.
class UpAxisHandler : public XmlHandler {
 public:
  void open(std::string_view name, const XmlAttributes&) override { is_open_ = name == "up_axis"; }
  void close(std::string_view name) override {
    is_open_ = false;
    if (name == "up_axis" || name == "asset") is_done = true;
  }
  void text(std::string_view part) override {
    if (is_open_ && !is_done) axis += part;
  }

  std::string axis;
  bool is_done = false;

 private:
  bool is_open_ = false;
};

}  // namespace

int collada_up_axis(const MeshSource& source) {
  UpAxisHandler handler;
  XmlParser parser(source, "", handler);
  constexpr std::size_t kStep = 4096;
  for (std::string_view rest = source.bytes; !handler.is_done && !rest.empty();
       rest.remove_prefix(std::min(kStep, rest.size())))
    parser.parse(rest.substr(0, kStep));
  std::string_view text = handler.axis;
  const std::string_view axis = take_word(text);
  return axis == "X_UP" ? 0 : axis == "Z_UP" ? 2 : 1;
}

MeshWithAppearance read_collada(const MeshSource& source, ReadParts parts) {
  return ColladaReader(source).read(parts);
}

}  // namespace voxdag

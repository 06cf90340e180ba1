#include "voxdag/formats/readers/threemf/threemf_reader.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "voxdag/core/srgb.hpp"
#include "voxdag/formats/readers/text_scan.hpp"
#include "voxdag/formats/readers/threemf/zip_part.hpp"
#include "voxdag/formats/readers/xml/xml_mesh.hpp"
#include "voxdag/formats/readers/xml/xml_parser.hpp"

namespace voxdag {
namespace {

constexpr int kMaxComponentDepth = 64;  ///< Of components in components.

/// A resource of the archive: the part that holds it, and its number there.
using ResourceId = std::pair<std::string, std::string>;

struct Reference3mf {
  ResourceId object;
  AffineTransform transform;
};

/// A triangle and the materials of its corners.
struct ObjectTriangle {
  Triangle corners, materials;
};

struct Object3mf {
  explicit Object3mf(MemoryBudget* memory) : vertices(memory), triangles(memory) {}
  CountedVector<Vec3d> vertices;
  CountedVector<ObjectTriangle> triangles;
  std::vector<Reference3mf> components;
  bool has_gradients = false;  ///< A triangle has several materials.
  bool is_support = false;     ///< Of a print, not of the body.
  bool is_other = false;       ///< Neither: slicers store modifiers and the like so.
};

/// A range of materials.
struct Group3mf {
  std::uint32_t first = 0, count = 0;
};

/// Everything that the parts of the archive say.
struct Archive3mf {
  explicit Archive3mf(MemoryBudget* memory) : charge(memory, 0) {}
  /// Counts an entry of one of the containers below, whose texts have `bytes`.
  void count_entry(std::size_t bytes) {
    constexpr std::uint64_t kEntryBytes = sizeof(Material) + sizeof(Object3mf);
    charge.resize(charge.bytes() + kEntryBytes + 2 * bytes);
  }

  MemoryReservation charge;
  std::map<ResourceId, Object3mf> objects;
  std::map<ResourceId, Group3mf> groups;
  std::vector<Reference3mf> build;
  std::set<std::string> parts;         ///< The models that others name.
  std::vector<std::string> unread;     ///< Those of them that are not read yet.
  std::vector<Material> materials{1};  ///< The first one is that of triangles without.
  /// Kinds of elements that are not read: of the shape, and of its colours.
  std::set<std::string> left_out_shapes, left_out_colors;
  std::set<ResourceId> missing_groups;  ///< Groups that were named before they came.
};

double millimetres_of(std::string_view unit) {
  constexpr std::pair<std::string_view, double> kUnits[] = {
      {"", 1},        {"micron", 0.001}, {"millimeter", 1}, {"centimeter", 10},
      {"inch", 25.4}, {"foot", 304.8},   {"meter", 1000}};
  for (const auto& [name, size] : kUnits)
    if (name == unit) return size;
  throw Error("has the unknown unit " + in_quotes(unit));
}

/// Throws Error if the model needs an extension that changes its shape, and that is not read.
void check_extensions(const XmlAttributes& model) {
  for (std::string_view prefixes = model["requiredextensions"]; !prefixes.empty();) {
    const std::size_t end = std::min(prefixes.find(' '), prefixes.size());
    const std::string_view extension =
        model[prefixes.substr(0, end)];  // By its `xmlns:` attribute.
    prefixes.remove_prefix(std::min(end + 1, prefixes.size()));
    const auto is = [&](std::string_view name) { return extension.find(name) != extension.npos; };
    if (end > 0 && !is("/material/") && !is("/production/") && !is("/trianglesets/"))
      throw Error("needs an extension of 3MF that is not read: " + name_in_quotes(extension));
  }
}

AffineTransform item_transform_of(std::string_view text) {
  AffineTransform transform;
  if (text.empty()) return transform;
  std::array<double, 12> m;
  parse_exact_numbers(text, m, "transform");
  for (std::size_t c = 0; c < 4; ++c) transform.columns[c] = {m[3 * c], m[3 * c + 1], m[3 * c + 2]};
  return transform;
}

/// Returns the linear colour of "#RRGGBB" or "#RRGGBBAA"; nothing if it is none.
std::optional<Vec3f> property_color_of(std::string_view text) {
  if ((text.size() != 7 && text.size() != 9) || text[0] != '#') return std::nullopt;
  Vec3f color;
  for (int c = 0; c < 3; ++c) {
    unsigned code = 0;
    const char* const first = text.data() + 1 + 2 * c;
    const auto parsed = std::from_chars(first, first + 2, code, 16);
    if (parsed.ptr != first + 2) return std::nullopt;
    color[c] = srgb_to_linear(static_cast<float>(code) / 255);
  }
  return color;
}

/// Reads one model of the archive.
class ModelHandler : public XmlHandler {
 public:
  ModelHandler(const MeshSource& source, std::string part, Archive3mf& archive, bool is_root)
      : memory_(source.work().memory),
        part_(std::move(part)),
        archive_(archive),
        is_root_(is_root) {}

  void open(std::string_view name, const XmlAttributes& attributes) override {
    if (name == "vertex")
      add_vertex(attributes);
    else if (name == "triangle")
      add_triangle(attributes);
    else if (name == "model")
      open_model(attributes);
    else if (name == "object")
      open_object(attributes);
    else if (name == "component" && object_ != nullptr)
      object_->components.push_back(reference(attributes));
    else if (name == "item" && is_root_)
      archive_.build.push_back(reference(attributes));
    else
      open_property(name, attributes);
  }
  void close(std::string_view name) override {
    if (name == "object") object_ = nullptr;
    if (name == "basematerials" || name == "colorgroup") group_ = nullptr;
  }

 private:
  static std::array<Vec3d, 4> scaled(double size) {
    return {{{size, 0, 0}, {0, size, 0}, {0, 0, size}, {0, 0, 0}}};
  }

  void open_model(const XmlAttributes& attributes) {
    check_extensions(attributes);
    unit_.columns = scaled(millimetres_of(attributes["unit"]));
  }

  void open_object(const XmlAttributes& attributes) {
    const ResourceId id{part_, std::string(attributes["id"])};
    const auto [object, is_new] = archive_.objects.try_emplace(id, memory_);
    if (!is_new) throw Error("object " + in_quotes(id.second) + " is there twice");
    archive_.count_entry(part_.size() + id.second.size());
    object_ = &object->second;
    object_->is_support = attributes["type"] == "support" || attributes["type"] == "solidsupport";
    object_->is_other = attributes["type"] == "other";
    default_group_ = attributes["pid"];
    default_material_ =
        default_group_.empty() ? 0 : material_of(default_group_, attributes["pindex"]);
  }

  Reference3mf reference(const XmlAttributes& attributes) {
    std::string path(attributes["path"]);
    if (path.starts_with('/')) path.erase(0, 1);
    if (path.empty()) path = part_;
    std::string id(attributes["objectid"]);
    archive_.count_entry(path.size() + id.size());
    if (archive_.parts.insert(path).second) archive_.unread.push_back(path);
    AffineTransform transform = item_transform_of(attributes["transform"]);
    transform.columns[3] = unit_.point(transform.columns[3]);  // Vertices are scaled, too.
    return {{std::move(path), std::move(id)}, transform};
  }

  void add_vertex(const XmlAttributes& attributes) {
    if (object_ == nullptr) throw Error("a vertex is in no object");
    Vec3d vertex;
    for (int axis = 0; axis < 3; ++axis) {
      const char name[] = {"xyz"[axis], 0};
      parse_exact_numbers(attributes[name], {&vertex[axis], 1}, "the coordinate of a vertex");
    }
    object_->vertices.push_back(unit_.point(vertex));
  }

  void add_triangle(const XmlAttributes& attributes) {
    if (object_ == nullptr) throw Error("a triangle is in no object");
    ObjectTriangle triangle{};
    constexpr const char *kCorners[] = {"v1", "v2", "v3"}, *kProperties[] = {"p1", "p2", "p3"};
    for (std::size_t i = 0; i < 3; ++i) {
      std::string_view text = attributes[kCorners[i]];
      triangle.corners[i] = take_index(text, object_->vertices.size(), "vertex");
    }
    triangle.materials.fill(default_material_);
    const std::string_view pid = attributes["pid"], first = attributes["p1"];
    if (!first.empty() && !(pid.empty() && default_group_.empty()))
      for (std::size_t i = 0; i < 3; ++i) {
        const std::string_view property = attributes[kProperties[i]];
        triangle.materials[i] =
            material_of(pid.empty() ? default_group_ : pid, property.empty() ? first : property);
      }
    object_->has_gradients |= triangle.materials[1] != triangle.materials[0] ||
                              triangle.materials[2] != triangle.materials[0];
    object_->triangles.push_back(triangle);
  }

  /// Returns the material of a property: 0 if its group has no colours that are read.
  std::uint32_t material_of(std::string_view pid, std::string_view index) {
    const auto group = archive_.groups.find({part_, std::string(pid)});
    if (group == archive_.groups.end()) {
      archive_.missing_groups.insert({part_, std::string(pid)});
      return 0;
    }
    return group->second.first + take_index(index, group->second.count, "property");
  }

  void open_property(std::string_view name, const XmlAttributes& attributes) {
    if (name == "basematerials" || name == "colorgroup") {
      archive_.count_entry(part_.size());
      const ResourceId id{part_, std::string(attributes["id"])};
      if (archive_.missing_groups.contains(id))
        archive_.left_out_colors.insert("a group of materials after the objects that name it");
      group_ = &archive_.groups[id];
      *group_ = {static_cast<std::uint32_t>(archive_.materials.size()), 0};
    } else if (group_ != nullptr && (name == "base" || name == "color")) {
      Material material;
      material.name = attributes["name"];
      const std::string_view text = attributes[name == "base" ? "displaycolor" : "color"];
      const std::optional<Vec3f> color = property_color_of(text);
      if (!color && !text.empty()) archive_.left_out_colors.insert("colours that are not #RRGGBB");
      material.base_color = color.value_or(kDefaultColor);
      archive_.count_entry(material.name.size());
      archive_.materials.push_back(std::move(material));
      ++group_->count;
    } else if (name == "texture2dgroup" || name == "compositematerials" ||
               name == "multiproperties") {
      archive_.left_out_colors.emplace(name);
    } else if (name == "beamlattice") {
      archive_.left_out_shapes.emplace(name);
    }
  }

  MemoryBudget* memory_;
  std::string part_;
  Archive3mf& archive_;
  bool is_root_;
  AffineTransform unit_;
  Object3mf* object_ = nullptr;
  std::string default_group_;           ///< Of the object.
  std::uint32_t default_material_ = 0;  ///< Of the object.
  Group3mf* group_ = nullptr;
};

/// Finds the root model's name in the archive's relationships.
class RootHandler : public XmlHandler {
 public:
  void open(std::string_view name, const XmlAttributes& attributes) override {
    if (name == "Relationship" && attributes["Type"].ends_with("/3dmodel") && root.empty())
      root = attributes["Target"];
  }
  void close(std::string_view) override {}

  std::string root;
};

class ThreemfReader {
 public:
  explicit ThreemfReader(const MeshSource& source)
      : source_(source), archive_(source.work().memory), instances_(source.work().memory) {
    archive_.materials[0].base_color = kDefaultColor;
  }

  MeshWithAppearance read(ReadParts parts) {
    RootHandler relations;
    read_part("_rels/.rels", relations);
    std::string root = relations.root.empty() ? "3D/3dmodel.model" : relations.root;
    if (root.starts_with('/')) root.erase(0, 1);
    read_models(root);
    if (archive_.build.empty()) throw source_.error("its build has no items");
    for (const Reference3mf& item : archive_.build) find_instances(item, 0);
    InstancedMesh mesh(source_, vertices_, triangles_);
    for (const auto& [object, transform] : instances_) add(mesh, *object, transform);
    MeshWithAppearance result;
    result.mesh = mesh.take();
    for (const Material& material : archive_.materials)
      result.mesh.materials.push_back(material.name);
    warn_of(archive_.left_out_shapes, result);
    if (others_ > 0)
      result.warnings.push_back(
          source_.name + ": " + std::to_string(others_) +
          " objects of the type \"other\" are left out: 3MF counts them to no body");
    if (parts == ReadParts::kMeshAndAppearance) add_appearance(result);
    return result;
  }

 private:
  /// Returns false if the archive has no such part.
  bool read_part(const std::string& name, XmlHandler& handler) {
    XmlParser parser(source_, name, handler);
    if (!read_zip_part(source_, name, [&](std::string_view bytes) { parser.parse(bytes); }))
      return false;
    parser.finish();
    return true;
  }

  /// Reads the root model and the models that it names.
  void read_models(const std::string& root) {
    archive_.parts.insert(root);
    archive_.unread.push_back(root);
    while (!archive_.unread.empty()) {
      const std::string name = std::move(archive_.unread.back());
      archive_.unread.pop_back();
      ModelHandler handler(source_, name, archive_, name == root);
      if (!read_part(name, handler))
        throw source_.error("has no part " + name_in_quotes(name) + ", so it is no 3MF file");
    }
  }

  /// Adds the meshes of an object and its components to `instances_`.
  void find_instances(const Reference3mf& reference, int depth) {
    source_.work().poll();
    const auto found = archive_.objects.find(reference.object);
    if (found == archive_.objects.end())
      throw Error(source_.name, reference.object.first,
                  "has no object " + in_quotes(reference.object.second));
    if (depth > kMaxComponentDepth)
      throw source_.error("components are nested more than " + std::to_string(kMaxComponentDepth) +
                          " deep");
    if (++references_ > kMaxXmlInstances)
      throw source_.error("the build has more than " + std::to_string(kMaxXmlInstances) +
                          " objects");
    const Object3mf& object = found->second;
    others_ += object.is_other ? 1 : 0;
    if (object.is_support || object.is_other) return;
    if (!object.triangles.empty()) {
      instances_.push_back({&object, reference.transform});
      vertices_ += object.vertices.size();
      triangles_ += object.triangles.size();
      has_gradients_ |= object.has_gradients;
    }
    for (const Reference3mf& component : object.components)
      find_instances({component.object, reference.transform * component.transform}, depth + 1);
  }

  static void add(InstancedMesh& mesh, const Object3mf& object, const AffineTransform& transform) {
    mesh.begin_instance(transform);
    for (const Vec3d vertex : object.vertices) mesh.add_vertex(vertex);
    for (const ObjectTriangle& t : object.triangles) mesh.add_triangle(t.corners, t.materials[0]);
  }

  void warn_of(const std::set<std::string>& left_out, MeshWithAppearance& result) const {
    for (const std::string& kind : left_out)
      result.warnings.push_back(source_.name + ": " + kind + " is not read");
  }

  void add_appearance(MeshWithAppearance& result) {
    result.appearance.materials = archive_.materials;
    warn_of(archive_.left_out_colors, result);
    if (!has_gradients_) return;
    // Corners have the colours, so that materials must not tint them.
    const MemoryReservation memory(source_.work().memory, 3 * triangles_ * sizeof(Rgba16));
    result.appearance.colors.reserve(3 * triangles_);
    for (const auto& [object, transform] : instances_) {
      for (const ObjectTriangle& t : object->triangles)
        for (const std::size_t corner : transform.is_mirroring()
                                            ? std::array<std::size_t, 3>{0, 2, 1}
                                            : std::array<std::size_t, 3>{0, 1, 2})
          result.appearance.colors.push_back(
              to_rgba16(archive_.materials[t.materials[corner]].base_color, 1));
    }
    for (Material& material : result.appearance.materials) material.base_color = {1, 1, 1};
  }

  const MeshSource& source_;
  Archive3mf archive_;
  CountedVector<std::pair<const Object3mf*, AffineTransform>> instances_;
  std::uint64_t references_ = 0, vertices_ = 0, triangles_ = 0, others_ = 0;
  bool has_gradients_ = false;
};

}  // namespace

bool is_3mf(std::string_view bytes) {
  constexpr std::size_t kMaxDirectory = 65536;  // The end of it, with the names of the parts.
  return bytes.starts_with("PK\3\4") &&
         bytes.substr(bytes.size() - std::min(bytes.size(), kMaxDirectory)).find(".model") !=
             bytes.npos;
}

MeshWithAppearance read_3mf(const MeshSource& source, ReadParts parts) {
  return ThreemfReader(source).read(parts);
}

}  // namespace voxdag

/// The functions that make DAGs from meshes, and open files.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "arrays.hpp"
#include "dag.hpp"
#include "grid_arguments.hpp"
#include "run_work.hpp"
#include "voxdag/builders/attributes/build_attributes.hpp"
#include "voxdag/builders/attributes/cut_alpha.hpp"
#include "voxdag/builders/attributes/inside_attributes.hpp"
#include "voxdag/builders/dag/build_svdag.hpp"
#include "voxdag/builders/solid/solid_settings.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/srgb.hpp"
#include "voxdag/core/with_file_name.hpp"
#include "voxdag/formats/presentation.hpp"
#include "voxdag/formats/readers/read_mesh.hpp"
#include "voxdag/mesh/has_colors.hpp"
#include "voxdag/mesh/place_vertices.hpp"
#include "voxdag/mesh/surface/surface_shading.hpp"

namespace py = pybind11;

namespace voxdag::python {
namespace {

std::optional<SolidRule> rule_of(const py::object& solid) {
  if (solid.is_none() || solid.is(py::bool_(false))) return std::nullopt;
  if (solid.is(py::bool_(true))) return SolidRule::kParity;
  try {
    return solid_rule(solid.cast<std::string>());
  } catch (const std::exception&) {
    throw py::value_error("solid must be True, \"parity\", \"winding\" or \"flood\"");
  }
}

/// Returns the options of the channels that the argument `channels` names: a name, several in a
/// text as of `voxdag build --channel`, or a list of names.
AttributeOptions with_channels(const py::object& channels, AttributeOptions options) {
  if (channels.is_none()) return options;
  if (py::isinstance<py::str>(channels)) return with_channels(channels.attr("split")(","), options);
  for (const py::handle name : channels)
    options.add_channel(name.cast<py::str>().attr("strip")().cast<std::string>());
  return options;
}

/// Builds the DAG of a mesh, as `voxdag build` does. `options` say which attributes. Adds warnings
/// about textures.
DagPointer build_mesh(const MeshWithAppearance& source, const GridRequest& grid,
                      const std::optional<SolidRule>& solid, AttributeOptions options,
                      bool cuts_alpha, const std::string& name, const Presentation& presentation,
                      std::vector<std::string>& warnings, Work work) {
  const Mesh& mesh = source.mesh;
  VdagMetadata metadata;
  metadata.presentation = presentation;
  metadata.grid = grid_for(mesh, grid);
  metadata.source = {name, mesh.vertices.size(), mesh.triangles.size()};
  metadata.build = settings_of(grid);
  if (solid) add_solid_settings({*solid}, metadata.build);
  Svdag dag = build_svdag(mesh, metadata.grid, {}, work).dag, cover;
  if (solid) {
    cover = std::move(dag);
    dag = fill_solid(cover.view(), mesh, metadata.grid, {*solid}, work);
  }
  DagAttributes attributes;
  if (options.colors || options.has_channels()) {
    const SurfaceShading shading(mesh, source.appearance, &warnings, work, options.has_channels());
    auto cut =
        cuts_alpha ? cut_alpha(mesh, metadata.grid, dag.view(), shading, work) : std::nullopt;
    if (cut) {
      dag = std::move(*cut);
      metadata.build["alpha"] = "cut";
    }
    options.finest_level = metadata.grid.levels;
    if (solid) {
      AttributeOptions exact = options;
      exact.color_bound = 0;
      const DagAttributes surface =
          build_attributes(mesh, metadata.grid, cover.view(), &shading, exact, work);
      attributes = inside_attributes({cover.view(), surface.view()}, dag.view(), options, {}, work);
    } else {
      attributes = build_attributes(mesh, metadata.grid, dag.view(), &shading, options, work);
    }
    metadata.attributes.resolution = metadata.grid.resolution();
    if (options.colors)
      metadata.attributes.colors = {options.color_bound, attributes.color_errors.squared};
  }
  return std::make_shared<Dag>(DagModel(std::move(dag), std::move(attributes), metadata));
}

/// Returns a mesh with the colours of its vertices, if there are some.
MeshWithAppearance mesh_of(const ArrayLike& vertices, const ArrayLike& faces,
                           const std::optional<ArrayLike>& colors) {
  MeshWithAppearance source;
  const std::vector<Vec3d> points = rows_of<double>(vertices, "vertices");
  source.mesh.vertices.reserve(points.size());
  for (const Vec3d p : points) source.mesh.vertices.push_back(static_cast<Vec3f>(p));
  const auto count = static_cast<std::int64_t>(source.mesh.vertices.size());
  using Limits = std::numeric_limits<std::int64_t>;
  for (const Vec3<std::int64_t> face :
       whole_rows_of(faces, "faces", Limits::min(), Limits::max())) {
    for (int i = 0; i < 3; ++i) {
      if (face[i] < 0 || face[i] >= count)
        throw py::value_error("faces has the index " + std::to_string(face[i]) +
                              ", but there are " + std::to_string(count) + " vertices");
      const Vec3f v = source.mesh.vertices[static_cast<std::size_t>(face[i])];
      if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z))
        throw py::value_error("vertex " + std::to_string(face[i]) + " is not finite");
    }
    source.mesh.triangles.push_back({static_cast<std::uint32_t>(face.x),
                                     static_cast<std::uint32_t>(face.y),
                                     static_cast<std::uint32_t>(face.z)});
  }
  place_vertices(source.mesh, [&](std::size_t i) { return points[i]; });
  source.appearance.materials.resize(1);
  if (!colors) return source;
  const std::vector<Vec3<std::uint8_t>> values = colors_of(*colors);
  if (values.size() != source.mesh.vertices.size())
    throw py::value_error("colors must have a row for each vertex");
  for (const Triangle& triangle : source.mesh.triangles)
    for (const std::uint32_t vertex : triangle) {
      const auto linear = [](std::uint8_t code) {
        return srgb_to_linear(static_cast<float>(code) / 255);
      };
      const Vec3<std::uint8_t> c = values[vertex];
      source.appearance.colors.push_back(to_rgba16({linear(c.x), linear(c.y), linear(c.z)}, 1));
    }
  return source;
}

DagPointer build(const ArrayLike& vertices, const ArrayLike& faces,
                 std::optional<std::int64_t> resolution, std::optional<double> pitch,
                 std::optional<Bounds> bounds, const py::object& solid,
                 const std::optional<ArrayLike>& colors) {
  const GridRequest grid = grid_request(resolution, pitch, bounds);
  const std::optional<SolidRule> rule = rule_of(solid);
  const MeshWithAppearance source = mesh_of(vertices, faces, colors);
  return run_work([&](Work work) {
    AttributeOptions attributes;
    attributes.colors = colors.has_value();
    std::vector<std::string> none;  // There are no textures.
    return build_mesh(source, grid, rule, attributes, false, "arrays", {}, none, work);
  });
}

DagPointer build_file(const std::filesystem::path& path, std::optional<std::int64_t> resolution,
                      std::optional<double> pitch, std::optional<Bounds> bounds,
                      const py::object& solid, bool colors, const std::string& alpha,
                      const py::object& channels) {
  if (alpha != "cut" && alpha != "keep") throw py::value_error("alpha must be \"cut\" or \"keep\"");
  const GridRequest grid = grid_request(resolution, pitch, bounds);
  const std::optional<SolidRule> rule = rule_of(solid);
  AttributeOptions attributes = with_channels(channels, {});
  attributes.colors = colors;
  std::vector<std::string> warnings;
  DagPointer dag = run_work([&](Work work) {
    const ReadOptions options{.work = work};
    MeshWithAppearance source;
    if (colors || attributes.has_channels())
      source = read_mesh_with_appearance(path, options);
    else
      source.mesh = read_mesh(path, options);
    if (attributes.has_channels() && !has_metallic_roughness(source.appearance))
      warnings.push_back(path.string() + ": has no metallic and no roughness: channels stores 0 " +
                         "and 1 for all cells");
    return with_file_name(path.string(), [&] {
      return build_mesh(source, grid, rule, attributes, colors && alpha == "cut",
                        path.filename().string(), presentation_of({}, mesh_custom(path, options)),
                        warnings, work);
    });
  });
  for (const std::string& warning : warnings) warn(warning);
  return dag;
}

DagPointer open(const std::filesystem::path& path) {
  return run_work([&](Work work) { return std::make_shared<Dag>(DagModel(path, work)); });
}

}  // namespace

void add_makers(py::module_& module) {
  add_importers(module);
  const auto none = py::none();
  module.def("open", &open, py::arg("path"),
             R"(Opens the .vdag file at `path`. Raises OSError if it cannot be read.)");
  module.def("build", &build, py::arg("vertices"), py::arg("faces"), py::kw_only(),
             py::arg("resolution") = none, py::arg("pitch") = none, py::arg("bounds") = none,
             py::arg("solid") = none, py::arg("colors") = none);
  module.def("build_mesh", &build_file, py::arg("path"), py::kw_only(),
             py::arg("resolution") = none, py::arg("pitch") = none, py::arg("bounds") = none,
             py::arg("solid") = none, py::arg("colors") = false, py::arg("alpha") = "cut",
             py::arg("channels") = none,
             R"(Builds the DAG of the voxels that the triangles of a mesh file meet.

path: .obj, .ply, .stl, .glb and others (docs/meshes.md).
resolution, pitch, bounds, solid: as for build().
colors: give voxels the colours and textures of the mesh.
alpha: "cut" leaves out transparent voxels if colors, "keep" sets them.
channels: "metallic", "roughness", or both in a list: numbers of the materials of glTF and OBJ, from 0
to 255 (docs/attributes.md#metallic-and-roughness).
Raises OSError if the file cannot be read; a texture that cannot be read becomes a warning.)");
}

}  // namespace voxdag::python

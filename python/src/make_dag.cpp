/// The functions that make DAGs from meshes, points, coordinates, dense arrays and files.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>

#include "arrays.hpp"
#include "dag.hpp"
#include "run_work.hpp"
#include "voxdag/builders/attributes/build_attributes.hpp"
#include "voxdag/builders/dag/build_svdag.hpp"
#include "voxdag/builders/solid/solid_settings.hpp"
#include "voxdag/builders/voxelize/grid_request.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/srgb.hpp"
#include "voxdag/core/with_file_name.hpp"
#include "voxdag/formats/imports/import_model.hpp"
#include "voxdag/formats/readers/read_mesh.hpp"
#include "voxdag/mesh/place_vertices.hpp"
#include "voxdag/mesh/surface/surface_shading.hpp"

namespace py = pybind11;

namespace voxdag::python {
namespace {

using Bounds = std::array<std::array<double, 3>, 2>;

GridRequest grid_request(const std::optional<std::int64_t>& resolution,
                         const std::optional<double>& pitch, const std::optional<Bounds>& bounds) {
  if (resolution.has_value() == pitch.has_value())
    throw py::value_error("give exactly one of resolution and pitch");
  if (pitch && !(*pitch > 0)) throw py::value_error("pitch must be positive");
  GridRequest request{std::nullopt, pitch, std::nullopt};
  if (resolution) request.levels = levels_of(*resolution);
  if (bounds) {
    const auto& [lo, hi] = *bounds;
    request.bounds = {{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}};
  }
  return request;
}

std::optional<SolidRule> rule_of(const py::object& solid) {
  if (solid.is_none() || solid.is(py::bool_(false))) return std::nullopt;
  if (solid.is(py::bool_(true))) return SolidRule::kParity;
  try {
    return solid_rule(solid.cast<std::string>());
  } catch (const std::exception&) {
    throw py::value_error("solid must be True, \"parity\", \"winding\" or \"flood\"");
  }
}

/// Builds the DAG of a mesh, as `voxdag build` does.
DagPointer build_mesh(const MeshWithAppearance& source, const GridRequest& grid,
                      const std::optional<SolidRule>& solid, bool colors, const std::string& name,
                      Work work) {
  const Mesh& mesh = source.mesh;
  VdagMetadata metadata;
  metadata.grid = grid_for(mesh, grid);
  metadata.source = {name, mesh.vertices.size(), mesh.triangles.size()};
  metadata.build = settings_of(grid);
  if (solid) add_solid_settings({*solid}, metadata.build);
  Svdag dag = build_svdag(mesh, metadata.grid, {}, work).dag;
  if (solid) dag = fill_solid(dag.view(), mesh, metadata.grid, {*solid}, work);
  DagAttributes attributes;
  if (colors) {
    const SurfaceShading shading(mesh, source.appearance, nullptr, work);
    AttributeOptions options;
    options.colors = true;
    options.finest_level = metadata.grid.levels;
    attributes = build_attributes(mesh, metadata.grid, dag.view(), &shading, options, work);
    metadata.attributes.resolution = metadata.grid.resolution();
    metadata.attributes.colors = {options.color_bound, attributes.color_errors.squared};
  }
  return std::make_shared<Dag>(DagModel(std::move(dag), std::move(attributes), metadata));
}

/// Returns a mesh with the colours of its vertices, if there are some.
MeshWithAppearance mesh_of(const Array<double>& vertices, const Array<std::int64_t>& faces,
                           const std::optional<Array<std::uint8_t>>& colors) {
  MeshWithAppearance source;
  const std::vector<Vec3d> points = rows_of(vertices, "vertices");
  source.mesh.vertices.reserve(points.size());
  for (const Vec3d p : points) source.mesh.vertices.push_back(static_cast<Vec3f>(p));
  const auto count = static_cast<std::int64_t>(source.mesh.vertices.size());
  for (const Vec3<std::int64_t> face : rows_of(faces, "faces")) {
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
  const std::vector<Vec3<std::uint8_t>> values = rows_of(*colors, "colors");
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

DagPointer build(const Array<double>& vertices, const Array<std::int64_t>& faces,
                 std::optional<std::int64_t> resolution, std::optional<double> pitch,
                 std::optional<Bounds> bounds, const py::object& solid,
                 const std::optional<Array<std::uint8_t>>& colors) {
  const GridRequest grid = grid_request(resolution, pitch, bounds);
  const std::optional<SolidRule> rule = rule_of(solid);
  if (rule && colors) throw py::value_error("a solid has no colours inside: leave out colors");
  const MeshWithAppearance source = mesh_of(vertices, faces, colors);
  return run_work([&](Work work) {
    return build_mesh(source, grid, rule, colors.has_value(), "arrays", work);
  });
}

DagPointer build_file(const std::filesystem::path& path, std::optional<std::int64_t> resolution,
                      std::optional<double> pitch, std::optional<Bounds> bounds,
                      const py::object& solid, bool colors) {
  const GridRequest grid = grid_request(resolution, pitch, bounds);
  const std::optional<SolidRule> rule = rule_of(solid);
  if (rule && colors) throw py::value_error("a solid has no colours inside: leave out colors");
  return run_work([&](Work work) {
    const ReadOptions options{.work = work};
    MeshWithAppearance source;
    if (colors)
      source = read_mesh_with_appearance(path, options);
    else
      source.mesh = read_mesh(path, options);
    return with_file_name(path.string(), [&] {
      return build_mesh(source, grid, rule, colors, path.filename().string(), work);
    });
  });
}

/// Points or voxels in arrays.
class ArraySource : public VoxelSource {
 public:
  ArraySource(std::vector<Vec3d> places, std::vector<Rgb8> colors, bool has_points)
      : places_(std::move(places)), colors_(std::move(colors)), has_points_(has_points) {}

  bool has_points() const override { return has_points_; }
  bool has_colors() const override { return !colors_.empty(); }
  void visit_all(const VisitBatch& visit) const override {
    constexpr std::size_t kBatch = 65536;
    for (std::size_t i = 0; i < places_.size(); i += kBatch) {
      const std::size_t count = std::min(kBatch, places_.size() - i);
      visit({std::span(places_).subspan(i, count),
             colors_.empty() ? std::span<const Rgb8>() : std::span(colors_).subspan(i, count)});
    }
  }

 private:
  std::vector<Vec3d> places_;
  std::vector<Rgb8> colors_;
  bool has_points_;
};

std::vector<Rgb8> colors_of(const std::optional<Array<std::uint8_t>>& colors, std::size_t rows) {
  std::vector<Rgb8> result;
  if (!colors) return result;
  for (const Vec3<std::uint8_t> c : rows_of(*colors, "colors")) result.push_back({c.x, c.y, c.z});
  if (result.size() != rows) throw py::value_error("colors must have a row for each point");
  return result;
}

DagPointer import_source(const VoxelSource& source, const ImportOptions& options,
                         const std::string& name, Work work) {
  return std::make_shared<Dag>(import_model(source, options, name, work).model);
}

/// Returns the grid of voxels that have numbers: by default the smallest one that holds them.
GridRequest coords_grid(const std::optional<std::int64_t>& resolution) {
  GridRequest request;
  if (resolution) request.levels = levels_of(*resolution);
  return request;
}

ImportOptions import_options(const GridRequest& grid) {
  ImportOptions options;
  options.levels = grid.levels;
  options.voxel_size = grid.voxel_size;
  options.bounds = grid.bounds;
  options.folder = std::filesystem::temp_directory_path();
  return options;
}

DagPointer from_points(const Array<double>& points, std::optional<std::int64_t> resolution,
                       std::optional<double> pitch, std::optional<Bounds> bounds,
                       const std::optional<Array<std::uint8_t>>& colors) {
  const ImportOptions options = import_options(grid_request(resolution, pitch, bounds));
  std::vector<Vec3d> places = rows_of(points, "points");
  std::vector<Rgb8> values = colors_of(colors, places.size());
  const ArraySource source(std::move(places), std::move(values), true);
  return run_work([&](Work work) { return import_source(source, options, "points", work); });
}

DagPointer from_coords(const Array<std::int32_t>& coords, std::optional<std::int64_t> resolution,
                       const std::optional<Array<std::uint8_t>>& colors) {
  const ImportOptions options = import_options(coords_grid(resolution));
  std::vector<Vec3d> places;
  for (const Vec3i v : rows_of(coords, "coords")) places.push_back(Vec3d(v));
  std::vector<Rgb8> values = colors_of(colors, places.size());
  const ArraySource source(std::move(places), std::move(values), false);
  return run_work([&](Work work) { return import_source(source, options, "coords", work); });
}

DagPointer from_dense(const Array<bool>& dense, std::optional<std::int64_t> resolution) {
  if (dense.ndim() != 3) throw py::value_error("dense must have three dimensions: x, y, z");
  std::vector<Vec3d> places;
  const auto at = dense.unchecked<3>();
  std::int64_t side = 1 << kMinLevels;
  for (int axis = 0; axis < 3; ++axis) side = std::max<std::int64_t>(side, dense.shape(axis));
  for (py::ssize_t x = 0; x < dense.shape(0); ++x)
    for (py::ssize_t y = 0; y < dense.shape(1); ++y)
      for (py::ssize_t z = 0; z < dense.shape(2); ++z)
        if (at(x, y, z))
          places.push_back(
              {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)});
  const auto least = static_cast<std::int64_t>(std::bit_ceil(static_cast<std::uint64_t>(side)));
  const ImportOptions options = import_options(coords_grid(resolution.value_or(least)));
  const ArraySource source(std::move(places), {}, false);
  return run_work([&](Work work) { return import_source(source, options, "dense", work); });
}

DagPointer open(const std::filesystem::path& path) {
  return run_work([&](Work work) { return std::make_shared<Dag>(DagModel(path, work)); });
}

}  // namespace

void add_makers(py::module_& module) {
  const auto none = py::none();
  module.def("open", &open, py::arg("path"), "Open a .vdag file.");
  module.def("build", &build, py::arg("vertices"), py::arg("faces"), py::kw_only(),
             py::arg("resolution") = none, py::arg("pitch") = none, py::arg("bounds") = none,
             py::arg("solid") = none, py::arg("colors") = none);
  module.def("build_mesh", &build_file, py::arg("path"), py::kw_only(),
             py::arg("resolution") = none, py::arg("pitch") = none, py::arg("bounds") = none,
             py::arg("solid") = none, py::arg("colors") = false);
  module.def("from_points", &from_points, py::arg("points"), py::kw_only(),
             py::arg("resolution") = none, py::arg("pitch") = none, py::arg("bounds") = none,
             py::arg("colors") = none);
  module.def("from_coords", &from_coords, py::arg("coords"), py::kw_only(),
             py::arg("resolution") = none, py::arg("colors") = none);
  module.def("from_dense", &from_dense, py::arg("dense"), py::kw_only(),
             py::arg("resolution") = none);
}

}  // namespace voxdag::python

/// The functions that make DAGs from meshes, points, coordinates, dense arrays and files.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "arrays.hpp"
#include "dag.hpp"
#include "run_work.hpp"
#include "voxdag/builders/attributes/build_attributes.hpp"
#include "voxdag/builders/attributes/cut_alpha.hpp"
#include "voxdag/builders/attributes/inside_attributes.hpp"
#include "voxdag/builders/dag/build_svdag.hpp"
#include "voxdag/builders/solid/solid_settings.hpp"
#include "voxdag/builders/voxelize/grid_request.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/srgb.hpp"
#include "voxdag/core/with_file_name.hpp"
#include "voxdag/formats/imports/import_model.hpp"
#include "voxdag/formats/presentation.hpp"
#include "voxdag/formats/readers/read_mesh.hpp"
#include "voxdag/mesh/place_vertices.hpp"
#include "voxdag/mesh/surface/surface_shading.hpp"

namespace py = pybind11;

namespace voxdag::python {
namespace {

using Bounds = std::array<std::array<double, 3>, 2>;

/// Raises ValueError if there is a resolution that no grid can have.
std::optional<std::int64_t> checked(const std::optional<std::int64_t>& resolution) {
  if (resolution && (*resolution < 1 || *resolution > 1 << kMaxLevels))
    throw py::value_error("resolution must be from 1 to 1048576");
  return resolution;
}

GridRequest grid_request(const std::optional<std::int64_t>& resolution,
                         const std::optional<double>& pitch, const std::optional<Bounds>& bounds) {
  if (resolution.has_value() == pitch.has_value())
    throw py::value_error("give exactly one of resolution and pitch");
  if (pitch && !(*pitch > 0)) throw py::value_error("pitch must be positive");
  GridRequest request;
  request.voxel_size = pitch;
  request.resolution = checked(resolution);
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
                      const std::optional<SolidRule>& solid, bool colors, bool cuts_alpha,
                      const std::string& name, const Presentation& presentation, Work work) {
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
  if (colors) {
    const SurfaceShading shading(mesh, source.appearance, nullptr, work);
    auto cut =
        cuts_alpha ? cut_alpha(mesh, metadata.grid, dag.view(), shading, work) : std::nullopt;
    if (cut) {
      dag = std::move(*cut);
      metadata.build["alpha"] = "cut";
    }
    AttributeOptions options;
    options.colors = true;
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
    return build_mesh(source, grid, rule, colors.has_value(), false, "arrays", {}, work);
  });
}

DagPointer build_file(const std::filesystem::path& path, std::optional<std::int64_t> resolution,
                      std::optional<double> pitch, std::optional<Bounds> bounds,
                      const py::object& solid, bool colors, const std::string& alpha) {
  if (alpha != "cut" && alpha != "keep") throw py::value_error("alpha must be \"cut\" or \"keep\"");
  const GridRequest grid = grid_request(resolution, pitch, bounds);
  const std::optional<SolidRule> rule = rule_of(solid);
  return run_work([&](Work work) {
    const ReadOptions options{.work = work};
    MeshWithAppearance source;
    if (colors)
      source = read_mesh_with_appearance(path, options);
    else
      source.mesh = read_mesh(path, options);
    return with_file_name(path.string(), [&] {
      return build_mesh(source, grid, rule, colors, alpha == "cut", path.filename().string(),
                        presentation_of({}, mesh_custom(path, options)), work);
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

std::vector<Rgb8> colors_of_rows(const std::optional<ArrayLike>& colors, std::size_t rows) {
  std::vector<Rgb8> result;
  if (!colors) return result;
  for (const Vec3<std::uint8_t> c : colors_of(*colors)) result.push_back({c.x, c.y, c.z});
  if (result.size() != rows) throw py::value_error("colors must have a row for each point");
  return result;
}

/// Imports a source. Adds a warning about points that are left out.
DagPointer import_source(const VoxelSource& source, const ImportOptions& options,
                         const std::string& name, Work work, std::vector<std::string>& warnings) {
  ImportedModel imported = import_model(source, options, name, work);
  if (imported.not_finite > 0)
    warnings.push_back(std::to_string(imported.not_finite) +
                       " points left out: a coordinate is not finite");
  if (imported.too_large > 0)
    warnings.push_back(std::to_string(imported.too_large) +
                       " splats left out: they are larger than max_scale");
  Presentation presentation;
  presentation.cubes = !source.has_points();
  imported.model.set_presentation(presentation);
  return std::make_shared<Dag>(std::move(imported.model));
}

/// Imports arrays as import_source(). Its warnings are Python's.
DagPointer import_arrays(const ArraySource& source, const ImportOptions& options,
                         const std::string& name) {
  std::vector<std::string> warnings;
  DagPointer dag =
      run_work([&](Work work) { return import_source(source, options, name, work, warnings); });
  for (const std::string& warning : warnings) warn(name + ": " + warning);
  return dag;
}

ImportOptions import_options(const GridRequest& grid) {
  ImportOptions options;
  static_cast<GridRequest&>(options) = grid;
  options.folder = std::filesystem::temp_directory_path();
  // No channel of a colour differs by more than 5 %: the bound weighs blue with 1 of 7.
  options.color_bound = 0.05 / std::sqrt(7.0);
  return options;
}

using Point = std::array<double, 3>;

/// Sets the place of the grid of voxels that have numbers: by default voxels of size 1 from 0.
/// Without `resolution`, it is the smallest grid that holds them.
ImportOptions options_of_voxels(const std::optional<std::int64_t>& resolution,
                                const std::optional<double>& pitch,
                                const std::optional<Point>& origin) {
  if (pitch && !(*pitch > 0 && std::isfinite(*pitch)))
    throw py::value_error("pitch must be positive");
  GridRequest request{.resolution = checked(resolution), .voxel_size = pitch};
  ImportOptions options = import_options(request);
  if (!origin) return options;
  options.origin = {(*origin)[0], (*origin)[1], (*origin)[2]};
  if (!is_finite(*options.origin)) throw py::value_error("origin must be finite");
  return options;
}

DagPointer from_points(const ArrayLike& points, std::optional<std::int64_t> resolution,
                       std::optional<double> pitch, std::optional<Bounds> bounds,
                       const std::optional<ArrayLike>& colors) {
  const ImportOptions options = import_options(grid_request(resolution, pitch, bounds));
  std::vector<Vec3d> places = rows_of<double>(points, "points");
  std::vector<Rgb8> values = colors_of_rows(colors, places.size());
  const ArraySource source(std::move(places), std::move(values), true);
  return import_arrays(source, options, "points");
}

DagPointer from_coords(const ArrayLike& coords, std::optional<std::int64_t> resolution,
                       const std::optional<double>& pitch, const std::optional<Point>& origin,
                       const std::optional<ArrayLike>& colors) {
  const ImportOptions options = options_of_voxels(resolution, pitch, origin);
  std::vector<Vec3d> places;
  for (const Vec3i v : voxels_of(coords, "coords")) places.push_back(Vec3d(v));
  std::vector<Rgb8> values = colors_of_rows(colors, places.size());
  const ArraySource source(std::move(places), std::move(values), false);
  return import_arrays(source, options, "coords");
}

DagPointer from_dense(const ArrayLike& given, std::optional<std::int64_t> resolution,
                      const std::optional<double>& pitch, const std::optional<Point>& origin) {
  if (given.ndim() != 3) throw py::value_error("dense must have three dimensions: x, y, z");
  kind_of(given, "dense", "biu", "bool or whole numbers: compare real ones, dense > 0.5");
  const Array<bool> dense(given);
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
  const ImportOptions options = options_of_voxels(resolution.value_or(least), pitch, origin);
  const ArraySource source(std::move(places), {}, false);
  return import_arrays(source, options, "dense");
}

/// Reads a file of points, voxels or a volume, as `voxdag import` does. Its warnings are Python's.
DagPointer import_file(const std::filesystem::path& path, std::optional<std::int64_t> resolution,
                       const std::optional<double>& pitch, const std::optional<Point>& origin,
                       const std::optional<Bounds>& bounds, const std::optional<double>& threshold,
                       const std::string& grid, bool colors, const std::optional<double>& opacity,
                       const std::optional<double>& min_scale,
                       const std::optional<double>& max_scale, bool points) {
  if (opacity && !(*opacity > 0 && *opacity < 1))
    throw py::value_error("opacity must be above 0 and below 1");
  for (const auto& [scale, name] : {std::pair(min_scale, "min_scale"), {max_scale, "max_scale"}})
    if (scale && !(*scale > 0 && std::isfinite(*scale)))
      throw py::value_error(std::string(name) + " must be positive");
  ImportOptions options = options_of_voxels(resolution, pitch, origin);
  if (bounds) {
    const auto& [lo, hi] = *bounds;
    options.bounds = {{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}};
  }
  options.colors = colors;
  options.color_bound = std::nullopt;  // That of `voxdag import`.
  options.splats = {opacity, min_scale, max_scale};
  std::vector<std::string> warnings;
  DagPointer dag = run_work([&](Work work) {
    return with_file_name(path.string(), [&] {
      const std::unique_ptr<VoxelSource> source =
          open_voxel_source(path, {.threshold = threshold,
                                   .use_placement = !pitch && !origin,
                                   .grid = grid,
                                   .splats_are_points = points,
                                   .work = work});
      warnings = source->warnings();
      check_grid_options(*source, options);
      return import_source(*source, options, path.filename().string(), work, warnings);
    });
  });
  for (const std::string& warning : warnings) warn(path.string() + ": " + warning);
  return dag;
}

DagPointer open(const std::filesystem::path& path) {
  return run_work([&](Work work) { return std::make_shared<Dag>(DagModel(path, work)); });
}

}  // namespace

void add_makers(py::module_& module) {
  const auto none = py::none();
  module.def("open", &open, py::arg("path"),
             R"(Opens the .vdag file at `path`. Raises OSError if it cannot be read.)");
  module.def("build", &build, py::arg("vertices"), py::arg("faces"), py::kw_only(),
             py::arg("resolution") = none, py::arg("pitch") = none, py::arg("bounds") = none,
             py::arg("solid") = none, py::arg("colors") = none);
  module.def("build_mesh", &build_file, py::arg("path"), py::kw_only(),
             py::arg("resolution") = none, py::arg("pitch") = none, py::arg("bounds") = none,
             py::arg("solid") = none, py::arg("colors") = false, py::arg("alpha") = "cut",
             R"(Builds the DAG of the voxels that the triangles of a mesh file meet.

path: .obj, .ply, .stl, .glb and others (docs/meshes.md).
resolution, pitch, bounds, solid: as for build().
colors: give voxels the colours and textures of the mesh.
alpha: "cut" leaves out transparent voxels if colors, "keep" sets them.
Raises OSError if the file cannot be read.)");
  module.def("from_points", &from_points, py::arg("points"), py::kw_only(),
             py::arg("resolution") = none, py::arg("pitch") = none, py::arg("bounds") = none,
             py::arg("colors") = none);
  module.def("from_coords", &from_coords, py::arg("coords"), py::kw_only(),
             py::arg("resolution") = none, py::arg("pitch") = none, py::arg("origin") = none,
             py::arg("colors") = none,
             R"(Builds the DAG of voxels.

coords: (N, 3) whole numbers.
resolution: voxels along the longest side, 1 to 2^20; default: a grid that holds them.
pitch: side of a voxel, in world units; default: 1.
origin: (x, y, z), lower corner of voxel (0, 0, 0), in world units.
colors: (N, 3), sRGB: uint8, uint16, or real numbers from 0 to 1.)");
  module.def("from_dense", &from_dense, py::arg("dense"), py::kw_only(),
             py::arg("resolution") = none, py::arg("pitch") = none, py::arg("origin") = none,
             R"(Builds the DAG of the voxels of a dense array.

dense: [x, y, z]; those that are True, or not 0 in whole numbers, are voxels.
resolution, pitch, origin: as for from_coords().)");
  module.def("import_file", &import_file, py::arg("path"), py::kw_only(),
             py::arg("resolution") = none, py::arg("pitch") = none, py::arg("origin") = none,
             py::arg("bounds") = none, py::arg("threshold") = none, py::arg("grid") = "",
             py::arg("colors") = true, py::arg("opacity") = none, py::arg("min_scale") = none,
             py::arg("max_scale") = none, py::arg("points") = false,
             R"(Reads a file of points, voxels or a volume, as `voxdag import` does.

path: .vox, .las, .ply, .nrrd, .npy and others (docs/import.md).
resolution, pitch: as for from_coords(); points need one of them.
origin: (x, y, z), lower corner of the grid; bounds: ((x0, y0, z0), (x1, y1, z1)), the box that it
holds; both in world units.
threshold: for volumes, the least value that sets a voxel.
grid: the name of a grid of a .vdb file.
colors: also read colours, if there are some.
opacity, min_scale, max_scale: how Gaussian splats set voxels (docs/splats.md).
points: read the centres of splats as points.
Raises OSError if the file cannot be read; what the file holds and is left out becomes a warning.)");
}

}  // namespace voxdag::python

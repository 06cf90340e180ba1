/// The functions that make DAGs from points, coordinates, dense arrays, and files of them.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <bit>
#include <cmath>
#include <filesystem>

#include "arrays.hpp"
#include "channels.hpp"
#include "dag.hpp"
#include "grid_arguments.hpp"
#include "run_work.hpp"
#include "voxdag/builders/dag/ray_space.hpp"
#include "voxdag/core/with_file_name.hpp"
#include "voxdag/formats/imports/import_model.hpp"
#include "voxdag/formats/imports/labels/label_value.hpp"

namespace py = pybind11;

namespace voxdag::python {
namespace {

/// Points or voxels in arrays.
class ArraySource : public VoxelSource {
 public:
  /// `colors` and `labels` have a value for each place, or none.
  ArraySource(std::vector<Vec3d> places, std::vector<Rgb8> colors, std::vector<Label> labels,
              ChannelRows channels, bool has_points)
      : places_(std::move(places)),
        colors_(std::move(colors)),
        labels_(std::move(labels)),
        channels_(std::move(channels)),
        has_points_(has_points) {}

  bool has_points() const override { return has_points_; }
  bool has_colors() const override { return !colors_.empty(); }
  bool has_labels() const override { return !labels_.empty(); }
  std::vector<ChannelSpec> channels() const override { return channels_.specs; }
  void visit_all(const VisitBatch& visit) const override {
    constexpr std::size_t kBatch = 65536;
    for (std::size_t i = 0; i < places_.size(); i += kBatch) {
      const std::size_t count = std::min(kBatch, places_.size() - i);
      const auto part = [&]<class T>(const std::vector<T>& of) {
        return of.empty() ? std::span<const T>() : std::span(of).subspan(i, count);
      };
      const std::size_t each = channels_.specs.size();
      visit({part(places_),
             part(colors_),
             {},
             part(labels_),
             std::span(channels_.values).subspan(i * each, count * each)});
    }
  }

 private:
  std::vector<Vec3d> places_;
  std::vector<Rgb8> colors_;
  std::vector<Label> labels_;
  ChannelRows channels_;
  bool has_points_;
};

std::vector<Rgb8> colors_of_rows(const std::optional<ArrayLike>& colors, std::size_t rows) {
  std::vector<Rgb8> result;
  if (!colors) return result;
  for (const Vec3<std::uint8_t> c : colors_of(*colors)) result.push_back({c.x, c.y, c.z});
  if (result.size() != rows) throw py::value_error("colors must have a row for each point");
  return result;
}

std::vector<Label> labels_of_rows(const std::optional<ArrayLike>& labels, std::size_t rows) {
  if (!labels) return {};
  constexpr Label kMost = Label{1} << 53;
  std::vector<Label> result = whole_values_of(*labels, "labels", -kMost, kMost);
  if (result.size() != rows) throw py::value_error("labels must have a value for each point");
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

/// Imports places with the colours, labels and channels of their rows.
DagPointer import_rows(std::vector<Vec3d> places, const std::optional<ArrayLike>& colors,
                       const std::optional<ArrayLike>& labels, const ChannelsArgument& channels,
                       bool has_points, const ImportOptions& options, const std::string& name) {
  std::vector<Rgb8> values = colors_of_rows(colors, places.size());
  std::vector<Label> numbers = labels_of_rows(labels, places.size());
  ChannelRows rows = channel_rows(channels, {static_cast<py::ssize_t>(places.size())});
  const ArraySource source(std::move(places), std::move(values), std::move(numbers),
                           std::move(rows), has_points);
  return import_arrays(source, options, name);
}

DagPointer from_points(const ArrayLike& points, std::optional<std::int64_t> resolution,
                       std::optional<double> pitch, std::optional<Bounds> bounds,
                       const std::optional<ArrayLike>& colors,
                       const std::optional<ArrayLike>& labels, const ChannelsArgument& channels) {
  return import_rows(rows_of<double>(points, "points"), colors, labels, channels, true,
                     import_options(grid_request(resolution, pitch, bounds)), "points");
}

DagPointer from_coords(const ArrayLike& coords, std::optional<std::int64_t> resolution,
                       const std::optional<double>& pitch, const std::optional<Point>& origin,
                       const std::optional<ArrayLike>& colors,
                       const std::optional<ArrayLike>& labels, const ChannelsArgument& channels) {
  const ImportOptions options = options_of_voxels(resolution, pitch, origin);
  std::vector<Vec3d> places;
  for (const Vec3i v : voxels_of(coords, "coords")) places.push_back(Vec3d(v));
  return import_rows(std::move(places), colors, labels, channels, false, options, "coords");
}

/// Calls add(place, value) for the values of a dense array that are not 0.
template <class T, class Add>
void visit_dense(const Array<T>& dense, const Add& add) {
  const auto at = dense.template unchecked<3>();
  for (py::ssize_t x = 0; x < dense.shape(0); ++x)
    for (py::ssize_t y = 0; y < dense.shape(1); ++y)
      for (py::ssize_t z = 0; z < dense.shape(2); ++z)
        if (at(x, y, z) != T{})
          add(Vec3d{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)},
              at(x, y, z));
}

DagPointer from_dense(const ArrayLike& given, std::optional<std::int64_t> resolution,
                      const std::optional<double>& pitch, const std::optional<Point>& origin,
                      bool labels, const ChannelsArgument& channels) {
  if (given.ndim() != 3) throw py::value_error("dense must have three dimensions: x, y, z");
  const char kind =
      kind_of(given, "dense", "biu", "bool or whole numbers: compare real ones, dense > 0.5");
  std::vector<Vec3d> places;
  std::vector<Label> values;
  std::vector<std::size_t> picks;  // the places in the array, in C order
  const auto add_label = [&](Vec3d place, auto value) {
    places.push_back(place);
    values.push_back(label_of(value));
  };
  if (!labels)
    visit_dense(Array<bool>(given), [&](Vec3d place, bool) { places.push_back(place); });
  else if (kind == 'u')
    visit_dense(Array<std::uint64_t>(given), add_label);
  else
    visit_dense(Array<std::int64_t>(given), add_label);
  for (const Vec3d place : places) {
    const Vec3<std::size_t> at(place);
    picks.push_back((at.x * static_cast<std::size_t>(given.shape(1)) + at.y) *
                        static_cast<std::size_t>(given.shape(2)) +
                    at.z);
  }
  ChannelRows rows =
      channel_rows(channels, {given.shape(0), given.shape(1), given.shape(2)}, &picks);
  std::int64_t side = 1 << kMinLevels;
  for (int axis = 0; axis < 3; ++axis) side = std::max<std::int64_t>(side, given.shape(axis));
  const auto least = static_cast<std::int64_t>(std::bit_ceil(static_cast<std::uint64_t>(side)));
  const ImportOptions options = options_of_voxels(resolution.value_or(least), pitch, origin);
  const ArraySource source(std::move(places), {}, std::move(values), std::move(rows), false);
  return import_arrays(source, options, "dense");
}

/// Returns the request for labels: False, True, or the name of a field.
LabelRequest label_request(const py::object& labels) {
  if (labels.is(py::bool_(false)) || labels.is_none()) return std::nullopt;
  if (labels.is(py::bool_(true))) return "";
  if (!py::isinstance<py::str>(labels))
    throw py::type_error("labels must be True, False or the name of a field");
  return labels.cast<std::string>();
}

/// Returns names of labels as texts: a list of names and numbers.
std::vector<std::string> words_of(const py::iterable& labels) {
  std::vector<std::string> words;
  for (const py::handle label : labels) words.push_back(py::str(label));
  return words;
}

/// Reads a file of points, voxels or a volume, as `voxdag import` does. Its warnings are Python's.
DagPointer import_file(const std::filesystem::path& path, std::optional<std::int64_t> resolution,
                       const std::optional<double>& pitch, const std::optional<Point>& origin,
                       const std::optional<Bounds>& bounds, const std::optional<double>& threshold,
                       const std::string& grid, bool colors, const std::optional<double>& opacity,
                       const std::optional<double>& min_scale,
                       const std::optional<double>& max_scale, bool points,
                       const py::object& labels, const std::optional<py::list>& keep,
                       const std::optional<py::list>& drop, const py::object& channels) {
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
  if (keep && drop) throw py::value_error("give one of keep and drop");
  if (keep || drop) options.labels = words_of(keep ? *keep : *drop);
  options.drops_labels = drop.has_value();
  LabelRequest request = label_request(labels);
  if ((keep || drop) && !request) request = "";
  const std::vector<ChannelRequest> wanted = channel_requests(channels);
  std::vector<std::string> warnings;
  DagPointer dag = run_work([&](Work work) {
    return with_file_name(path.string(), [&] {
      const std::unique_ptr<VoxelSource> source =
          open_voxel_source(path, {.threshold = threshold,
                                   .use_placement = !pitch && !origin,
                                   .grid = grid,
                                   .splats_are_points = points,
                                   .labels = request,
                                   .channels = wanted,
                                   .work = work});
      warnings = source->warnings();
      check_grid_options(*source, options);
      return import_source(*source, options, path.filename().string(), work, warnings);
    });
  });
  for (const std::string& warning : warnings) warn(path.string() + ": " + warning);
  return dag;
}

std::pair<DagPointer, DagPointer> carve_rays(const ArrayLike& origins, const ArrayLike& ends,
                                             std::optional<std::int64_t> resolution,
                                             std::optional<double> pitch,
                                             std::optional<Bounds> bounds,
                                             const std::optional<ArrayLike>& hits) {
  const GridRequest request = grid_request(resolution, pitch, bounds);
  ArrayLike rows = origins;
  if (origins.ndim() == 1) rows = ArrayLike(py::array(origins).attr("reshape")(1, -1));
  const std::vector<Vec3d> from = rows_of<double>(rows, "origins"),
                           to = rows_of<double>(ends, "ends");
  std::vector<bool> hit;
  if (hits) {
    kind_of(*hits, "hits", "b", "bool");
    if (hits->ndim() != 1) throw py::value_error("hits must have the shape (N,)");
    const Array<bool> values(*hits);
    hit.assign(values.data(), values.data() + values.size());
  }
  return run_work([&](Work work) {
    RaySpace space = ray_space(from, to, hit, request, work);
    const auto dag_of = [&](Svdag dag, const char* name) {
      VdagMetadata metadata;
      metadata.grid = space.grid;
      metadata.source = {name, to.size(), 0};
      metadata.build = settings_of(request);
      metadata.presentation.cubes = true;
      return std::make_shared<Dag>(DagModel(std::move(dag), {}, std::move(metadata), work));
    };
    return std::pair(dag_of(std::move(space.occupied), "ends of rays"),
                     dag_of(std::move(space.free), "free space"));
  });
}

}  // namespace

void add_importers(py::module_& module) {
  const auto none = py::none();
  module.def("from_points", &from_points, py::arg("points"), py::kw_only(),
             py::arg("resolution") = none, py::arg("pitch") = none, py::arg("bounds") = none,
             py::arg("colors") = none, py::arg("labels") = none, py::arg("channels") = none);
  module.def("from_coords", &from_coords, py::arg("coords"), py::kw_only(),
             py::arg("resolution") = none, py::arg("pitch") = none, py::arg("origin") = none,
             py::arg("colors") = none, py::arg("labels") = none, py::arg("channels") = none,
             R"(Builds the DAG of voxels.

coords: (N, 3) whole numbers.
resolution: voxels along the longest side, 1 to 2^20; default: a grid that holds them.
pitch: side of a voxel, in world units; default: 1.
origin: (x, y, z), lower corner of voxel (0, 0, 0), in world units.
colors: (N, 3), sRGB: uint8, uint16, or real numbers from 0 to 1.
labels: (N,) whole numbers, which become materials.
channels: a dict from names to (N,) numbers, or to pairs of such an array and a bound, the largest
error of a value; without a bound, values are exact. A voxel has the mean of its rows.)");
  module.def("from_dense", &from_dense, py::arg("dense"), py::kw_only(),
             py::arg("resolution") = none, py::arg("pitch") = none, py::arg("origin") = none,
             py::arg("labels") = false, py::arg("channels") = none,
             R"(Builds the DAG of the voxels of a dense array.

dense: [x, y, z]; those that are True, or not 0 in whole numbers, are voxels.
resolution, pitch, origin: as for from_coords().
labels: keep the values as labels, which become materials.
channels: as for from_coords(), with arrays of the shape of dense.)");
  module.def(
      "carve_rays", &carve_rays, py::arg("origins"), py::arg("ends"), py::kw_only(),
      py::arg("resolution") = none, py::arg("pitch") = none, py::arg("bounds") = none,
      py::arg("hits") = none,
      R"(Makes the occupied and the free voxels of rays of a sensor. Returns two DAGs in one grid.

A voxel in which a ray ends is occupied; one that rays pass through, and in which none ends, is free;
all others are unknown. The rule is exact: points are rounded to 1/256 voxel (design.md, exact cover).
origins: (N, 3), or (3,) for all rays; ends: (N, 3); world units.
resolution, pitch, bounds: as for build(). Parts of rays outside of bounds are left out.
hits: (N,) bool: False for rays that met nothing, whose last voxel is free, too.)");
  module.def("import_file", &import_file, py::arg("path"), py::kw_only(),
             py::arg("resolution") = none, py::arg("pitch") = none, py::arg("origin") = none,
             py::arg("bounds") = none, py::arg("threshold") = none, py::arg("grid") = "",
             py::arg("colors") = true, py::arg("opacity") = none, py::arg("min_scale") = none,
             py::arg("max_scale") = none, py::arg("points") = false, py::arg("labels") = false,
             py::arg("keep") = none, py::arg("drop") = none, py::arg("channels") = none,
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
labels: keep labels as materials: True, or the name of a field of points (docs/import.md#labels).
keep, drop: import only these labels, or all others: a list of numbers and names.
channels: fields to keep as channels (docs/import.md#channels): a list of names, or a dict from names
of channels to names of fields, or to pairs of a field and a bound. The field of a volume is "value".
Raises OSError if the file cannot be read; what the file holds and is left out becomes a warning.)");
}

}  // namespace voxdag::python

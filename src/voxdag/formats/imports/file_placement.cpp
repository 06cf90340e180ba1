#include "voxdag/formats/imports/file_placement.hpp"

#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <system_error>
#include <utility>

#include "voxdag/core/box.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/io/unpacked_name.hpp"
#include "voxdag/formats/export_placement.hpp"
#include "voxdag/formats/imports/derived_source.hpp"
#include "voxdag/formats/input_file.hpp"

namespace voxdag {
namespace {

struct FilePlacement {
  Grid grid;
  Box3i window;                      ///< Of the grid's voxels.
  Vec3i lo_in_file;                  ///< The coordinates of voxel window.lo in the file.
  std::array<int, 3> axes{0, 1, 2};  ///< The grid's axes of x, y and z in the file.
  /// How the export turned the scene, and the axis that points up without that turn.
  Orientation orientation;
  std::optional<char> up;
};

template <class T>
Vec3<T> vector_of(const nlohmann::json& json) {
  return {json.at(0).get<T>(), json.at(1).get<T>(), json.at(2).get<T>()};
}

/// Parses a placement. Throws nlohmann::json::exception and Error without a file.
FilePlacement parse_placement(const nlohmann::json& json, bool is_folder) {
  FilePlacement placement;
  const nlohmann::json &grid = json.at("grid"), &window = json.at("window");
  const auto resolution = grid.at("resolution").get<std::uint64_t>();
  const auto voxel_size = grid.at("voxel_size").get<double>();
  if (!std::has_single_bit(resolution) || resolution < (1u << kMinLevels) ||
      resolution > (1u << kMaxLevels) || !(voxel_size > 0) ||
      !std::isfinite(kSubvoxels / voxel_size))
    throw Error("its grid cannot be");
  placement.grid = {std::countr_zero(resolution), vector_of<double>(grid.at("origin")), voxel_size,
                    kSubvoxels / voxel_size};
  placement.window = {vector_of<std::int32_t>(window.at("lo")),
                      vector_of<std::int32_t>(window.at("hi"))};
  if (json.contains("turned")) {
    const auto up = json["turned"].at("from_up").get<std::string>();
    if (up != "y" && up != "z") throw Error("its axis that points up is neither y nor z");
    placement.up = up[0];
    placement.orientation = turn_of_export(up[0]);
    placement.grid.origin = vector_of<double>(json["turned"].at("origin_before"));
  }
  const nlohmann::json& array = json.at("array");
  if (window.contains("lo_in_file"))
    placement.lo_in_file = vector_of<std::int32_t>(window.at("lo_in_file"));
  else if (!array.contains("axes_slowest_to_fastest"))
    placement.lo_in_file = placement.window.lo;  // Coordinates of the grid.
  if (is_folder) {
    // Slices, rows and columns are z, y and x of the file.
    const auto names = array.at("axes_slowest_to_fastest").get<std::string>();
    std::array<bool, 3> found{};
    for (std::size_t i = 0; i < 3; ++i) {
      const int axis = names.size() == 3 ? names[i] - 'x' : -1;
      if (axis < 0 || axis > 2 || std::exchange(found[static_cast<std::size_t>(axis)], true))
        throw Error("its axes are not x, y and z");
      placement.axes[2 - i] = axis;
    }
  }
  return placement;
}

class PlacedVoxels final : public DerivedSource {
 public:
  PlacedVoxels(std::unique_ptr<VoxelSource> source, const FilePlacement& placement,
               std::string name)
      : DerivedSource(std::move(source)), placement_(placement), name_(std::move(name)) {}

  bool has_place() const override { return true; }
  std::optional<Grid> grid() const override { return placement_.grid; }
  std::optional<char> up() const override { return placement_.up; }
  Vec3l first_voxel() const override { return {}; }
  void visit_all(const VisitBatch& visit) const override {
    const Vec3d first = static_cast<Vec3d>(source_->first_voxel());
    visit_moved(visit, [&](Vec3d place) { return place_of(place + first); });
  }

 private:
  Vec3d place_of(Vec3d in_file) const {
    Vec3d place;
    for (int axis = 0; axis < 3; ++axis) {
      const int to = placement_.axes[static_cast<std::size_t>(axis)];
      const double lo = placement_.window.lo[to];
      place[to] = in_file[axis] - placement_.lo_in_file[to] + lo;
      if (place[to] < lo || place[to] >= placement_.window.hi[to])
        throw Error(
            name_, "window",
            "does not hold all voxels of the file, so it belongs to another one: remove it");
    }
    if (!placement_.up) return place;
    return Vec3d(source_cell(placement_.orientation, Vec3i(place), placement_.grid.levels));
  }

  FilePlacement placement_;
  std::string name_;  ///< Of the file with the placement.
};

}  // namespace

std::unique_ptr<VoxelSource> with_file_placement(const std::filesystem::path& path,
                                                 std::unique_ptr<VoxelSource> source) {
  if (source->has_points() || source->has_place()) return source;
  std::error_code ignored;
  const bool is_folder = std::filesystem::is_directory(path, ignored);
  std::filesystem::path beside =
      is_folder ? path / "placement.json" : std::filesystem::path(path.string() + ".json");
  nlohmann::json json = read_placement(beside);
  if (json.is_null() && !is_folder) {
    beside = unpacked_name(path).string() + ".json";
    json = read_placement(beside);
  }
  if (json.is_null()) return source;
  try {
    const FilePlacement placement = parse_placement(json, is_folder);
    return std::make_unique<PlacedVoxels>(std::move(source), placement, beside.string());
  } catch (const nlohmann::json::exception&) {
    throw Error(beside.string(), "", "is no placement as voxdag export writes it");
  } catch (const Error& error) {
    throw Error(beside.string(), "", error.reason());
  }
}

bool has_numbered_slices(const std::filesystem::path& folder) {
  const nlohmann::json json = read_placement(folder / "placement.json");
  const nlohmann::json array = json.is_null() ? json : json.value("array", nlohmann::json());
  return array.is_object() && array.value("slices", nlohmann::json()) == "numbered";
}

}  // namespace voxdag

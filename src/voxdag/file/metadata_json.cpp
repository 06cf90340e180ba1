#include "voxdag/file/metadata_json.hpp"

namespace voxdag {
namespace {

Grid read_grid(const MetadataField& field) {
  Grid grid;
  const std::uint64_t levels = field.at("levels").count();
  if (levels < kMinLevels || levels > kMaxLevels)
    field.at("levels").fail(std::to_string(levels) + " is not in the range " +
                            std::to_string(kMinLevels) + " to " + std::to_string(kMaxLevels));
  grid.levels = static_cast<int>(levels);
  const MetadataField origin = field.at("origin");
  origin.expect_array(3);
  for (int axis = 0; axis < 3; ++axis)
    grid.origin[axis] = origin.at(static_cast<std::size_t>(axis)).finite();
  grid.voxel_size = field.at("voxel_size").positive();
  grid.quantization_scale = field.at("quantization_scale").positive();
  const Vec3d far_corner = grid.bounds().hi;
  for (int axis = 0; axis < 3; ++axis)
    if (!std::isfinite(far_corner[axis]))
      field.fail("the far corner of the grid is not a finite number");
  if (!std::isfinite(1 / grid.voxel_size))
    field.at("voxel_size").fail("is too small: 1 / voxel_size is not a finite number");
  return grid;
}

VdagSource read_source(const MetadataField& field) {
  return {field.at("name").text(), field.at("vertices").count(), field.at("triangles").count()};
}

std::map<std::string, std::string> read_build(const MetadataField& field) {
  if (!field.value.is_object()) field.fail("not an object");
  std::map<std::string, std::string> build;
  for (const auto& [key, value] : field.value.items()) build[key] = field.at(key).text();
  return build;
}

Vec3d read_point(const MetadataField& field) {
  field.expect_array(3);
  return {field.at(std::size_t{0}).finite(), field.at(std::size_t{1}).finite(),
          field.at(std::size_t{2}).finite()};
}

HomeView read_home(const MetadataField& field) {
  HomeView view{{read_point(field.at("eye")), read_point(field.at("target")),
                 read_point(field.at("up")), field.at("fov").finite()},
                {}};
  const Vec3d forward = view.target - view.eye, aside = cross(forward, view.up);
  const double least = 1e-12 * dot(forward, forward) * dot(view.up, view.up);
  if (!(dot(aside, aside) > least && least > 0))
    field.fail("has no direction, or an up vector along it");
  if (!(view.vertical_fov_degrees >= kMinFovDegrees && view.vertical_fov_degrees < 180))
    field.at("fov").fail("not an angle from 0.000001 to below 180 degrees");
  if (!field.value.contains("sun")) return view;
  view.sun = read_point(field.at("sun"));
  if (!(dot(*view.sun, *view.sun) > 0)) field.at("sun").fail("has no direction");
  return view;
}

bool read_flag(const MetadataField& field) {
  if (!field.value.is_boolean()) field.fail("is neither true nor false");
  return field.value.get<bool>();
}

Presentation read_presentation(const MetadataField& root) {
  Presentation presentation;
  if (root.value.contains("up")) {
    const std::string up = root.at("up").text();
    if (up != "x" && up != "y" && up != "z") root.at("up").fail("is none of x, y and z");
    presentation.up = up[0];
    if (root.value.contains("up_guessed"))
      presentation.is_up_guessed = read_flag(root.at("up_guessed"));
  }
  if (root.value.contains("unit")) presentation.unit = root.at("unit").text();
  if (root.value.contains("home")) presentation.home = read_home(root.at("home"));
  if (root.value.contains("cubes")) presentation.cubes = read_flag(root.at("cubes"));
  return presentation;
}

MetadataJson point_json(Vec3d v) { return MetadataJson::array({v.x, v.y, v.z}); }

}  // namespace

MetadataJson parse_metadata_json(std::string_view text) {
  // The parser takes a zero for the end of the text.
  if (const std::size_t zero = text.find('\0'); zero != std::string_view::npos)
    throw Error("", ErrorPlace::byte(zero + 1), "not valid JSON");
  try {
    return MetadataJson::parse(text);
  } catch (const MetadataJson::parse_error& error) {
    throw Error("", ErrorPlace::byte(error.byte), "not valid JSON");
  } catch (const MetadataJson::exception& error) {  // thrown for a number out of range
    throw Error("", "", std::string("not valid JSON: ") + error.what());
  }
}

std::string metadata_text(const MetadataJson& json) {
  return json.dump(-1, ' ', false, MetadataJson::error_handler_t::replace);
}

MetadataJson begin_metadata_json(const SceneMetadata& metadata) {
  const Grid& grid = metadata.grid;
  MetadataJson json;
  json["grid"] = {{"levels", grid.levels},
                  {"origin", {grid.origin.x, grid.origin.y, grid.origin.z}},
                  {"voxel_size", grid.voxel_size},
                  {"quantization_scale", grid.quantization_scale}};
  return json;
}

void finish_metadata_json(MetadataJson& json, const SceneMetadata& metadata) {
  const VdagSource& source = metadata.source;
  json["source"] = {
      {"name", source.name}, {"vertices", source.vertices}, {"triangles", source.triangles}};
  json["program"] = metadata.program;
  json["build"] = metadata.build;
  add_presentation(json, metadata.presentation);
}

void add_presentation(MetadataJson& json, const Presentation& presentation) {
  if (presentation.up) json["up"] = std::string(1, *presentation.up);
  if (presentation.is_up_guessed) json["up_guessed"] = true;
  if (!presentation.unit.empty()) json["unit"] = presentation.unit;
  if (const auto& home = presentation.home) {
    json["home"] = {{"eye", point_json(home->eye)},
                    {"target", point_json(home->target)},
                    {"up", point_json(home->up)},
                    {"fov", home->vertical_fov_degrees}};
    if (home->sun) json["home"]["sun"] = point_json(*home->sun);
  }
  if (presentation.cubes) json["cubes"] = true;
}

void read_scene_metadata(const MetadataField& root, SceneMetadata& metadata) {
  metadata.grid = read_grid(root.at("grid"));
  metadata.source = read_source(root.at("source"));
  metadata.program = root.at("program").text();
  metadata.build = read_build(root.at("build"));
  metadata.presentation = read_presentation(root);
}

}  // namespace voxdag

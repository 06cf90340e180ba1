/// The options of `voxdag render`.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include "cli/environment_input.hpp"
#include "cli/look_input.hpp"
#include "cli/parse.hpp"
#include "render/render_arguments.hpp"
#include "render/render_light.hpp"
#include "voxdag/render/film/film.hpp"

namespace voxdag::cli {
namespace {

/// Parses "0,255"; throws std::invalid_argument.
ChannelRange parse_channel_range(const std::string& text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string::npos) throw std::invalid_argument("must be two numbers: 0,255");
  const ChannelRange range{parse_finite(text.substr(0, comma)),
                           parse_finite(text.substr(comma + 1))};
  if (!(range.least < range.most))
    throw std::invalid_argument("the first number must be less than the second");
  const ChannelRange floats = range_of(ChannelKind::kF32);
  if (range.least < floats.least || range.most > floats.most)
    throw std::invalid_argument("must be in the range of floats");
  return range;
}

/// Parses "depth=z.exr"; throws std::invalid_argument.
PicturePass parse_pass(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) throw std::invalid_argument("must be NAME=FILE");
  const PicturePass pass{find_picture_kind(text.substr(0, equals)), text.substr(equals + 1)};
  if (pass.kind == nullptr) {
    std::vector<std::string_view> names;
    for (const PictureKind& kind : picture_kinds()) names.push_back(kind.name);
    throw std::invalid_argument(
        fmt::format("\"{}\" is not one of {}", text.substr(0, equals), fmt::join(names, ", ")));
  }
  return pass;
}

std::string parse_primary(const std::string& text) {
  if (text != "voxels" && text != "mesh")
    throw std::invalid_argument(fmt::format("\"{}\" is neither voxels nor mesh", text));
  return text;
}

/// Parses a point and a normal: "PX,PY,PZ,NX,NY,NZ".
SectionOptions::Plane parse_plane(const std::string& text) {
  const std::vector<double> v = parse_numbers(text);
  if (v.size() != 6) throw std::invalid_argument("must be six numbers: a point and a normal");
  const SectionOptions::Plane plane{{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
  if (!(dot(plane.normal, plane.normal) > 0))
    throw std::invalid_argument("has a normal whose length is zero");
  return plane;
}

FilterKind parse_filter_kind(const std::string& text) {
  if (text == "guided") return FilterKind::kGuided;
  if (text == "plain") return FilterKind::kPlain;
  if (text == "naive") return FilterKind::kNaive;
  throw std::invalid_argument(fmt::format("\"{}\" is neither guided nor plain nor naive", text));
}

/// Parses "STRENGTH" or "STRENGTH:EXPONENT"; throws std::invalid_argument.
Specular parse_specular(const std::string& text) {
  Specular specular;
  const std::size_t colon = text.find(':');
  specular.strength = NumberRange::from(0, 1).parse<float>(text.substr(0, colon));
  if (colon != std::string::npos)
    specular.exponent = NumberRange::whole(1, 10'000).parse<int>(text.substr(colon + 1));
  return specular;
}

ToneMap parse_tone(const std::string& text) {
  if (text == "neutral") return ToneMap::kNeutral;
  if (text == "agx") return ToneMap::kAgx;
  if (text == "filmic") return ToneMap::kFilmic;
  throw std::invalid_argument(fmt::format("\"{}\" is neither neutral nor agx nor filmic", text));
}

bool parse_on_off(const std::string& text) {
  if (text != "on" && text != "off")
    throw std::invalid_argument(fmt::format("\"{}\" is neither on nor off", text));
  return text == "on";
}

Background parse_background(const std::string& text) {
  constexpr std::pair<const char*, Background> kNames[] = {
      {"sky", Background::kSky},
      {"grey", Background::kGrey},
      {"white", Background::kWhite},
      {"black", Background::kBlack},
      {"transparent", Background::kTransparent}};
  for (const auto& [name, background] : kNames)
    if (text == name || (text == "gray" && background == Background::kGrey)) return background;
  throw std::invalid_argument(
      fmt::format("\"{}\" is none of sky, grey, white, black and transparent", text));
}

/// Returns whether any light casts shadows with soft edges.
bool has_soft_light(const RenderOptions& options) {
  return (options.with_sun && options.sun_degrees > 0) ||
         std::any_of(options.lights.begin(), options.lights.end(),
                     [](const LightSpec& light) { return light.kind != LightKind::kPoint; });
}

struct ViewOptions {
  Option eye, target, matrix, write_camera;
};

/// Options that win over the file of --view.
using Winners = std::vector<Option>;

ViewOptions add_view_options(const Command& command, RenderArguments& arguments, Winners& winners) {
  ViewRequest& view = arguments.options.view;
  const Option eye = command.parsed("--eye", view.eye, parse_vec3, "X,Y,Z",
                                    "Position of the camera (default: chosen to show the scene)");
  const Option target =
      command.parsed("--target", view.target, parse_vec3, "X,Y,Z",
                     "Point in the centre of the picture (default: chosen to show the scene)");
  const Option up = command.parsed(
      "--up", view.up, parse_direction, "X,Y,Z",
      "Direction that is up (default: y, or z if the shape of the scene shows that z is up)");
  const Option fov = command.optional_number<double>(
      "--fov", view.vertical_fov_degrees, NumberRange::half_open(kMinFovDegrees, 180), "DEGREES",
      "Vertical angle of view, below 180 (default: chosen to show the scene)");
  winners.insert(winners.end(), {eye, target, up, fov});
  const Option matrix = command.text(
      "--camera-matrix", arguments.camera_matrix, "CAMERA.json",
      "Take the camera from matrices: \"camera_to_world\" or \"world_to_camera\" (OpenGL's "
      "convention, or \"convention\": \"opencv\"), and \"fov_y_degrees\", or \"intrinsics\" "
      "with \"height\"");
  for (const Option& option : {eye, target, up, fov}) option.not_with(matrix);
  const Option write_camera =
      command.text("--write-camera", arguments.write_camera, "CAMERA.json",
                   "Write the camera of the picture as matrices, as --camera-matrix reads them");
  return {eye, target, matrix, write_camera};
}

void add_sun_options(const Command& command, RenderOptions& options, Winners& winners) {
  const auto has_sun = [&options] { return options.with_sun; };
  winners.push_back(command
                        .parsed("--sun", options.sun, parse_direction, "X,Y,Z",
                                "Direction towards the sun (default: over the viewer's left "
                                "shoulder; in an interior, "
                                "through an opening)")
                        .only_if(has_sun, "with --no-sun"));
  winners.push_back(command
                        .number("--sun-angle", options.sun_degrees,
                                NumberRange::from(0, RenderLimits::kSunDegrees), "DEGREES",
                                "Angular diameter of the sun; 0: hard shadows")
                        .only_if(has_sun, "with --no-sun"));
  winners.push_back(command.off_switch("--no-sun", options.with_sun, "Turn the sun off"));
}

void add_light_options(const Command& command, RenderArguments& arguments, Winners& winners) {
  RenderOptions& options = arguments.options;
  add_sun_options(command, options, winners);
  command.repeated(
      "--light", options.lights, parse_light, "KIND:...",
      "Add a light: point:X,Y,Z, sphere:X,Y,Z,RADIUS, disc:X,Y,Z,NX,NY,NZ,RADIUS or "
      "rect:X,Y,Z,UX,UY,UZ,VX,VY,VZ, each optionally with ,R,G,B for its colour; repeatable, up to "
      "15 times");
  winners.push_back(command.number("--sky", options.sky, NumberRange::from(0, RenderLimits::kSky),
                                   "FACTOR", "Factor that scales the light of the sky; 0: black"));
  add_environment_option(command, arguments.environment,
                         "Light the scene by this picture of all directions, whose sun casts "
                         "shadows, instead of the clear sky");
  winners.push_back(command
                        .number("--environment-turn", options.environment_degrees,
                                NumberRange::from(-360, 360), "DEGREES",
                                "Turn the environment to the left")
                        .only_if(
                            [&arguments] {
                              return !arguments.environment.empty() || !arguments.view.file.empty();
                            },
                            "without --environment"));
  const auto has_lights = [&options] { return options.with_sun || !options.lights.empty(); };
  winners.push_back(command
                        .off_switch("--no-shadows", options.shadows,
                                    "Turn the shadows of the sun and the lights off")
                        .only_if(has_lights, "without sun and lights"));
  command
      .parsed("--specular", options.specular, parse_specular, "STRENGTH[:EXPONENT]",
              "Add Phong highlights of the sun and the lights: the mirrored part of the light, 0 "
              "to 1, and how small they are, 1 to 10000 (default: 0:20)")
      .only_if(has_lights, "without sun and lights");
  command.off_switch("--no-reflections", options.reflections,
                     "Ignore the channels metallic and roughness (`voxdag build --channel`): all "
                     "surfaces are diffuse");
  command
      .number("--shadow-samples", options.shadow_samples, NumberRange::whole(1, 4096), "N",
              "Shadow rays per pixel and per light with soft edges")
      .only_if([&options] { return options.shadows; }, "with --no-shadows")
      .only_if([&options] { return has_soft_light(options); }, "without a light with soft edges");
}

void add_occlusion_options(const Command& command, RenderOptions& options, Winners& winners) {
  const auto has_occlusion = [&options] { return options.occlusion_samples > 0; };
  winners.push_back(command.number("--ao", options.occlusion_samples,
                                   NumberRange::whole(0, RenderLimits::kOcclusionSamples), "N",
                                   "Ambient occlusion rays per pixel; 0: none"));
  winners.push_back(
      command
          .parsed("--ao-distance", options.occlusion_distance, parse_positive, "LENGTH",
                  "Length of ambient occlusion rays, in world units (default: 0.15 of the "
                  "grid's side, in an interior 0.8)")
          .only_if(has_occlusion, "with --ao 0"));
  winners.push_back(
      command
          .number(
              "--ao-cone", options.occlusion_cone,
              NumberRange::from(0, RenderLimits::kOcclusionCone), "SR",
              "End ambient occlusion rays at cells of this solid angle, such as 0.07: darker, and "
              "faster on rough surfaces; 0: never")
          .only_if(has_occlusion, "with --ao 0"));
  winners.push_back(
      command
          .optional_number<int>(
              "--bounces", options.bounces, NumberRange::whole(0, RenderLimits::kBounces), "N",
              "Trace paths instead of ambient occlusion: exact light of the sky and of "
              "up to N reflections, with --ao paths per pixel; grainy below some "
              "thousand paths")
          .only_if(has_occlusion, "with --ao 0"));
}

void add_quality_options(const Command& command, RenderOptions& options, Winners& winners) {
  command.number("--spp,--samples", options.samples_per_pixel, NumberRange::whole(1, 4096), "N",
                 "Samples per pixel; they share its shadow and occlusion rays");
  winners.push_back(command.number(
      "--lod", options.lod_pixels, NumberRange::from(0, RenderLimits::kLodPixels), "PIXELS",
      "End rays at cells of this size in the picture; 0: always at voxels"));
  command.off_switch("--no-beams", options.beams,
                     "Do not shorten rays by beams: slower, the same picture");
  winners.push_back(command.optional_number<float>(
      "--exposure", options.exposure, NumberRange::positive(), "FACTOR",
      "Factor that scales the light before tone mapping (default: chosen for the picture)"));
  winners.push_back(command.parsed(
      "--tone", options.tone, parse_tone, "neutral|agx|filmic",
      "Curve that maps the light to the display. neutral keeps colours as they are up to bright "
      "ones; agx lets bright colours turn pale; filmic raises the contrast (default: neutral)"));
  winners.push_back(command.parsed(
      "--ground", options.ground, parse_on_off, "on|off",
      "Show the shadow of the scene on a ground under it, except in an interior, a section and "
      "of an ESVO (default: on)"));
  winners.push_back(command.parsed(
      "--background", options.background, parse_background, "sky|grey|white|black|transparent",
      "What the picture shows where nothing is; transparent writes alpha (default: sky)"));
}

Option add_mesh_options(const Command& command, MeshArguments& mesh) {
  const Option file = command.text(
      "--mesh", mesh.file, "MESH",
      "Show the triangles of this mesh, with their colours, textures and normals. The voxels, "
      "which must be built from it, cast shadows and occlusion");
  const auto is_seen = [&mesh] { return mesh.primary != "voxels"; };
  command
      .flag("--grey", mesh.grey,
            "With --mesh: ignore the colours, textures and normals of the mesh")
      .needs(file)
      .only_if(is_seen, "with --primary voxels");
  command.parsed("--primary", mesh.primary, parse_primary, "voxels|mesh",
                 "What the picture shows (default: the mesh if --mesh names one)");
  add_mesh_access_options(command, mesh.access, &file);
  return file;
}

void add_filter_options(const Command& command, RenderArguments& arguments) {
  const auto shows_voxels = [&arguments] { return !arguments.mesh.is_seen(); };
  Winners& winners = arguments.view.winners;
  winners.push_back(
      command
          .number(
              "--cubes", arguments.options.cube_pixels,
              NumberRange::from(0, RenderLimits::kCubePixels), "PIXELS",
              "Show voxels as cubes if they are larger in the picture, and as smooth surfaces "
              "below half of that; 0: always cubes (default for voxels of voxel models and labels)")
          .only_if(shows_voxels, "with --mesh"));
  const Option filter = command
                            .flag("--filter", arguments.filter,
                                  "Smooth voxels that are larger than pixels (default for an ESVO)")
                            .only_if(shows_voxels, "with --mesh");
  const Option kind =
      command
          .parsed("--filter-kind", arguments.filter_kind, parse_filter_kind, "guided|plain|naive",
                  "Smooth voxels that are larger than pixels, but not across surfaces and shadows "
                  "(guided, the default), across them too (plain, as in the ESVO paper), or so "
                  "that seams show where the voxels' size changes (naive)")
          .only_if(shows_voxels, "with --mesh");
  command.flag("--no-filter", arguments.no_filter, "Show every voxel as it is")
      .not_with(filter)
      .not_with(kind);
}

void add_section_options(const Command& command, RenderArguments& arguments) {
  const auto has_no_mesh = [&arguments] { return arguments.mesh.file.empty(); };
  SectionOptions& section = arguments.options.section;
  section.hatch = true;  // As in the page.
  Winners& winners = arguments.view.winners;
  winners.push_back(
      command
          .parsed("--section-box", section.box, parse_box, "X0,Y0,Z0,X1,Y1,Z1",
                  "Show only what is in this box, in world units; not with --mesh. Cut "
                  "faces are hatched, unless --view says \"hatch\": false")
          .only_if(has_no_mesh, "with --mesh"));
  winners.push_back(command
                        .parsed("--section-plane", section.plane, parse_plane, "PX,PY,PZ,NX,NY,NZ",
                                "Remove the side of the plane through the point P to which the "
                                "normal N points, in world units; not with --mesh")
                        .only_if(has_no_mesh, "with --mesh"));
}

void add_path_options(const Command& command, PathArguments& path, const ViewOptions& view) {
  const Option file = command.text(
      "--path", path.file, "KEYS.json",
      "Render a film along this camera path (see `voxdag scene NAME --path`); names of output "
      "files then need a placeholder for the frame number, such as frame_%04d.png, or end in .mp4 "
      "or .webm: then ffmpeg makes a film. Under mpirun or srun, the processes share the frames");
  view.eye.not_with(file);
  view.target.not_with(file);
  view.matrix.not_with(file);
  view.write_camera.not_with(file);
  command
      .number("--fps", path.frames_per_second, NumberRange::up_to(kMaxFramesPerSecond), "N",
              "With --path: frames per second")
      .needs(file);
  command.text("--timings", path.timings, "OUT.csv", "With --path: write the time of each frame")
      .needs(file);
}

}  // namespace

void add_render_options(const Command& command, Session& session, RenderArguments& arguments) {
  RenderOptions& options = arguments.options;
  options.samples_per_pixel = 4;
  options.ground = true;
  arguments.input.with_colors = true;
  add_scene_input(command, arguments.input, session, "The .vdag or .esvo file");
  command.text(
      "-o,--output", arguments.output, "OUT",
      "The picture to write: .png, or .exr for linear light; with --path, a film: .mp4 or .webm. "
      "-: a PNG file on standard output (default: the name of FILE with .png, in the current "
      "folder; it replaces no file)");
  command.parsed("--size", arguments.size, parse_image_size, "WxH",
                 "Width and height in pixels, 1 to 32768 each (default: 1920x1080)");
  Winners& winners = arguments.view.winners;
  const ViewOptions view = add_view_options(command, arguments, winners);
  add_light_options(command, arguments, winners);
  add_occlusion_options(command, options, winners);
  add_quality_options(command, options, winners);
  command.text("--view", arguments.view.file, "SETTINGS.json",
               "Take the camera, the light, the quality and the section from settings that the "
               "viewer saved; other options win over them");
  add_filter_options(command, arguments);
  add_section_options(command, arguments);
  command.text("--depth", arguments.depth, "OUT", "Short for --pass depth=OUT");
  command.text("--normal", arguments.normal, "OUT", "Short for --pass normal=OUT");
  command.repeated("--pass", arguments.passes, parse_pass, "NAME=OUT",
                   "Also write a pass: picture, radiance, depth, normal, albedo, occlusion, "
                   "shadow, voxel, material, steps or steps64 to a .exr or .png file; repeatable");
  const auto shows_voxels = [&arguments] { return !arguments.mesh.is_seen(); };
  add_look_option(command, arguments.look).only_if(shows_voxels, "with --mesh");
  const Option color_by =
      command
          .text("--color-by", arguments.channel, "CHANNEL",
                "Show the values of a channel of the file or --look as colours, from violet for "
                "the least to yellow for the greatest")
          .only_if(shows_voxels, "with --mesh")
          .only_if([&arguments] { return arguments.stream_memory == 0; },
                   "with --memory: ESVOs have no channels");
  command
      .parsed("--range", arguments.channel_range, parse_channel_range, "LEAST,GREATEST",
              "With --color-by: the values of the first and the last colour (default: those of "
              "the channel)")
      .needs(color_by);
  command
      .flag("--materials", arguments.materials,
            "Show each material in a colour of its own, if the file or --look has material ids")
      .only_if(shows_voxels, "with --mesh")
      .only_if([&arguments] { return arguments.stream_memory == 0; },
               "with --memory: ESVOs have no material ids")
      .not_with(color_by);
  add_mesh_options(command, arguments.mesh);
  add_path_options(command, arguments.path, view);
  add_device_option(command, arguments.device);
  command
      .parsed("--memory", arguments.stream_memory, parse_memory, "LIMIT",
              "Stream an ESVO: load only the parts that the picture shows, into this much memory "
              "(512M), with --device cuda of the device. A coarse picture is written first and "
              "replaced by finer ones; with --path, each frame is written once")
      .only_if([&arguments] { return arguments.mesh.file.empty() && arguments.look.empty(); },
               "with --mesh or --look");
  add_threads_option(command, session);
  add_quiet_option(command, session);
}

}  // namespace voxdag::cli

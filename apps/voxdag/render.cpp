/// `voxdag render`: a picture of a .vdag file.
#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <memory>

#include "commands.hpp"
#include "human.hpp"
#include "parse.hpp"
#include "voxdag/cpu/render_image.hpp"
#include "voxdag/file/vdag_file.hpp"
#include "voxdag/image/color.hpp"
#include "voxdag/image/exr.hpp"
#include "voxdag/image/png.hpp"

namespace voxdag {
namespace {

struct RenderArguments {
  std::string output, depth, normal;
  ImageSize size{1920, 1080};
  RenderOptions options;
};

bool has_extension(const std::string& path, std::string_view extension) {
  return std::filesystem::path(path).extension() == extension;
}

ImageF vector_image(const RenderedImage& image, const std::vector<Vec3f>& values) {
  ImageF out(image.width, image.height, 3);
  for (std::size_t i = 0; i < values.size(); ++i)
    for (int axis = 0; axis < 3; ++axis) out.pixels[3 * i + axis] = values[i][axis];
  return out;
}

void write_picture(const std::string& path, const RenderedImage& image) {
  if (has_extension(path, ".exr"))
    return write_exr(path, vector_image(image, image.rgb), {"R", "G", "B"});
  ImageRgb8 png(image.width, image.height);
  for (std::size_t i = 0; i < image.rgb.size(); ++i)
    for (int axis = 0; axis < 3; ++axis)
      png.pixels[3 * i + axis] = linear_to_srgb8(image.rgb[i][axis]);
  write_png(path, png);
}

void write_depth(const std::string& path, const RenderedImage& image) {
  ImageF out(image.width, image.height, 1);
  out.pixels = image.depth;
  write_exr(path, out, {"Z"});
}

void render(RenderArguments& arguments, Session& session) {
  for (const std::string& path : {arguments.output, arguments.depth, arguments.normal})
    if (!path.empty()) check_writable(path);
  const VdagFile file(session.subject);
  arguments.options.width = arguments.size.width;
  arguments.options.height = arguments.size.height;
  const auto start = std::chrono::steady_clock::now();
  const RenderedImage image =
      render_image(file.view(), file.grid(), arguments.options, &session.progress);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  write_picture(arguments.output, image);
  if (!arguments.depth.empty()) write_depth(arguments.depth, image);
  if (!arguments.normal.empty())
    write_exr(arguments.normal, vector_image(image, image.normal), {"N.X", "N.Y", "N.Z"});
  session.bar.clear();
  if (session.quiet) return;
  const View& view = image.view;
  fmt::print("{}: {} x {} pixels in {}, {} rays/s\n", arguments.output, image.width, image.height,
             human_seconds(seconds), human_count(static_cast<double>(image.rays) / seconds));
  fmt::print(
      "  --eye {:.6g},{:.6g},{:.6g} --target {:.6g},{:.6g},{:.6g} --up {:.6g},{:.6g},{:.6g} --fov "
      "{:.6g}\n",
      view.eye.x, view.eye.y, view.eye.z, view.target.x, view.target.y, view.target.z, view.up.x,
      view.up.y, view.up.z, view.vertical_fov_degrees);
}

void require_extension(const std::string& option, const std::string& path,
                       const std::vector<std::string_view>& extensions) {
  for (const std::string_view extension : extensions)
    if (path.empty() || has_extension(path, extension)) return;
  throw CLI::ValidationError(
      option, fmt::format("\"{}\" does not end in {}", path, fmt::join(extensions, " or ")));
}

void add_view_options(CLI::App& command, ViewRequest& view) {
  add_parsed_option(command, "--eye", view.eye, parse_vec3, "X,Y,Z",
                    "Where the camera is (default: where the scene shows well)");
  add_parsed_option(command, "--target", view.target, parse_vec3, "X,Y,Z",
                    "The point in the middle of the picture");
  add_parsed_option(command, "--up", view.up, parse_vec3, "X,Y,Z", "What is up");
  add_parsed_option(command, "--fov", view.vertical_fov_degrees, parse_positive, "DEGREES",
                    "Vertical angle of view");
}

}  // namespace

void add_render_command(CLI::App& app, Session& session) {
  const auto arguments = std::make_shared<RenderArguments>();
  RenderOptions& options = arguments->options;
  CLI::App& command = add_command(app, "render", "Make a picture: sun, sky and shadows",
                                  "voxdag render scene.vdag -o scene.png --size 1920x1080");
  command.add_option("file", session.subject, "The .vdag file")->type_name("FILE")->required();
  command
      .add_option("-o,--output", arguments->output, "The picture: .png, or .exr for linear light")
      ->type_name("OUT")
      ->required();
  add_parsed_option(command, "--size", arguments->size, parse_image_size, "WxH",
                    "Pixels (default 1920x1080)");
  add_view_options(command, options.view);
  add_parsed_option(command, "--sun", options.sun, parse_vec3, "X,Y,Z",
                    "Direction towards the sun (default: over the viewer's left shoulder)");
  command.add_option("--samples", options.samples_per_pixel, "Samples per pixel")
      ->check(CLI::Range(1, 4096))
      ->type_name("N")
      ->capture_default_str();
  command.add_flag("!--no-shadows", options.shade.shadows, "Leave the sun's shadows out");
  command
      .add_option("--lod", options.shade.lod_pixels,
                  "Stop at cells of this many pixels; 0: always at voxels")
      ->check(CLI::Range(0.0, 1000.0))
      ->type_name("PIXELS")
      ->capture_default_str();
  command.add_option("--depth", arguments->depth, "Write the depth along the view, channel Z")
      ->type_name("OUT.exr");
  command.add_option("--normal", arguments->normal, "Write world space normals, N.X N.Y N.Z")
      ->type_name("OUT.exr");
  add_threads_option(command, session);
  add_quiet_option(command, session);
  command.callback([arguments, &session] {
    require_extension("--output", arguments->output, {".png", ".exr"});
    require_extension("--depth", arguments->depth, {".exr"});
    require_extension("--normal", arguments->normal, {".exr"});
    session.work = [arguments, &session] { render(*arguments, session); };
  });
}

}  // namespace voxdag

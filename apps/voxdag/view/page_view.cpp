#include "view/page_view.hpp"

#include <filesystem>

#include "cli/environment_input.hpp"
#include "voxdag/core/io/base64.hpp"
#include "voxdag/cpu/presentation.hpp"
#include "voxdag/cpu/render_image.hpp"
#include "voxdag/image/jpeg_writer.hpp"
#include "voxdag/render/film/environment_json.hpp"
#include "voxdag/render/film/picture_pass.hpp"
#include "voxdag/render/film/view_settings.hpp"
#include "voxdag/stored/attributes/channel_colors.hpp"

namespace voxdag::cli {
namespace {

constexpr int kPosterWidth = 640, kPosterHeight = 360, kPosterQuality = 75;
constexpr SizeLimit kSettingsLimit{std::uint64_t{16} << 20, "a view"};

}  // namespace

std::vector<Option> add_page_view_options(const Command& command, PageViewArguments& arguments) {
  return {command.text("--view", arguments.file, "SETTINGS.json",
                       "What the page shows first: camera, light, section, measures, notes, title "
                       "and licence. The page saves this file; docs/viewer.md lists its keys"),
          command.text("--title", arguments.title, "TEXT",
                       "Title of the page (default: that of --view, else the name of the scene)"),
          add_environment_option(command, arguments.environment,
                                 "Light the scene by this picture of all directions, which the "
                                 "page then holds, instead of the clear sky")};
}

void note_page_view_files(const PageViewArguments& arguments, Session& session) {
  session.inputs.push_back(arguments.file);
  note_environment_file(arguments.environment, session);
}

PageView read_page_view(const PageViewArguments& arguments) {
  nlohmann::json json = {{"version", 1}};
  PageView view;
  if (!arguments.file.empty()) {
    const ViewSettings settings = read_view_settings(arguments.file);
    if (!settings.unknown.empty())
      throw Error(arguments.file, "", "\"" + settings.unknown.front() + "\" is an unknown key");
    json = read_json_file(arguments.file, kSettingsLimit);
    json["version"] = 1;  // which a file may leave out
    view.title = settings.title;
  }
  if (!arguments.title.empty()) json["title"] = view.title = arguments.title;
  const std::string& environment = arguments.environment;
  if (is_built_in_environment(environment))
    json["environment"]["map"] = environment;
  else if (!environment.empty())
    json["environment"]["map"] = environment_json(
        *read_environment(environment), std::filesystem::path(environment).filename().string());
  if (json.size() > 1) view.settings = json.dump();
  return view;
}

std::string render_poster(const PageView& view, const ShownScene& scene, Work work) {
  const ReducedDag& dag = scene.dag();
  ViewSettings settings = parse_view_settings(view.settings.empty() ? "{}" : view.settings, "view");
  RenderOptions& options = settings.options;
  options.width = kPosterWidth;
  options.height = kPosterHeight;
  options.samples_per_pixel = 4;
  const Presentation& presentation = dag.metadata().presentation;
  show_as(presentation, options.view);
  if (presentation.cubes && options.cube_pixels == RenderOptions{}.cube_pixels)
    options.cube_pixels = 0;
  DagAttributesView attributes = dag.attributes();
  if (!settings.colors) attributes.colors = {};
  ValuePages colors;
  if (const std::size_t i = attributes.channels.find(settings.channel);
      i < attributes.channels.count()) {
    const ChannelView channel = attributes.channels[i];
    colors = channel_colors(
        channel, settings.channel_range ? *settings.channel_range : range_of(channel), work);
    attributes.colors = colors.view();
    // Colours that stand for numbers are no colours of metals.
    options.reflections = false;
  }
  if (!settings.normals) attributes.normals = {};
  options.look = ColoredDagView{dag.dag(), attributes};
  const CpuScene voxels(dag.dag());
  const RenderedImage image = render_image(voxels, dag.metadata().grid, options, work);
  return "data:image/jpeg;base64," +
         base64(encode_jpeg(find_picture_kind("picture")->shown(image), kPosterQuality));
}

}  // namespace voxdag::cli

/// `voxdag render`: renders a picture or film of a .vdag or .esvo file.
#include <fmt/core.h>

#include <memory>

#include "cli/commands.hpp"
#include "cli/job.hpp"
#include "cli/look_input.hpp"
#include "cli/stopwatch.hpp"
#include "render/look_on_device.hpp"
#include "render/picture_summary.hpp"
#include "render/render_arguments.hpp"
#include "render/render_film.hpp"
#include "render/render_mesh.hpp"
#include "render/render_streamed.hpp"
#include "voxdag/core/io/atomic_file.hpp"
#include "voxdag/core/number_text.hpp"
#include "voxdag/cpu/presentation.hpp"
#include "voxdag/cpu/render_image.hpp"
#include "voxdag/cuda/render_image.hpp"
#include "voxdag/file/model/scene_model.hpp"
#include "voxdag/render/film/camera_file.hpp"
#include "voxdag/render/film/frame_names.hpp"

namespace voxdag::cli {
namespace {

void render_loaded(const RenderArguments& arguments, Session& session) {
  SceneModel file(session.subject, &session.progress);
  const VoxelSet scene = file.voxels();
  RenderOptions options = picture_options(arguments, scene.esvo() != nullptr);
  show_as(file.metadata().presentation, options.view);
  const bool is_usual_size = options.cube_pixels == RenderOptions{}.cube_pixels;
  if (file.metadata().presentation.cubes && is_usual_size && !arguments.view.has("--cubes"))
    options.cube_pixels = 0;
  std::optional<SceneModel> look = open_look(arguments.look, file, session);
  if (arguments.materials && look)
    look->show_materials(arguments.look, &session.progress);
  else if (arguments.materials)
    file.show_materials(session.subject, &session.progress);
  if (!arguments.channel.empty()) {
    const ChannelRange range =
        (look ? *look : file)
            .show_channel(look ? arguments.look : session.subject, arguments.channel,
                          arguments.channel_range, &session.progress);
    if (!arguments.channel_range && !session.quiet)
      fmt::print(stderr, "{}: {} (violet) to {} (yellow)\n", arguments.channel,
                 number_text(range.least), number_text(range.most));
  }
  std::optional<DeviceScene> device_scene = load_on_chosen_device(arguments.device, scene);
  const LookOnDevice look_on_device(arguments.device, look ? *look : file, !look, device_scene);
  options.look = look_on_device.view();
  // --materials, which shows materials as colours, wins over the file of --view.
  if (!arguments.view.colors && !arguments.materials && arguments.channel.empty())
    options.look.dag.attributes.colors = {};
  if (!arguments.view.normals) options.look.dag.attributes.normals = {};
  // Colours that stand for numbers do not tint metals.
  if (arguments.materials || !arguments.channel.empty()) options.reflections = false;
  if (options.with_material) options.materials = (look ? *look : file).colored_dag();
  std::optional<CpuScene> cpu_scene;
  if (!device_scene) cpu_scene.emplace(scene);
  const std::unique_ptr<ViewSource> source =
      open_view_source(arguments.mesh, options.albedo, scene, file.grid(), session);
  const auto render = [&](const RenderOptions& of_picture, Work work) {
    if (device_scene)
      return render_image(*device_scene, file.grid(), of_picture, work, source.get());
    return render_image(*cpu_scene, file.grid(), of_picture, work, source.get());
  };
  if (!arguments.path.file.empty())
    return render_film(arguments, {scene, file.grid(), render, {}}, options, session);
  const Stopwatch watch;
  const RenderedImage image = render(options, &session.progress);
  const double seconds = watch.since_start();
  for (const PicturePass& pass : all_passes(arguments)) write_pass(*pass.kind, pass.path, image);
  if (!arguments.write_camera.empty())
    write_whole_file(arguments.write_camera, camera_json(image.view, image.width, image.height));
  session.bar.clear();
  if (!session.quiet)
    print_picture_summary(arguments.output, image, seconds, device_name(device_scene),
                          is_up_guessed(options.view, file.metadata().presentation));
}

void render(RenderArguments& arguments, Session& session) {
  const bool is_film = !arguments.path.file.empty();
  const bool is_first = !is_film || join_job(session).is_first();
  apply_view_file(arguments, session);
  read_render_files(arguments);
  if (is_first)
    for (const PicturePass& pass : all_passes(arguments)) check_writable(frame_name(pass.path, 0));
  if (arguments.stream_memory == 0) return render_loaded(arguments, session);
  render_streamed(arguments, session);
}

}  // namespace

void add_render_command(const Command& program, Session& session) {
  const auto arguments = std::make_shared<RenderArguments>();
  const Command command = program.add(
      "render", "Render a picture with sun, sky, shadows and ambient occlusion",
      "voxdag render scene.vdag -o scene.png --size 1920x1080\n"
      "  voxdag render scene.vdag -o scene.exr --eye 8,3,0 --target 0,3,0 --fov 60 --pass "
      "depth=z.exr\n"
      "  voxdag render scene.vdag -o lamp.png --no-sun --sky 0.1 --light sphere:0,3,0,0.2\n"
      "  voxdag render scene.vdag --mesh scene.obj -o triangles.png\n"
      "  voxdag render helmet.gltf -r 2048 -o helmet.png\n"
      "  voxdag render scene.vdag --path flight.json -o frame_%04d.png\n"
      "  voxdag render scene.vdag --path flight.json -o flight.mp4\n\n"
      "The command chooses each value that you do not give so that the picture shows the "
      "scene well. It prints the view and the exposure as options that give the same "
      "picture again. A scene without ground, such as a plant in the air, does not show "
      "which way is up: give --up 0,0,1 if z is up.");
  add_render_options(command, session, *arguments);
  command.when_parsed([arguments, &session] {
    check_render_arguments(*arguments, session);
    session.work = [arguments, &session] {
      work_on_scene(arguments->input, session, [&] { render(*arguments, session); });
    };
  });
}

}  // namespace voxdag::cli

/// `voxdag render`: a picture of a .vdag or .esvo file.
#include <chrono>
#include <memory>

#include "cli/commands.hpp"
#include "cli/device.hpp"
#include "render/frame_names.hpp"
#include "render/render_arguments.hpp"
#include "render/render_mesh.hpp"
#include "render/render_passes.hpp"
#include "render/render_path.hpp"
#include "render/render_streamed.hpp"
#include "render/render_summary.hpp"
#include "voxdag/cpu/render_image.hpp"
#include "voxdag/cuda/render_image.hpp"
#include "voxdag/file/scene_file.hpp"

namespace voxdag {
namespace {

void render(RenderArguments& arguments, Session& session) {
  const std::vector<RenderPass> passes = all_passes(arguments);
  for (const RenderPass& pass : passes) {
    check_writable(frame_name(pass.path, 0));
    if (pass.name == "steps") arguments.options.with_steps = true;
  }
  if (arguments.stream_memory != 0) {
    if (!is_esvo_file(session.subject))
      throw Error(session.subject, "", "--memory is for an ESVO, and this is a DAG");
    arguments.options.width = arguments.size.width;
    arguments.options.height = arguments.size.height;
    arguments.options.filter = arguments.filter.value_or(true);
    return render_streamed(arguments, passes, session);
  }
  const SceneFile file(session.subject);
  const VoxelSet scene = file.voxels();
  arguments.options.width = arguments.size.width;
  arguments.options.height = arguments.size.height;
  arguments.options.filter = arguments.filter.value_or(scene.esvo() != nullptr);
  const std::optional<DeviceScene> device_dag = load_on_device(arguments.device, scene);
  std::optional<CpuScene> cpu_scene;
  if (!device_dag) cpu_scene.emplace(scene);
  const std::unique_ptr<ViewSource> source =
      open_view_source(arguments.mesh, arguments.options.albedo, scene, file.grid(), session);
  const auto render_frame = [&](const RenderOptions& options, Progress* progress) {
    if (device_dag) return render_image(*device_dag, file.grid(), options, progress, source.get());
    return render_image(*cpu_scene, file.grid(), options, progress, source.get());
  };
  if (!arguments.path.file.empty())
    return render_path(scene, file.grid(), arguments.options, arguments.path,
                       {render_frame, passes, {}}, session);
  const auto start = std::chrono::steady_clock::now();
  const RenderedImage image = render_frame(arguments.options, &session.progress);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  for (const RenderPass& pass : passes) write_pass(pass, image);
  session.bar.clear();
  if (!session.quiet) print_summary(arguments.output, image, seconds, device_name(device_dag));
}

}  // namespace

void add_render_command(CLI::App& app, Session& session) {
  const auto arguments = std::make_shared<RenderArguments>();
  CLI::App& command =
      add_command(app, "render", "Make a picture: sun, sky, shadows and ambient occlusion",
                  "voxdag render scene.vdag -o scene.png --size 1920x1080");
  add_render_options(command, session, *arguments);
  command.callback([arguments, &session] {
    check_render_arguments(*arguments, session);
    session.work = [arguments, &session] { render(*arguments, session); };
  });
}

}  // namespace voxdag

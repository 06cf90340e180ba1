/// `voxdag trace`: casts the rays of a NumPy array and writes their hits to another array.
#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "cli/commands.hpp"
#include "cli/device.hpp"
#include "cli/look_input.hpp"
#include "cli/output_files.hpp"
#include "cli/usage_error.hpp"
#include "trace/hit_rows.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/with_file_name.hpp"
#include "voxdag/cpu/trace_batch.hpp"
#include "voxdag/cuda/trace_batch.hpp"
#include "voxdag/file/compact_file.hpp"
#include "voxdag/file/model/scene_model.hpp"
#include "voxdag/file/npy.hpp"
#include "voxdag/file/report/human.hpp"

namespace voxdag::cli {
namespace {

/// The number of rays in memory at a time: enough for all threads of a CPU or GPU.
constexpr std::size_t kRaysPerBatch = std::size_t{1} << 20;

struct TraceArguments {
  std::string rays, output, look;
  bool in_place = false;
  DeviceChoice device;
};

/// Casts all rays of the file with cast(rays, hits) and writes the hits. Returns a line with the
/// numbers of rays and hits.
template <class Cast>
std::string trace_rays(const TraceArguments& arguments, const HitRows& hit_rows, NpyReader& reader,
                       const std::string& device, Session& session, const Cast& cast) {
  NpyWriter writer(arguments.output, hit_rows.dtype(), {}, hit_rows.row_bytes(), reader.rows());
  const std::size_t batch =
      static_cast<std::size_t>(std::min<std::uint64_t>(kRaysPerBatch, reader.rows()));
  std::vector<Ray> rays(batch);
  std::vector<Hit> hits(batch);
  std::vector<std::byte> rows(batch * hit_rows.row_bytes());
  std::uint64_t hit_count = 0;
  while (const std::size_t count = reader.read_rows(rays.data(), batch)) {
    session.progress.throw_if_cancelled();
    const auto batch_hits = std::span(hits).first(count);
    cast(std::span<const Ray>(rays).first(count), batch_hits);
    hit_rows.pack(batch_hits, rows.data());
    hit_count += static_cast<std::uint64_t>(
        std::count_if(hits.begin(), hits.begin() + static_cast<std::ptrdiff_t>(count),
                      [](const Hit& hit) { return hit.hit; }));
    writer.write_rows(rows.data(), count);
    session.progress.report(
        "trace", static_cast<double>(writer.rows_written()) / static_cast<double>(reader.rows()),
        writer.rows_written());
  }
  writer.commit();
  return fmt::format("{}: {} rays, {} hits, on {}\n", arguments.output, with_commas(reader.rows()),
                     with_commas(hit_count), device);
}

NpyReader ray_reader(const TraceArguments& arguments) {
  return NpyReader(arguments.rays, "<f4", {8}, sizeof(float));
}

std::string trace_scene(const TraceArguments& arguments, Session& session) {
  const SceneModel file(session.subject, &session.progress);
  const VoxelSet scene = file.voxels();
  const std::optional<SceneModel> look = open_look(arguments.look, file, session);
  const std::optional<DeviceScene> device_scene = load_on_chosen_device(arguments.device, scene);
  std::optional<CudaTracer> cuda;
  if (device_scene) cuda.emplace(*device_scene, file.grid());
  NpyReader reader = ray_reader(arguments);
  std::optional<CpuScene> cpu_scene;
  if (!cuda) cpu_scene.emplace(scene, reader.rows());
  const HitRows hit_rows(scene.levels(), look_of(look ? *look : file));
  return trace_rays(arguments, hit_rows, reader, device_name(device_scene), session,
                    [&](std::span<const Ray> rays, std::span<Hit> hits) {
                      if (cuda)
                        cuda->trace(rays, hits);
                      else
                        trace_batch(*cpu_scene, file.grid(), rays, hits);
                    });
}

/// Opens the file in the compact form. Throws Error if it has another form.
CompactFile compact_file(const std::string& path) {
  VdagContainer opened(path);
  if (opened.kind() != VdagKind::kCompact)
    throw Error(path, "", "does not have the compact form, which --in-place needs");
  CompactFile file(std::move(opened));
  if (file.view().levels < 4)
    throw Error(path, "", "has a grid of fewer than 16³ voxels, too few for --in-place");
  return file;
}

InPlaceDag open_in_place(const CompactFile& file, Session& session) {
  return with_file_name(session.subject, [&] {
    return InPlaceDag(file.view(), InPlaceDag::kCachedUnits, &session.progress);
  });
}

std::string trace_in_place(const TraceArguments& arguments, Session& session) {
  const CompactFile file = compact_file(session.subject);
  const InPlaceDag dag = open_in_place(file, session);
  NpyReader reader = ray_reader(arguments);
  return trace_rays(arguments, HitRows(dag.levels(), {}), reader, "the CPU", session,
                    [&](std::span<const Ray> rays, std::span<Hit> hits) {
                      trace_batch(dag, file.grid(), rays, hits);
                    });
}

void trace(const TraceArguments& arguments, Session& session) {
  const std::string done =
      arguments.in_place ? trace_in_place(arguments, session) : trace_scene(arguments, session);
  session.bar.clear();
  if (!session.quiet) fmt::print("{}", done);
}

}  // namespace

void add_trace_command(const Command& program, Session& session) {
  const auto arguments = std::make_shared<TraceArguments>();
  const Command command =
      program.add("trace", "Cast rays from a NumPy file and write what they hit",
                  "voxdag trace scene.vdag --rays rays.npy -o hits.npy\n\n"
                  "t is measured in lengths of the ray's direction. Hits, normals and colours are "
                  "equal on every device, to the bit. Without --in-place, a file in the compact "
                  "form is decoded when it is opened.");
  command.text("file", session.subject, "FILE", "The .vdag or .esvo file").required();
  command
      .text("--rays", arguments->rays, "RAYS.npy",
            "float32 array of shape (N, 8): origin, t_min, direction, t_max, in world units")
      .required();
  command
      .text("-o,--output", arguments->output, "HITS.npy",
            "Structured array of shape (N,): t, voxel, face (0 to 5: -x, +x, -y, +y, -z, +z; -1: "
            "the ray starts inside), hit; if the scene or --look stores normals, colours or "
            "materials, also normal (world space), color (sRGB, 0 to 255) or material (65535: "
            "none); and each channel under its name")
      .required();
  const Option look = add_look_option(command, arguments->look);
  command
      .flag("--in-place", arguments->in_place,
            "Cast at a file in the compact form without decoding it, on the CPU: takes less memory "
            "and more time, and writes no normals, colours, materials and channels")
      .not_with(look);
  add_device_option(command, arguments->device);
  add_threads_option(command, session);
  add_quiet_option(command, session);
  command.when_parsed([arguments, &session] {
    session.inputs = {arguments->rays, arguments->look};
    check_distinct({{"--output", arguments->output}}, session);
    if (arguments->in_place && arguments->device.kind == DeviceChoice::Kind::kCuda)
      throw UsageError("--in-place", "casts on the CPU, not on a CUDA device");
    session.work = [arguments, &session] { trace(*arguments, session); };
  });
}

}  // namespace voxdag::cli

/// `voxdag export`: the voxels in the formats of other programs.
#include "voxdag/file/export.hpp"

#include <memory>

#include "cli/commands.hpp"
#include "cli/output_files.hpp"
#include "cli/parse.hpp"
#include "voxdag/file/scene_file.hpp"

namespace voxdag {
namespace {

struct ExportArguments {
  std::string output;
  ExportOptions options;
  bool faces = false;
};

void export_file(ExportArguments& arguments, Session& session) {
  const SceneFile file(session.subject);
  const VoxelSet voxels = file.voxels();
  // Of an ESVO's leaves nobody knows before how many voxels they stand for.
  std::uint64_t count = 0;
  const Box3i window = arguments.options.window.value_or(whole_grid(voxels.levels()));
  voxels.for_each_leaf_block(window, [&](Vec3i, std::uint64_t mask) {
    count += static_cast<std::uint64_t>(popcount64(mask));
  });
  arguments.options.progress = [&session, count](std::uint64_t done) {
    session.progress.throw_if_cancelled();
    session.progress.report("export", static_cast<double>(done) / static_cast<double>(count), done);
  };
  export_voxels(arguments.output, voxels, file.grid(),
                arguments.faces ? PlyContent::kFaces : PlyContent::kPoints, arguments.options);
}

}  // namespace

void add_export_command(CLI::App& app, Session& session) {
  const auto arguments = std::make_shared<ExportArguments>();
  CLI::App& command =
      add_command(app, "export", "Write the voxels as .npy, .ply or .raw, by the extension",
                  "voxdag export scene.vdag -o voxels.npy");
  command.add_option("file", session.subject, "The .vdag or .esvo file")
      ->type_name("FILE")
      ->required();
  command
      .add_option("-o,--output", arguments->output,
                  ".npy: coordinates, or dense bytes with --window; .ply: points, or with --faces "
                  "the outer faces of cubes; .raw: dense bytes")
      ->type_name("OUT")
      ->required();
  add_parsed_option(command, "--window", arguments->options.window, parse_window,
                    "X0,Y0,Z0,X1,Y1,Z1", "Only these voxels; the last corner is one past the end");
  command.add_flag("--faces", arguments->faces, "For .ply: the outer faces of the voxels");
  add_quiet_option(command, session);
  command.callback([arguments, &session] {
    if (arguments->faces && !arguments->output.ends_with(".ply"))
      throw CLI::ValidationError("--faces", "is for an output that ends in .ply");
    check_distinct({{"--output", arguments->output}, {"--output", arguments->output + ".json"}},
                   session);
    session.work = [arguments, &session] { export_file(*arguments, session); };
  });
}

}  // namespace voxdag

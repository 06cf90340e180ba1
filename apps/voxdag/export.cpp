/// `voxdag export`: the voxels in the formats of other programs.
#include "voxdag/file/export.hpp"

#include <memory>

#include "commands.hpp"
#include "parse.hpp"
#include "voxdag/file/vdag_file.hpp"

namespace voxdag {
namespace {

struct ExportArguments {
  std::string output;
  ExportOptions options;
  bool faces = false;
};

void export_file(ExportArguments& arguments, Session& session) {
  const VdagFile file(session.subject);
  const double voxels = static_cast<double>(file.metadata().counts.voxels);
  arguments.options.progress = [&session, voxels](std::uint64_t done) {
    session.progress.throw_if_cancelled();
    session.progress.report("export", static_cast<double>(done) / voxels, done);
  };
  export_voxels(arguments.output, file.view(), file.grid(),
                arguments.faces ? PlyContent::kFaces : PlyContent::kPoints, arguments.options);
}

}  // namespace

void add_export_command(CLI::App& app, Session& session) {
  const auto arguments = std::make_shared<ExportArguments>();
  CLI::App& command =
      add_command(app, "export", "Write the voxels as .npy, .ply or .raw, by the extension",
                  "voxdag export scene.vdag -o voxels.npy");
  command.add_option("file", session.subject, "The .vdag file")->type_name("FILE")->required();
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
    session.work = [arguments, &session] { export_file(*arguments, session); };
  });
}

}  // namespace voxdag

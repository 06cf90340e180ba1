/// `voxdag export`: writes the voxels in the formats of other programs.
#include "voxdag/file/export.hpp"

#include <memory>
#include <optional>

#include "cli/commands.hpp"
#include "cli/look_input.hpp"
#include "cli/output_files.hpp"
#include "cli/parse.hpp"
#include "cli/scene_input.hpp"

namespace voxdag {
namespace {

struct ExportArguments {
  std::string output, look;
  bool grey = false;
  ExportOptions options;
  bool faces = false;
};

void export_file(ExportArguments& arguments, Session& session) {
  const SceneInput file(session.subject, &session.progress);
  const VoxelSet voxels = file.voxels();
  arguments.options.progress = [&session](double fraction, std::uint64_t done) {
    session.progress.throw_if_cancelled();
    session.progress.report("export", fraction, done);
  };
  const std::optional<SceneInput> look = open_look(arguments.look, file, session);
  if (!arguments.grey) arguments.options.look = look_of(look ? *look : file);
  export_voxels(arguments.output, voxels, file.grid(),
                arguments.faces ? PlyContent::kFaces : PlyContent::kPoints, arguments.options);
}

}  // namespace

void add_export_command(const Command& program, Session& session) {
  const auto arguments = std::make_shared<ExportArguments>();
  const Command command = program.add("export", "Write the voxels as .npy, .ply or .raw",
                                      "voxdag export scene.vdag -o voxels.npy");
  command.text("file", session.subject, "FILE", "The .vdag or .esvo file").required();
  command
      .text("-o,--output", arguments->output, "OUT",
            ".npy: coordinates, or a dense array with --window; .ply: points, or with --faces the "
            "outer faces of the voxels; .raw: a dense array")
      .required();
  command.parsed(
      "--window", arguments->options.window, parse_window, "X0,Y0,Z0,X1,Y1,Z1",
      "Export only the voxels from the first corner (included) to the second (excluded)");
  command
      .flag("--faces", arguments->faces,
            "With .ply: write the outer faces of the voxels, not points")
      .only_if([arguments] { return arguments->output.ends_with(".ply"); },
               "on an output that does not end in .ply");
  const auto carries_look = [arguments] {
    return arguments->output.ends_with(".ply") ||
           (arguments->output.ends_with(".npy") && !arguments->options.window);
  };
  constexpr const char* kCarriesNone =
      "on an output that cannot hold colours, normals and materials";
  const Option look = add_look_option(command, arguments->look).only_if(carries_look, kCarriesNone);
  command
      .flag(
          "--grey", arguments->grey,
          "Leave out colours, normals and materials: an .npy file is a plain array of coordinates")
      .only_if(carries_look, kCarriesNone)
      .not_with(look);
  add_quiet_option(command, session);
  command.when_parsed([arguments, &session] {
    session.inputs = {arguments->look};
    check_distinct({{"--output", arguments->output}, {"--output", arguments->output + ".json"}},
                   session);
    session.work = [arguments, &session] { export_file(*arguments, session); };
  });
}

}  // namespace voxdag

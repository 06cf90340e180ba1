/// `voxdag export`: writes the voxels in the formats of other programs, or as a page of the viewer.
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "cli/commands.hpp"
#include "cli/look_input.hpp"
#include "cli/output_files.hpp"
#include "cli/parse.hpp"
#include "cli/scene_input.hpp"
#include "view/export_page.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/exports/export_voxels.hpp"

namespace voxdag {
namespace {

struct ExportArguments {
  std::string output, look;
  bool grey = false;
  ExportOptions options;
  bool faces = false;
  ShownSceneArguments page;

  bool is_page() const { return is_page_output(output); }
};

/// Throws Error, before the file is read, if no output has this extension.
void check_extension(const std::string& output) {
  if (!can_export_to(output))
    throw Error(output, "",
                "cannot export to '" + std::filesystem::path(output).extension().string() +
                    "': the extension must be .npy, .ply, .raw or .html; a folder ends in /");
}

void export_file(ExportArguments& arguments, Session& session) {
  if (arguments.is_page()) return export_page(arguments.output, arguments.page, session);
  check_extension(arguments.output);
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

void add_page_options(const Command& command, ExportArguments& arguments) {
  std::vector<Option> options = add_reduction_options(command, arguments.page.reduction);
  options.push_back(add_memory_option(command, arguments.page.memory_limit));
  for (const Option& option : options)
    option.in_group("Options for pages only (.html, FOLDER/)")
        .only_if([&arguments] { return arguments.is_page(); },
                 "on an output that is neither .html nor a folder");
}

void check_outputs(const ExportArguments& arguments, const Session& session) {
  if (arguments.is_page()) return check_page_output(arguments.output, session);
  check_distinct({{"--output", arguments.output}, {"--output", arguments.output + ".json"}},
                 session);
}

}  // namespace

void add_export_command(const Command& program, Session& session) {
  const auto arguments = std::make_shared<ExportArguments>();
  const Command command = program.add(
      "export", "Write the voxels as .npy, .ply or .raw, or as a page that shows them",
      "voxdag export scene.vdag -o voxels.npy\n  voxdag export scene.vdag -o scene.html");
  command.text("file", session.subject, "FILE", "The .vdag or .esvo file").required();
  command
      .text("-o,--output", arguments->output, "OUT",
            ".npy: coordinates, or a dense array with --window; .ply: points, or with --faces the "
            "outer faces of the voxels; .raw: a dense array; .html: a page in one file that shows "
            "a DAG, also offline; FOLDER/: the page and the scene, for any web server")
      .required();
  command
      .parsed("--window", arguments->options.window, parse_window, "X0,Y0,Z0,X1,Y1,Z1",
              "Export only the voxels from the first corner (included) to the second (excluded)")
      .only_if([arguments] { return !arguments->is_page(); }, "on a page");
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
  add_page_options(command, *arguments);
  add_quiet_option(command, session);
  command.when_parsed([arguments, &session] {
    session.inputs = {arguments->look};
    check_outputs(*arguments, session);
    session.work = [arguments, &session] { export_file(*arguments, session); };
  });
}

}  // namespace voxdag

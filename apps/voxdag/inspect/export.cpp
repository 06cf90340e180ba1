/// `voxdag export`: writes the voxels in the formats of other programs, or as a page of the viewer.
#include <fmt/core.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "cli/commands.hpp"
#include "cli/look_input.hpp"
#include "cli/output_files.hpp"
#include "cli/parse.hpp"
#include "view/export_page.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/io/process_memory.hpp"
#include "voxdag/file/model/scene_model.hpp"
#include "voxdag/formats/exports/export_voxels.hpp"
#include "voxdag/formats/exports/grids/export_slices.hpp"

namespace voxdag::cli {
namespace {

struct ExportArguments {
  std::string output, look;
  bool grey = false;
  ExportOptions options;
  ExportContent content;
  std::optional<int> slices;  ///< Axis.
  ShownSceneArguments page;

  bool is_vdb() const { return !slices && (output.ends_with(".vdb") || output.ends_with(".nvdb")); }
  bool is_page() const { return !slices && is_page_output(output); }
  bool carries_colors() const {
    return slices || export_has_colors(output, options.window.has_value());
  }
};

/// Throws Error, before the file is read, if no output has this extension.
void check_extension(const std::string& output) {
  if (!can_export_to(output))
    throw Error(
        output, "",
        fmt::format("cannot export to '{}': the extension must be {}, or .html; a folder "
                    "ends in /",
                    std::filesystem::path(output).extension().string(), export_extensions()));
}

void export_file(ExportArguments& arguments, Session& session) {
  if (arguments.is_page()) return export_page(arguments.output, arguments.page, session);
  if (!arguments.slices) {
    check_extension(arguments.output);
    check_writable(arguments.output);
  } else if (can_export_to(arguments.output) || arguments.output.ends_with(".html")) {
    throw Error(arguments.output, "", "is the name of a file, and --slices writes a folder");
  }
  const SceneModel file(session.subject, &session.progress);
  const VoxelSet voxels = file.voxels();
  arguments.options.progress = [&session](double fraction, std::uint64_t done) {
    session.progress.throw_if_cancelled();
    session.progress.report("export", fraction, done);
  };
  const std::optional<SceneModel> look = open_look(arguments.look, file, session);
  MemoryBudget memory = command_budget(arguments.page.memory_limit);
  arguments.options.memory = &memory;
  if (!arguments.grey) arguments.options.look = look_of(look ? *look : file);
  if (arguments.slices)
    return export_slices(arguments.output, *arguments.slices, voxels, file.grid(),
                         arguments.options);
  const std::vector<std::filesystem::path> files =
      export_voxels(arguments.output, voxels, file.grid(), arguments.content, arguments.options);
  session.bar.clear();
  if (files.size() == 1 || session.quiet) return;
  for (const std::filesystem::path& part : files) fmt::print("{}\n", part.string());
}

void add_page_options(const Command& command, ExportArguments& arguments) {
  for (const Option& option : add_reduction_options(command, arguments.page.reduction))
    option.in_group("Options for pages only (.html, FOLDER/)")
        .only_if([&arguments] { return arguments.is_page(); },
                 "on an output that is neither .html nor a folder");
  add_memory_option(command, arguments.page.memory_limit)
      .only_if(
          [&arguments] { return arguments.is_page() || arguments.is_vdb(); },
          "on an output that is neither a page nor .vdb or .nvdb: others take less than 100 MB");
}

void check_outputs(const ExportArguments& arguments, const Session& session) {
  if (arguments.is_page()) return check_page_output(arguments.output, session);
  std::string beside = arguments.output + ".json";
  if (arguments.output.ends_with(".voxel.json"))
    beside = arguments.output.substr(0, arguments.output.size() - 4) + "bin";
  check_distinct({{"--output", arguments.output}, {"--output", beside}}, session);
}

}  // namespace

void add_export_command(const Command& program, Session& session) {
  const auto arguments = std::make_shared<ExportArguments>();
  const Command command = program.add(
      "export", "Write the voxels in the formats of other programs, or as a page that shows them",
      "voxdag export scene.vdag -o scene.glb\n"
      "  voxdag export scene.vdag -o cubes.ply --faces\n"
      "  voxdag export scene.vdag -o part.raw --window 0,0,0,512,512,512\n"
      "  voxdag export solid.vdag -o layers/ --slices z\n"
      "  voxdag export scene.vdag -o scene.html\n"
      "  voxdag export scene.vdag -o site/\n\n"
      "An ESVO exports its voxels of the finest level. The outputs have the colours of the file, "
      "or "
      "of --look, as far as their formats can. Formats that cannot hold a place in the world come "
      "with OUT.json, which has it.\n\n"
      "A page shows the whole DAG with its colours and normals; --levels, --color-bound, "
      "--normal-bound and --drop-attributes make it smaller. The command prints its size, and "
      "warns "
      "if an .html file has more than 64 MiB: a browser reads such a file completely, but reads "
      "only "
      "the levels that it shows from a folder.\n\n"
      "A folder that exists is replaced as a whole, and only if it has no files but those of an "
      "older "
      "page. It stays if the export fails. `kill -9`, or a second Ctrl-C, can leave the unfinished "
      "folder OUT.voxdag-PID-N.");
  command.text("file", session.subject, "FILE", "The .vdag or .esvo file").required();
  command
      .text("-o,--output", arguments->output, "OUT",
            "Outer faces: .glb, .obj, .stl, or .ply with --faces. Points: .ply. Voxels: .vox "
            "(MagicaVoxel), .vdb, .nvdb, .binvox, .schem (Minecraft), .voxel.json (PlayCanvas). "
            "Arrays: .npy "
            "(coordinates, or dense with --window), .raw (dense), .spc.npy (kaolin). With "
            "--slices: a folder. Pages that show a DAG: .html (one "
            "file, also offline) or FOLDER/ (with the scene, for any web server)")
      .required();
  const auto is_no_page = [arguments] { return !arguments->is_page(); };
  command
      .parsed("--window", arguments->options.window, parse_window, "X0,Y0,Z0,X1,Y1,Z1",
              "Export only the voxels from the first corner (included) to the second (excluded)")
      .only_if(is_no_page, "on a page");
  const Option faces = command
                           .flag("--faces", arguments->content.ply_faces,
                                 "With .ply: write the outer faces of the voxels, not points")
                           .only_if([arguments] { return arguments->output.ends_with(".ply"); },
                                    "on an output that does not end in .ply");
  command
      .parsed("--slices", arguments->slices, parse_axis, "AXIS",
              "Write a folder of PNG files, one for each layer along x, y or z: slice_0000.png and "
              "so on")
      .not_with(faces);
  const auto carries_look = [arguments] { return arguments->carries_colors(); };
  constexpr const char* kCarriesNone = "on an output that cannot hold colours";
  const Option look = add_look_option(command, arguments->look)
                          .only_if(is_no_page, "on a page")
                          .only_if(carries_look, kCarriesNone);
  command
      .flag("--grey", arguments->grey,
            "Leave out colours, normals and materials: an .npy file is a plain array of "
            "coordinates, and .glb and .obj merge faces to larger rectangles")
      .only_if(is_no_page, "on a page: see --drop-attributes")
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

}  // namespace voxdag::cli

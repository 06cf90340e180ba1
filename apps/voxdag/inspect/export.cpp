/// `voxdag export`: writes the voxels in the formats of other programs, or as a page of the viewer.
#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <optional>
#include <stdexcept>
#include <vector>

#include "cli/commands.hpp"
#include "cli/look_input.hpp"
#include "cli/output_files.hpp"
#include "cli/parse.hpp"
#include "cli/scene_input.hpp"
#include "cli/written_files.hpp"
#include "view/export_page.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/io/process_memory.hpp"
#include "voxdag/core/lower_case.hpp"
#include "voxdag/file/model/scene_model.hpp"
#include "voxdag/formats/exports/count_voxels.hpp"
#include "voxdag/formats/exports/export_scene.hpp"
#include "voxdag/formats/exports/grids/export_slices.hpp"

namespace voxdag::cli {
namespace {

struct ExportArguments {
  SceneInput input;
  std::string output, look;
  bool grey = false, watertight = false, manifold = false, smooth = false, merge = false;
  ExportOptions options;
  ExportContent content;
  std::optional<int> slices;  ///< Axis.
  ShownSceneArguments page;
  PageViewArguments page_view;

  /// Returns the output with the extension of its format, in lower case.
  std::string name() const {
    return lower_case(content.format.empty() ? output : "out." + content.format);
  }
  bool has_ending(std::initializer_list<const char*> endings) const {
    return !slices && std::any_of(endings.begin(), endings.end(),
                                  [&](const char* ending) { return name().ends_with(ending); });
  }
  bool is_vdb() const { return has_ending({".vdb", ".nvdb"}); }
  bool is_printed() const { return has_ending({".stl", ".3mf"}); }
  bool is_merged() const { return has_ending({".glb", ".obj"}); }
  bool is_page() const { return !slices && is_page_output(output); }
  bool carries_colors() const {
    return slices || export_has_colors(name(), options.window.has_value());
  }
};

/// Throws Error, before the file is read, if no output has this extension.
void check_extension(const ExportArguments& arguments) {
  const std::string name = arguments.name();
  if (arguments.content.format.empty() && is_standard_output(arguments.output))
    throw Error(arguments.output, "",
                "--format EXT is needed: EXT is an extension of " + export_extensions());
  if (!can_export_to(name))
    throw Error(arguments.output, "",
                fmt::format("cannot export to '{}': the extension must be {}, or .html; a folder "
                            "ends in /. --format EXT is for outputs without an extension",
                            std::filesystem::path(name).extension().string(), export_extensions()));
}

/// Returns the mesh of faces that the options ask for: STL and 3MF files are for printing, which
/// needs a manifold.
FaceMesh face_mesh(const ExportArguments& arguments) {
  if (arguments.smooth) return FaceMesh::kSmooth;
  if (arguments.manifold || (arguments.is_printed() && !arguments.watertight))
    return FaceMesh::kManifold;
  return arguments.merge ? FaceMesh::kFewest : FaceMesh::kWatertight;
}

void export_file(ExportArguments& arguments, Session& session) {
  if (arguments.is_page())
    return export_page(arguments.output, arguments.page, arguments.page_view, session);
  if (!arguments.slices) {
    check_extension(arguments);
    check_writable(arguments.output);
  } else if (can_export_to(arguments.output) || lower_case(arguments.output).ends_with(".html")) {
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
  arguments.options.faces = face_mesh(arguments);
  arguments.content.ply_faces |= arguments.smooth;
  std::vector<std::string> notes;
  arguments.options.notes = &notes;
  if (!arguments.grey) arguments.options.look = look_of(look ? *look : file);
  std::uint64_t faces = 0;
  arguments.options.faces_written = &faces;
  WrittenFiles written;
  if (arguments.slices) {
    export_slices(arguments.output, *arguments.slices, voxels, file.grid(), arguments.options);
    written.files = {arguments.output};
  } else {
    for (const std::filesystem::path& part :
         export_scene(arguments.output, voxels, file.metadata(), arguments.content,
                      arguments.options, {&memory, &session.progress}))
      written.files.push_back(part.string());
  }
  const auto side = static_cast<std::int32_t>(file.grid().resolution());
  const Box3i window = arguments.options.window.value_or(Box3i{{0, 0, 0}, {side, side, side}});
  constexpr std::uint64_t kAll = ~std::uint64_t{0} - 1;
  written.counts = {{"voxels", count_voxels(voxels, window, kAll, [&session] {
                       session.progress.throw_if_cancelled();
                     })}};
  if (faces > 0)
    written.counts.emplace_back(
        arguments.content.ply_faces && !arguments.smooth ? "faces" : "triangles", faces);
  print_warnings(notes, session);
  print_written(written, session);
}

void add_page_options(const Command& command, ExportArguments& arguments, const Session& session) {
  std::vector<Option> options = add_reduction_options(command, arguments.page.reduction);
  options.push_back(command.flag("--poster", arguments.page_view.poster,
                                 "Render the first view, and show that picture until the page has "
                                 "loaded the scene: about 20 KB"));
  for (const Option& option : options)
    option.only_if([&session] { return !session.subject.empty(); }, "without FILE");
  for (const Option& option : add_page_view_options(command, arguments.page_view))
    options.push_back(option);
  for (const Option& option : options)
    option.in_group("Options for pages only (.html, FOLDER/)")
        .only_if([&arguments] { return arguments.is_page(); },
                 "on an output that is neither .html nor a folder");
  add_memory_option(command, arguments.page.memory_limit)
      .only_if(
          [&arguments] { return arguments.is_page() || arguments.is_vdb(); },
          "on an output that is neither a page nor .vdb or .nvdb: others take less than 100 MB");
}

void add_mesh_options(const Command& command, ExportArguments& arguments) {
  const auto has_faces = [&arguments] { return arguments.has_ending({".glb", ".obj", ".stl"}); };
  const auto is_mesh = [&arguments] {
    return arguments.has_ending({".glb", ".obj", ".stl", ".3mf", ".ply"});
  };
  const auto is_merged = [&arguments] { return arguments.is_merged(); };
  constexpr const char *kNoFaces = "on an output that is neither .glb, .obj nor .stl",
                       *kNotMerged = "on an output that is neither .glb nor .obj";
  const Option watertight =
      command
          .flag("--watertight", arguments.watertight,
                "With .glb, .obj and .stl: no corner lies inside an edge of another triangle (the "
                "default of .glb and .obj)")
          .only_if(has_faces, kNoFaces);
  const Option manifold =
      command
          .flag("--manifold", arguments.manifold,
                "With .glb, .obj and .stl: each edge has two triangles, each corner one fan. Where "
                "voxels only touch, corners move by 1/8 voxel (the default of .stl; .3mf files "
                "always are manifolds)")
          .only_if(has_faces, kNoFaces)
          .not_with(watertight);
  const Option smooth =
      command
          .flag("--smooth", arguments.smooth,
                "With .glb, .obj, .stl, .3mf and .ply: a manifold without steps. Its corners lie "
                "within a third of a voxel, along each axis, of those of the cubes")
          .only_if(is_mesh, "on an output that is neither .glb, .obj, .stl, .3mf nor .ply")
          .not_with(watertight)
          .not_with(manifold);
  command
      .flag("--merge", arguments.merge,
            "With .glb and .obj: the fewest triangles; corners can lie inside edges of others, "
            "which can show as cracks")
      .only_if(is_merged, kNotMerged)
      .not_with(watertight)
      .not_with(manifold)
      .not_with(smooth);
  command
      .flag("--texture", arguments.options.texture,
            "With .glb and .obj: write colours as a texture, for programs that show no colours of "
            "corners. OUT.mtl and OUT.png lie beside OUT.obj")
      .only_if(is_merged, kNotMerged);
  command
      .parsed(
          "--up", arguments.content.up,
          [](const std::string& text) {
            if (text != "y" && text != "z")
              throw std::invalid_argument(fmt::format("\"{}\" is neither y nor z", text));
            return text[0];
          },
          "y|z",
          "The axis that points up in the output: the scene is turned about x if another one does "
          "in FILE (default: y for .glb and .schem, z for .vox, .stl and .3mf, if FILE or the "
          "format of its source says which axis points up; others are not turned)")
      .only_if([&arguments] { return !arguments.is_page() && !arguments.slices; },
               "on a page or slices");
}

void check_outputs(const ExportArguments& arguments, const Session& session) {
  if (arguments.is_page()) return check_page_output(arguments.output, session);
  std::string beside = arguments.output + ".json";
  if (arguments.output.ends_with(".voxel.json"))
    beside = arguments.output.substr(0, arguments.output.size() - 4) + "bin";
  std::vector<OutputFile> outputs{{"--output", arguments.output}, {"--output", beside}};
  if (arguments.options.texture && arguments.name().ends_with(".obj"))
    for (const char* extension : {".mtl", ".png"})
      outputs.push_back(
          {"--texture",
           std::filesystem::path(arguments.output).replace_extension(extension).string()});
  check_distinct(outputs, session);
}

}  // namespace

void add_export_command(const Command& program, Session& session) {
  const auto arguments = std::make_shared<ExportArguments>();
  const Command command = program.add(
      "export", "Write the voxels in the formats of other programs, or as a page that shows them",
      "voxdag export scene.vdag -o scene.glb\n"
      "  voxdag export scene.vdag -o cubes.ply --faces\n"
      "  voxdag export part.vdag -o part.3mf --smooth\n"
      "  voxdag export scene.vdag -o part.raw --window 0,0,0,512,512,512\n"
      "  voxdag export solid.vdag -o layers/ --slices z\n"
      "  voxdag export scene.vdag -o scene.html\n"
      "  voxdag export scene.vdag -o scene.html --view scene.settings.json --title Castle "
      "--poster\n"
      "  voxdag export scene.vdag -o site/\n"
      "  voxdag export -o site/\n"
      "  voxdag export bunny.ply -r 256 -o bunny.vox\n\n"
      "An ESVO exports its voxels of the finest level. The outputs have the colours of the file, "
      "or of --look, as far as their formats can. Formats that cannot hold a place in the world "
      "come with OUT.json, which has it.\n\n"
      "A page shows the whole DAG with its colours and normals; --levels, --color-bound, "
      "--normal-bound and --drop-attributes make it smaller. The command prints its size, and "
      "warns if an .html file has more than 64 MiB: a browser reads such a file completely, but "
      "reads only the levels that it shows from a folder. Without FILE, the page begins with a "
      "place to drop one.\n\n"
      "A folder that exists is replaced as a whole, and only if it has no files but those of an "
      "older page. It stays if the export fails. `kill -9`, or a second Ctrl-C, can leave the "
      "unfinished folder OUT.voxdag-PID-N.");
  arguments->input.with_colors = true;
  add_scene_input(command, arguments->input, session, "The .vdag or .esvo file", false);
  command
      .text("-o,--output", arguments->output, "OUT",
            "Outer faces: .glb, .obj, .stl, .3mf, or .ply with --faces. Points: .ply. Voxels: .vox "
            "(MagicaVoxel), .vdb, .nvdb, .binvox, .schem (Minecraft), .voxel.json (PlayCanvas). "
            "Volumes: .nrrd, .mha, .mhd, .nii, .nii.gz, .vti. "
            "Arrays: .npy (coordinates, or dense with --window), .raw (dense), .spc.npy (kaolin). "
            "With --slices: a folder. Pages that show a DAG: .html (one file, also offline) or "
            "FOLDER/ (with the scene, for any web server)")
      .required();
  command.text("--format", arguments->content.format, "EXT",
               "Write OUT as if its name ended in .EXT: for standard output (-o -)");
  const auto is_no_page = [arguments] { return !arguments->is_page(); };
  command
      .parsed("--window", arguments->options.window, parse_window, "X0,Y0,Z0,X1,Y1,Z1",
              "Export only the voxels from the first corner (included) to the second (excluded)")
      .only_if(is_no_page, "on a page");
  const Option faces = command
                           .flag("--faces", arguments->content.ply_faces,
                                 "With .ply: write the outer faces of the voxels, not points")
                           .only_if([arguments] { return arguments->name().ends_with(".ply"); },
                                    "on an output that does not end in .ply");
  const Option slices =
      command
          .parsed("--slices", arguments->slices, parse_axis, "AXIS",
                  "Write a folder of PNG files, one for each layer along x, y or z: slice_0000.png "
                  "and so on")
          .not_with(faces);
  command
      .flag("--skip-empty", arguments->options.skip_empty,
            "Leave out the files of layers without voxels; import puts the others to their places")
      .needs(slices);
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
  add_mesh_options(command, *arguments);
  add_page_options(command, *arguments, session);
  add_json_option(command, session);
  add_quiet_option(command, session);
  command.when_parsed([arguments, &session] {
    session.inputs = {arguments->look};
    note_page_view_files(arguments->page_view, session);
    check_outputs(*arguments, session);
    if (session.subject.empty() && !arguments->is_page())
      throw UsageError("FILE", "is required, unless the output is a page");
    session.work = [arguments, &session] {
      if (session.subject.empty())
        return export_start_page(arguments->output, arguments->page_view, session);
      work_on_scene(arguments->input, session, [&] { export_file(*arguments, session); });
    };
  });
}

}  // namespace voxdag::cli

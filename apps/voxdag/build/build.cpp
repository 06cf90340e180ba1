/// `voxdag build`: builds a .vdag or .esvo file from a mesh.
#include <fmt/core.h>

#include <memory>
#include <stdexcept>

#include "build/build_arguments.hpp"
#include "build/written_output.hpp"
#include "cli/commands.hpp"
#include "cli/input_files.hpp"
#include "cli/parse.hpp"
#include "voxdag/builders/voxelize/grid_mapping.hpp"

namespace voxdag::cli {
namespace {

/// Headings of options that only one kind of output has.
constexpr const char *kDagOptions = "Options for DAGs only",
                     *kEsvoOptions = "Options for ESVOs only";

/// Returns whether the text asks for an ESVO.
bool parse_structure(const std::string& text) {
  if (text != "dag" && text != "esvo")
    throw std::invalid_argument(fmt::format("\"{}\" is neither dag nor esvo", text));
  return text == "esvo";
}

/// Parses the value of --rule. Returns whether it is "centre".
bool parse_voxel_rule(const std::string& text) {
  if (text == "cover") return false;
  if (text == "centre") return true;
  throw std::invalid_argument(fmt::format("\"{}\" is neither cover nor centre", text));
}

BuildMethod parse_method(const std::string& text) {
  if (text == "hash") return BuildMethod::kHashConsed;
  if (text == "sort") return BuildMethod::kSort;
  if (text == "paper") return BuildMethod::kPaper;
  throw std::invalid_argument(fmt::format("\"{}\" is not hash, sort or paper", text));
}

void add_grid_options(const Command& command, BuildArguments& arguments) {
  command.parsed("-r,--resolution", arguments.grid.resolution, parse_resolution, "N",
                 "Voxels along the longest side: 1 to 1048576; 8K is 8192 (default: 1024)");
  command.parsed("--voxel-size", arguments.grid.voxel_size, parse_positive, "SIZE",
                 "Instead of -r: side of a voxel, in the units of the mesh");
  command.parsed(
      "--bounds", arguments.grid.bounds, parse_box, "X0,Y0,Z0,X1,Y1,Z1",
      "Box that the grid holds: the grid, a cube, starts at its lower corner (default: the "
      "mesh's bounding box)");
  command
      .parsed(
          "--origin", arguments.grid.origin, parse_vec3, "X,Y,Z",
          "Lower corner of the grid (default: that of the mesh); -r counts the voxels from there "
          "to the upper corner of the mesh")
      .only_if([&arguments] { return !arguments.grid.bounds; }, "with --bounds");
  add_margin_options(command, arguments.grid);
  add_transform_options(command, arguments.access.transform);
}

void add_parts_options(const Command& command, BuildArguments& arguments) {
  command
      .text("--work", arguments.work_folder, "DIR",
            "Build in parts, whose files lie in this folder until the output is complete. If the "
            "build ends early, the same command goes on with them. Under mpirun or srun all "
            "processes build together; they must see the folder")
      .in_group(kDagOptions);
  command
      .optional_number<int>(
          "--parts", arguments.parts, NumberRange::whole(1, 1000000), "K",
          "Build in at least K parts, one after the other, with less memory (default "
          "with --work: as many as memory and processes need)")
      .in_group(kDagOptions);
}

void add_esvo_options(const Command& command, EsvoArguments& arguments) {
  EsvoSettings& settings = arguments.settings;
  const auto has_contours = [&settings] { return settings.contours; };
  const auto has_attributes = [&settings] { return settings.attributes; };
  command
      .number("--max-error", settings.max_error, NumberRange::from(0, 1e6), "VOXELS",
              "Largest distance of a leaf's shape from the surface, in voxels of the finest level")
      .only_if(has_contours, "with --no-contours")
      .in_group(kEsvoOptions);
  command
      .number("--color-error", settings.color_error, NumberRange::from(0, 1), "DIFFERENCE",
              "Largest difference of a leaf's colours from their mean, in the channel that differs "
              "most (sRGB)")
      .only_if(has_contours, "with --no-contours")
      .only_if(has_attributes, "with --no-attributes")
      .in_group(kEsvoOptions);
  command
      .number("--normal-error", arguments.normal_degrees, NumberRange::from(0, 180), "DEGREES",
              "Largest difference of the normals in a leaf")
      .only_if(has_contours, "with --no-contours")
      .only_if(has_attributes, "with --no-attributes")
      .in_group(kEsvoOptions);
  const Option displace = add_displace_option(command, arguments.displace).in_group(kEsvoOptions);
  add_no_displacement_option(command, arguments.displace).not_with(displace).in_group(kEsvoOptions);
  add_bake_options(command, arguments.bake, has_attributes, kEsvoOptions);
  command
      .off_switch("--no-contours", settings.contours,
                  "Store only cubes of the finest level: the voxels of the DAG")
      .in_group(kEsvoOptions);
  command
      .off_switch("--no-attributes", settings.attributes,
                  "Store the shape only: no colours, no normals")
      .in_group(kEsvoOptions);
}

bool is_in_parts(const BuildArguments& arguments) {
  return !arguments.work_folder.empty() || arguments.parts != 0;
}

/// Throws UsageError if options ask for another grid than that of --grid-of.
void check_grid_of(const BuildArguments& arguments) {
  const GridRequest& grid = arguments.grid;
  if (grid.resolution || grid.voxel_size || grid.bounds || grid.origin || grid.padding != 0 ||
      grid.center || is_in_parts(arguments))
    throw UsageError("--grid-of",
                     "sets the whole grid: not with -r, --voxel-size, --bounds, --origin, "
                     "--padding, --center, --work or --parts");
}

/// Throws UsageError for options that belong to the other kind of output, and for wrong
/// combinations.
void check_build_arguments(const Command& command, BuildArguments& arguments, Session& session) {
  const std::string maker = maker_of(arguments.output);
  if (arguments.as_esvo && !maker.empty())
    throw UsageError("--as esvo", "needs an output that ends in .esvo or .vdag");
  if (session.json && maker == "render") throw UsageError("--json", "has no effect on a picture");
  arguments.attributes.colors_if_any |= !maker.empty() && shows_colors(arguments.output);
  if (arguments.as_esvo)
    command.refuse_group(kDagOptions, "is for DAGs only, but the output is an ESVO (see --as)");
  else
    command.refuse_group(kEsvoOptions, "is for ESVOs only, but the output is a DAG (see --as)");
  if (is_in_parts(arguments) &&
      (arguments.solid || arguments.attributes.is_wanted() || arguments.attributes.colors_if_any ||
       arguments.attributes.cuts_alpha() || arguments.compact || arguments.meshes.size() > 1 ||
       !maker.empty() || arguments.method != BuildMethod::kHashConsed))
    throw UsageError(
        "--work and --parts build the surface's voxels by --method hash: not with --solid, "
        "--color, --normal, --material-ids, --channel, --alpha cut, --compact, several meshes, "
        "another method or an output that is no .vdag file");
  if (arguments.solid) {
    if (arguments.attributes.cut.value_or(false))
      throw UsageError("--solid fills the whole surface: not with --alpha cut");
    arguments.attributes.cut = false;
  }
  arguments.access.outputs = {{"--output", arguments.output}};
  check_distinct(arguments.access.outputs, session);
  if (arguments.grid.resolution && arguments.grid.voxel_size)
    throw UsageError("give -r/--resolution or --voxel-size, not both");
  if (!arguments.grid_of.empty()) return check_grid_of(arguments);
  if (arguments.grid.voxel_size) return;
  if (!arguments.grid.resolution) arguments.grid.resolution = kDefaultResolution;
  const int levels = levels_of(*arguments.grid.resolution);
  arguments.esvo.bake.check_levels(levels);
  arguments.attributes.check_levels(levels);
}

}  // namespace

void add_build_command(const Command& program, Session& session) {
  const auto arguments = std::make_shared<BuildArguments>();
  const Command command = program.add(
      "build", "Build the sparse voxel DAG or the ESVO of a triangle mesh",
      "voxdag build sponza.obj -r 8192 -o sponza.vdag\n"
      "  voxdag build scan.ply --voxel-size 0.5 -o scan.vdag\n"
      "  voxdag build city.glb -r 16K --bounds 0,0,0,100,100,100 -o block.vdag\n"
      "  voxdag build FlightHelmet.gltf -r 1024 --color --normal -o helmet.vdag\n"
      "  voxdag build FlightHelmet.gltf -r 1024 --color --normal --channel metallic,roughness -o "
      "helmet.vdag\n"
      "  voxdag build FlightHelmet.gltf -r 1024 -o helmet.esvo\n"
      "  voxdag build sibenik.obj -r 2048 --displace stone:0.1:4 -o sibenik.esvo\n"
      "  voxdag build chair.obj room.glb -r 1000 --ids file -o scene.vdag\n"
      "  voxdag build part.stl --unit in:mm --voxel-size 0.1 --snap --solid -o part.vdag\n\n"
      "The grid is a cube of 2^L voxels a side. With -r alone, the longest side of the "
      "mesh's bounding box spans N voxels, from the grid's lower corner on. With --voxel-size "
      "alone, the grid is the smallest one that holds the mesh. With --bounds, the grid starts at "
      "the lower corner of the box: with -r, the longest side of the box spans N voxels; with "
      "--voxel-size, it is the smallest grid that holds the box. The build clips the "
      "mesh to the grid. Several meshes, or those of a folder, share one grid.\n\n"
      "By default a DAG stores the shape only: --color, --normal, --material-ids and --channel "
      "add values of all its cells. If a texture cannot be read, build warns and uses the "
      "material's colour.");
  command
      .repeated(
          "mesh", arguments->meshes, [](const std::string& text) { return text; }, "MESH...",
          "Meshes, folders of meshes, or patterns: OBJ, PLY, STL, OFF, glTF/GLB, 3MF, COLLADA, or "
          "another format if voxdag was built with assimp; also compressed (.gz, .zst). "
          "-: standard input")
      .required();
  command.text(
      "-o,--output", arguments->output, "FILE",
      "The file to write: .vdag, .esvo, a page (.html, FOLDER/), a picture (.png, .exr), or "
      "a file that `voxdag export` writes (.glb, .vox, ...). All but .vdag and .esvo are made "
      "of a temporary DAG, with the mesh's colours if it has some (default: the name of the "
      "first MESH with .vdag, in the current folder; it replaces no other kind of file)");
  const Option as =
      command.parsed("--as", arguments->as_esvo, parse_structure, "dag|esvo",
                     "dag: the minimal DAG; esvo: an octree with contours, colours and normals "
                     "(default: esvo if FILE ends in .esvo, else dag)");
  add_grid_options(command, *arguments);
  command
      .parsed(
          "--method", arguments->method, parse_method, "hash|sort|paper",
          "hash: depth-first with a hash table of nodes; sort: the paper's reduction by sorting, "
          "sub-volumes in parallel; paper: one sub-volume at a time, as the paper does. All "
          "write the same file (default: hash)")
      .in_group(kDagOptions);
  command
      .flag_or_parsed(
          "--solid", arguments->solid, solid_rule, "parity", "parity|winding|flood",
          "Also set the voxels inside. parity (the default): voxels from which a ray crosses an "
          "odd number of triangles, for closed meshes; winding: voxels around which the surface "
          "winds, for meshes with holes or of overlapping bodies; flood: empty voxels that no way "
          "through empty voxels connects with the sides of the grid")
      .in_group(kDagOptions);
  command
      .parsed(
          "--rule", arguments->by_centre, parse_voxel_rule, "cover|centre",
          "Voxels that --solid parity and winding set. cover: those that the body meets; centre: "
          "those whose centre is inside (default: cover)")
      .only_if(
          [arguments = arguments.get()] {
            return arguments->solid && *arguments->solid != SolidRule::kFlood;
          },
          "without --solid parity or winding")
      .in_group(kDagOptions);
  command
      .parsed("--winding-threshold", arguments->winding_threshold, parse_positive, "W",
              "For --solid winding: a voxel is inside if the absolute generalised winding number "
              "at its centre is at least W (default: 0.5)")
      .only_if([arguments = arguments.get()] { return arguments->solid == SolidRule::kWinding; },
               "without --solid winding")
      .in_group(kDagOptions);
  add_attribute_options(command, arguments->attributes, kDagOptions,
                        [arguments = arguments.get()] { return arguments->solid.has_value(); });
  command
      .flag("--compact", arguments->compact,
            "Write the compact form: the geometry takes about a quarter of the bytes; those of "
            "colours, normals, material ids and channels do not change. Every command reads it")
      .in_group(kDagOptions);
  command.parsed("--memory", arguments->memory_limit, parse_memory, "LIMIT",
                 "Maximum memory, including the program and the mesh: 512M, 16GiB. A build that "
                 "needs more is refused (default: three quarters of the available memory)");
  add_parts_options(command, *arguments);
  add_mesh_access_options(command, arguments->access);
  command.parsed(
      "--texture", arguments->access.texture,
      [arguments = arguments.get()](const std::string& text) {
        arguments->attributes.options.colors = true;
        return text;
      },
      "IMAGE",
      "Take the colours from this PNG or JPEG file at the mesh's texture coordinates, not from the "
      "images that the mesh names. Implies --color for a DAG");
  command.text(
      "--grid-of", arguments->grid_of, "FILE",
      "Build in the grid of this .vdag or .esvo file, so that `voxdag combine` and `voxdag "
      "diff` take both. Parts of the mesh outside are left out");
  command.flag("--stats", arguments->stats, "Also print the number of nodes of each level")
      .only_if([&session] { return !session.json; }, "with --json, which always prints all levels")
      .only_if([&session] { return !session.quiet; }, "with --quiet")
      .only_if([arguments = arguments.get()] { return maker_of(arguments->output).empty(); },
               "on an output that is no .vdag or .esvo file");
  add_esvo_options(command, arguments->esvo);
  add_threads_option(command, session);
  add_quiet_option(command, session);
  add_json_option(command, session);
  command.when_parsed([arguments, as, command, &session] {
    const std::string first = arguments->meshes.front();
    arguments->meshes = expand_inputs(
        arguments->meshes, {".obj", ".ply", ".stl", ".off", ".gltf", ".glb", ".3mf", ".dae"});
    session.subject = arguments->meshes.front();
    session.inputs = arguments->meshes;
    session.inputs.insert(session.inputs.end(), {arguments->access.texture, arguments->grid_of});
    if (arguments->output.empty())
      arguments->output =
          default_output(first, session.subject, arguments->as_esvo ? ".esvo" : ".vdag");
    const bool is_named_esvo = arguments->output.ends_with(".esvo");
    if (!as.is_given()) arguments->as_esvo = is_named_esvo;
    if (is_named_esvo && !arguments->as_esvo)
      throw UsageError("--as dag", "contradicts the output, which ends in .esvo");
    check_build_arguments(command, *arguments, session);
    session.work = [arguments, &session] {
      const std::string output = arguments->output;
      build_output(output, session, [&](const std::string& file) {
        arguments->output = file;
        if (arguments->as_esvo) return build_esvo_file(*arguments, session);
        is_in_parts(*arguments) ? build_dag_in_parts(*arguments, session)
                                : build_dag_file(*arguments, session);
      });
    };
  });
}

}  // namespace voxdag::cli

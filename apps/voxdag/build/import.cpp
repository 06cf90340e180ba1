/// `voxdag import`: builds a DAG from a file of voxels or points.
#include <fmt/core.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "build/placing_options.hpp"
#include "build/written_output.hpp"
#include "cli/commands.hpp"
#include "cli/input_files.hpp"
#include "cli/output_files.hpp"
#include "cli/parse.hpp"
#include "cli/stopwatch.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/io/process_memory.hpp"
#include "voxdag/core/with_file_name.hpp"
#include "voxdag/cpu/presentation.hpp"
#include "voxdag/file/report/dag_report.hpp"
#include "voxdag/file/report/human.hpp"
#include "voxdag/formats/exports/export_scene.hpp"
#include "voxdag/formats/imports/import_model.hpp"
#include "voxdag/formats/imports/moved_source.hpp"
#include "voxdag/formats/presentation.hpp"

namespace voxdag::cli {
namespace {

struct ImportArguments {
  std::vector<std::string> files;
  TransformRequest transform;
  std::string output;
  ImportOptions options;
  std::string format, grid;         ///< As in VoxelSourceOptions.
  std::optional<double> threshold;  ///< For volumes.
  bool splats_are_points = false;
  bool has_labels = false;
  std::string label_field;
  std::vector<std::string> keep, drop;
  std::vector<ChannelRequest> channels;
  bool is_grey = false;
  bool compact = false;
  std::uint64_t memory_limit = 0;
};

std::vector<std::string> warnings_of(const VoxelSource& source, const std::string& name) {
  std::vector<std::string> warnings = source.warnings();
  for (std::string& warning : warnings) warning.insert(0, name + ": ");
  return warnings;
}

/// Imports the file. Errors name it.
ImportedModel import_file(const ImportArguments& arguments, Work work, Session& session) {
  ImportOptions options = arguments.options;
  options.colors = !arguments.is_grey;
  options.drops_labels = arguments.keep.empty();
  options.labels = options.drops_labels ? arguments.drop : arguments.keep;
  const LabelRequest labels =
      arguments.has_labels ? LabelRequest(arguments.label_field) : std::nullopt;
  options.folder = arguments.output == session.scratch
                       ? std::filesystem::temp_directory_path()
                       : std::filesystem::path(arguments.output).parent_path();
  if (options.folder.empty()) options.folder = ".";
  std::vector<std::unique_ptr<VoxelSource>> sources;
  for (const std::string& file : arguments.files)
    with_file_name(file, [&] {
      std::unique_ptr<VoxelSource> source = open_voxel_source(
          file, {arguments.threshold, !options.voxel_size && !options.origin, arguments.format,
                 arguments.grid, arguments.splats_are_points, labels, arguments.channels, work});
      print_warnings(warnings_of(*source, file), session);
      if (source->has_points() && !source->grid() && !options.resolution && !options.voxel_size)
        options.resolution = kDefaultResolution;
      check_grid_options(*source, options);
      sources.push_back(
          moved_source(std::move(source),
                       InputTransform(arguments.transform, custom_of(file, arguments.format))));
    });
  const bool has_points = sources.front()->has_points();
  return with_file_name(session.subject, [&] {
    ImportedModel result = import_model(*joined_source(std::move(sources)), options,
                                        names_of(arguments.files), work, arguments.transform);
    Presentation presentation =
        presentation_of(arguments.transform, custom_of(arguments.files.front(), arguments.format));
    // Values from a threshold on lie within a surface.
    presentation.cubes = !has_points && !arguments.threshold;
    if (const auto up = up_of(result.model.metadata())) presentation.up = up;
    result.model.set_presentation(
        with_home(presentation, result.model.view(), result.model.grid()));
    return result;
  });
}

/// Returns the files to import. A folder of slices is one input.
std::vector<std::string> files_of(const std::vector<std::string>& arguments) {
  std::vector<std::string> files;
  for (const std::string& argument : arguments) {
    const std::vector<std::string> of_argument =
        is_slice_folder(argument)
            ? std::vector{argument}
            : expand_inputs({argument}, {".xyz", ".txt", ".csv", ".asc", ".pts", ".xyzrgb", ".ply",
                                         ".splat", ".spz", ".sog", ".las", ".pcd", ".npy"});
    files.insert(files.end(), of_argument.begin(), of_argument.end());
  }
  return files;
}

double parse_opacity(const std::string& text) {
  const double opacity = parse_finite(text);
  if (!(opacity > 0 && opacity < 1)) throw std::invalid_argument("must be above 0 and below 1");
  return opacity;
}

/// Returns the line of the summary that says how splats set voxels; empty for other sources.
std::string splat_table(const ImportedModel& result) {
  const std::map<std::string, std::string>& build = result.model.metadata().build;
  if (build.at("cover") != "splats") return "";
  return fmt::format("  {:<14}opacity {}, scales {} to {}{}\n", "splats", build.at("opacity"),
                     build.at("min_scale"), build.at("max_scale"),
                     result.too_large > 0
                         ? fmt::format("; {} larger ones left out", with_commas(result.too_large))
                         : "");
}

/// Returns the line of the summary that counts the labels; empty without labels.
std::string label_table(const DagModel& model) {
  const std::size_t count = model.metadata().attributes.labels.size();
  return count > 0 ? fmt::format("  {:<14}{} (voxdag materials lists them)\n", "labels",
                                 with_commas(count))
                   : "";
}

/// Reads FIELD[:as NAME][,bound=B][,kind=KIND].
ChannelRequest parse_channel(const std::string& text) {
  ChannelRequest request;
  std::vector<std::string> parts = parse_words(text);
  if (parts.empty()) throw std::invalid_argument("names no field");
  const std::size_t as = parts[0].find(":as");
  request.field = parts[0].substr(0, as);
  if (as != std::string::npos) {
    const std::size_t name = parts[0].find_first_not_of(" =", as + 3);
    if (name == std::string::npos) throw std::invalid_argument("has no name after :as");
    request.name = parts[0].substr(name);
    if (!is_channel_name(request.name))
      throw std::invalid_argument(
          "names a channel with other characters than letters, digits, '_', '-' and '.'");
  }
  for (std::size_t i = 1; i < parts.size(); ++i) {
    if (parts[i].starts_with("bound=")) {
      request.bound = parse_positive(parts[i].substr(6));
    } else if (parts[i].starts_with("kind=")) {
      for (std::uint32_t kind = 0; kind < kChannelKinds; ++kind)
        if (parts[i].substr(5) == name_of(static_cast<ChannelKind>(kind)))
          request.kind = static_cast<ChannelKind>(kind);
      if (!request.kind) throw std::invalid_argument("the kinds are u8, u16, i16, i32 and f32");
    } else {
      throw std::invalid_argument("\"" + parts[i] + "\" is neither bound=B nor kind=KIND");
    }
  }
  return request;
}

/// Returns the line of the summary that names the channels; empty without channels.
std::string channel_table(const DagModel& model) {
  std::string names;
  const ChannelsView channels = model.attributes().channels;
  for (std::size_t i = 0; i < channels.count(); ++i)
    names += (i > 0 ? ", " : "") + std::string(channels[i].name()) + " (" +
             name_of(channels[i].kind) + ")";
  return names.empty() ? "" : fmt::format("  {:<14}{}\n", "channels", names);
}

double parse_color_bound(const std::string& text) {
  const double bound = parse_finite(text);
  if (!(bound >= 0 && bound <= 1)) throw std::invalid_argument("must be from 0 to 1");
  return bound;
}

void import(const ImportArguments& arguments, Session& session) {
  check_writable(arguments.output);
  const Stopwatch watch;
  MemoryBudget memory = command_budget(arguments.memory_limit);
  const Work work(&memory, &session.progress);
  const ImportedModel result = import_file(arguments, work, session);
  const DagModel& model = result.model;
  model.save(arguments.output, arguments.compact, work);
  const SvdagCounts& counts = model.metadata().counts;
  session.bar.clear();
  warn_if_empty(counts.voxels, arguments.output, session,
                result.outside > 0 ? "all points lie outside of the grid"
                                   : names_of(arguments.files) + " sets none");
  if (session.json) {
    const nlohmann::ordered_json json = {{"read", result.read},
                                         {"outside", result.outside},
                                         {"unwanted", result.unwanted},
                                         {"not_finite", result.not_finite},
                                         {"too_large", result.too_large},
                                         {"voxels", counts.voxels},
                                         {"dag_nodes", counts.dag_nodes()},
                                         {"seconds", watch.since_start()},
                                         {"peak_memory_bytes", peak_resident_bytes()}};
    fmt::print("{}", json_text(json));
  } else if (!session.quiet) {
    std::error_code unknown;
    const std::uintmax_t bytes = std::filesystem::file_size(arguments.output, unknown);
    fmt::print(
        "{}: {} read{}{}{}, {} voxels of {}³, {}, {}\n{}{}{}{}", arguments.output,
        with_commas(result.read),
        result.outside > 0 ? fmt::format(", {} of them outside", with_commas(result.outside)) : "",
        result.unwanted > 0
            ? fmt::format(", {} of them with other labels", with_commas(result.unwanted))
            : "",
        result.not_finite > 0
            ? fmt::format(", {} of them not finite", with_commas(result.not_finite))
            : "",
        with_commas(counts.voxels), with_commas(model.grid().resolution()),
        human_bytes(unknown ? 0 : static_cast<std::uint64_t>(bytes)),
        human_seconds(watch.since_start()), splat_table(result), label_table(model),
        channel_table(model),
        transform_table(arguments.transform, custom_of(arguments.files.front(), arguments.format)));
  }
}

}  // namespace

void add_import_command(const Command& program, Session& session) {
  const auto arguments = std::make_shared<ImportArguments>();
  const Command command = program.add("import", "Build a DAG from a file of voxels or points",
                                      "voxdag import cloud.xyz -r 2048 -o cloud.vdag\n"
                                      "  voxdag import points.npy --voxel-size 0.05 --bounds "
                                      "0,0,0,100,100,20 -o street.vdag\n"
                                      "  voxdag import castle.vox -o castle.vdag\n"
                                      "  voxdag import head.nii.gz --threshold 300 -o head.vdag\n"
                                      "  voxdag import scan.ply --voxel-size 0.05 -o scan.vdag\n"
                                      "  voxdag import city.las --voxel-size 0.5 --labels --drop 7 "
                                      "-o city.vdag\n\n"
                                      "The file may have any number of points or voxels, in any "
                                      "order. Each point sets the voxel that it lies in; Gaussian "
                                      "splats set the voxels where they are opaque "
                                      "(docs/splats.md). The DAG gets the colours of the file.");
  command
      .repeated(
          "file", arguments->files, [](const std::string& text) { return text; }, "FILE...",
          "One file, several, a folder of them or a pattern. Points: .ply, .las, .pcd, .npy of N x "
          "3 floats, or texts: .xyz, .txt, .csv, .asc, .pts. Gaussian splats: .ply, .splat, .spz, "
          ".sog. Voxels: .vox, .binvox, .schem, .schematic, .litematic, .nbt (Minecraft), .bt, .ot "
          "(OctoMap), or .npy of N x 3 integers. Volumes: .npy of X x Y x Z, .nrrd, .nhdr, .nii, "
          ".tif, .dcm, .vdb, or a folder of .png or .tif slices or DICOM images. Each of them may "
          "also be compressed (.gz, .zst). -: standard input")
      .required();
  command.text(
      "-o,--output", arguments->output, "OUT",
      "The file to write: .vdag, a page (.html, FOLDER/), a picture (.png, .exr), or a file "
      "that `voxdag export` writes (.glb, .vox, ...) (default: the name of the first FILE with "
      ".vdag, in the current folder; it replaces no other kind of file)");
  command.text("--format", arguments->format, "EXT",
               "Read FILE as if its name ended in .EXT: needed for standard input");
  command.text("--grid", arguments->grid, "NAME",
               "For .vdb: the grid to read (default: density, else the first one)");
  ImportOptions& options = arguments->options;
  const Option resolution =
      command.parsed("-r,--resolution", options.resolution, parse_resolution, "N",
                     "Voxels along the longest side, 1 to 1048576 (default for points: 1024; for "
                     "voxels: that of FILE, or the least that holds them)");
  command
      .parsed(
          "--voxel-size", options.voxel_size, parse_positive, "SIZE",
          "For points, instead of -r: side of a voxel, in the units of the points; the grid "
          "then begins half a voxel below the least coordinates. For voxels whose file does not "
          "say it: side of a voxel")
      .not_with(resolution);
  command.parsed("--origin", options.origin, parse_vec3, "X,Y,Z",
                 "Lower corner of the grid, for the same files (default: 0,0,0 for voxels)");
  command.parsed("--bounds", options.bounds, parse_box, "X0,Y0,Z0,X1,Y1,Z1",
                 "For points: box that the grid holds; points outside are left out (default: the "
                 "bounding box of the points)");
  add_margin_options(command, options);
  add_transform_options(command, arguments->transform);
  command.parsed("--threshold", arguments->threshold, parse_finite, "VALUE",
                 "For volumes of numbers: values from VALUE on set their voxel (default: all but "
                 "0)");
  command.parsed("--opacity", options.splats.opacity, parse_opacity, "A",
                 "For Gaussian splats: set the voxels whose splats together have this opacity or "
                 "more, above 0 and below 1 (default: 0.1)");
  command.parsed("--min-scale", options.splats.min_scale, parse_positive, "S",
                 "For splats: the least standard deviation along an axis, in world units; thinner "
                 "splats grow to it (default: half a voxel)");
  command.parsed(
      "--max-scale", options.splats.max_scale, parse_positive, "S",
      "For splats: leave out those with a standard deviation of S or more (default: 1/64 "
      "of the longest side of the box of the centres, or of --bounds, rounded down to a "
      "power of two)");
  command.flag(
      "--labels", arguments->has_labels,
      "Keep labels as materials: the values of a volume, the palette of .vox, the blocks of "
      "Minecraft, the classification of .las, the field label, class, classification or "
      "instance of other points");
  command.text("--label-field", arguments->label_field, "NAME",
               "For points: read the labels from this field, or in texts without names from the "
               "column of this number; implies --labels");
  const Option keep =
      command.parsed("--keep", arguments->keep, parse_words, "LABEL,...",
                     "Import only these labels, numbers or names; implies --labels");
  command
      .parsed("--drop", arguments->drop, parse_words, "LABEL,...",
              "Import all but these labels; implies --labels")
      .not_with(keep);
  command.repeated(
      "--channel", arguments->channels, parse_channel, "FIELD[:as NAME][,bound=B][,kind=KIND]",
      "Keep a field as a channel, up to 16: a property of .ply, a field of .pcd or .npy, the "
      "intensity of .las, a column of a text by its name or number, a grid of .vdb, or value, the "
      "numbers of a volume. A voxel has the mean of its points. B is the "
      "largest error of a stored value (default: lossless); KIND is u8, u16, i16, i32 or f32 "
      "(default: that of the field, f32 with a bound)");
  command.flag("--points", arguments->splats_are_points,
               "For splats: read their centres as points");
  const Option no_colors =
      command.flag("--no-color", arguments->is_grey, "Leave out the colours of FILE");
  command
      .parsed("--color-bound", options.color_bound, parse_color_bound, "DIFFERENCE",
              "Largest error of a stored colour, 0 to 1, as for voxdag build; 0 is lossless "
              "(default: 0.05, of .vox 0)")
      .not_with(no_colors);
  command.flag("--compact", arguments->compact, "Write the compact form");
  command.parsed("--memory", arguments->memory_limit, parse_memory, "LIMIT",
                 "Maximum memory, including the program: voxels that do not fit are sorted in "
                 "a file beside OUT (default: three quarters of the available memory)");
  add_threads_option(command, session);
  add_quiet_option(command, session);
  add_json_option(command, session);
  command.when_parsed([arguments, &session] {
    const std::string first = arguments->files.front();
    arguments->has_labels |=
        !arguments->label_field.empty() || !arguments->keep.empty() || !arguments->drop.empty();
    arguments->files = files_of(arguments->files);
    session.subject = arguments->files.front();
    if (arguments->output.empty())
      arguments->output = default_output(first, session.subject, ".vdag");
    session.inputs = arguments->files;
    check_distinct({{"--output", arguments->output}}, session);
    if (arguments->output.ends_with(".esvo"))
      throw UsageError("--output", "ends in .esvo, and import makes DAGs");
    const std::string maker = maker_of(arguments->output);
    if (session.json && maker == "render") throw UsageError("--json", "has no effect on a picture");
    session.work = [arguments, &session] {
      const std::string output = arguments->output;
      build_output(output, session, [&](const std::string& file) {
        arguments->output = file;
        import(*arguments, session);
      });
    };
  });
}

}  // namespace voxdag::cli

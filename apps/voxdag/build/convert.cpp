/// `voxdag convert`: writes a DAG in its other form, or with fewer levels.
#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

#include "cli/commands.hpp"
#include "cli/output_files.hpp"
#include "cli/parse.hpp"
#include "cli/scene_input.hpp"
#include "cli/stopwatch.hpp"
#include "voxdag/attributes/coarsen_attributes.hpp"
#include "voxdag/compact/coarsen.hpp"
#include "voxdag/compact/encode_svdag.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/file/vdag_writer.hpp"
#include "voxdag/file/verify_vdag.hpp"
#include "voxdag/io/process_memory.hpp"
#include "voxdag/report/human.hpp"

namespace voxdag {
namespace {

struct ConvertArguments {
  std::string output;
  bool compact = false, plain = false;
  bool drop_attributes = false;
  std::optional<int> levels;
  CoarsenBounds bounds;
  std::uint64_t memory_limit = 0;
};

/// Throws Error unless the metadata of the file describes its attributes.
void check_metadata(const VdagMetadata& metadata, const DagAttributesView& attributes,
                    const std::string& file) {
  try {
    compare_attributes(metadata.attributes, attributes);
  } catch (const Error& error) {
    throw error.in_file(file);
  }
}

/// Describes values that were encoded again within these bounds. The errors of some of the cells
/// alone are not known.
void encode_again(AttributesMetadata& attributes, const CoarsenBounds& bounds) {
  if (attributes.colors)
    attributes.colors = {std::min(attributes.colors->bound + bounds.color_bound, 1.0), {}};
  if (attributes.normals)
    attributes.normals = {std::min(attributes.normals->bound + bounds.normal_bound_degrees, 180.0),
                          {}};
}

void convert(const ConvertArguments& arguments, Session& session) {
  check_writable(arguments.output);
  const Stopwatch watch;
  MemoryBudget memory = command_budget(arguments.memory_limit);
  const DagInput file(session.subject, &session.progress, &memory);
  SvdagView dag = file.view();
  VdagMetadata metadata = file.metadata();
  Svdag coarse;
  const bool is_coarser = arguments.levels && *arguments.levels != dag.levels;
  if (is_coarser) {
    if (*arguments.levels > dag.levels)
      throw Error(session.subject, "",
                  fmt::format("has {} voxels a side, so that it cannot get {}",
                              with_commas(static_cast<std::uint64_t>(file.grid().resolution())),
                              with_commas(std::uint64_t{1} << *arguments.levels)));
    coarse = coarsen(dag, *arguments.levels, &memory, &session.progress);
    dag = coarse.view();
    metadata = coarser_metadata(metadata, dag);
  }
  const bool compact = arguments.compact || (!arguments.plain && file.is_compact());
  DagAttributesView attributes =
      arguments.drop_attributes ? DagAttributesView{} : file.attributes();
  if (attributes.is_empty())
    metadata.attributes = {};
  else
    check_metadata(file.metadata(), attributes, session.subject);
  DagAttributes coarse_attributes;
  if (!attributes.is_empty() && is_coarser) {
    coarse_attributes = coarsen_attributes({file.view(), attributes}, dag, arguments.bounds,
                                           &memory, &session.progress);
    if (attributes.index.finest_level > dag.levels)
      encode_again(metadata.attributes, arguments.bounds);
    attributes = coarse_attributes.view();
    metadata.attributes.resolution = std::int64_t{1} << attributes.index.finest_level;
  }
  const MemoryReservation attribute_bytes(&memory, coarse_attributes.bytes());
  if (compact) {
    write_vdag(arguments.output, encode_svdag(dag, {.memory = &memory}, &session.progress),
               metadata, attributes);
  } else {
    write_vdag(arguments.output, dag, metadata, attributes);
  }
  session.bar.clear();
  if (session.quiet) return;
  std::error_code unknown;
  const std::uintmax_t bytes = std::filesystem::file_size(arguments.output, unknown);
  fmt::print("{}: {}, {} form, {}\n", arguments.output,
             human_bytes(unknown ? 0 : static_cast<std::uint64_t>(bytes)),
             compact ? "compact" : "plain", human_seconds(watch.since_start()));
}

}  // namespace

void add_convert_command(const Command& program, Session& session) {
  const auto arguments = std::make_shared<ConvertArguments>();
  const Command command =
      program.add("convert", "Write a DAG in the compact or the plain form, or with fewer levels",
                  "voxdag convert scene.vdag --compact -o small.vdag");
  command.text("file", session.subject, "FILE", "The .vdag file, in either form").required();
  command.text("-o,--output", arguments->output, "OUT", "The .vdag file to write").required();
  const Option compact = command.flag("--compact", arguments->compact,
                                      "Write the compact form (default: the form of FILE)");
  command.flag("--plain", arguments->plain, "Write the plain form, the layout of the paper")
      .not_with(compact);
  command.optional_number<int>(
      "--levels", arguments->levels, NumberRange::whole(kMinLevels, kMaxLevels), "L",
      "Write a coarser grid, of 2^L voxels a side: a voxel is set if one in it was");
  const auto has_levels = [arguments] { return arguments->levels.has_value(); };
  command
      .number("--color-bound", arguments->bounds.color_bound, NumberRange::from(0, 1), "DIFFERENCE",
              "With --levels: how far a colour may change when the coarser colours are encoded "
              "again, in the units of build (0: not at all)")
      .only_if(has_levels, "without --levels");
  command
      .number("--normal-bound", arguments->bounds.normal_bound_degrees, NumberRange::from(0, 180),
              "DEGREES",
              "With --levels: how far a normal may turn when it is encoded again (0: not at all)")
      .only_if(has_levels, "without --levels");
  command.flag("--drop-attributes", arguments->drop_attributes,
               "Leave out colours, normals and material ids");
  command.parsed("--memory", arguments->memory_limit, parse_memory, "LIMIT",
                 "Maximum memory, including the program (default: three quarters of the available "
                 "memory)");
  add_threads_option(command, session);
  add_quiet_option(command, session);
  command.when_parsed([arguments, &session] {
    check_distinct({{"--output", arguments->output}}, session);
    session.work = [arguments, &session] { convert(*arguments, session); };
  });
}

}  // namespace voxdag

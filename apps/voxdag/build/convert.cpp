/// `voxdag convert`: writes a DAG in its other form, or with fewer levels. `voxdag coarsen`: drops
/// levels.
#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include "cli/commands.hpp"
#include "cli/output_files.hpp"
#include "cli/parse.hpp"
#include "cli/reduced_dag.hpp"
#include "cli/written_files.hpp"
#include "voxdag/algebra/coarsen.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/io/process_memory.hpp"
#include "voxdag/file/long_vdag_file.hpp"
#include "voxdag/file/vdag_writer.hpp"
#include "voxdag/stored/compact/encode_svdag.hpp"

namespace voxdag::cli {
namespace {

struct ConvertArguments {
  std::string output;
  bool compact = false, plain = false, wire = false;
  DagReduction reduction;
  std::optional<int> coarsen_by;  ///< Levels to drop, instead of reduction.levels.
  std::uint64_t memory_limit = 0;
};

/// Returns the reduction of a file with `levels`. Throws Error if it drops too many.
DagReduction reduction_of(const ConvertArguments& arguments, int levels, const std::string& path) {
  DagReduction reduction = arguments.reduction;
  if (!arguments.coarsen_by) return reduction;
  if (*arguments.coarsen_by > levels - kMinLevels)
    throw Error(path, "",
                fmt::format("has {} levels, so that --by can drop {} at most", levels,
                            levels - kMinLevels));
  reduction.levels = levels - *arguments.coarsen_by;
  return reduction;
}

/// Reads the input. A DAG with long pointers is read with the levels of the result, and `reduction`
/// asks for no fewer afterwards.
DagModel read_input(const ConvertArguments& arguments, DagReduction& reduction,
                    MemoryBudget& memory, Session& session) {
  const std::string& path = session.subject;
  VdagContainer opened(path, &memory);
  if (opened.kind() != VdagKind::kLong) {
    DagModel file(std::move(opened), {&memory, &session.progress});
    reduction = reduction_of(arguments, file.grid().levels, path);
    return file;
  }
  const LongVdagFile file(std::move(opened));
  reduction = reduction_of(arguments, file.view().levels, path);
  const int levels = std::min(reduction.levels.value_or(kMaxLevels), file.view().levels);
  if (reduction.levels == levels) reduction.levels.reset();
  if (levels == file.view().levels && file.view().node_words() > kMaxPlainWords)
    throw Error(path, "",
                "has too many nodes for 32-bit pointers: give fewer levels (voxdag coarsen), or a "
                "window (voxdag crop)");
  Svdag dag = coarsen(file.view(), levels, {&memory, &session.progress});
  VdagMetadata metadata = file.metadata();
  if (levels < file.view().levels) metadata = coarser_metadata(metadata, dag.view());
  return {std::move(dag), {}, std::move(metadata), &memory};
}

void convert(const ConvertArguments& arguments, Session& session) {
  check_dag_writable(arguments.output);
  MemoryBudget memory = command_budget(arguments.memory_limit);
  DagReduction reduction;
  const DagModel file = read_input(arguments, reduction, memory, session);
  const ReducedDag dag(file, session.subject, reduction, {&memory, &session.progress});
  const bool compact = arguments.compact || (!arguments.plain && file.is_compact());
  const DagAttributesView attributes = dag.attributes();
  const AttributeForm form = arguments.wire ? AttributeForm::kWire : AttributeForm::kPages;
  const MemoryReservation coded = reserve_coded(attributes, form, &memory);
  if (compact) {
    write_vdag(arguments.output, encode_svdag(dag.dag(), {}, {&memory, &session.progress}),
               dag.metadata(), attributes, form);
  } else {
    write_vdag(arguments.output, dag.dag(), dag.metadata(), attributes, form);
  }
  print_written({{arguments.output},
                 {{"voxels", dag.metadata().counts.voxels}},
                 compact ? "compact form" : "plain form"},
                session);
}

/// Adds the options of the output that both commands have.
void add_output_form(const Command& command, ConvertArguments& arguments) {
  command.text("-o,--output", arguments.output, "OUT", "The .vdag file to write").required();
  const Option compact = command.flag("--compact", arguments.compact,
                                      "Write the compact form (default: the form of FILE)");
  command.flag("--plain", arguments.plain, "Write the plain form, the layout of the paper")
      .not_with(compact);
}

void add_work_options(const Command& command, const std::shared_ptr<ConvertArguments>& arguments,
                      Session& session) {
  add_memory_option(command, arguments->memory_limit);
  add_threads_option(command, session);
  add_json_option(command, session);
  add_quiet_option(command, session);
  command.when_parsed([arguments, &session] {
    check_distinct({{"--output", arguments->output}}, session);
    session.work = [arguments, &session] { convert(*arguments, session); };
  });
}

}  // namespace

void add_convert_command(const Command& program, Session& session) {
  const auto arguments = std::make_shared<ConvertArguments>();
  const Command command = program.add(
      "convert", "Write a DAG in the compact or the plain form, or with fewer levels",
      "voxdag convert scene.vdag --compact -o small.vdag\n"
      "  voxdag convert small.vdag --plain -o scene.vdag\n"
      "  voxdag convert scene.vdag --levels 10 -o coarse.vdag\n"
      "  voxdag convert scene.vdag --compact --wire -o to_send.vdag\n\n"
      "The result depends on the voxels alone: converting there and back gives the same "
      "bytes. The command holds the whole DAG in memory, refuses a file that needs more "
      "than --memory, and then writes nothing.\n\n"
      "Both forms and coarser grids keep colours, normals and material ids. In a coarser "
      "grid every cell keeps the values that it had as an inner cell of the fine grid. "
      "--color-bound and --normal-bound let these values change, so that they take fewer "
      "bytes.\n\n"
      "Without --wire, rays find the colours, normals and material ids of a cell at once. With "
      "--wire, a reader decodes all of them before it uses any; they are smaller than `xz -9` "
      "makes "
      "them. `voxdag info` tells which form a file has. The web pages of `voxdag export` hold the "
      "wire form, and `voxdag view` shows it.");
  command.text("file", session.subject, "FILE", "The .vdag file, in either form").required();
  add_output_form(command, *arguments);
  command.flag("--wire", arguments->wire,
               "Code colours, normals and material ids for sending: a quarter smaller or more, but "
               "readers decode all of them");
  add_reduction_options(command, arguments->reduction);
  add_work_options(command, arguments, session);
}

void add_coarsen_command(const Command& program, Session& session) {
  const auto arguments = std::make_shared<ConvertArguments>();
  const Command command = program.add(
      "coarsen", "Drop levels of a DAG: each one halves the resolution",
      "voxdag coarsen scene.vdag --by 2 -o small.vdag\n\n"
      "A voxel of the result is set if any of the voxels in it is. Colours, normals and material "
      "ids stay. `voxdag convert --levels` drops levels, too, and can store their values with "
      "larger "
      "errors.");
  command.text("file", session.subject, "FILE", "The .vdag file, in either form").required();
  command
      .optional_number<int>("--by", arguments->coarsen_by,
                            NumberRange::whole(1, kMaxLevels - kMinLevels), "K",
                            "Number of levels to drop")
      .required();
  add_output_form(command, *arguments);
  add_work_options(command, arguments, session);
}

}  // namespace voxdag::cli

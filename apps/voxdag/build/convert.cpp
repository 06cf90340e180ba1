/// `voxdag convert`: writes a DAG in its other form, or with fewer levels.
#include <fmt/core.h>

#include <filesystem>
#include <memory>

#include "cli/commands.hpp"
#include "cli/output_files.hpp"
#include "cli/parse.hpp"
#include "cli/reduced_dag.hpp"
#include "cli/stopwatch.hpp"
#include "voxdag/compact/encode_svdag.hpp"
#include "voxdag/file/vdag_writer.hpp"
#include "voxdag/io/process_memory.hpp"
#include "voxdag/report/human.hpp"

namespace voxdag {
namespace {

struct ConvertArguments {
  std::string output;
  bool compact = false, plain = false, wire = false;
  DagReduction reduction;
  std::uint64_t memory_limit = 0;
};

void convert(const ConvertArguments& arguments, Session& session) {
  check_writable(arguments.output);
  const Stopwatch watch;
  MemoryBudget memory = command_budget(arguments.memory_limit);
  const DagInput file(session.subject, &session.progress, &memory);
  const ReducedDag dag(file, session.subject, arguments.reduction, &memory, &session.progress);
  const bool compact = arguments.compact || (!arguments.plain && file.is_compact());
  const DagAttributesView attributes = dag.attributes();
  const AttributeForm form = arguments.wire ? AttributeForm::kWire : AttributeForm::kPages;
  const MemoryReservation coded = reserve_coded(attributes, form, &memory);
  if (compact) {
    write_vdag(arguments.output, encode_svdag(dag.dag(), {.memory = &memory}, &session.progress),
               dag.metadata(), attributes, form);
  } else {
    write_vdag(arguments.output, dag.dag(), dag.metadata(), attributes, form);
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
  command.flag("--wire", arguments->wire,
               "Code colours, normals and material ids for sending: a quarter smaller or more, but "
               "readers decode "
               "all of them");
  add_reduction_options(command, arguments->reduction);
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

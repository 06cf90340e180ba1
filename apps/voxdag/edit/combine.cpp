/// `voxdag combine` and `voxdag diff`: set operations on two DAGs.
#include "voxdag/algebra/combine.hpp"

#include <fmt/core.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "cli/commands.hpp"
#include "cli/output_files.hpp"
#include "edit/edited_file.hpp"
#include "voxdag/core/io/process_memory.hpp"
#include "voxdag/core/with_file_name.hpp"
#include "voxdag/file/model/aligned_models.hpp"
#include "voxdag/file/report/human.hpp"

namespace voxdag::cli {
namespace {

/// Two files in one grid.
class AlignedFiles {
 public:
  AlignedFiles(const std::string& first, const std::string& second, const EditArguments& arguments,
               Work work)
      : first_(first, work), second_(second, work) {
    refuse_attributes(first_, first, arguments);
    refuse_attributes(second_, second, arguments);
    with_file_name(second, [&] { models_.emplace(first_, second_, work); });
  }
  AlignedFiles(const AlignedFiles&) = delete;
  AlignedFiles& operator=(const AlignedFiles&) = delete;

  const DagModel& first() const { return first_; }
  const AlignedModels& models() const { return *models_; }

 private:
  DagModel first_, second_;
  std::optional<AlignedModels> models_;
};

struct CombineArguments {
  EditArguments edit;
  std::string second;
  bool is_union = false, is_intersection = false, is_difference = false, is_symmetric = false;
};

void run_combine(const CombineArguments& arguments, Session& session) {
  check_writable(arguments.edit.output);
  MemoryBudget memory = command_budget(arguments.edit.memory_limit);
  const AlignedFiles files(session.subject, arguments.second, arguments.edit,
                           {&memory, &session.progress});
  const SetOperation operation = arguments.is_union          ? SetOperation::kUnion
                                 : arguments.is_intersection ? SetOperation::kIntersection
                                 : arguments.is_difference   ? SetOperation::kDifference
                                                             : SetOperation::kSymmetric;
  const char* name = arguments.is_union          ? "union with "
                     : arguments.is_intersection ? "intersection with "
                     : arguments.is_difference   ? "minus "
                                                 : "symmetric difference with ";
  const std::string edit = name + std::filesystem::path(arguments.second).filename().string();
  write_edited(arguments.edit, files.models().result(operation), files.models().grid_of(operation),
               files.first(), edit, memory, session);
}

struct DiffArguments {
  EditArguments edit;
  std::string second;
};

void run_diff(const DiffArguments& arguments, Session& session) {
  if (!arguments.edit.output.empty()) check_writable(arguments.edit.output);
  MemoryBudget memory = command_budget(arguments.edit.memory_limit);
  EditArguments voxels_only = arguments.edit;
  voxels_only.drop_attributes = true;
  const AlignedFiles files(session.subject, arguments.second, voxels_only,
                           {&memory, &session.progress});
  const auto count = [&](SetOperation operation) {
    return count_svdag(files.models().combine(operation).view()).voxels;
  };
  Svdag dag = files.models().combine(SetOperation::kSymmetric);
  const std::uint64_t differing = count_svdag(dag.view()).voxels;
  const std::uint64_t only_first = count(SetOperation::kDifference);
  const std::uint64_t both = count(SetOperation::kIntersection);
  if (!arguments.edit.output.empty()) {
    const bool quiet = session.quiet;
    session.quiet = true;
    write_edited(
        voxels_only, std::move(dag), files.models().grid(), files.first(),
        "symmetric difference with " + std::filesystem::path(arguments.second).filename().string(),
        memory, session);
    session.quiet = quiet;
  }
  session.bar.clear();
  if (session.json) {
    const nlohmann::ordered_json json = {{"only_in_first", only_first},
                                         {"only_in_second", differing - only_first},
                                         {"in_both", both},
                                         {"differing", differing}};
    fmt::print("{}", json_text(json));
  } else if (!session.quiet) {
    fmt::print("only in {}: {} voxels\nonly in {}: {} voxels\nin both: {} voxels\n",
               session.subject, with_commas(only_first), arguments.second,
               with_commas(differing - only_first), with_commas(both));
  }
}

}  // namespace

void add_combine_command(const Command& program, Session& session) {
  const auto arguments = std::make_shared<CombineArguments>();
  const Command command = program.add(
      "combine", "Write the union, intersection or difference of two DAGs",
      "voxdag combine body.vdag hole.vdag --subtract -o drilled.vdag\n\n"
      "The grids may have other sizes and places if their voxels coincide, within "
      "1/1000 of a voxel: `voxdag build --voxel-size` and `voxdag build --bounds` make "
      "such grids. Other grids are refused. The result of --union and --xor gets the "
      "smallest grid that starts at the lower corner of both and holds both; the result "
      "of --intersect and --subtract keeps the grid of A.");
  command.text("first", session.subject, "A", "A .vdag file").required();
  command.text("second", arguments->second, "B", "Another .vdag file").required();
  const Option all = command.flag("--union", arguments->is_union, "Voxels of A, of B or of both");
  const Option common =
      command.flag("--intersect", arguments->is_intersection, "Voxels of A that B has, too")
          .not_with(all);
  const Option minus =
      command.flag("--subtract", arguments->is_difference, "Voxels of A that B does not have")
          .not_with(all)
          .not_with(common);
  command.flag("--xor", arguments->is_symmetric, "Voxels of A or of B, but not of both")
      .not_with(all)
      .not_with(common)
      .not_with(minus);
  add_edit_options(command, arguments->edit, session);
  command.when_parsed([arguments, &session] {
    if (!arguments->is_union && !arguments->is_intersection && !arguments->is_difference &&
        !arguments->is_symmetric)
      throw UsageError("one of --union, --intersect, --subtract and --xor is required");
    session.inputs.push_back(arguments->second);
    check_distinct({{"--output", arguments->edit.output}}, session);
    session.work = [arguments, &session] { run_combine(*arguments, session); };
  });
}

void add_diff_command(const Command& program, Session& session) {
  const auto arguments = std::make_shared<DiffArguments>();
  const Command command = program.add(
      "diff", "Count the voxels in which two DAGs differ, and write them",
      "voxdag diff before.vdag after.vdag -o changed.vdag\n\n"
      "Counts the voxels that only A has, that only B has, and that both have. The grids "
      "are aligned as by `voxdag combine --xor`.");
  command.text("first", session.subject, "A", "A .vdag file").required();
  command.text("second", arguments->second, "B", "Another .vdag file").required();
  EditArguments& edit = arguments->edit;
  add_optional_output(command, edit, "The .vdag file to write: voxels of only one of both");
  add_memory_option(command, edit.memory_limit);
  add_json_option(command, session);
  add_threads_option(command, session);
  add_quiet_option(command, session);
  command.when_parsed([arguments, &session] {
    session.inputs.push_back(arguments->second);
    check_distinct({{"--output", arguments->edit.output}}, session);
    session.work = [arguments, &session] { run_diff(*arguments, session); };
  });
}

}  // namespace voxdag::cli

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

SetOperation chosen_operation(const CombineArguments& arguments) {
  if (arguments.is_union) return SetOperation::kUnion;
  if (arguments.is_intersection) return SetOperation::kIntersection;
  if (arguments.is_difference) return SetOperation::kDifference;
  return SetOperation::kSymmetric;
}

/// Returns the text that tells in the metadata of the result how its voxels were made.
std::string edit_text(SetOperation operation, const std::string& second) {
  const std::string name = std::filesystem::path(second).filename().string();
  switch (operation) {
    case SetOperation::kUnion:
      return "union with " + name;
    case SetOperation::kIntersection:
      return "intersection with " + name;
    case SetOperation::kDifference:
      return "minus " + name;
    default:
      return "symmetric difference with " + name;
  }
}

void run_combine(const CombineArguments& arguments, Session& session) {
  check_writable(arguments.edit.output);
  MemoryBudget memory = command_budget(arguments.edit.memory_limit);
  const AlignedFiles files(session.subject, arguments.second, arguments.edit,
                           {&memory, &session.progress});
  const SetOperation operation = chosen_operation(arguments);
  write_edited(arguments.edit, files.models().result(operation), files.models().grid_of(operation),
               files.first(), edit_text(operation, arguments.second), memory, session);
}

struct DiffArguments {
  EditArguments edit;
  std::string second;
};

/// Numbers of voxels of two files.
struct VoxelCounts {
  std::uint64_t only_first, only_second, both;
};

void print_counts(const VoxelCounts& counts, const DiffArguments& arguments, Session& session) {
  session.bar.clear();
  if (session.json) {
    const nlohmann::ordered_json json = {{"only_in_first", counts.only_first},
                                         {"only_in_second", counts.only_second},
                                         {"in_both", counts.both},
                                         {"differing", counts.only_first + counts.only_second}};
    fmt::print("{}", json_text(json));
  } else if (!session.quiet) {
    fmt::print("only in {}: {} voxels\nonly in {}: {} voxels\nin both: {} voxels\n",
               session.subject, with_commas(counts.only_first), arguments.second,
               with_commas(counts.only_second), with_commas(counts.both));
  }
}

/// Writes the voxels that differ. Prints no summary of the file: the command prints its counts.
void write_difference(const DiffArguments& arguments, Svdag differing, const AlignedFiles& files,
                      MemoryBudget& memory, Session& session) {
  const bool quiet = std::exchange(session.quiet, true);
  write_edited(arguments.edit, std::move(differing), files.models().grid(), files.first(),
               edit_text(SetOperation::kSymmetric, arguments.second), memory, session);
  session.quiet = quiet;
}

void run_diff(const DiffArguments& arguments, Session& session) {
  if (!arguments.edit.output.empty()) check_writable(arguments.edit.output);
  MemoryBudget memory = command_budget(arguments.edit.memory_limit);
  const AlignedFiles files(session.subject, arguments.second, arguments.edit,
                           {&memory, &session.progress});
  const auto count = [&](SetOperation operation) {
    return count_svdag(files.models().combine(operation).view()).voxels;
  };
  Svdag differing = files.models().combine(SetOperation::kSymmetric);
  const std::uint64_t either = count_svdag(differing.view()).voxels,
                      only_first = count(SetOperation::kDifference);
  const VoxelCounts counts{only_first, either - only_first, count(SetOperation::kIntersection)};
  if (!arguments.edit.output.empty())
    write_difference(arguments, std::move(differing), files, memory, session);
  print_counts(counts, arguments, session);
}

}  // namespace

void add_combine_command(const Command& program, Session& session) {
  const auto arguments = std::make_shared<CombineArguments>();
  const Command command = program.add(
      "combine", "Write the union, intersection or difference of two DAGs",
      "voxdag combine body.vdag hole.vdag --subtract -o drilled.vdag\n\n"
      "The grids may have other sizes and places if their voxels coincide, within "
      "1/1000 of a voxel: `voxdag build` and `voxdag import` make such grids with one "
      "--voxel-size and --snap or --bounds. Other grids are refused. The result of --union and "
      "--xor gets the "
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
  edit.drop_attributes = true;  // The command compares voxels only.
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

/// `voxdag combine` and `voxdag diff`: set operations on two DAGs.
#include "voxdag/algebra/combine.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "cli/commands.hpp"
#include "cli/output_files.hpp"
#include "edit/edited_file.hpp"
#include "voxdag/algebra/shift.hpp"
#include "voxdag/core/io/process_memory.hpp"
#include "voxdag/core/with_file_name.hpp"
#include "voxdag/file/model/aligned_models.hpp"
#include "voxdag/file/report/human.hpp"
#include "voxdag/stored/svdag/svdag_counts.hpp"
#include "voxdag/stored/svdag/voxel_set.hpp"

namespace voxdag::cli {
namespace {

/// Returns the least coordinates of voxels along each axis.
Vec3i lowest_corner(const SvdagView& dag) {
  const auto side = std::int32_t{1} << dag.levels;
  Vec3i low{side, side, side};
  VoxelSet(dag).for_each_leaf_block(Box3i{{0, 0, 0}, low}, [&](Vec3i origin, std::uint64_t mask) {
    for (; mask != 0; mask &= mask - 1) {
      const Vec3i voxel =
          origin + morton_decode(static_cast<std::uint64_t>(std::countr_zero(mask)));
      for (int axis = 0; axis < 3; ++axis) low[axis] = std::min(low[axis], voxel[axis]);
    }
  });
  return low;
}

/// Returns the shift, in voxels, that makes the voxels of `a` those of `b`, if there is one.
std::optional<Vec3i> equal_when_shifted(const SvdagView& a, const SvdagView& b, Work work) {
  if (a.is_empty() || b.is_empty() || count_svdag(a).voxels != count_svdag(b).voxels) return {};
  const Vec3i by = lowest_corner(b) - lowest_corner(a);
  const int levels = std::max(a.levels, b.levels);
  const Svdag moved = shift(a, by, levels, work), same = shift(b, {}, levels, work);
  const Svdag differing = combine(moved.view(), same.view(), SetOperation::kSymmetric, work);
  return differing.view().is_empty() ? std::optional(by) : std::nullopt;
}

/// Two files in one grid.
class AlignedFiles {
 public:
  AlignedFiles(const std::string& first, const std::string& second, Work work)
      : first_(first, work), second_(second, work) {
    with_file_name(second, [&] {
      try {
        models_.emplace(first_, second_, work);
      } catch (const Error& error) {
        if (!error.reason().starts_with("the grids")) throw;
        throw Error(fmt::format("{}; voxdag build --grid-of {} builds in that grid{}",
                                error.reason(), first, shift_text(work)));
      }
    });
  }
  AlignedFiles(const AlignedFiles&) = delete;
  AlignedFiles& operator=(const AlignedFiles&) = delete;

  const DagModel& first() const { return first_; }
  const AlignedModels& models() const { return *models_; }
  /// Returns by how many voxels the first file must move to have the voxels of the second one; none
  /// if no shift does that.
  std::optional<Vec3i> equal_shift(Work work) const {
    const std::optional<Vec3i> by = equal_when_shifted(first_.view(), second_.view(), work);
    if (!by) return by;
    const Vec3d place = first_.grid().to_grid(second_.grid().to_world(Vec3d(*by)));
    return Vec3i{static_cast<std::int32_t>(std::lround(place.x)),
                 static_cast<std::int32_t>(std::lround(place.y)),
                 static_cast<std::int32_t>(std::lround(place.z))};
  }

 private:
  /// Returns what to add to the error if the voxels are equal in their own grids.
  std::string shift_text(Work work) const {
    const std::optional<Vec3i> by = equal_when_shifted(first_.view(), second_.view(), work);
    if (!by) return "";
    const Vec3d at = second_.grid().to_world(Vec3d(*by)) - first_.grid().origin;
    return fmt::format("; the voxels are equal if the first file moves by {:.9g},{:.9g},{:.9g}",
                       at.x, at.y, at.z);
  }

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

/// Says which kinds of values only one of two files has.
void warn_of_missing(const std::vector<PlacedModel>& files, const std::vector<std::string>& paths,
                     Session& session) {
  for (std::size_t i = 0; i < 2; ++i) {
    const ValueKinds own = kinds_of(files[i].model.attributes());
    const ValueKinds other = kinds_of(files[1 - i].model.attributes());
    std::string kinds;
    const auto add = [&](const char* name, bool is_missing) {
      if (is_missing) kinds += (kinds.empty() ? "" : ", ") + std::string(name);
    };
    add("colours", other.colors && !own.colors);
    add("normals", other.normals && !own.normals);
    add("material ids", other.materials != 0 && own.materials == 0);
    const ChannelsView own_channels = files[i].model.attributes().channels,
                       other_channels = files[1 - i].model.attributes().channels;
    for (std::size_t k = 0; k < other_channels.count(); ++k)
      add(("channel " + std::string(other_channels[k].name())).c_str(),
          own_channels.find(other_channels[k].name()) == own_channels.count());
    if (kinds.empty()) continue;
    print_warnings({fmt::format("{} has no {}: its voxels count as new, and take those of the "
                                "nearest voxel of {} or given ones",
                                paths[i], kinds, paths[1 - i])},
                   session);
  }
}

void run_combine(const CombineArguments& arguments, Session& session) {
  check_dag_writable(arguments.edit.output);
  MemoryBudget memory = command_budget(arguments.edit.memory_limit);
  const AlignedFiles files(session.subject, arguments.second, {&memory, &session.progress});
  const SetOperation operation = chosen_operation(arguments);
  const std::vector<PlacedModel> placed = files.models().placed(operation);
  if (placed.size() == 2 && !arguments.edit.drop_attributes)
    warn_of_missing(placed, {session.subject, arguments.second}, session);
  write_edited(arguments.edit, files.models().result(operation), files.models().grid_of(operation),
               placed, edit_text(operation, arguments.second), memory, session);
}

struct DiffArguments {
  EditArguments edit;
  std::string second;
};

/// Numbers of voxels of two files.
struct VoxelCounts {
  std::uint64_t only_first, only_second, both;
};

/// `by`: the shift of the first file that makes both equal.
void print_counts(const VoxelCounts& counts, const std::optional<Vec3i>& by,
                  const DiffArguments& arguments, Session& session) {
  session.bar.clear();
  if (session.json) {
    nlohmann::ordered_json json = {{"only_in_first", counts.only_first},
                                   {"only_in_second", counts.only_second},
                                   {"in_both", counts.both},
                                   {"differing", counts.only_first + counts.only_second}};
    if (by) json["equal_when_shifted"] = {by->x, by->y, by->z};
    fmt::print("{}", json_text(json));
  } else if (!session.quiet) {
    fmt::print("only in {}: {} voxels\nonly in {}: {} voxels\nin both: {} voxels\n",
               session.subject, with_commas(counts.only_first), arguments.second,
               with_commas(counts.only_second), with_commas(counts.both));
    if (by)
      fmt::print("equal if {} is shifted: voxdag shift --by {},{},{}\n", session.subject, by->x,
                 by->y, by->z);
  }
}

/// Writes the voxels that differ. Prints no summary of the file: the command prints its counts.
void write_difference(const DiffArguments& arguments, Svdag differing, const AlignedFiles& files,
                      MemoryBudget& memory, Session& session) {
  const CommandState asked = session;
  session.quiet = true;
  session.json = false;
  const PlacedModel source{files.first()};
  write_edited(arguments.edit, std::move(differing), files.models().grid(), {&source, 1},
               edit_text(SetOperation::kSymmetric, arguments.second), memory, session);
  static_cast<CommandState&>(session) = asked;
}

void run_diff(const DiffArguments& arguments, Session& session) {
  if (!arguments.edit.output.empty()) check_dag_writable(arguments.edit.output);
  MemoryBudget memory = command_budget(arguments.edit.memory_limit);
  const AlignedFiles files(session.subject, arguments.second, {&memory, &session.progress});
  const auto count = [&](SetOperation operation) {
    return count_svdag(files.models().combine(operation).view()).voxels;
  };
  Svdag differing = files.models().combine(SetOperation::kSymmetric);
  const std::uint64_t either = count_svdag(differing.view()).voxels,
                      only_first = count(SetOperation::kDifference);
  const VoxelCounts counts{only_first, either - only_first, count(SetOperation::kIntersection)};
  if (!arguments.edit.output.empty())
    write_difference(arguments, std::move(differing), files, memory, session);
  std::optional<Vec3i> by;
  if (counts.only_first > 0 && counts.only_first == counts.only_second)
    by = files.equal_shift({&memory, &session.progress});
  print_counts(counts, by, arguments, session);
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
  add_edit_options(command, arguments->edit, session, true);
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

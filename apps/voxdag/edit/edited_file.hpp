#pragma once
/// What the commands that change the voxels of a DAG have in common.
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cli/command.hpp"
#include "cli/session.hpp"
#include "voxdag/algebra/grow.hpp"
#include "voxdag/core/memory_budget.hpp"
#include "voxdag/file/model/edited.hpp"

namespace voxdag::cli {

struct EditArguments {
  std::string output;
  bool compact = false, plain = false, drop_attributes = false;
  EditedValues values;
  std::uint64_t memory_limit = 0;
};

/// Adds --output, --compact, --plain, the options of add_value_options(), --memory, --threads,
/// --json and --quiet. They belong to `arguments`.
void add_edit_options(const Command& command, EditArguments& arguments, Session& session,
                      bool makes_voxels = false);

/// Adds --color-bound, --normal-bound and --drop-attributes, and --color and --material if the
/// command makes new voxels. `is_written`: whether the command writes a file.
void add_value_options(
    const Command& command, EditArguments& arguments, bool makes_voxels,
    const std::function<bool()>& is_written = [] { return true; });

/// Adds --output, --compact and --plain for a command whose output is optional: `help`
/// says what it writes. Returns --output. add_listing_options() adds the rest.
Option add_optional_output(const Command& command, EditArguments& arguments,
                           const std::string& help);

/// Adds --color-bound, --normal-bound, --drop-attributes, --memory, --json, --threads and --quiet
/// for a command that lists something, and writes a file if --output is given.
void add_listing_options(const Command& command, EditArguments& arguments, Session& session);

/// Adds --neighbours.
void add_neighbours_option(const Command& command, Neighbours& neighbours);

/// Writes `dag` in the form that the options ask for, else in that of the first of `sources`. The
/// grid is `grid`; voxels keep the attributes of `sources` unless --drop-attributes was given. The
/// metadata is that of the first source and says in `build` how the voxels were made: `edit`.
/// Prints a summary.
void write_edited(const EditArguments& arguments, Svdag dag, const Grid& grid,
                  std::span<const PlacedModel> sources, const std::string& edit,
                  MemoryBudget& memory, Session& session);
/// Writes `model` in the compact or the plain form. Prints a summary with these counts.
void write_edited(const EditArguments& arguments, DagModel model, bool compact,
                  MemoryBudget& memory, Session& session,
                  const std::vector<std::pair<std::string, std::uint64_t>>& counts = {});

}  // namespace voxdag::cli

#pragma once
/// What the commands that change the voxels of a DAG have in common.
#include <string>
#include <utility>
#include <vector>

#include "cli/command.hpp"
#include "cli/session.hpp"
#include "voxdag/algebra/grow.hpp"
#include "voxdag/core/memory_budget.hpp"
#include "voxdag/file/model/scene_model.hpp"

namespace voxdag::cli {

struct EditArguments {
  std::string output;
  bool compact = false, plain = false, drop_attributes = false;
  std::uint64_t memory_limit = 0;
};

/// Adds --output, --compact, --plain, --drop-attributes, --memory, --threads, --json and
/// --quiet. They belong to `arguments`.
void add_edit_options(const Command& command, EditArguments& arguments, Session& session);

/// Adds --output, --compact and --plain for a command whose output is optional: `help` says what it
/// writes. Returns --output.
Option add_optional_output(const Command& command, EditArguments& arguments,
                           const std::string& help);

/// Adds --neighbours.
void add_neighbours_option(const Command& command, Neighbours& neighbours);

/// Throws Error if the file has colours, normals or material ids and --drop-attributes was not
/// given: a command that changes voxels keeps none.
void refuse_attributes(const DagModel& file, const std::string& path,
                       const EditArguments& arguments);

/// Writes `dag` in the form that the options ask for, else in that of `source`. The grid is `grid`;
/// the metadata is that of `source` and says in `build` how the voxels were made: `edit`. Prints a
/// summary.
void write_edited(const EditArguments& arguments, Svdag dag, const Grid& grid,
                  const DagModel& source, const std::string& edit, MemoryBudget& memory,
                  Session& session);
/// Writes `model` in the compact or the plain form. Prints a summary with these counts.
void write_edited(const EditArguments& arguments, DagModel model, bool compact,
                  MemoryBudget& memory, Session& session,
                  const std::vector<std::pair<std::string, std::uint64_t>>& counts = {});

}  // namespace voxdag::cli

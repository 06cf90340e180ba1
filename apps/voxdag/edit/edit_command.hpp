#pragma once
/// Commands that make one DAG from another.
#include <functional>
#include <optional>
#include <string>

#include "edit/edited_file.hpp"

namespace voxdag::cli {

/// The file, what is known about it, and the memory and progress of an edit.
struct EditContext {
  const std::string& path;  ///< The input, for errors.
  const std::string& unit;  ///< Of the coordinates; empty: not known.
  Work work;
  std::optional<char> up = {};  ///< The axis that points up.
};

/// The grid of the result, and where it has the voxels of the input.
struct Placing {
  Grid grid;
  Orientation orientation{};
  Vec3i offset{};
};

/// Makes the DAG of a command. May change the placing.
using Edit =
    std::function<Svdag(const SvdagView& dag, Placing& placing, const EditContext& context)>;

/// Makes the plain DAG of a command from one with long pointers.
using LongEdit = std::function<Svdag(const LongSvdagView& dag, const EditContext& context)>;

/// Lets the command read FILE, apply the edit and write OUT. describe() says what was done. Without
/// `long_edit`, files with long pointers are refused. `makes_voxels`: the result may have voxels
/// that the input does not have.
void add_edit(const Command& command, Session& session, const Edit& edit,
              const std::function<std::string()>& describe, const LongEdit& long_edit = {},
              bool makes_voxels = false);

/// Adds `voxdag hollow`.
void add_hollow_command(const Command& program, Session& session);
/// Adds `voxdag carve`.
void add_carve_command(const Command& program, Session& session);

}  // namespace voxdag::cli

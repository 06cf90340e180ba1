#pragma once
/// The input of commands that show, render, export or measure voxels: a .vdag or .esvo file, or a
/// file that `voxdag build` or `voxdag import` reads.
#include <cstdint>
#include <functional>
#include <string>

#include "cli/session.hpp"

namespace voxdag::cli {

struct SceneInput {
  std::string resolution;    ///< The text of -r; empty: the default of the command that builds.
  std::string keep;          ///< The DAG to write; empty: a scratch file.
  bool with_colors = false;  ///< Give the DAG the colours of a mesh, if it has some.
};

/// Adds the positional FILE, which sets session.subject, -r and --keep. `help` says which .vdag and
/// .esvo files the command takes. Without FILE, session.subject is empty.
void add_scene_input(const Command& command, SceneInput& input, Session& session,
                     const std::string& help, bool is_required = true);

/// Calls work() with a DAG or ESVO as session.subject. If the subject is another kind of file, it
/// first builds or imports a DAG of it, and says so in one line on stderr.
void work_on_scene(const SceneInput& input, Session& session, const std::function<void()>& work);

}  // namespace voxdag::cli

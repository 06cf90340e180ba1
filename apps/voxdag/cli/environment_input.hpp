#pragma once
/// The option --environment: the light around a scene.
#include <memory>
#include <string>

#include "cli/command.hpp"
#include "cli/session.hpp"
#include "voxdag/render/environment.hpp"

namespace voxdag::cli {

/// Adds --environment, which stores a file or the name of a built-in environment. `help` says what
/// it does.
Option add_environment_option(const Command& command, std::string& value, const std::string& help);

/// Adds the file of --environment, if it is one, to session.inputs.
void note_environment_file(const std::string& value, Session& session);

/// Returns the environment of --environment; null for an empty value. Throws Error with the file.
std::shared_ptr<const Environment> read_environment(const std::string& value);

}  // namespace voxdag::cli

#pragma once
/// The names of temporary files that a signal handler removes before the process ends.
#include <filesystem>

namespace voxdag {

/// Registers the name of a temporary file. Returns a handle for the functions below, or null if too
/// many names are registered. Thread-safe.
char* note_unfinished(const std::filesystem::path& name);

/// Returns whether the name is still registered: remove_unfinished_files() has not taken it.
bool is_noted(const char* name);

/// Unregisters a name, unless remove_unfinished_files() has taken it. Accepts null.
void forget_unfinished(char* name) noexcept;

/// Removes the temporary files of every AtomicFile that was not committed. Async-signal-safe: for
/// signal handlers that are about to end the process. Any later commit() fails. Removes at most 64
/// files.
void remove_unfinished_files() noexcept;

}  // namespace voxdag

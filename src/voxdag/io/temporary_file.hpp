#pragma once
/// Temporary files beside an output: their names, their locks, and the ones that killed processes
/// left behind.
#include <filesystem>

namespace voxdag {

/// Returns a new name in the folder of `target`: NAME.voxdag-PID-N, with this process's id and a
/// serial number. NAME is cut to 200 bytes.
std::filesystem::path temporary_name(const std::filesystem::path& target);

/// Locks a file of this process (flock) for as long as its open file description lives. The lock
/// tells remove_leftovers() of other processes, also in other containers, that its writer lives.
/// File systems without locks are left alone.
void lock_temporary(int descriptor) noexcept;

/// Removes temporary files of `target` whose writer was killed: regular files with a name that
/// temporary_name() makes, of this user, of no running process, which no process locks. Lists each
/// folder once per process. Never throws.
void remove_leftovers(const std::filesystem::path& target) noexcept;

}  // namespace voxdag

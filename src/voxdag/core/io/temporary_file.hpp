#pragma once
/// Temporary files beside an output: their names, their locks, and the removal of those that killed
/// processes left behind.
#include <filesystem>

namespace voxdag {

/// Returns a new name in the folder of `target`: NAME.voxdag-PID-N, with this process's id and a
/// serial number. NAME is cut to 200 bytes.
std::filesystem::path temporary_name(const std::filesystem::path& target);

/// Locks a file of this process (flock) as long as its open file description lives. The lock tells
/// remove_leftovers() in other processes, also in other containers, that the writer is alive. Does
/// nothing on file systems without locks.
void lock_temporary(int descriptor) noexcept;

/// Removes temporary files of `target` whose writer was killed: regular files of this user, with a
/// name from temporary_name(), whose process does not run and which no process locks. Also removes
/// NAME.voxdag-PID-N.locktest.RANK, which Open MPI leaves behind if it is killed while it opens
/// such a file. Lists each folder once per process. Never throws.
void remove_leftovers(const std::filesystem::path& target) noexcept;

}  // namespace voxdag

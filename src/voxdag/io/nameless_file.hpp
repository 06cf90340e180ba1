#pragma once
/// Files that have no name yet: nothing is left of them however the process ends.
#include <filesystem>

namespace voxdag {

/// A new file on the file system of `folder`, for reading and writing: its descriptor, or -1 where
/// there are no such files. `folder` may be empty: the current one.
int open_nameless_file(const std::filesystem::path& folder);

/// Gives it a name in the folder that it was opened for. Returns 0, or the system's error: EEXIST
/// where the name is taken.
int name_file(int descriptor, const std::filesystem::path& name) noexcept;

/// Copies all its bytes and its mode to another file, an empty one, for where it may have no name.
/// Returns 0, or the system's error.
int copy_file(int from, int to) noexcept;

}  // namespace voxdag

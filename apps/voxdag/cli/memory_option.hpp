#pragma once
/// `--memory LIMIT` of commands that build, and the budget that it sets.
#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <optional>

#include "voxdag/core/memory_budget.hpp"

namespace voxdag {

/// Adds `--memory LIMIT`; `limit` receives the bytes, and stays 0 if the option is not given.
void add_memory_option(CLI::App& command, std::uint64_t& limit);

/// The budget of a whole command: make it before anything is read, then pass it to readers and
/// builders. Its base is what the process holds now. `limit` in bytes; 0: default_memory_limit().
MemoryBudget command_budget(std::uint64_t limit);

/// Three quarters of the memory that the system has available, or of what the process's control
/// groups allow if that is less. 0 (no limit) if the system reports neither.
std::uint64_t default_memory_limit();

/// The least memory limit in bytes of the process's control group (version 1 or 2) and of those
/// above it, if there is one. Reads proc/self/cgroup and sys/fs/cgroup below `root`.
std::optional<std::uint64_t> cgroup_memory_limit(const std::filesystem::path& root = "/");

/// Bytes of memory that the process has resident; 0 if the system does not report it.
std::uint64_t resident_bytes();

}  // namespace voxdag

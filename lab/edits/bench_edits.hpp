#pragma once
/// `voxdag bench edits`: milliseconds, nodes and bytes of edits of a DAG.
#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "voxdag/core/parallel/work.hpp"

namespace voxdag::lab {

struct EditsPlan {
  std::vector<std::string> scenes;   ///< .vdag files.
  std::vector<std::string> replays;  ///< Recorded sessions (edit/replay.hpp).
  std::vector<double> radii;         ///< Of single balls, in voxels.
  int repeats = 9;                   ///< Balls of each radius.
  std::uint32_t session = 100000;    ///< Edits of a long session; 0: none.
  bool rewrites = true;              ///< Also measures algebra/combine.hpp on the whole DAG.
};

/// Times of edits of one kind, sorted, in milliseconds.
struct EditTimes {
  std::string name;  ///< A replay's file, or a radius with "add" or "remove".
  double least_radius = 0, most_radius = 0;
  std::vector<double> milliseconds, undo_milliseconds;
  std::uint64_t new_nodes = 0, new_bytes = 0;  ///< Of all edits.

  /// Returns the time that a part of the edits, 0 to 1, does not exceed.
  double quantile(double part) const;
};

/// A long session of balls of 4 to 47 voxels' radius, of which the last 1,000 can be undone.
struct LongSession {
  static constexpr std::size_t kHistory = 1000;

  EditTimes times;
  std::uint64_t most_bytes = 0;   ///< Of nodes and values behind the base, unused ones included.
  std::uint64_t early_bytes = 0;  ///< The same, of the first tenth of the edits.
};

struct EditsRun {
  std::string scene;
  int levels = 0;
  bool has_colors = false;
  std::uint64_t file_bytes = 0, base_nodes = 0, memory_bytes = 0;
  double read_seconds = 0, open_seconds = 0, save_seconds = 0;
  double rewrite_milliseconds = 0;  ///< Takes a ball of 20 voxels out by rewriting the DAG.
  std::vector<EditTimes> times;
  LongSession session;  ///< Without times if the plan has none.
};

/// Measures the plan on the current TBB arena. Replays edit one after the other, each from the
/// scene as it was; balls of single radii are undone. Throws Error and Cancelled.
std::vector<EditsRun> bench_edits(const EditsPlan& plan, Progress& progress);

nlohmann::ordered_json edits_json(const std::vector<EditsRun>& runs,
                                  const nlohmann::ordered_json& machine);
std::string edits_table(const std::vector<EditsRun>& runs);

}  // namespace voxdag::lab

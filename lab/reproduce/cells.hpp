#pragma once
/// The measurements of a report. Each is a run of voxdag in a process of its own. Finished runs are
/// kept, so that an interrupted report continues where it stopped.
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "lab/report/bench_child.hpp"

namespace voxdag::lab {

/// A run of voxdag.
struct Cell {
  std::vector<std::string> arguments;  ///< Without the program: "build", "a.obj", "--json".
  /// The files that it reads. Each is an argument, or a part of one: "NAME=FILE --option".
  std::vector<std::filesystem::path> inputs;
  std::filesystem::path output;  ///< The file that it writes; or empty.
  std::string device;            ///< Name of the CUDA device that it uses; or empty.
  double seconds_limit = 0;      ///< 0: none.
  bool prints_json = true;
  bool keeps_output = false;  ///< A kept result counts only if the output is still the same.
};

struct CellResult {
  std::string failure;          ///< Why there is no JSON; or empty.
  nlohmann::ordered_json json;  ///< What the command printed; null if it prints no JSON.
  ProcessCost cost;
  std::string output_check;  ///< Of a kept result: the checksum of an output that the cell keeps.
  bool is_kept = false;      ///< From an earlier run of the report.
};

/// Returns the command as one line for a reader: "voxdag build sponza.obj -r 1024 --json". Files
/// are named without their folders.
std::string command_of(const Cell& cell);

/// Runs cells, and keeps their results in a folder as JSON files, which several processes may
/// share. A result is used again only for the same arguments, contents of the inputs, program
/// (version and commit), processor, number of cores, number of processes that run cells at one time
/// on a machine, and CUDA device. The content of textures and material files that a mesh names does
/// not count.
class CellStore {
 public:
  /// Creates the folder if it does not exist. Commands run in `directory`. `at_once`: most
  /// processes that run cells at one time on a machine. Throws Error if the folder cannot be made.
  CellStore(std::filesystem::path folder, std::filesystem::path directory, int at_once,
            Progress& progress);

  /// Returns the program, the processor and the number of cores: one line each.
  const std::string& machine() const { return machine_; }

  /// States the content of a file that no cell writes.
  void add_input(const std::filesystem::path& file, std::uint64_t check);

  /// Returns the kept result, or runs the command and keeps its result, also if it fails. Before a
  /// run, makes those inputs that are outputs of earlier cells and were removed. Throws Error if
  /// the result cannot be written, and Cancelled.
  CellResult run(const Cell& cell);
  /// Returns whether run() would return a kept result.
  bool is_kept(const Cell& cell) const;

  /// Returns the keys of the cells that this object ran.
  const std::set<std::string>& measured_keys() const { return measured_; }
  /// Counts cells that another process ran for this report.
  void add_measured(std::string key) { measured_.insert(std::move(key)); }
  /// Returns the number of commands that were run for this report.
  std::size_t measured() const { return measured_.size(); }
  /// Returns the number of results from earlier runs of the report.
  std::size_t kept() const {
    return static_cast<std::size_t>(std::count_if(
        kept_.begin(), kept_.end(), [this](const auto& key) { return !measured_.contains(key); }));
  }

 private:
  std::string key_of(const Cell& cell) const;
  std::filesystem::path file_of(const std::string& key) const;
  CellResult measure(const Cell& cell);
  void make_inputs(const Cell& cell);

  std::filesystem::path folder_, directory_;
  int at_once_;
  Progress& progress_;
  std::string machine_;
  std::map<std::filesystem::path, std::string> contents_;
  std::map<std::filesystem::path, Cell> writers_;  ///< By output.
  std::set<std::string> kept_, measured_;          ///< Keys.
};

}  // namespace voxdag::lab

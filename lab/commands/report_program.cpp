#include "lab/commands/report_program.hpp"

#include <filesystem>

#include "lab/runs/child.hpp"
#include "voxdag/core/error.hpp"

namespace voxdag::lab {

namespace fs = std::filesystem;

std::vector<std::string> report_command(const std::vector<std::string>& arguments) {
  const fs::path beside = fs::read_symlink("/proc/self/exe").parent_path() / "report";
  const bool is_beside = fs::exists(beside / "__main__.py");
  std::vector<std::string> command{"python3", "-B",
                                   is_beside ? beside.string() : VOXDAG_LAB_REPORT};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return command;
}

std::string run_report(const std::vector<std::string>& arguments, const Progress& progress) {
  const ChildResult result = run_child(report_command(arguments), fs::current_path(), 0, progress);
  const std::string failure = failure_of(result, 0);
  if (!failure.empty()) throw Error(failure);
  return result.out;
}

}  // namespace voxdag::lab

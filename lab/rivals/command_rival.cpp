#include "lab/rivals/command_rival.hpp"

#include <array>
#include <nlohmann/json.hpp>

#include "lab/report/bench_child.hpp"
#include "lab/report/scratch_folder.hpp"

namespace voxdag::lab {
namespace {

namespace fs = std::filesystem;

std::uint64_t bytes_in(const fs::path& folder) {
  std::uint64_t bytes = 0;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
    if (entry.symlink_status().type() == fs::file_type::regular) bytes += entry.file_size();
  return bytes;
}

std::string quoted(const std::string& text) {
  std::string shell = "'";
  for (const char c : text) shell += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return shell + "'";
}

std::string filled_in(std::string command,
                      const std::array<std::array<std::string, 2>, 4>& values) {
  for (const auto& [name, value] : values)
    for (std::size_t at = 0; (at = command.find(name, at)) != std::string::npos; at += value.size())
      command.replace(at, name.size(), value);
  return command;
}

/// Returns the last line if that is a JSON object, else an empty text.
std::string last_line_json(const std::string& text) {
  std::string line = text.substr(0, text.find_last_not_of('\n') + 1);
  line.erase(0, line.find_last_of('\n') + 1);
  return nlohmann::json::parse(line, nullptr, false).is_object() ? line : "";
}

}  // namespace

CommandRival::CommandRival(std::string name, std::string command)
    : Rival(std::move(name)), command_(std::move(command)) {}

std::optional<RivalBuild> CommandRival::build(const RivalTask& task, Progress& progress) {
  const ScratchFolder folder;
  const std::string command =
      filled_in(command_, {{{"{mesh}", quoted(task.mesh)},
                            {"{out}", quoted(folder.path() / "out")},
                            {"{resolution}", std::to_string(1 << task.levels)},
                            {"{levels}", std::to_string(task.levels)}}});
  const ChildResult child =
      run_child({"/bin/sh", "-c", command}, folder.path(), task.seconds_limit, progress);
  RivalBuild build;
  build.command = command_;
  build.failure = failure_of(child, task.seconds_limit);
  build.cost = child.cost;
  build.output_bytes = bytes_in(folder.path());
  build.reported = last_line_json(child.out);
  return build;
}

}  // namespace voxdag::lab

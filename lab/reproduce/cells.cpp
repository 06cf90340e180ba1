#include "lab/reproduce/cells.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <span>

#include "lab/build/bench_mesh.hpp"
#include "lab/report/bench_machine.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/io/atomic_file.hpp"
#include "voxdag/core/io/checksum.hpp"

namespace voxdag::lab {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json cost_json(const ProcessCost& cost) {
  return {{"wall_seconds", cost.wall_seconds},
          {"user_seconds", cost.user_seconds},
          {"system_seconds", cost.system_seconds},
          {"peak_memory_bytes", cost.peak_bytes}};
}

/// Returns the kept result in a file, or nothing if there is none or it is damaged.
std::optional<CellResult> read_result(const fs::path& file) {
  std::ifstream stream(file);
  const Json json = Json::parse(stream, nullptr, false);
  if (!json.is_object()) return std::nullopt;
  try {
    CellResult result;
    result.is_kept = true;
    result.failure = json.at("failure");
    result.json = json.at("result");
    result.output_check = json.at("output_check");
    const Json& cost = json.at("cost");
    result.cost = {cost.at("wall_seconds"), cost.at("user_seconds"), cost.at("system_seconds"),
                   cost.at("peak_memory_bytes")};
    return result;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

/// Returns a checksum of the cell's output if the cell keeps it and the output is there; else "".
std::string output_check(const Cell& cell) {
  std::ifstream stream(cell.output, std::ios::binary);
  if (!cell.keeps_output || !stream) return "";
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  return fmt::format("{:016x}", xxh3_64(std::as_bytes(std::span(bytes))));
}

/// Returns the argument with the input in it, if there is one, replaced by text(input). The input
/// may follow "NAME=", and options may follow the input.
template <class Text>
std::string with_input(const Cell& cell, const std::string& argument, const Text& text) {
  for (const fs::path& input : cell.inputs) {
    const std::string path = input;
    const std::size_t at = argument.find(path);
    if (at != std::string::npos)
      return argument.substr(0, at) + text(input) + argument.substr(at + path.size());
  }
  return argument;
}

/// Returns the argument with the name of the cell's output, which may follow "NAME=", replaced.
std::string with_output(const Cell& cell, const std::string& argument, const std::string& name) {
  const std::string output = cell.output;
  if (output.empty() || output.starts_with("/dev/") || !argument.ends_with(output)) return argument;
  return fmt::format("{}{}", argument.substr(0, argument.size() - output.size()), name);
}

}  // namespace

std::string command_of(const Cell& cell) {
  const std::string output = cell.output.filename();
  std::string line = "voxdag";
  for (const std::string& argument : cell.arguments) {
    const std::string word = with_output(
        cell,
        with_input(cell, argument, [](const fs::path& input) { return input.filename().string(); }),
        output);
    line +=
        word.find(' ') == std::string::npos ? fmt::format(" {}", word) : fmt::format(" '{}'", word);
  }
  return line;
}

CellStore::CellStore(fs::path folder, fs::path directory, int at_once, Progress& progress)
    : folder_(std::move(folder)),
      directory_(std::move(directory)),
      at_once_(at_once),
      progress_(progress) {
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) throw Error(folder_, "", "cannot make the folder: " + error.message());
  const Json machine = machine_json();
  machine_ = fmt::format("{}\n{}\n{}", program_name(), machine.at("processor").get<std::string>(),
                         machine.at("cores").get<int>());
}

void CellStore::add_input(const fs::path& file, std::uint64_t check) {
  contents_[file] = fmt::format("{:016x}", check);
}

std::string CellStore::key_of(const Cell& cell) const {
  std::string text = fmt::format("{}\n{}\n", machine_, cell.seconds_limit);
  if (at_once_ > 1) text += fmt::format("{} at once\n", at_once_);
  if (!cell.device.empty()) text += cell.device + "\n";
  const std::string extension = cell.output.extension();
  for (const std::string& argument : cell.arguments) {
    const auto content = [this](const fs::path& input) { return "content " + contents_.at(input); };
    text += with_output(cell, with_input(cell, argument, content), extension) + "\n";
  }
  return fmt::format("{:016x}", xxh3_64(std::as_bytes(std::span(text))));
}

fs::path CellStore::file_of(const std::string& key) const { return folder_ / (key + ".json"); }

bool CellStore::is_kept(const Cell& cell) const {
  return read_result(file_of(key_of(cell))).has_value();
}

CellResult CellStore::run(const Cell& cell) {
  const std::string key = key_of(cell);
  if (!cell.output.empty()) {
    contents_[cell.output] = key;
    writers_[cell.output] = cell;
  }
  if (auto result = read_result(file_of(key));
      result && result->output_check == output_check(cell)) {
    kept_.insert(key);
    return *result;
  }
  make_inputs(cell);
  measured_.insert(key);
  CellResult result = measure(cell);
  const Json json{{"command", command_of(cell)},        {"program", program_name()},
                  {"machine", machine_json()},          {"at_once", at_once_},
                  {"cost", cost_json(result.cost)},     {"failure", result.failure},
                  {"output_check", output_check(cell)}, {"result", result.json}};
  write_whole_file(file_of(key), json.dump(2) + "\n");
  return result;
}

CellResult CellStore::measure(const Cell& cell) {
  std::vector<std::string> command{voxdag_program()};
  command.insert(command.end(), cell.arguments.begin(), cell.arguments.end());
  const ChildResult child = run_child(command, directory_, cell.seconds_limit, progress_);
  CellResult result;
  result.cost = child.cost;
  result.failure = failure_of(child, cell.seconds_limit);
  if (!result.failure.empty() || !cell.prints_json) return result;
  result.json = Json::parse(child.out, nullptr, false);
  if (result.json.is_discarded()) {
    result.json = nullptr;
    result.failure = "printed no JSON";
  }
  return result;
}

void CellStore::make_inputs(const Cell& cell) {
  for (const fs::path& input : cell.inputs) {
    const auto writer = writers_.find(input);
    if (writer == writers_.end() || fs::exists(input)) continue;
    const Cell maker = writer->second;
    make_inputs(maker);
    const CellResult made = measure(maker);
    if (!made.failure.empty()) throw Error(input, "", made.failure);
  }
}

}  // namespace voxdag::lab

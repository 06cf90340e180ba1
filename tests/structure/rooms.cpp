#include "rooms.hpp"

#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>
#include <stdexcept>

namespace voxdag {
namespace {

bool is_source(const std::filesystem::path& file) {
  static const std::set<std::string> kExtensions = {".hpp", ".cpp", ".h", ".cu", ".cuh", ".inl"};
  return kExtensions.count(file.extension().string()) != 0;
}

/// Returns the path that a line includes if it begins with `prefix`, else nothing.
std::string included_path(const std::string& line, const std::string& prefix) {
  const std::size_t hash = line.find_first_not_of(" \t");
  if (hash == std::string::npos || line[hash] != '#') return {};
  const std::size_t word = line.find_first_not_of(" \t", hash + 1);
  if (word == std::string::npos || line.compare(word, 7, "include") != 0) return {};
  const std::size_t open = line.find_first_of("\"<", word);
  const std::size_t close = open == std::string::npos ? open : line.find_first_of("\">", open + 1);
  if (close == std::string::npos) return {};
  const std::string path = line.substr(open + 1, close - open - 1);
  return path.rfind(prefix, 0) == 0 ? path : std::string();
}

void close_transitively(Rooms& rooms) {
  for (bool grew = true; grew;) {
    grew = false;
    for (auto& [folder, room] : rooms) {
      const std::set<std::string> direct = room.rooms;
      for (const std::string& next : direct) {
        if (rooms.count(next) == 0) throw std::runtime_error("no line for folder " + next);
        for (const std::string& far : rooms.at(next).rooms) grew |= room.rooms.insert(far).second;
      }
    }
  }
}

std::set<std::string> words_of(const std::string& text) {
  std::istringstream in(text);
  return {std::istream_iterator<std::string>(in), {}};
}

/// Returns the targets that the commands voxdag_library and target_link_libraries of a
/// CMakeLists.txt link.
std::vector<std::string> linked_targets(const std::filesystem::path& cmake_lists) {
  static const std::regex kComment("#[^\n]*"), kCommand(R"((\w+)\s*\(([^()]*)\))"),
      kBuildInterface(R"(\$<BUILD_INTERFACE:([^>]*)>)");
  std::ifstream in(cmake_lists);
  std::string text(std::istreambuf_iterator<char>(in), {});
  text = std::regex_replace(text, kComment, "");
  text = std::regex_replace(text, kBuildInterface, "$1");
  std::vector<std::string> targets;
  for (std::sregex_iterator command(text.begin(), text.end(), kCommand), end; command != end;
       ++command) {
    const bool links_only = (*command)[1] == "target_link_libraries";
    if (!links_only && (*command)[1] != "voxdag_library") continue;
    std::istringstream words((*command)[2]);
    std::string word;
    words >> word;  // the target itself
    for (bool linking = links_only; words >> word;) {
      const bool is_keyword = word.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ_") == word.npos;
      if (!is_keyword && linking) targets.push_back(word);
      if (is_keyword) linking = links_only || word == "LINK" || word == "PRIVATE_LINK";
    }
  }
  return targets;
}

/// Returns the name of the package that provides a target: "PNG" for "PNG::PNG".
std::string package_of(const std::string& target) {
  static const std::map<std::string, std::string> kOthers = {{"CUDA", "CUDAToolkit"}};
  const std::string package = target.substr(0, target.find("::"));
  const auto other = kOthers.find(package);
  return other == kOthers.end() ? package : other->second;
}

}  // namespace

Rooms read_rooms(const std::filesystem::path& table) {
  std::ifstream in(table);
  if (!in) throw std::runtime_error("cannot read " + table.string());
  Rooms rooms;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') continue;
    const std::size_t colon = line.find(':'), bar = line.find('|');
    if (colon == std::string::npos) throw std::runtime_error("no colon in: " + line);
    Room& room = rooms[line.substr(0, colon)];
    room.rooms = words_of(line.substr(colon + 1, bar == std::string::npos ? bar : bar - colon - 1));
    room.rooms.insert(line.substr(0, colon));
    if (bar != std::string::npos) room.packages = words_of(line.substr(bar + 1));
  }
  close_transitively(rooms);
  return rooms;
}

std::vector<std::string> broken_links(const std::filesystem::path& root, const Rooms& rooms) {
  std::vector<std::string> broken;
  for (const auto& [folder, room] : rooms) {
    const std::string file = folder + "/CMakeLists.txt";
    for (const std::string& target : linked_targets(root / file)) {
      // A module has the settings of all targets, and is a part of its own room.
      if (target == "voxdag_settings" || target == "voxdag_" + folder) continue;
      const std::string prefix = "voxdag_";
      const bool allowed = target.rfind(prefix, 0) == 0
                               ? room.rooms.count(target.substr(prefix.size())) != 0
                               : room.packages.count(package_of(target)) != 0;
      if (!allowed) broken.push_back(file + ": links " + target);
    }
  }
  return broken;
}

std::vector<std::string> includes_of(const std::filesystem::path& folder,
                                     const std::string& prefix) {
  std::vector<std::string> found;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file() || !is_source(entry.path())) continue;
    std::ifstream in(entry.path());
    int number = 0;
    for (std::string line; std::getline(in, line);) {
      ++number;
      const std::string path = included_path(line, prefix);
      if (!path.empty())
        found.push_back(entry.path().string() + ":" + std::to_string(number) + ": includes " +
                        path);
    }
  }
  return found;
}

std::vector<std::string> broken_includes(const std::filesystem::path& root, const Rooms& rooms,
                                         const std::string& prefix) {
  namespace fs = std::filesystem;
  std::vector<std::string> broken;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root)) {
    if (!entry.is_regular_file() || !is_source(entry.path())) continue;
    const fs::path file = entry.path().lexically_relative(root);
    if (!file.has_parent_path()) continue;  // A source beside the folders may include all of them.
    const auto room = rooms.find(file.begin()->string());
    if (room == rooms.end()) {
      broken.push_back(file.string() + ": is in a folder that the table does not name");
      continue;
    }
    std::ifstream in(entry.path());
    int number = 0;
    for (std::string line; std::getline(in, line);) {
      ++number;
      const std::string path = included_path(line, prefix);
      if (path.empty()) continue;
      const fs::path target = path.substr(prefix.size());
      const bool exists = fs::exists(root / target);
      if (!exists && prefix.empty()) continue;
      if (!exists || room->second.rooms.count(target.begin()->string()) == 0)
        broken.push_back(file.string() + ":" + std::to_string(number) + ": includes " + path);
    }
  }
  return broken;
}

}  // namespace voxdag

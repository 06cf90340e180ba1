#include "include_rules.hpp"

#include <fstream>
#include <sstream>
#include <stdexcept>

namespace voxdag {
namespace {

bool is_source(const std::filesystem::path& file) {
  static const std::set<std::string> kExtensions = {".hpp", ".cpp", ".h", ".cu", ".cuh", ".inl"};
  return kExtensions.count(file.extension().string()) != 0;
}

/// The "voxdag/..." path that a line includes, or nothing.
std::string included_path(const std::string& line) {
  const std::size_t hash = line.find_first_not_of(" \t");
  if (hash == std::string::npos || line[hash] != '#') return {};
  const std::size_t word = line.find_first_not_of(" \t", hash + 1);
  if (word == std::string::npos || line.compare(word, 7, "include") != 0) return {};
  const std::size_t open = line.find_first_of("\"<", word);
  const std::size_t close = open == std::string::npos ? open : line.find_first_of("\">", open + 1);
  if (close == std::string::npos) return {};
  const std::string path = line.substr(open + 1, close - open - 1);
  return path.rfind("voxdag/", 0) == 0 ? path : std::string();
}

void close_transitively(IncludeRules& rules) {
  for (bool grew = true; grew;) {
    grew = false;
    for (auto& [folder, allowed] : rules) {
      const std::set<std::string> direct = allowed;
      for (const std::string& next : direct) {
        if (rules.count(next) == 0) throw std::runtime_error("no rule for folder " + next);
        for (const std::string& far : rules.at(next)) grew |= allowed.insert(far).second;
      }
    }
  }
}

}  // namespace

IncludeRules read_include_rules(const std::filesystem::path& table) {
  std::ifstream in(table);
  if (!in) throw std::runtime_error("cannot read " + table.string());
  IncludeRules rules;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') continue;
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos) throw std::runtime_error("no colon in: " + line);
    const std::string folder = line.substr(0, colon);
    std::set<std::string>& allowed = rules[folder];
    allowed.insert(folder);
    std::istringstream words(line.substr(colon + 1));
    for (std::string word; words >> word;) allowed.insert(word);
  }
  close_transitively(rules);
  return rules;
}

std::vector<std::string> broken_includes(const std::filesystem::path& root,
                                         const IncludeRules& rules) {
  namespace fs = std::filesystem;
  std::vector<std::string> broken;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root)) {
    if (!entry.is_regular_file() || !is_source(entry.path())) continue;
    const fs::path file = entry.path().lexically_relative(root);
    const auto rule = rules.find(file.begin()->string());
    if (rule == rules.end()) {
      broken.push_back(file.string() + ": is in a folder without a rule");
      continue;
    }
    std::ifstream in(entry.path());
    int number = 0;
    for (std::string line; std::getline(in, line);) {
      ++number;
      const std::string path = included_path(line);
      if (path.empty()) continue;
      const fs::path target = fs::path(path).lexically_relative("voxdag");
      const bool allowed = rule->second.count(target.begin()->string()) != 0;
      if (!allowed || !fs::exists(root / target))
        broken.push_back(file.string() + ":" + std::to_string(number) + ": includes " + path);
    }
  }
  return broken;
}

}  // namespace voxdag

#pragma once
/// The lines of an OBJ or MTL file.
#include <string>
#include <string_view>

#include "voxdag/core/memory_budget.hpp"
#include "voxdag/formats/readers/text_scan.hpp"

namespace voxdag {

/// Removes the next corner from a face line and returns it; empty at its end or at a comment.
inline std::string_view next_corner(std::string_view& line) {
  const std::string_view token = next_token(line);
  return token.starts_with('#') ? std::string_view{} : token;
}

/// Calls body(text, position) for every line of a chunk, with leading blanks removed and continued
/// lines joined. `position` points to the line's start in the file. Counts joined lines against
/// `memory`.
template <class Line>
void for_each_line(std::string_view chunk, char line_end, MemoryBudget* memory, const Line& body) {
  std::basic_string<char, std::char_traits<char>, CountedAllocator<char>> joined(memory);
  while (!chunk.empty()) {
    std::string_view line = next_line(chunk, line_end);
    const char* const position = line.data();
    while (!line.empty() && is_blank(line.front())) line.remove_prefix(1);
    if (line.empty() || line.front() == '#') continue;
    if (line.back() == '\r') line.remove_suffix(1);
    if (line.ends_with('\\')) {
      joined.assign(line);
      while (joined.ends_with('\\')) {
        joined.back() = ' ';
        joined += next_line(chunk, line_end);
        if (joined.ends_with('\r')) joined.pop_back();
      }
      line = joined;
    }
    body(line, position);
  }
}

}  // namespace voxdag

/// Fuzzes the parser of scripts of edits and the shapes: any text gives edits of a small DAG, or an
/// Error.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "voxdag/core/error.hpp"
#include "voxdag/edit/edit_script.hpp"
#include "voxdag/edit/replay.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const voxdag::Grid grid{.levels = 4, .origin = {-1, 0, 1}, .voxel_size = 0.25};
  voxdag::Svdag none;
  none.levels = grid.levels;
  voxdag::EditableDag dag(none.view(), {.history = 4});
  for (std::size_t start = 0; start < text.size();) {
    const std::size_t end = text.find('\n', start);
    const std::string_view line = text.substr(start, end - start);
    start = end == text.npos ? text.size() : end + 1;
    try {
      if (const auto step = voxdag::parse_edit_line(line, grid)) apply_step(dag, *step);
    } catch (const voxdag::Error&) {
    }
    try {
      voxdag::parse_replay_line(line);
    } catch (const voxdag::Error&) {
    }
  }
  dag.snapshot().svdag();
  return 0;
}

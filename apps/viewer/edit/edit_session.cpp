#include "viewer/edit/edit_session.hpp"

#include <algorithm>
#include <utility>

#include "voxdag/core/printable.hpp"
#include "voxdag/edit/edit_script.hpp"

namespace voxdag {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostNameBytes = 200;

std::vector<EditStep> steps_of(std::string_view lines, const Grid& grid) {
  std::vector<EditStep> steps;
  for (std::uint64_t number = 1; !lines.empty(); ++number) {
    const std::size_t end = std::min(lines.find('\n'), lines.size());
    at_edit_line(number, [&] {
      const auto step = parse_edit_line(lines.substr(0, end), grid);
      if (!step) return;
      if (step->verb == EditVerb::kUndo || step->verb == EditVerb::kRedo)
        throw Error("undo and redo are no part of a stroke");
      steps.push_back(*step);
    });
    lines.remove_prefix(std::min(end + 1, lines.size()));
  }
  return steps;
}

}  // namespace

fs::path save_path(const fs::path& folder, std::string_view name) {
  constexpr std::string_view kEnding = ".vdag";
  if (name.empty()) throw Error("the file needs a name");
  if (name.size() > kMostNameBytes)
    throw Error("the name of the file has more than " + std::to_string(kMostNameBytes) + " bytes");
  if (name.find_first_of("/\\") != name.npos || name.front() == '.' || printable(name) != name)
    throw Error(name_in_quotes(name) + " is no name of a file in the folder of the scene");
  std::string file(name);
  if (!file.ends_with(kEnding)) file += kEnding;
  return folder / file;
}

EditSession::EditSession(const ColoredDagView& scene, const Grid& grid, fs::path file, Save save,
                         Work work, bool starts_empty)
    : grid_(grid),
      file_(std::move(file)),
      save_(std::move(save)),
      dag_(scene, {.tracks_changes = true, .starts_empty = starts_empty}, work) {}

void EditSession::check_writer(std::uint32_t writer) const {
  if (writer != writer_ || writer == 0) throw NotTheWriter();
}

void EditSession::go_to(std::size_t count) {
  while (dag_.undo_count() > count) dag_.undo();
  while (dag_.undo_count() < count && dag_.redo()) {
  }
}

std::string EditSession::update(EditChanges nodes, std::vector<EditRun> values) const {
  const EditSnapshot now = dag_.snapshot();
  EditUpdate update;
  update.writer = writer_;
  update.root = now.view().is_empty() ? EditNodes::kNone : now.view().root;
  update.colors = now.values().overlays.colors.root;
  update.normals = now.values().overlays.normals.root;
  update.materials = now.values().overlays.materials.root;
  update.undos = static_cast<std::uint32_t>(strokes_);
  update.redos = static_cast<std::uint32_t>(ends_.size() - strokes_);
  update.nodes = std::move(nodes);
  update.values = std::move(values);
  return update.bytes(dag_.nodes(), dag_.values());
}

std::string EditSession::changes() {
  EditChanges nodes = dag_.take_changes();
  return update(std::move(nodes), dag_.take_value_changes());
}

std::string EditSession::open() {
  const std::lock_guard lock(mutex_);
  ++writer_;
  dag_.take_changes();
  dag_.take_value_changes();
  const EditNodes& nodes = dag_.nodes();
  EditChanges all;
  std::vector<EditRun> values;
  const std::uint64_t words = nodes.base().node_words(), blocks = nodes.base().leaf_block_count;
  if (nodes.words_end() > words) all.words.push_back({words, nodes.words_end() - words});
  if (nodes.blocks_end() > blocks) all.blocks.push_back({blocks, nodes.blocks_end() - blocks});
  // The first eight words of values have no meaning.
  if (dag_.values().bytes() > 0) values.push_back({8, dag_.values().bytes() / 4});
  return update(std::move(all), std::move(values));
}

std::string EditSession::stroke(std::uint32_t writer, std::string_view lines, bool goes_on) {
  const std::lock_guard lock(mutex_);
  check_writer(writer);
  const std::vector<EditStep> steps = steps_of(lines, grid_);
  if (steps.empty()) return changes();
  const std::size_t before = dag_.undo_count();
  ends_.resize(strokes_);
  if (saved_ > before) saved_ = static_cast<std::size_t>(-1);
  try {
    for (const EditStep& step : steps) apply_step(dag_, step);
  } catch (...) {
    go_to(before);
    throw;
  }
  if (goes_on && strokes_ > 0)
    ends_.back() = dag_.undo_count();
  else
    ends_.push_back(dag_.undo_count());
  strokes_ = ends_.size();
  return changes();
}

std::string EditSession::undo(std::uint32_t writer) {
  const std::lock_guard lock(mutex_);
  check_writer(writer);
  if (strokes_ > 0) --strokes_;
  go_to(strokes_ > 0 ? ends_[strokes_ - 1] : 0);
  return changes();
}

std::string EditSession::redo(std::uint32_t writer) {
  const std::lock_guard lock(mutex_);
  check_writer(writer);
  if (strokes_ < ends_.size()) go_to(ends_[strokes_++]);
  return changes();
}

void EditSession::save(std::uint32_t writer, std::string_view name, bool replaces) {
  const std::lock_guard saving(saving_);
  const fs::path path = save_path(file_.parent_path(), name);
  std::unique_lock lock(mutex_);
  check_writer(writer);
  const EditSnapshot snapshot = dag_.snapshot();
  const std::size_t edits = dag_.undo_count();
  lock.unlock();
  // A symbolic link could lead out of the folder.
  const fs::file_status status = fs::symlink_status(path);
  if (fs::exists(status) && !fs::is_regular_file(status))
    throw Error(path.filename().string() + " exists and is no file");
  if (fs::exists(status) && !replaces) throw FileExists(path.filename().string());
  save_(snapshot, path);
  lock.lock();
  saved_ = edits;
}

bool EditSession::has_unsaved() const {
  const std::lock_guard lock(mutex_);
  return dag_.undo_count() != saved_;
}

}  // namespace voxdag

#pragma once
/// The scene that a page edits: strokes, undo by strokes, and files that are saved.
#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "viewer/edit/edit_update.hpp"

namespace voxdag {

/// Thrown if another page has become the one that edits.
class NotTheWriter : public Error {
 public:
  NotTheWriter() : Error("another window edits this scene now: reload this page to edit it here") {}
};

/// Thrown if a file of the name exists and must not be replaced.
class FileExists : public Error {
 public:
  explicit FileExists(const std::string& name) : Error(name + " exists") {}
};

/// Thread-safe. One page at a time edits: the one that called open() last. Functions return the
/// bytes of an EditUpdate. They throw NotTheWriter for another page, and what the edits of
/// EditableDag throw; then the scene is as before, but undone strokes may be lost.
class EditSession {
 public:
  /// Writes a version of the scene to a file. Called on any thread, while edits go on.
  using Save = std::function<void(const EditSnapshot&, const std::filesystem::path&)>;

  /// Copies a valid DAG, but not its attributes, which must outlive this object. `file` is the file
  /// that saving suggests. Files are saved in its folder only. `starts_empty`: see EditOptions.
  EditSession(const ColoredDagView& scene, const Grid& grid, std::filesystem::path file, Save save,
              Work work = {}, bool starts_empty = false);

  /// Returns the name of the file that saving suggests.
  std::string file_name() const { return file_.filename().string(); }

  /// Makes the caller the page that edits. Returns all that edits have written so far.
  std::string open();
  /// Makes edits of lines of a script (edit/edit_script.hpp): all of them or none. With `goes_on`,
  /// they belong to the stroke of the call before. Throws Error with the line for a line that is no
  /// edit, and for undo and redo.
  std::string stroke(std::uint32_t writer, std::string_view lines, bool goes_on);
  /// Goes back one stroke, or forward again; does nothing if there is none.
  std::string undo(std::uint32_t writer);
  std::string redo(std::uint32_t writer);
  /// Saves the present version. Edits may go on meanwhile. Throws FileExists unless `replaces`, and
  /// Error for a name that names no file of the folder.
  void save(std::uint32_t writer, std::string_view name, bool replaces);

  /// Returns whether the present version is neither the one that was opened nor the one that was
  /// saved last.
  bool has_unsaved() const;

 private:
  void check_writer(std::uint32_t writer) const;
  /// Undoes or redoes edits until `count` can be undone.
  void go_to(std::size_t count);
  std::string update(EditChanges nodes, std::vector<EditRun> values) const;
  std::string changes();

  const Grid grid_;
  const std::filesystem::path file_;
  const Save save_;
  mutable std::mutex mutex_;
  std::mutex saving_;
  EditableDag dag_;
  std::uint32_t writer_ = 0;
  /// The number of edits at the end of each stroke, and how many strokes the version has.
  std::vector<std::size_t> ends_;
  std::size_t strokes_ = 0;
  std::size_t saved_ = 0;  ///< The number of edits of the version that was saved last.
};

/// Returns the path of a file of `folder`: ".vdag" is added if the name does not end so. Throws
/// Error for a name with a slash, a control character or bytes that are not UTF-8, that begins with
/// a dot, or is empty or too long.
std::filesystem::path save_path(const std::filesystem::path& folder, std::string_view name);

}  // namespace voxdag

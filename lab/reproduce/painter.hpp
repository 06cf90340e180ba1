#pragma once
/// Renders the pictures of a report.
#include <string>
#include <vector>

#include "lab/report/document.hpp"
#include "lab/reproduce/found_scenes.hpp"
#include "lab/reproduce/papers_plan.hpp"

namespace voxdag::lab {

/// A rendered picture, or the reason why there is none.
struct ScenePicture {
  FoundScene scene;
  Cell cell;
  CellResult result;

  bool is_there() const { return result.failure.empty(); }
};

/// How the voxels of a picture are built.
struct PictureVoxels {
  int levels = 0;
  bool is_esvo = false;
  std::vector<std::string> options;  ///< More options of `build`.
};

/// Returns options of `render` for a camera that shows the scene well; none if nothing is known
/// about it.
std::vector<std::string> camera_of(const FoundScene& scene);
/// Returns these options, and those of a sun that goes with the camera.
std::vector<std::string> view_of(const FoundScene& scene);

/// Builds voxels and renders them. Pictures that are kept from an earlier run of the report need no
/// voxels.
class Painter {
 public:
  Painter(const PapersPlan& plan, CellStore& cells, const Progress& progress)
      : plan_(plan), cells_(cells), progress_(progress) {}
  ~Painter();
  Painter(const Painter&) = delete;
  Painter& operator=(const Painter&) = delete;

  /// The next pictures show these voxels of the scene.
  void show(const FoundScene& scene, const PictureVoxels& voxels);

  /// Returns the result of their build.
  const CellResult& built() const { return built_; }
  /// Returns their file, which exists until the next voxels are shown.
  const std::filesystem::path& voxels() const { return voxels_; }

  /// Renders a picture to `file` in the plan's folder; if `pass` is not empty, that pass of it.
  /// `options`: more options of `render`. Throws Error and Cancelled.
  ScenePicture paint(const std::string& file, const std::string& pass, ImageSize size,
                     const std::vector<std::string>& options);

 private:
  void remove_voxels();

  const PapersPlan& plan_;
  CellStore& cells_;
  const Progress& progress_;
  FoundScene scene_;
  std::filesystem::path voxels_;
  CellResult built_;
};

/// Adds the picture, or the reason why there is none, and its command.
void add_picture(Section& section, const ScenePicture& picture, const std::string& caption);

/// Adds the pictures side by side, and the command of the last. If one is not there, adds the
/// reason instead.
void add_row(Section& section, const std::vector<ScenePicture>& pictures,
             const std::vector<std::string>& captions);

}  // namespace voxdag::lab

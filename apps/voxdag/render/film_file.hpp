#pragma once
/// The film that ffmpeg makes of the frames of `voxdag render --path`.
#include <filesystem>
#include <string>
#include <vector>

#include "voxdag/core/io/temporary_folder.hpp"
#include "voxdag/core/parallel/progress.hpp"

namespace voxdag::cli {

/// Returns whether the path ends in .mp4 or .webm.
bool is_film_path(const std::string& path);

/// The frames of a film, and the film. The destructor removes the frames.
class FilmFile {
 public:
  /// Creates a folder for the frames beside the film. Throws Error if it cannot, or if FILM.frames
  /// exists: frames would get that name.
  FilmFile(const std::string& path, double frames_per_second);

  /// Returns the names of the frames, with a placeholder for the number.
  std::string frames() const { return pattern_in(folder_.path()); }

  /// Runs ffmpeg, which must be on PATH, and gives the film its name when it is complete. Throws
  /// Error if that fails; the frames then stay as FILM.frames, and the error has the command that
  /// makes the film of them.
  void encode(const Progress& progress);

 private:
  static std::string pattern_in(const std::filesystem::path& folder) {
    return (folder / "frame_%06d.png").string();
  }
  /// Returns ffmpeg's command line for frames in a folder.
  std::vector<std::string> command(const std::filesystem::path& folder,
                                   const std::filesystem::path& film) const;
  /// Returns the file of ffmpeg's messages.
  std::filesystem::path log() const { return folder_.path() / "log"; }
  /// Returns the film before it has its name.
  std::filesystem::path unnamed_film() const {
    return folder_.path() / ("film" + film_.extension().string());
  }
  [[noreturn]] void keep_frames(const std::string& reason) const;

  std::filesystem::path film_, kept_;
  double frames_per_second_;
  TemporaryFolder folder_;
};

}  // namespace voxdag::cli

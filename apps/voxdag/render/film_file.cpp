#include "render/film_file.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/mapped_file.hpp"

namespace voxdag::cli {
namespace {

namespace fs = std::filesystem;

/// Returns the folder of frames that are kept. Throws Error if it exists.
fs::path kept_folder(const fs::path& film) {
  fs::path kept = film.string() + ".frames";
  std::error_code unknown;
  if (fs::exists(kept, unknown))
    throw Error(kept.string(), "", "exists: remove it, or choose another name for the film");
  return kept;
}

/// Returns the argument as a shell reads it.
std::string quoted(const std::string& argument) {
  constexpr const char* kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789%+,-./:=_";
  if (!argument.empty() && argument.find_first_not_of(kPlain) == argument.npos) return argument;
  std::string text = "'";
  for (const char c : argument) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

/// Runs a program of PATH, whose messages go to the file `log`. Returns its exit status, 128 + N if
/// signal N ended it. Throws std::system_error if it cannot be started.
int run_to_end(const std::vector<std::string>& command, const fs::path& log) {
  std::vector<char*> arguments;
  for (const std::string& argument : command)
    arguments.push_back(const_cast<char*>(argument.c_str()));  // It is not changed.
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDERR_FILENO, log.c_str(), O_WRONLY | O_CREAT, 0666);
  posix_spawn_file_actions_adddup2(&files, STDERR_FILENO, STDOUT_FILENO);
  posix_spawn_file_actions_addclosefrom_np(&files, STDERR_FILENO + 1);
  pid_t process = 0;
  const int error =
      posix_spawnp(&process, arguments[0], &files, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  if (error != 0) throw std::system_error(error, std::system_category());
  int status = 0;
  while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/// Returns the last line of a file that is not empty.
std::string last_line(const fs::path& file) {
  const MappedFile mapping(file);
  std::string_view text = mapping.text();
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.remove_suffix(1);
  return std::string(text.substr(text.find_last_of("\r\n") + 1));  // npos + 1 is 0.
}

}  // namespace

bool is_film_path(const std::string& path) {
  return path.ends_with(".mp4") || path.ends_with(".webm");
}

FilmFile::FilmFile(const std::string& path, double frames_per_second)
    : film_(fs::absolute(path)),
      kept_(kept_folder(path)),
      frames_per_second_(frames_per_second),
      folder_(fs::absolute(kept_)) {}

std::vector<std::string> FilmFile::command(const fs::path& folder, const fs::path& film) const {
  std::vector<std::string> words = {"ffmpeg",     "-loglevel",
                                    "error",      "-y",
                                    "-framerate", fmt::format("{}", frames_per_second_),
                                    "-i",         pattern_in(folder)};
  const auto add = [&](std::initializer_list<const char*> more) {
    words.insert(words.end(), more.begin(), more.end());
  };
  if (film.extension() == ".mp4")
    add({"-c:v", "libx264", "-crf", "18", "-movflags", "+faststart"});
  else
    add({"-c:v", "libvpx-vp9", "-crf", "24", "-b:v", "0"});
  // Players expect the colours of HD television.
  add({"-pix_fmt", "yuv420p", "-vf", "scale=out_color_matrix=bt709", "-colorspace", "bt709",
       "-color_primaries", "bt709", "-color_trc", "bt709"});
  words.push_back(film.string());
  return words;
}

void FilmFile::keep_frames(const std::string& reason) const {
  std::error_code unknown;
  fs::remove(log(), unknown);
  fs::remove(unnamed_film(), unknown);
  folder_.take_name();
  std::string line;
  for (const std::string& word : command(kept_, film_)) line += " " + quoted(word);
  throw Error(film_.string(), "",
              fmt::format("{}: its frames are in {}; this makes the film:{}", reason,
                          kept_.string(), line));
}

void FilmFile::encode(const Progress& progress) {
  int status = 0;
  std::string reason;
  try {
    status = run_to_end(command(folder_.path(), unnamed_film()), log());
    reason = last_line(log());
  } catch (const std::system_error& error) {
    if (error.code() == std::errc::no_such_file_or_directory)
      keep_frames("ffmpeg, which makes films, is not on PATH");
    keep_frames(fmt::format("ffmpeg cannot be started ({})", error.code().message()));
  }
  std::error_code unknown;
  if (status != 0 || !fs::is_regular_file(unnamed_film(), unknown)) {
    progress.throw_if_cancelled();  // Ctrl-C also ends ffmpeg.
    if (reason.empty())
      reason = status == 0 ? "it wrote no film" : fmt::format("with status {}", status);
    keep_frames(fmt::format("ffmpeg failed ({})", reason));
  }
  fs::rename(unnamed_film(), film_);
}

}  // namespace voxdag::cli

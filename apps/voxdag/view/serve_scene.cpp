#include "view/serve_scene.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <spawn.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <system_error>
#include <thread>

#include "viewer/server/page_server.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/io/descriptor.hpp"

namespace voxdag::cli {
namespace {

bool is_set(const char* variable) {
  const char* const value = std::getenv(variable);
  return value != nullptr && *value != '\0';
}

bool has_display() { return is_set("DISPLAY") || is_set("WAYLAND_DISPLAY"); }

/// A file that leads a browser to a secret address. Other users of this machine can see the
/// arguments of a browser, but only this user can read the file.
class SecretPage {
 public:
  explicit SecretPage(const std::string& target) {
    const bool has_own = is_set("XDG_RUNTIME_DIR");
    path_ = (has_own ? std::string(std::getenv("XDG_RUNTIME_DIR"))
                     : std::filesystem::temp_directory_path().string()) +
            "/voxdag-XXXXXX.html";
    const Descriptor file(mkostemps(path_.data(), 5, O_CLOEXEC));
    const std::string text = "<meta http-equiv=\"refresh\" content=\"0;url=" + target + "\">\n";
    if (!file.is_open() || write(file.get(), text.data(), text.size()) < 0) path_.clear();
  }
  SecretPage(const SecretPage&) = delete;
  SecretPage& operator=(const SecretPage&) = delete;
  ~SecretPage() {
    if (!path_.empty()) unlink(path_.c_str());
  }
  std::string url() const { return "file://" + path_; }

 private:
  std::string path_;
};

/// Starts xdg-open with the address. Does not wait for it, and ignores its errors, because the
/// address is also on stdout.
void open_in_browser(const std::string& url) {
  posix_spawn_file_actions_t files;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&files);
  posix_spawnattr_init(&attributes);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&files, stream, "/dev/null", O_RDWR, 0);
  // The browser must not keep the server's sockets open.
  posix_spawn_file_actions_addclosefrom_np(&files, STDERR_FILENO + 1);
  // The browser gets a session of its own, so that Ctrl-C does not end it.
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSID);
  std::string program = "xdg-open", argument = url;
  char* const arguments[] = {program.data(), argument.data(), nullptr};
  pid_t process = 0;
  posix_spawnp(&process, program.c_str(), &files, &attributes, arguments, environ);
  posix_spawn_file_actions_destroy(&files);
  posix_spawnattr_destroy(&attributes);
}

}  // namespace

void require_page_server() {}

void serve_scene(const SceneBytes& scene, std::span<const PageFile> page,
                 const ServeArguments& arguments, Session& session, EditSession* editing) {
  ServerOptions options;
  options.files = page;
  options.address = arguments.address;
  options.port = arguments.port;
  options.editing = editing;
  PageServer server(scene, options);
  server.start();
  session.bar.clear();
  fmt::print("{}\n", server.url());
  if (std::fflush(stdout) != 0)
    throw Error("standard output", "", std::system_category().message(errno));
  if (!session.quiet) print_line("Ctrl-C ends the server");
  std::optional<SecretPage> secret;
  if (arguments.open && has_display())
    open_in_browser(editing == nullptr ? server.url() : secret.emplace(server.url()).url());
  while (!session.progress.cancelled()) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  server.stop();
  if (editing != nullptr && editing->has_unsaved() && !session.quiet)
    print_line("the last edits were not saved");
  session.progress.throw_if_cancelled();
}

}  // namespace voxdag::cli

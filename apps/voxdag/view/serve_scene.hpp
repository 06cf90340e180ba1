#pragma once
/// Serves the page and a scene until the user ends the program.
#include <string>

#include "cli/session.hpp"
#include "viewer/edit/edit_session.hpp"
#include "viewer/embedded/page_files.hpp"
#include "viewer/scene/scene_bytes.hpp"

namespace voxdag::cli {

struct ServeArguments {
  std::string address = "127.0.0.1";
  int port = 0;      ///< 0: any free port.
  bool open = true;  ///< Open the page in the browser if there is a display.
};

/// Throws Error if this program was built without the server.
void require_page_server();

/// Prints the page's address as one line on stdout, and serves the files of the page until the user
/// ends the program. The page edits the scene of `editing`; null: it only shows the scene. Throws
/// Error if it cannot listen, and Cancelled at a signal.
void serve_scene(const SceneBytes& scene, std::span<const PageFile> page,
                 const ServeArguments& arguments, Session& session, EditSession* editing = nullptr);

}  // namespace voxdag::cli

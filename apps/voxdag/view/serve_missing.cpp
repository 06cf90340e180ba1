/// Replaces serve_scene.cpp in a program that is built without the server.
#include "view/serve_scene.hpp"
#include "voxdag/core/error.hpp"

namespace voxdag::cli {

void require_page_server() {
  throw Error(
      "this voxdag was built without its server, which needs cpp-httplib 0.11: use `voxdag export "
      "FILE -o FOLDER/`, which writes a page for any web server");
}

void serve_scene(const SceneBytes&, std::span<const PageFile>, const ServeArguments&, Session&,
                 EditSession*) {
  require_page_server();
}

}  // namespace voxdag::cli

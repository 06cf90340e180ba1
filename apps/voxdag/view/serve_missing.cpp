/// The program without the server.
#include "view/serve_scene.hpp"
#include "voxdag/core/error.hpp"

namespace voxdag {

bool has_page_server() { return false; }

void serve_scene(const SceneBytes&, const ServeArguments&, Session&) {
  throw Error(
      "this voxdag was built without its server, which needs cpp-httplib 0.11: `voxdag export "
      "FILE -o FOLDER/` writes a page for any other server");
}

}  // namespace voxdag

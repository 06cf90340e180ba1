/// The edits of a page without a server: the requests of server/edit_answers.hpp as a C function.
#include <memory>
#include <string>

#include "viewer/edit/edit_session.hpp"
#include "viewer/edit/save_edited.hpp"
#include "voxdag/core/io/process_memory.hpp"
#include "voxdag/file/model/dag_model.hpp"

namespace voxdag {
namespace {

/// The scene that is edited, with all that it refers to.
struct Editing {
  explicit Editing(const std::string& path)
      : memory(command_budget(0)),
        file(path, &memory),
        session(
            {file.view(), file.attributes()}, file.grid(), "/out/scene.vdag",
            [this](const EditSnapshot& version, const std::filesystem::path& to) {
              save_edited(version, file.metadata(), to, file.is_compact(), &memory);
            },
            &memory) {}

  MemoryBudget memory;
  DagModel file;
  EditSession session;
};

std::unique_ptr<Editing> editing;
std::string result;

/// Returns what EditAnswers::answer_edit() answers. `begin` takes a path instead: the scene to
/// edit.
std::string answer(const std::string& verb, std::uint32_t writer, const std::string& body) {
  if (verb == "begin") {
    editing.reset();
    editing = std::make_unique<Editing>(body);
    return "";
  }
  if (!editing) throw Error("no scene is open for edits");
  EditSession& session = editing->session;
  if (verb == "open") return session.open();
  if (verb == "stroke") return session.stroke(writer, body, false);
  if (verb == "stroke?more") return session.stroke(writer, body, true);
  if (verb == "undo") return session.undo(writer);
  if (verb == "redo") return session.redo(writer);
  if (verb == "file") return session.file_name();
  if (verb != "save" && verb != "save?replace") throw Error("there is no " + verb);
  session.save(writer, body, verb != "save");
  return save_path({}, body).string();
}

}  // namespace
}  // namespace voxdag

extern "C" {

/// Answers a request of the page (edit/client.js): a status of HTTP. The answer, or the reason, is
/// then in voxdag_result(). `begin` opens the scene at the path `body`; `save` writes into /out.
int voxdag_edit(const char* verb, unsigned writer, const char* body) {
  using namespace voxdag;
  try {
    result = answer(verb, writer, body);
    return 200;
  } catch (const NotTheWriter& error) {
    result = error.what();
    return 409;
  } catch (const FileExists& error) {
    result = error.what();
    return 412;
  } catch (const std::bad_alloc&) {
    result = "there is not enough memory";
    return 400;
  } catch (const std::exception& error) {
    result = error.what();
    return 400;
  }
}

const char* voxdag_result() { return voxdag::result.data(); }
unsigned voxdag_result_bytes() { return static_cast<unsigned>(voxdag::result.size()); }
}

#include "cli/scene_input.hpp"

#include <fmt/core.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <stdexcept>

#include "cli/input_files.hpp"
#include "cli/output_files.hpp"
#include "cli/parse.hpp"
#include "cli/scratch_dag.hpp"
#include "voxdag/core/io/unpacked_name.hpp"
#include "voxdag/core/lower_case.hpp"
#include "voxdag/formats/imports/voxel_source.hpp"
#include "voxdag/formats/input_file.hpp"

namespace voxdag::cli {
namespace {

/// Returns whether the header of a PLY file has neither faces nor strips of triangles.
bool is_ply_of_points(const std::string& file) {
  const InputFile input(file);
  std::ifstream stream(input.path(), std::ios::binary);
  std::string word, name;
  std::uint64_t count = 0;
  while (stream >> word && word != "end_header")
    if (word == "element" && stream >> name >> count && count > 0 &&
        (name == "face" || name == "tristrips"))
      return false;
  return true;
}

/// Returns the command that makes a DAG of the file, "build" or "import"; "" if it is a DAG or an
/// ESVO, or cannot be read.
std::string builder_of(const std::string& file) {
  std::error_code unknown;
  const std::string ending = lower_case(unpacked_name(file).extension().string());
  // DAGs and ESVOs are opened once, by the command: only files of other endings are looked at here.
  if (ending.empty() || ending == ".vdag" || ending == ".esvo" ||
      !std::filesystem::is_regular_file(file, unknown) || is_container(file))
    return "";
  const bool is_imported = ending == ".ply" ? is_ply_of_points(file) : is_voxel_source(file);
  return is_imported ? "import" : "build";
}

}  // namespace

void add_scene_input(const Command& command, SceneInput& input, Session& session,
                     const std::string& help, bool is_required) {
  const Option file = command.text(
      "file", session.subject, "FILE",
      help + ", or a mesh, points or voxels that `voxdag build` or `voxdag import` reads");
  if (is_required) file.required();
  const auto is_built = [&session] { return !builder_of(session.subject).empty(); };
  constexpr const char* kIsDag = "on a .vdag or .esvo file";
  command
      .parsed(
          "-r,--resolution", input.resolution,
          [](const std::string& text) { return parse_resolution(text), text; }, "N",
          "For a mesh or points: voxels along the longest side (default: 1024; voxels keep theirs)")
      .only_if(is_built, kIsDag);
  command
      .parsed(
          "--keep", input.keep,
          [](const std::string& text) {
            if (!text.ends_with(".vdag")) throw std::invalid_argument("must end in .vdag");
            return text;
          },
          "OUT.vdag",
          "For a mesh, points or voxels: keep the DAG that is built of it (default: a temporary "
          "file in TMPDIR or /tmp)")
      .only_if(is_built, kIsDag);
}

void work_on_scene(const SceneInput& input, Session& session, const std::function<void()>& work) {
  const std::string source = session.subject, builder = builder_of(source);
  if (builder.empty()) return work();
  std::optional<ScratchDag> scratch;
  if (input.keep.empty()) scratch.emplace(source, session);
  const std::string dag = scratch ? scratch->path() : input.keep;
  std::vector<std::string> arguments = {builder, source, "-o", dag, "--quiet"};
  if (!input.resolution.empty())
    arguments.insert(arguments.end(), {"--resolution", input.resolution});
  if (builder == "build" && input.with_colors) arguments.push_back("--color-if-any");
  if (builder == "import" && !input.with_colors) arguments.push_back("--no-color");
  session.run_command(arguments);
  const std::int64_t side = grid_of_file(dag).resolution();
  if (!session.quiet && !session.is_silent) {
    session.bar.clear();
    print_line(
        fmt::format("{}: built a DAG of {}³ voxels{}", source, side,
                    scratch ? " (-r N: another resolution; --keep FILE: keep it)" : ", " + dag));
  }
  session.subject = dag;
  work();
}

}  // namespace voxdag::cli

#include "build/written_output.hpp"

#include <fmt/core.h>

#include <filesystem>

#include "cli/output_files.hpp"
#include "cli/scratch_dag.hpp"
#include "voxdag/formats/exports/export_voxels.hpp"
#include "voxdag/render/film/picture_pass.hpp"

namespace voxdag::cli {
namespace {

namespace fs = std::filesystem;

bool is_page(const std::string& output) {
  return output.ends_with(".html") || output.ends_with('/');
}

}  // namespace

std::string maker_of(const std::string& output) {
  if (output.ends_with(".vdag") || output.ends_with(".esvo") || is_pipe_or_device(output))
    return "";
  if (is_page(output) || can_export_to(output)) return "export";
  if (is_picture_path(output)) return "render";
  throw UsageError("--output", fmt::format("\"{}\" must end in .vdag, .esvo, .png, .exr, .html, / "
                                           "(the folder of a page), {}",
                                           output, export_extensions()));
}

bool shows_colors(const std::string& output) {
  return is_page(output) || is_picture_path(output) || export_has_colors(output, false);
}

void build_output(const std::string& output, Session& session,
                  const std::function<void(const std::string& file)>& build) {
  const std::string maker = maker_of(output);
  if (maker.empty()) return build(output);
  if (!output.ends_with('/')) check_writable(output);
  const ScratchDag dag(session.subject, session);
  const CommandState asked = session;
  session.quiet = true;
  session.json = false;
  build(dag.path());
  std::vector<std::string> arguments = {maker, dag.path(), "-o", output};
  if (asked.quiet) arguments.push_back("--quiet");
  if (asked.json) arguments.push_back("--json");
  session.run_command(arguments);
}

}  // namespace voxdag::cli

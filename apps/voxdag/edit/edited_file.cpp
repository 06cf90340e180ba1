#include "edit/edited_file.hpp"

#include <stdexcept>
#include <utility>

#include "cli/parse.hpp"
#include "cli/written_files.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/cpu/presentation.hpp"
#include "voxdag/file/model/edited.hpp"

namespace voxdag::cli {

void add_edit_options(const Command& command, EditArguments& arguments, Session& session) {
  command.text("-o,--output", arguments.output, "OUT", "The .vdag file to write").required();
  const Option compact = command.flag("--compact", arguments.compact,
                                      "Write the compact form (default: the form of the input)");
  command.flag("--plain", arguments.plain, "Write the plain form, the layout of the paper")
      .not_with(compact);
  command.flag("--drop-attributes", arguments.drop_attributes,
               "Leave out colours, normals and material ids; files that have some are refused "
               "without it");
  add_memory_option(command, arguments.memory_limit);
  add_threads_option(command, session);
  add_json_option(command, session);
  add_quiet_option(command, session);
}

Option add_optional_output(const Command& command, EditArguments& arguments,
                           const std::string& help) {
  const Option output = command.text("-o,--output", arguments.output, "OUT", help);
  const Option compact = command
                             .flag("--compact", arguments.compact,
                                   "Write the compact form (default: the form of the input)")
                             .needs(output);
  command.flag("--plain", arguments.plain, "Write the plain form, the layout of the paper")
      .needs(output)
      .not_with(compact);
  return output;
}

void add_neighbours_option(const Command& command, Neighbours& neighbours) {
  command.parsed(
      "--neighbours", neighbours,
      [](const std::string& text) {
        if (text == "6") return Neighbours::k6;
        if (text == "26") return Neighbours::k26;
        throw std::invalid_argument("must be 6 or 26");
      },
      "6|26", "Neighbours share a face (6), or a face, an edge or a corner (26, the default)");
}

void refuse_attributes(const DagModel& file, const std::string& path,
                       const EditArguments& arguments) {
  if (!arguments.drop_attributes && !file.attributes().is_empty())
    throw Error(path, "",
                "has colours, normals or material ids, which this command cannot keep: "
                "--drop-attributes leaves them out");
}

void write_edited(const EditArguments& arguments, Svdag dag, const Grid& grid,
                  const DagModel& source, const std::string& edit, MemoryBudget& memory,
                  Session& session) {
  write_edited(arguments, edited(source, std::move(dag), grid, edit, &memory),
               arguments.compact || (!arguments.plain && source.is_compact()), memory, session);
}

void write_edited(const EditArguments& arguments, DagModel model, bool compact,
                  MemoryBudget& memory, Session& session,
                  const std::vector<std::pair<std::string, std::uint64_t>>& counts) {
  model.set_presentation(with_home(model.metadata().presentation, model.view(), model.grid()));
  model.save(arguments.output, compact, {&memory, &session.progress});
  const std::uint64_t voxels = model.metadata().counts.voxels;
  warn_if_empty(voxels, arguments.output, session);
  WrittenFiles written{
      {arguments.output}, {{"voxels", voxels}}, compact ? "compact form" : "plain form"};
  written.counts.insert(written.counts.end(), counts.begin(), counts.end());
  print_written(written, session);
}

}  // namespace voxdag::cli

#include "edit/edited_file.hpp"

#include <stdexcept>
#include <utility>

#include "cli/parse.hpp"
#include "cli/written_files.hpp"
#include "voxdag/core/with_file_name.hpp"
#include "voxdag/cpu/presentation.hpp"

namespace voxdag::cli {

void add_edit_options(const Command& command, EditArguments& arguments, Session& session,
                      bool makes_voxels) {
  command.text("-o,--output", arguments.output, "OUT", "The .vdag file to write").required();
  const Option compact = command.flag("--compact", arguments.compact,
                                      "Write the compact form (default: the form of the input)");
  command.flag("--plain", arguments.plain, "Write the plain form, the layout of the paper")
      .not_with(compact);
  add_value_options(command, arguments, makes_voxels);
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

void add_listing_options(const Command& command, EditArguments& arguments, Session& session) {
  add_value_options(command, arguments, false, [&arguments] { return !arguments.output.empty(); });
  add_memory_option(command, arguments.memory_limit);
  add_json_option(command, session);
  add_threads_option(command, session);
  add_quiet_option(command, session);
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

void add_value_options(const Command& command, EditArguments& arguments, bool makes_voxels,
                       const std::function<bool()>& is_written) {
  EditedValues& values = arguments.values;
  const auto is_kept = [&arguments, is_written] {
    return is_written() && !arguments.drop_attributes;
  };
  const char* const why_not = "where no attributes are written";
  if (makes_voxels) {
    command
        .parsed(
            "--color", values.new_values.color, parse_color, "R,G,B",
            "Colour of new voxels, sRGB, from 0 to 255 (default: that of the nearest old voxel)")
        .only_if(is_kept, why_not);
    command
        .parsed(
            "--material", values.new_values.material,
            [](const std::string& text) {
              const auto id = read_whole_number(text);
              if (!id || *id < 0 || *id >= kMaxMaterials)
                throw std::invalid_argument("must be a whole number from 0 to 65534");
              return static_cast<std::uint16_t>(*id);
            },
            "N", "Material id of new voxels (default: that of the nearest old voxel)")
        .only_if(is_kept, why_not);
  }
  command
      .number("--color-bound", values.bounds.color_bound, NumberRange::from(0, 1), "DIFFERENCE",
              "How far a colour may change when the colours are encoded again, in the units of "
              "build (0: not at all)")
      .only_if(is_kept, why_not);
  command
      .number("--normal-bound", values.bounds.normal_bound_degrees, NumberRange::from(0, 180),
              "DEGREES", "How far a normal may turn when it is encoded again (0: not at all)")
      .only_if(is_kept, why_not);
  command
      .flag("--drop-attributes", arguments.drop_attributes,
            "Leave out colours, normals and material ids")
      .only_if(is_written, "without --output");
}

void write_edited(const EditArguments& arguments, Svdag dag, const Grid& grid,
                  std::span<const PlacedModel> sources, const std::string& edit,
                  MemoryBudget& memory, Session& session) {
  const DagModel& first = sources[0].model;
  const bool compact = arguments.compact || (!arguments.plain && first.is_compact());
  const Work work{&memory, &session.progress};
  DagModel model = with_file_name(session.subject, [&] {
    return arguments.drop_attributes
               ? edited(first, std::move(dag), grid, edit, work)
               : edited(sources, std::move(dag), grid, edit, arguments.values, work);
  });
  write_edited(arguments, std::move(model), compact, memory, session);
}

void write_edited(const EditArguments& arguments, DagModel model, bool compact,
                  MemoryBudget& memory, Session& session,
                  const std::vector<std::pair<std::string, std::uint64_t>>& counts) {
  model.set_presentation(with_home(model.metadata().presentation, model.view(), model.grid()));
  model.save(arguments.output, compact, {&memory, &session.progress});
  const std::uint64_t voxels = model.metadata().counts.voxels;
  warn_if_empty(voxels, arguments.output, session, "the edit left none");
  WrittenFiles written{
      {arguments.output}, {{"voxels", voxels}}, compact ? "compact form" : "plain form"};
  written.counts.insert(written.counts.end(), counts.begin(), counts.end());
  print_written(written, session);
}

}  // namespace voxdag::cli

/// `voxdag components`: counts the connected components of a DAG, and keeps the large ones.
#include "voxdag/algebra/components.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/commands.hpp"
#include "cli/output_files.hpp"
#include "edit/edited_file.hpp"
#include "voxdag/core/io/process_memory.hpp"
#include "voxdag/file/report/human.hpp"

namespace voxdag::cli {
namespace {

struct ComponentsArguments {
  EditArguments edit;
  Neighbours neighbours = Neighbours::k26;
  bool largest = false;
  std::uint64_t least = 0;  ///< 0: not given.
};

void print_sizes(const std::string& path, const std::vector<ComponentSizes>& sizes,
                 Neighbours neighbours, bool json) {
  constexpr std::size_t kShown = 10;
  std::uint64_t count = 0;
  for (const ComponentSizes& size : sizes) count += size.count;
  const int of = neighbours == Neighbours::k6 ? 6 : 26;
  if (json) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const ComponentSizes& size : sizes)
      list.push_back({{"voxels", size.voxels}, {"count", size.count}});
    const nlohmann::ordered_json all = {
        {"components", count}, {"neighbours", of}, {"sizes", std::move(list)}};
    fmt::print("{}", json_text(all));
    return;
  }
  fmt::print("{}: {} components of {} neighbours\n", path, with_commas(count), of);
  if (count > 0) fmt::print("  {:>20}{:>16}\n", "voxels", "components");
  for (std::size_t i = 0; i < std::min(kShown, sizes.size()); ++i)
    fmt::print("  {:>20}{:>16}\n", with_commas(sizes[i].voxels), with_commas(sizes[i].count));
  if (sizes.size() > kShown)
    fmt::print("  {:>20}{:>16}\n", "fewer", with_commas(count - [&] {
                 std::uint64_t shown = 0;
                 for (std::size_t i = 0; i < kShown; ++i) shown += sizes[i].count;
                 return shown;
               }()));
}

void run(const ComponentsArguments& arguments, Session& session) {
  const EditArguments& edit = arguments.edit;
  if (!edit.output.empty()) check_dag_writable(edit.output);
  MemoryBudget memory = command_budget(edit.memory_limit);
  const DagModel file(session.subject, {&memory, &session.progress});
  std::optional<Components> components(std::in_place, file.view(), arguments.neighbours,
                                       Work{&memory, &session.progress});
  const std::vector<ComponentSizes> sizes = components->sizes();
  if (!edit.output.empty()) {
    const std::uint64_t least =
        arguments.largest ? (sizes.empty() ? 1 : sizes.front().voxels) : arguments.least;
    Svdag dag = components->keep(least);
    components.reset();  // Their memory is that of the attributes now.
    const CommandState asked = session;
    session.quiet = asked.quiet || asked.json;
    session.json = false;
    const PlacedModel source{file};
    write_edited(edit, std::move(dag), file.grid(), {&source, 1},
                 fmt::format("components of {} voxels or more", least), memory, session);
    static_cast<CommandState&>(session) = asked;
  }
  session.bar.clear();
  if (session.json || !session.quiet)
    print_sizes(session.subject, sizes, arguments.neighbours, session.json);
}

}  // namespace

void add_components_command(const Command& program, Session& session) {
  const auto arguments = std::make_shared<ComponentsArguments>();
  const Command command =
      program.add("components", "Count the connected components of a DAG, and keep the large ones",
                  "voxdag components scan.vdag --largest -o body.vdag\n"
                  "  voxdag components scan.vdag --at-least 100 -o clean.vdag\n\n"
                  "Voxels that are neighbours belong to one component. The command lists the ten "
                  "largest sizes; --json lists all.");
  command.text("file", session.subject, "FILE", "The .vdag file, in either form").required();
  add_neighbours_option(command, arguments->neighbours);
  EditArguments& edit = arguments->edit;
  const Option output = add_optional_output(command, edit, "The .vdag file to write: what is kept");
  const Option largest =
      command
          .flag("--largest", arguments->largest,
                "Keep the component with the most voxels; several that have as many are kept")
          .needs(output);
  command
      .number("--at-least", arguments->least, NumberRange::whole(1, std::int64_t{1} << 60), "N",
              "Keep the components with N voxels or more")
      .needs(output)
      .not_with(largest);
  add_listing_options(command, edit, session);
  command.when_parsed([arguments, &session] {
    if (!arguments->edit.output.empty() && !arguments->largest && arguments->least == 0)
      throw UsageError("--output", "needs --largest or --at-least");
    check_distinct({{"--output", arguments->edit.output}}, session);
    session.work = [arguments, &session] { run(*arguments, session); };
  });
}

}  // namespace voxdag::cli

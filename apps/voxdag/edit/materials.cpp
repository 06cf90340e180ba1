/// `voxdag materials`: lists the materials or labels of a DAG, and keeps some of them.
#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/commands.hpp"
#include "cli/output_files.hpp"
#include "cli/parse.hpp"
#include "edit/edited_file.hpp"
#include "voxdag/algebra/attributes/material_voxels.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/printable.hpp"
#include "voxdag/file/model/no_materials.hpp"
#include "voxdag/file/report/human.hpp"

namespace voxdag::cli {
namespace {

struct MaterialsArguments {
  EditArguments edit;
  std::vector<std::string> keep, drop;  ///< Names, labels or ids; one of them is empty.
};

void print_materials(const DagModel& file, const std::vector<MaterialVoxels>& voxels,
                     Session& session) {
  const AttributesMetadata& attributes = file.metadata().attributes;
  const Grid& grid = file.grid();
  std::vector<std::size_t> order(voxels.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  if (session.json) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const std::size_t i : order) {
      const Box3i& box = voxels[i].bounds;
      const Vec3d lo = grid.to_world(Vec3d(box.lo)), hi = grid.to_world(Vec3d(box.hi));
      nlohmann::ordered_json row = {{"id", i}, {"name", (*attributes.materials)[i]}};
      if (!attributes.labels.empty()) row["label"] = attributes.labels[i];
      row["voxels"] = voxels[i].voxels;
      if (voxels[i].voxels > 0) {
        row["window"] = {box.lo.x, box.lo.y, box.lo.z, box.hi.x, box.hi.y, box.hi.z};
        row["bounds"] = {lo.x, lo.y, lo.z, hi.x, hi.y, hi.z};
      }
      list.push_back(std::move(row));
    }
    fmt::print("{}", json_text(nlohmann::ordered_json{{"materials", std::move(list)}}));
    return;
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return voxels[a].voxels > voxels[b].voxels;
  });
  const char* const kind = attributes.labels.empty() ? "id" : "label";
  std::size_t widest = 8;
  for (const std::string& name : *attributes.materials) widest = std::max(widest, name.size());
  widest = std::min<std::size_t>(widest, 40);
  fmt::print("{}: materials: {}\n  {:>10}  {:<{}}{:>18}  window\n", session.named(session.subject),
             with_commas(order.size()), kind, "name", widest, "voxels");
  for (const std::size_t i : order) {
    const Box3i& box = voxels[i].bounds;
    fmt::print("  {:>10}  {:<{}}{:>18}  {},{},{},{},{},{}\n",
               attributes.labels.empty() ? static_cast<std::int64_t>(i) : attributes.labels[i],
               printable((*attributes.materials)[i]), widest, with_commas(voxels[i].voxels),
               box.lo.x, box.lo.y, box.lo.z, box.hi.x, box.hi.y, box.hi.z);
  }
}

void run(const MaterialsArguments& arguments, Session& session) {
  const EditArguments& edit = arguments.edit;
  if (!edit.output.empty()) check_dag_writable(edit.output);
  MemoryBudget memory = command_budget(edit.memory_limit);
  const Work work{&memory, &session.progress};
  const DagModel file(session.subject, work);
  const AttributesMetadata& attributes = file.metadata().attributes;
  if (!file.attributes().has_materials() || !attributes.materials)
    fail_without_materials(session.subject);
  if (edit.output.empty()) {
    const std::vector<MaterialVoxels> voxels =
        material_voxels(file.view(), file.attributes(), work);
    session.bar.clear();
    return print_materials(file, voxels, session);
  }
  const bool keeps_listed = !arguments.keep.empty();
  std::vector<bool> keeps(attributes.materials->size(), !keeps_listed);
  std::string names;
  for (const std::string& wanted : keeps_listed ? arguments.keep : arguments.drop) {
    const std::optional<std::size_t> id = find_material(attributes, wanted);
    if (!id)
      throw Error(session.subject, "",
                  "has no material " + in_quotes(wanted) + ": `voxdag materials` lists them");
    keeps[*id] = keeps_listed;
    names += (names.empty() ? "" : ", ") + wanted;
  }
  Svdag dag = keep_materials(file.view(), file.attributes(), keeps, work);
  const PlacedModel source{file};
  write_edited(edit, std::move(dag), file.grid(), {&source, 1},
               (keeps_listed ? "materials " : "without materials ") + names, memory, session);
}

}  // namespace

void add_materials_command(const Command& program, Session& session) {
  const auto arguments = std::make_shared<MaterialsArguments>();
  const Command command =
      program.add("materials", "List the materials or labels of a DAG, and keep some of them",
                  "voxdag materials city.vdag\n"
                  "  voxdag materials city.vdag --keep ground,building -o ground.vdag\n"
                  "  voxdag materials body.vdag --drop 3,7 -o rest.vdag\n\n"
                  "The list has the number of voxels of each material, and the window that holds "
                  "them, the most voxels first. `voxdag import --labels` keeps labels as "
                  "materials, and `voxdag build --material-ids` stores those of a mesh.");
  command.text("file", session.subject, "FILE", "The .vdag file, in either form").required();
  EditArguments& edit = arguments->edit;
  const Option output = add_optional_output(command, edit, "The .vdag file to write: what is kept");
  const Option keep = command
                          .parsed("--keep", arguments->keep, parse_words, "NAME,...",
                                  "Keep the voxels of these materials: their names, labels, or "
                                  "without labels their ids")
                          .needs(output);
  command
      .parsed("--drop", arguments->drop, parse_words, "NAME,...", "Keep the voxels of all others")
      .needs(output)
      .not_with(keep);
  add_listing_options(command, edit, session);
  command.when_parsed([arguments, &session] {
    if (!arguments->edit.output.empty() && arguments->keep.empty() && arguments->drop.empty())
      throw UsageError("--output", "needs --keep or --drop");
    check_distinct({{"--output", arguments->edit.output}}, session);
    session.work = [arguments, &session] { run(*arguments, session); };
  });
}

}  // namespace voxdag::cli

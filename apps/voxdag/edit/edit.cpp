/// `voxdag edit`: shapes, stamps and strokes of scripts, on an EditableDag.
#include <fmt/core.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cli/commands.hpp"
#include "cli/output_files.hpp"
#include "cli/scene_input.hpp"
#include "cli/stopwatch.hpp"
#include "edit/edited_file.hpp"
#include "edit/json_edit.hpp"
#include "edit/script_lines.hpp"
#include "voxdag/core/io/process_memory.hpp"
#include "voxdag/core/with_file_name.hpp"
#include "voxdag/edit/edit_script.hpp"
#include "voxdag/edit/replay.hpp"
#include "voxdag/file/model/seeded.hpp"
#include "voxdag/file/model/with_voxels.hpp"

namespace voxdag::cli {
namespace {

struct ScriptArguments {
  EditArguments edit;
  SceneInput input;
  std::string replay;
  std::vector<std::string> scripts, edits;
  std::size_t history = 0;
};

/// A DAG that edits change one after another.
class EditRun {
 public:
  EditRun(const DagModel& model, bool starts_empty, const ScriptArguments& arguments,
          MemoryBudget& memory, Session& session)
      : work_(&memory, &session.progress),
        model_(model),
        stamps_(model.grid(), {{"--output", arguments.edit.output}}, memory, session),
        dag_(ColoredDagView{model.view(), arguments.edit.drop_attributes ? DagAttributesView{}
                                                                         : model.attributes()},
             {.history = arguments.history, .starts_empty = starts_empty}, work_),
        drops_attributes_(arguments.edit.drop_attributes),
        first_root_(dag_.snapshot().view().root) {}

  /// Applies a line of CSV or JSON.
  void apply(std::string_view line) {
    work_.poll();
    const std::size_t first = line.find_first_not_of(" \t");
    if (first != line.npos && line[first] == '{') {
      apply_json_edit(line, dag_, model_.grid(), stamps_, work_);
    } else {
      const auto step = parse_edit_line(line, model_.grid());
      if (!step) return;
      apply_step(dag_, *step);
    }
    ++count_;
  }
  /// Calls apply(line) for each line of a file. Errors name both.
  template <class Apply>
  void for_each_line(const std::string& file, const Apply& apply) {
    with_file_name(file, [&] {
      ScriptLines lines(file);
      for (std::string_view line; lines.next(line);)
        at_edit_line(lines.number(), [&] { apply(line); });
    });
  }
  void run_script(const std::string& file) {
    for_each_line(file, [&](std::string_view line) { apply(line); });
  }
  void run_replay(const std::string& file) {
    ReplayPlaces places(model_.view());
    for_each_line(file, [&](std::string_view line) {
      const auto ball = parse_replay_line(line);
      if (!ball) return;
      work_.poll();
      const BallShape shape = places.place(*ball, dag_.snapshot().view());
      ball->adds ? dag_.add(shape) : dag_.remove(shape);
      ++count_;
    });
  }

  std::uint64_t count() const { return count_; }
  /// Returns whether the voxels are those before all edits, and no edit wrote values.
  bool changed_nothing() const {
    return dag_.snapshot().view().root == first_root_ && dag_.values().bytes() == 0;
  }
  const EditableDag& dag() const { return dag_; }
  /// Returns the DAG as edited, with its attributes.
  DagModel model() const {
    const EditSnapshot now = dag_.snapshot();
    Svdag dag = now.svdag(work_);
    DagAttributes attributes = now.attributes(dag.view(), {}, work_);
    return with_voxels(model_, std::move(dag), std::move(attributes),
                       fmt::format("{} edits", count_), work_, drops_attributes_);
  }

 private:
  Work work_;
  const DagModel& model_;
  StampFiles stamps_;
  EditableDag dag_;
  bool drops_attributes_;
  std::uint32_t first_root_;
  std::uint64_t count_ = 0;
};

void run(const ScriptArguments& arguments, Session& session) {
  check_dag_writable(arguments.edit.output);
  MemoryBudget memory = command_budget(arguments.edit.memory_limit);
  DagModel model(session.subject, {&memory, &session.progress});
  const bool is_compact = model.is_compact(), is_empty = model.view().is_empty();
  if (is_empty) model = seeded(model, &memory);
  EditRun run(model, is_empty, arguments, memory, session);
  Stopwatch watch;
  for (const std::string& script : arguments.scripts) run.run_script(script);
  if (!arguments.replay.empty()) run.run_replay(arguments.replay);
  for (const std::string& edit : arguments.edits)
    with_file_name("--do " + edit, [&] { run.apply(edit); });
  const double seconds = watch.lap();
  std::vector<std::pair<std::string, std::uint64_t>> counts = {{"edits", run.count()}};
  if (session.json)
    counts.insert(counts.end(),
                  {{"edit_milliseconds", static_cast<std::uint64_t>(seconds * 1e3)},
                   {"new_nodes", run.dag().nodes().added_nodes()},
                   {"new_bytes", run.dag().nodes().added_bytes() + run.dag().values().bytes()},
                   {"undo_depth", run.dag().undo_count()}});
  if (run.changed_nothing())
    print_warnings({session.subject + ": the edits changed no voxel"}, session);
  const bool compact = arguments.edit.compact || (!arguments.edit.plain && is_compact);
  write_edited(arguments.edit, run.model(), compact, memory, session, counts);
}

}  // namespace

void add_edit_command(const Command& program, Session& session) {
  const auto arguments = std::make_shared<ScriptArguments>();
  const Command command = program.add(
      "edit", "Add, remove and paint shapes and stamps, in an order that you say",
      "voxdag edit scene.vdag --do remove,ball,1,2,0.5,0.3 -o carved.vdag\n"
      "  voxdag edit scene.vdag --script strokes.csv -o edited.vdag\n\n"
      "An edit takes time for what it touches, not for the scene. A script has one edit a line, in "
      "world units:\n"
      "add|remove|paint|replace,SHAPE,NUMBERS[,#rrggbb][,material=N]; shapes are ball,X,Y,Z,R; "
      "box,X0,Y0,Z0,X1,Y1,Z1; capsule,X0,Y0,Z0,X1,Y1,Z1,R; halfspace,PX,PY,PZ,NX,NY,NZ and "
      "turnedbox,X,Y,Z,HX,HY,HZ,QX,QY,QZ,QW.\n"
      "smooth|grow|shrink,ball,X,Y,Z,R; copy|move,X0,Y0,Z0,X1,Y1,Z1,TX,TY,TZ; undo; redo.\n"
      "Lines that begin with # and empty lines do not count. A line that begins with { is an edit "
      "as JSON, which can also stamp files and lists of voxels. docs/editing.md describes both.\n"
      "Nothing is written if an edit fails.");
  add_scene_input(command, arguments->input, session, "A .vdag file, in either form");
  const auto any_text = [](const std::string& text) { return text; };
  command.repeated("--script", arguments->scripts, any_text, "FILE",
                   "Apply the edits of this file; - is the standard input. May be repeated");
  command.text("--replay", arguments->replay, "FILE",
               "Then apply a recorded session of HashDAG: its balls, each placed on a voxel of the "
               "scene");
  command.repeated("--do", arguments->edits, any_text, "EDIT",
                   "Then apply this edit. May be repeated");
  command.number("--history", arguments->history, NumberRange::whole(0, 1'000'000'000), "N",
                 "Number of edits that undo can take back; 0: all");
  add_edit_options(command, arguments->edit, session);
  command.when_parsed([arguments, &session] {
    if (arguments->scripts.empty() && arguments->replay.empty() && arguments->edits.empty())
      throw UsageError("one of --script, --replay and --do is required");
    for (const std::string& script : arguments->scripts)
      if (script != "-") session.inputs.push_back(script);
    if (!arguments->replay.empty()) session.inputs.push_back(arguments->replay);
    check_distinct({{"--output", arguments->edit.output}}, session);
    arguments->input.with_colors = !arguments->edit.drop_attributes;
    session.work = [arguments, &session] {
      work_on_scene(arguments->input, session, [&] { run(*arguments, session); });
    };
  });
}

}  // namespace voxdag::cli

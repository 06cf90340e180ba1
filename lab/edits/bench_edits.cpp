#include "lab/edits/bench_edits.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "voxdag/algebra/combine.hpp"
#include "voxdag/edit/editable_dag.hpp"
#include "voxdag/edit/replay.hpp"
#include "voxdag/file/model/dag_model.hpp"
#include "voxdag/stored/svdag/svdag_counts.hpp"

namespace voxdag::lab {
namespace {

double milliseconds_of(const auto& body) {
  const auto start = std::chrono::steady_clock::now();
  body();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

/// One editable scene, and what its edits cost.
class Editor {
 public:
  /// Takes places from copies of `places`, which cost a walk over the scene.
  Editor(const DagModel& model, const ReplayPlaces& places, std::size_t history,
         MemoryBudget& memory, Progress& progress)
      : progress_(progress),
        places_(places),
        has_colors_(model.attributes().has_colors()),
        dag_(ColoredDagView{model.view(), model.attributes()}, {.history = history},
             {&memory, &progress}) {}

  EditableDag& dag() { return dag_; }

  /// Places a ball and edits.
  void edit(ReplayPlaces& places, const ReplayBall& ball, EditTimes& times) {
    progress_.throw_if_cancelled();
    const BallShape shape = places.place(ball, dag_.snapshot().view());
    EditPaint paint;
    if (has_colors_) paint.color = Value8{200, 60, 40};
    times.milliseconds.push_back(
        milliseconds_of([&] { ball.adds ? dag_.add(shape, paint) : dag_.remove(shape); }));
    times.undo_milliseconds.push_back(milliseconds_of([&] { dag_.undo(); }));
    dag_.redo();
    times.least_radius = times.milliseconds.size() == 1
                             ? ball.radius_voxels
                             : std::min(times.least_radius, ball.radius_voxels);
    times.most_radius = std::max(times.most_radius, ball.radius_voxels);
  }

  /// Measures what body() edits, and goes back to the scene as it was.
  template <class Body>
  EditTimes measure(const std::string& name, const Body& body) {
    EditTimes times;
    times.name = name;
    const std::uint64_t nodes = dag_.nodes().added_nodes(), bytes = bytes_now();
    ReplayPlaces places = places_;
    body(places, times);
    times.new_nodes = dag_.nodes().added_nodes() - nodes;
    times.new_bytes = bytes_now() > bytes ? bytes_now() - bytes : 0;
    while (dag_.undo()) {
    }
    std::sort(times.milliseconds.begin(), times.milliseconds.end());
    std::sort(times.undo_milliseconds.begin(), times.undo_milliseconds.end());
    return times;
  }

  /// Returns the bytes of nodes and values that edits have taken.
  std::uint64_t bytes_now() const { return dag_.nodes().added_bytes() + dag_.values().bytes(); }

 private:
  Progress& progress_;
  const ReplayPlaces& places_;
  bool has_colors_;
  EditableDag dag_;
};

LongSession run_session(const DagModel& model, const ReplayPlaces& first, std::uint32_t edits,
                        Progress& progress) {
  LongSession session;
  session.times.name = fmt::format("{} edits", edits);
  MemoryBudget memory;
  Editor editor(model, first, LongSession::kHistory, memory, progress);
  ReplayPlaces places = first;
  std::mt19937 random(1);
  for (std::uint32_t i = 0; i < edits; ++i) {
    editor.edit(places, {4 + static_cast<double>(random() % 44), random() % 2 == 0}, session.times);
    session.most_bytes = std::max(session.most_bytes, editor.bytes_now());
    if (i < edits / 10) session.early_bytes = session.most_bytes;
    progress.report("session", static_cast<double>(i + 1) / edits, i + 1);
  }
  std::sort(session.times.milliseconds.begin(), session.times.milliseconds.end());
  std::sort(session.times.undo_milliseconds.begin(), session.times.undo_milliseconds.end());
  return session;
}

std::vector<ReplayBall> read_replay(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw Error(path, "", "cannot be read");
  std::vector<ReplayBall> balls;
  std::string line;
  for (std::uint64_t number = 1; std::getline(file, line); ++number) {
    try {
      if (const auto ball = parse_replay_line(line)) balls.push_back(*ball);
    } catch (const Error& error) {
      throw Error(path, fmt::format("line {}", number), error.what());
    }
  }
  return balls;
}

EditsRun run_scene(const std::string& scene, const EditsPlan& plan,
                   const std::vector<std::vector<ReplayBall>>& replays, Progress& progress) {
  EditsRun run;
  run.scene = scene;
  std::optional<DagModel> model;
  run.read_seconds = milliseconds_of([&] { model.emplace(scene, Work{&progress}); }) / 1000;
  run.file_bytes = model->file_bytes();
  run.levels = model->view().levels;
  run.has_colors = model->attributes().has_colors();
  for (const std::uint64_t count : count_svdag(model->view()).dag_nodes_per_level)
    run.base_nodes += count;
  const ReplayPlaces first(model->view());
  MemoryBudget memory;
  std::optional<Editor> editor;
  run.open_seconds =
      milliseconds_of([&] { editor.emplace(*model, first, 0, memory, progress); }) / 1000;
  run.memory_bytes = memory.used();
  for (std::size_t i = 0; i < replays.size(); ++i)
    run.times.push_back(editor->measure(std::filesystem::path(plan.replays[i]).filename(),
                                        [&](ReplayPlaces& places, EditTimes& times) {
                                          for (const ReplayBall& ball : replays[i])
                                            editor->edit(places, ball, times);
                                        }));
  for (const double radius : plan.radii)
    for (const bool adds : {true, false})
      run.times.push_back(editor->measure(fmt::format("{} {:g}", adds ? "add" : "remove", radius),
                                          [&](ReplayPlaces& places, EditTimes& times) {
                                            for (int i = 0; i < plan.repeats; ++i) {
                                              editor->edit(places, {radius, adds}, times);
                                              editor->dag().undo();
                                            }
                                          }));
  // An edit that is saved.
  EditTimes unused;
  ReplayPlaces places = first;
  editor->edit(places, {20, false}, unused);
  run.save_seconds = milliseconds_of([&] {
                       const EditSnapshot snapshot = editor->dag().snapshot();
                       const Svdag dag = snapshot.svdag({&progress});
                       snapshot.attributes(dag.view(), {}, {&progress});
                     }) /
                     1000;
  editor.reset();
  if (plan.session > 0) run.session = run_session(*model, first, plan.session, progress);
  if (plan.rewrites) {
    Svdag nothing;
    nothing.levels = run.levels;
    EditableDag empty(nothing.view());
    ReplayPlaces same = first;
    empty.add(same.place({20, false}, model->view()));
    const Svdag ball = empty.snapshot().svdag();
    run.rewrite_milliseconds = milliseconds_of(
        [&] { combine(model->view(), ball.view(), SetOperation::kDifference, {&progress}); });
  }
  return run;
}

}  // namespace

double EditTimes::quantile(double part) const {
  if (milliseconds.empty()) return 0;
  const auto last = static_cast<double>(milliseconds.size() - 1);
  return milliseconds[static_cast<std::size_t>(std::ceil(part * last))];
}

std::vector<EditsRun> bench_edits(const EditsPlan& plan, Progress& progress) {
  std::vector<std::vector<ReplayBall>> replays;
  for (const std::string& file : plan.replays) replays.push_back(read_replay(file));
  std::vector<EditsRun> runs;
  for (const std::string& scene : plan.scenes)
    runs.push_back(run_scene(scene, plan, replays, progress));
  return runs;
}

nlohmann::ordered_json edits_json(const std::vector<EditsRun>& runs,
                                  const nlohmann::ordered_json& machine) {
  nlohmann::ordered_json json{{"machine", machine}, {"runs", nlohmann::ordered_json::array()}};
  const auto times_json = [](const EditTimes& times) {
    return nlohmann::ordered_json{
        {"name", times.name},
        {"edits", times.milliseconds.size()},
        {"least_radius", times.least_radius},
        {"most_radius", times.most_radius},
        {"median_ms", times.quantile(0.5)},
        {"p95_ms", times.quantile(0.95)},
        {"most_ms", times.quantile(1)},
        {"most_undo_ms", times.undo_milliseconds.empty() ? 0.0 : times.undo_milliseconds.back()}};
  };
  for (const EditsRun& run : runs) {
    nlohmann::ordered_json edits = nlohmann::ordered_json::array();
    for (const EditTimes& times : run.times) {
      const auto count = static_cast<double>(times.milliseconds.size());
      nlohmann::ordered_json& row = edits.emplace_back(times_json(times));
      row["new_nodes_per_edit"] = static_cast<double>(times.new_nodes) / count;
      row["new_bytes_per_edit"] = static_cast<double>(times.new_bytes) / count;
    }
    json["runs"].push_back({{"scene", run.scene},
                            {"levels", run.levels},
                            {"has_colors", run.has_colors},
                            {"file_bytes", run.file_bytes},
                            {"base_nodes", run.base_nodes},
                            {"memory_bytes", run.memory_bytes},
                            {"read_seconds", run.read_seconds},
                            {"open_seconds", run.open_seconds},
                            {"save_seconds", run.save_seconds},
                            {"rewrite_ms", run.rewrite_milliseconds},
                            {"edits", std::move(edits)}});
    if (run.session.times.milliseconds.empty()) continue;
    nlohmann::ordered_json session = times_json(run.session.times);
    session["history"] = LongSession::kHistory;
    session["early_bytes"] = run.session.early_bytes;
    session["most_bytes"] = run.session.most_bytes;
    json["runs"].back()["session"] = std::move(session);
  }
  return json;
}

std::string edits_table(const std::vector<EditsRun>& runs) {
  std::string text;
  for (const EditsRun& run : runs) {
    text += fmt::format(
        "{}, {}³ voxels{}: {:.1f} M nodes, {:.0f} MiB; read {:.2f} s, open {:.2f} s, memory {:.0f} "
        "MiB, save {:.1f} s\n",
        run.scene, std::int64_t{1} << run.levels, run.has_colors ? ", colours" : "",
        static_cast<double>(run.base_nodes) / 1e6, static_cast<double>(run.file_bytes) / 1048576.0,
        run.read_seconds, run.open_seconds, static_cast<double>(run.memory_bytes) / 1048576.0,
        run.save_seconds);
    text +=
        fmt::format("{:36} {:>6} {:>12} {:>9} {:>9} {:>9} {:>9} {:>10} {:>10}\n", "edits", "count",
                    "radius", "median ms", "95% ms", "most ms", "undo ms", "nodes", "bytes");
    for (const EditTimes& times : run.times) {
      const auto count = static_cast<double>(times.milliseconds.size());
      text += fmt::format(
          "{:36} {:>6} {:>12} {:>9.3f} {:>9.3f} {:>9.3f} {:>9.4f} {:>10.0f} {:>10.0f}\n",
          times.name, times.milliseconds.size(),
          fmt::format("{:g} to {:g}", std::round(times.least_radius),
                      std::round(times.most_radius)),
          times.quantile(0.5), times.quantile(0.95), times.quantile(1),
          times.undo_milliseconds.empty() ? 0.0 : times.undo_milliseconds.back(),
          static_cast<double>(times.new_nodes) / count,
          static_cast<double>(times.new_bytes) / count);
    }
    if (const LongSession& session = run.session; !session.times.milliseconds.empty())
      text += fmt::format(
          "{} edits of 4 to 47 voxels' radius, undo for the last {}: median {:.3f} ms, most {:.3f} "
          "ms; at most {:.0f} MiB of edits, {:.0f} in the first tenth\n",
          session.times.milliseconds.size(), LongSession::kHistory, session.times.quantile(0.5),
          session.times.quantile(1), static_cast<double>(session.most_bytes) / 1048576.0,
          static_cast<double>(session.early_bytes) / 1048576.0);
    if (run.rewrite_milliseconds > 0)
      text += fmt::format("Taking a ball of 20 voxels out by `voxdag combine`: {:.0f} ms\n",
                          run.rewrite_milliseconds);
  }
  return text;
}

}  // namespace voxdag::lab

/// The class _LiveEdit, which voxdag.Edit wraps, and Snapshot.
#include <pybind11/stl.h>

#include <array>
#include <filesystem>
#include <mutex>

#include "arrays.hpp"
#include "dag.hpp"
#include "run_work.hpp"
#include "voxdag/algebra/reorient.hpp"
#include "voxdag/algebra/voxels/voxel_builder.hpp"
#include "voxdag/edit/edit_step.hpp"
#include "voxdag/edit/place_stamp.hpp"
#include "voxdag/file/model/seeded.hpp"
#include "voxdag/file/model/with_voxels.hpp"

namespace py = pybind11;

namespace voxdag::python {
namespace {

using Colors = std::vector<Vec3<std::uint8_t>>;

/// An edited DAG that threads may share: one changes it at a time.
class LiveEdit {
 public:
  LiveEdit(const DagPointer& base, std::size_t history)
      : base_(base->view().is_empty() ? std::make_shared<Dag>(seeded(base->model())) : base),
        dag_(run_work([&](Work) {
          return std::make_unique<EditableDag>(
              ColoredDagView{base_->view(), base_->model().attributes()},
              EditOptions{.history = history, .starts_empty = base_ != base});
        })) {}

  const Dag& base() const { return *base_; }

  /// Calls body(dag, work) without the GIL while no other thread does.
  template <class Body>
  auto run(const Body& body) {
    return run_work([&](Work work) {
      const std::lock_guard lock(changing_);
      return body(*dag_, work);
    });
  }
  std::shared_ptr<Snapshot> snapshot() {
    return std::make_shared<Snapshot>(base_,
                                      run([](EditableDag& dag, Work) { return dag.snapshot(); }));
  }
  DagPointer result() {
    const EditSnapshot now = run([](EditableDag& dag, Work) { return dag.snapshot(); });
    return run_work([&](Work work) {
      Svdag dag = now.svdag(work);
      DagAttributes attributes = now.attributes(dag.view(), {}, work);
      return std::make_shared<Dag>(
          with_voxels(base_->model(), std::move(dag), std::move(attributes), "edited"));
    });
  }

 private:
  DagPointer base_;
  std::mutex changing_;
  std::unique_ptr<EditableDag> dag_;
};

/// Returns the paint of edit i. Colours are one or as many as the edits.
EditPaint paint_of(const Colors& colors, const std::optional<std::uint32_t>& material,
                   std::size_t i) {
  EditPaint paint;
  if (!colors.empty()) {
    const auto& c = colors[colors.size() == 1 ? 0 : i];
    paint.color = Value8{c.x, c.y, c.z};
  }
  paint.material = material;
  return paint;
}

Colors colors_in(const std::optional<ArrayLike>& given) {
  return given ? colors_of(*given) : Colors();
}

/// Makes an edit of each row of numbers, then applies them in order.
void apply_rows(LiveEdit& edit, const std::string& verb, const std::string& shape,
                const Array<double>& numbers, const std::optional<ArrayLike>& color,
                const std::optional<std::uint32_t>& material) {
  const auto count = static_cast<std::size_t>(numbers.shape(0)),
             width = static_cast<std::size_t>(numbers.shape(1));
  const Colors colors = colors_in(color);
  if (colors.size() > 1 && colors.size() != count)
    throw py::value_error("color must be one colour or have one for each shape");
  std::vector<EditStep> steps;
  for (std::size_t i = 0; i < count; ++i)
    steps.push_back(make_edit_step(edit_verb(verb), shape, {numbers.data() + i * width, width},
                                   paint_of(colors, material, i), edit.base().grid()));
  edit.run([&](EditableDag& dag, Work work) {
    for (const EditStep& step : steps) {
      work.poll();
      apply_step(dag, step);
    }
    return 0;
  });
}

void stamp(LiveEdit& edit, const Dag& of, const std::optional<std::array<double, 3>>& at,
           const std::optional<std::string>& mirror,
           const std::optional<std::pair<std::string, int>>& turn, const std::string& mode,
           const std::optional<ArrayLike>& color, const std::optional<std::uint32_t>& material) {
  StampPlace place;
  if (at) place.at = Vec3d{(*at)[0], (*at)[1], (*at)[2]};
  if (mirror) place.orientation = mirrored(axis_of(*mirror));
  if (turn)
    place.orientation = then(place.orientation, rotated(axis_of(turn->first), turn->second % 4));
  StampMode how = StampMode::kAdd;
  if (mode == "remove")
    how = StampMode::kRemove;
  else if (mode == "replace")
    how = StampMode::kReplace;
  else if (mode != "add")
    throw py::value_error("mode must be 'add', 'remove' or 'replace'");
  const EditPaint paint = paint_of(colors_in(color), material, 0);
  edit.run([&](EditableDag& dag, Work work) {
    const PlacedStamp placed = place_stamp(of.view(), of.grid(), place, edit.base().grid(), work);
    dag.stamp(placed.voxels.view(), how, {}, paint, placed.box);
    return 0;
  });
}

void change_voxels(LiveEdit& edit, const ArrayLike& voxels, bool adds,
                   const std::optional<ArrayLike>& color,
                   const std::optional<std::uint32_t>& material) {
  const std::vector<Vec3i> places = voxels_of(voxels, "voxels");
  const EditPaint paint = paint_of(colors_in(color), material, 0);
  edit.run([&](EditableDag& dag, Work work) {
    constexpr std::size_t kInMemory = std::size_t{1} << 24;
    VoxelBuilder builder(dag.levels(), kInMemory, std::filesystem::temp_directory_path(), work);
    for (const Vec3i voxel : places) builder.add(voxel);
    const Svdag stamp = builder.finish();
    dag.stamp(stamp.view(), adds ? StampMode::kAdd : StampMode::kRemove, {}, paint);
    return 0;
  });
}

}  // namespace

void add_live_edits(py::module_& module) {
  py::class_<LiveEdit>(module, "_LiveEdit")
      .def(py::init<DagPointer, std::size_t>())
      .def("apply", &apply_rows)
      .def("stamp", &stamp)
      .def("change_voxels", &change_voxels)
      .def("undo",
           [](LiveEdit& e) { return e.run([](EditableDag& dag, Work) { return dag.undo(); }); })
      .def("redo",
           [](LiveEdit& e) { return e.run([](EditableDag& dag, Work) { return dag.redo(); }); })
      .def("counts",
           [](LiveEdit& e) {
             return e.run([](EditableDag& dag, Work) {
               return std::pair(dag.undo_count(), dag.redo_count());
             });
           })
      .def("snapshot", &LiveEdit::snapshot)
      .def("dag", &LiveEdit::result);
  SnapshotClass snapshot(module, "Snapshot",
                         "One version of a DAG that is being edited. It stays as it is while edits "
                         "go on, and takes no time to make.");
  add_rays(snapshot);
  add_contacts(snapshot);
  add_pictures(snapshot);
}

}  // namespace voxdag::python

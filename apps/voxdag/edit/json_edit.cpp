#include "edit/json_edit.hpp"

#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "voxdag/algebra/reorient.hpp"
#include "voxdag/algebra/voxels/voxel_builder.hpp"
#include "voxdag/core/printable.hpp"
#include "voxdag/edit/edit_step.hpp"
#include "voxdag/file/npy.hpp"

namespace voxdag::cli {
namespace {

/// The members of an object. check_all_used() throws for those that nobody asked for.
class Members {
 public:
  explicit Members(std::string_view line) : object_(nlohmann::json::parse(line, nullptr, false)) {
    if (!object_.is_object()) throw Error("is no object of JSON");
  }

  const nlohmann::json* find(std::string_view name) {
    const auto found = object_.find(name);
    if (found == object_.end()) return nullptr;
    used_.insert(std::string(name));
    return &*found;
  }
  std::string text(std::string_view name, const char* if_missing = nullptr) {
    const nlohmann::json* value = find(name);
    if (value == nullptr && if_missing != nullptr) return if_missing;
    if (value == nullptr || !value->is_string()) fail(name, "must be a text");
    return *value;
  }
  bool flag(std::string_view name) {
    const nlohmann::json* value = find(name);
    if (value != nullptr && !value->is_boolean()) fail(name, "must be true or false");
    return value != nullptr && *value;
  }
  /// Appends one number, or an array of `count` numbers.
  void append(std::string_view name, std::size_t count, std::vector<double>& numbers) {
    const nlohmann::json* value = find(name);
    const nlohmann::json list = value == nullptr ? nlohmann::json()
                                : count == 1     ? nlohmann::json::array({*value})
                                                 : *value;
    bool is_right = list.is_array() && list.size() == count;
    for (const nlohmann::json& number : list) is_right = is_right && number.is_number();
    if (!is_right)
      fail(name, count == 1 ? "must be a number"
                            : "must be an array of " + std::to_string(count) + " numbers");
    for (const nlohmann::json& number : list) numbers.push_back(number);
  }
  EditPaint paint() {
    EditPaint paint;
    if (find("color") != nullptr) paint.color = edit_color(text("color"));
    if (const nlohmann::json* material = find("material")) {
      if (!material->is_number_unsigned() || *material > 0xFFFFFFFFu)
        fail("material", "must be a whole number");
      paint.material = *material;
    }
    return paint;
  }
  void check_all_used() const {
    for (const auto& [name, value] : object_.items())
      if (!used_.contains(name)) fail(name, "is no member of this edit");
  }
  [[noreturn]] static void fail(std::string_view name, const std::string& reason) {
    throw Error(in_quotes(name) + " " + reason);
  }

 private:
  nlohmann::json object_;
  std::set<std::string> used_;
};

/// Calls add(voxel) for each voxel of a file, or of an array of arrays.
template <class Add>
void for_each_listed(const nlohmann::json& voxels, const Add& add) {
  if (voxels.is_string()) {
    NpyReader reader(voxels.get<std::string>(), "<i4", {3}, 4);
    std::vector<std::array<std::int32_t, 3>> rows(4096);
    while (const std::size_t count = reader.read_rows(rows.data(), rows.size()))
      for (std::size_t i = 0; i < count; ++i) add(Vec3i{rows[i][0], rows[i][1], rows[i][2]});
    return;
  }
  for (const nlohmann::json& voxel : voxels) {
    bool is_right = voxel.is_array() && voxel.size() == 3;
    for (const nlohmann::json& number : voxel)
      is_right = is_right && number.is_number_integer() && std::abs(number.get<double>()) < 0x1p31;
    if (!is_right) Members::fail("voxels", "must be arrays of 3 whole numbers, or a .npy file");
    add(Vec3i{voxel[0], voxel[1], voxel[2]});
  }
}

EditPaint paint_of_stamp(Members& edit, StampMode mode) {
  const EditPaint paint = edit.paint();
  if (mode == StampMode::kRemove && (paint.color || paint.material))
    throw Error("voxels that are removed take no colour and no material");
  return paint;
}

void apply_voxels(Members& edit, EditVerb verb, EditableDag& dag, Work work) {
  if (verb != EditVerb::kAdd && verb != EditVerb::kRemove)
    Members::fail("voxels", "belong to add and remove");
  constexpr std::size_t kInMemory = std::size_t{1} << 22;
  VoxelBuilder builder(dag.levels(), kInMemory, std::filesystem::temp_directory_path(), work);
  for_each_listed(*edit.find("voxels"), [&](Vec3i voxel) { builder.add(voxel); });
  const auto mode = verb == EditVerb::kAdd ? StampMode::kAdd : StampMode::kRemove;
  const EditPaint paint = paint_of_stamp(edit, mode);
  edit.check_all_used();
  const Svdag voxels = builder.finish();
  dag.stamp(voxels.view(), mode, {}, paint);
}

StampMode mode_in(const std::string& text) {
  if (text == "add") return StampMode::kAdd;
  if (text == "remove") return StampMode::kRemove;
  if (text == "replace") return StampMode::kReplace;
  Members::fail("mode", "must be \"add\", \"remove\" or \"replace\"");
}

int axis_in(const char* name, const nlohmann::json& value) {
  if (value == "x") return 0;
  if (value == "y") return 1;
  if (value == "z") return 2;
  Members::fail(name, "must have an axis: \"x\", \"y\" or \"z\"");
}

void apply_stamp(Members& edit, EditableDag& dag, StampFiles& stamps) {
  StampRequest request{edit.text("file"), edit.flag("solid"), {}};
  if (edit.find("at") != nullptr) {
    std::vector<double> at;
    edit.append("at", 3, at);
    request.place.at = Vec3d{at[0], at[1], at[2]};
  }
  Orientation& orientation = request.place.orientation;
  if (const nlohmann::json* mirror = edit.find("mirror"))
    orientation = mirrored(axis_in("mirror", *mirror));
  if (const nlohmann::json* turn = edit.find("turn")) {
    if (!turn->is_array() || turn->size() != 2 || !turn->at(1).is_number_integer())
      Members::fail("turn", "must be an axis and a number of quarter turns: [\"z\", 1]");
    const auto quarters = turn->at(1).get<std::int64_t>() % 4;
    orientation =
        then(orientation, rotated(axis_in("turn", turn->at(0)), static_cast<int>(quarters)));
  }
  const StampMode mode = mode_in(edit.text("mode", "add"));
  const EditPaint paint = paint_of_stamp(edit, mode);
  edit.check_all_used();
  const PlacedStamp stamp = stamps.place(request);
  dag.stamp(stamp.voxels.view(), mode, {}, paint, stamp.box);
}

void apply(Members& edit, EditableDag& dag, const Grid& grid, StampFiles& stamps, Work work) {
  const std::string op = edit.text("op");
  if (op == "stamp") return apply_stamp(edit, dag, stamps);
  const EditVerb verb = edit_verb(op);
  if (edit.find("voxels") != nullptr) return apply_voxels(edit, verb, dag, work);
  const std::string shape = takes_shape(verb) ? edit.text("shape") : "";
  std::vector<double> numbers;
  for (const EditField& field : edit_fields(verb, shape))
    edit.append(field.name, field.count, numbers);
  const EditPaint paint = edit.paint();
  edit.check_all_used();
  apply_step(dag, make_edit_step(verb, shape, numbers, paint, grid));
}

}  // namespace

void apply_json_edit(std::string_view line, EditableDag& dag, const Grid& grid, StampFiles& stamps,
                     Work work) {
  try {
    Members edit(line);
    apply(edit, dag, grid, stamps, work);
  } catch (const Cancelled&) {
    throw;
  } catch (const OverMemory&) {
    throw;
  } catch (const Error& error) {
    throw Error(error.what());  // The file is that of a stamp; the script's name comes before it.
  }
}

}  // namespace voxdag::cli

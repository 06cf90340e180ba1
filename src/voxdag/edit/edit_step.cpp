#include "voxdag/edit/edit_step.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <string>

#include "voxdag/core/error.hpp"
#include "voxdag/core/printable.hpp"
#include "voxdag/core/quaternion.hpp"

namespace voxdag {
namespace {

/// In the order of EditVerb.
constexpr std::string_view kVerbs[] = {"add",    "remove", "paint", "replace", "smooth", "grow",
                                       "shrink", "copy",   "move",  "undo",    "redo"};

constexpr EditField kBall[] = {{"center", 3}, {"radius", 1}};
constexpr EditField kBox[] = {{"min", 3}, {"max", 3}};
constexpr EditField kCapsule[] = {{"from", 3}, {"to", 3}, {"radius", 1}};
constexpr EditField kHalfSpace[] = {{"point", 3}, {"normal", 3}};
constexpr EditField kTurnedBox[] = {{"center", 3}, {"half", 3}, {"turn", 4}};
constexpr EditField kCopy[] = {{"min", 3}, {"max", 3}, {"to", 3}};

struct NamedShape {
  std::string_view name;
  std::span<const EditField> fields;
};
constexpr NamedShape kShapes[] = {{"ball", kBall},
                                  {"box", kBox},
                                  {"capsule", kCapsule},
                                  {"halfspace", kHalfSpace},
                                  {"turnedbox", kTurnedBox}};

bool is_filter(EditVerb verb) { return verb >= EditVerb::kSmooth && verb <= EditVerb::kShrink; }

Vec3d vec3(std::span<const double> numbers, std::size_t first) {
  return {numbers[first], numbers[first + 1], numbers[first + 2]};
}

void check_order(Vec3d lo, Vec3d hi) {
  for (int axis = 0; axis < 3; ++axis)
    if (hi[axis] < lo[axis]) throw Error("the box's max is less than its min");
}

EditShape turned_box(const Grid& grid, std::span<const double> numbers) {
  const auto turned = turned_axes(numbers[6], numbers[7], numbers[8], numbers[9]);
  const Vec3d axes[3] = {turned[0], turned[1], turned[2]};
  return make_turned_box(grid, vec3(numbers, 0), vec3(numbers, 3), axes);
}

EditShape shape_of(std::string_view shape, std::span<const double> numbers, const Grid& grid) {
  if (shape == "ball") return make_ball(grid, vec3(numbers, 0), numbers[3]);
  if (shape == "capsule") return make_capsule(grid, vec3(numbers, 0), vec3(numbers, 3), numbers[6]);
  if (shape == "halfspace") return make_half_space(grid, vec3(numbers, 0), vec3(numbers, 3));
  if (shape == "turnedbox") return turned_box(grid, numbers);
  check_order(vec3(numbers, 0), vec3(numbers, 3));
  return make_box(grid, vec3(numbers, 0), vec3(numbers, 3));
}

/// Returns the first voxel whose centre is not below a corner, along each axis.
Vec3i first_voxel(const Grid& grid, Vec3d corner) {
  const auto slabs = std::get<SlabsShape>(make_box(grid, corner, corner));
  Vec3i voxel;
  for (int axis = 0; axis < 3; ++axis) {
    const std::int64_t subvoxel = slabs.slabs[axis].first / SlabsShape::kAxisUnit;
    voxel[axis] = static_cast<std::int32_t>((subvoxel + kSubvoxels / 2 - 1) >> 8);
  }
  return voxel;
}
static_assert(kSubvoxels == 256);

/// "ball needs 4 numbers: center 3, radius 1"
std::string needs_text(std::string_view name, std::span<const EditField> fields) {
  std::size_t count = 0;
  std::string list;
  for (const EditField& field : fields) {
    count += field.count;
    list.append(list.empty() ? "" : ", ").append(field.name);
    list += " " + std::to_string(field.count);
  }
  return std::string(name) + " needs " + std::to_string(count) + " numbers" +
         (list.empty() ? "" : ": " + list);
}

}  // namespace

EditVerb edit_verb(std::string_view name) {
  const auto* found = std::find(std::begin(kVerbs), std::end(kVerbs), name);
  if (found == std::end(kVerbs))
    throw Error(in_quotes(name) +
                " is no edit: use add, remove, paint, replace, smooth, grow, shrink, copy, move, "
                "undo or redo");
  return static_cast<EditVerb>(found - std::begin(kVerbs));
}

std::string_view verb_name(EditVerb verb) { return kVerbs[static_cast<std::size_t>(verb)]; }

std::span<const EditField> edit_fields(EditVerb verb, std::string_view shape) {
  if (!takes_shape(verb)) {
    if (!shape.empty()) throw Error(std::string(verb_name(verb)) + " takes no shape");
    if (verb == EditVerb::kCopy || verb == EditVerb::kMove) return kCopy;
    return {};
  }
  const auto* found = std::find_if(std::begin(kShapes), std::end(kShapes),
                                   [&](const NamedShape& of) { return of.name == shape; });
  if (found == std::end(kShapes))
    throw Error(in_quotes(shape) + " is no shape: use ball, box, capsule, halfspace or turnedbox");
  if (is_filter(verb) && shape != "ball")
    throw Error(std::string(verb_name(verb)) + " takes a ball only");
  return found->fields;
}

EditStep make_edit_step(EditVerb verb, std::string_view shape, std::span<const double> numbers,
                        const EditPaint& paint, const Grid& grid) {
  const std::span<const EditField> fields = edit_fields(verb, shape);
  std::size_t count = 0;
  for (const EditField& field : fields) count += field.count;
  if (numbers.size() != count)
    throw Error(needs_text(takes_shape(verb) ? shape : verb_name(verb), fields) + "; it has " +
                std::to_string(numbers.size()));
  const bool has_paint = paint.color || paint.material;
  const bool paints = verb == EditVerb::kPaint || verb == EditVerb::kReplace;
  if (has_paint && verb != EditVerb::kAdd && !paints)
    throw Error(std::string(verb_name(verb)) + " takes no colour and no material");
  if (!has_paint && paints)
    throw Error(std::string(verb_name(verb)) + " needs a colour #rrggbb or a material");
  EditStep step{.verb = verb, .paint = paint};
  if (takes_shape(verb)) {
    step.shape = shape_of(shape, numbers, grid);
  } else if (!fields.empty()) {
    const Vec3d lo = vec3(numbers, 0), hi = vec3(numbers, 3), to = vec3(numbers, 6);
    check_order(lo, hi);
    step.box = {first_voxel(grid, lo), first_voxel(grid, hi)};
    first_voxel(grid, to);  // Throws for what is too far away.
    const Vec3d by = grid.to_grid(to) - grid.to_grid(lo);
    for (int axis = 0; axis < 3; ++axis)
      step.to[axis] = step.box.lo[axis] + static_cast<std::int32_t>(std::lround(by[axis]));
  }
  return step;
}

void apply_step(EditableDag& dag, const EditStep& step) {
  const auto filter = [&](BallFilter of) { dag.filter(std::get<BallShape>(step.shape), of); };
  switch (step.verb) {
    case EditVerb::kAdd:
      return dag.add(step.shape, step.paint);
    case EditVerb::kRemove:
      return dag.remove(step.shape);
    case EditVerb::kPaint:
      return dag.paint(step.shape, step.paint);
    case EditVerb::kReplace:
      return dag.replace(step.shape, step.paint);
    case EditVerb::kSmooth:
      return filter(BallFilter::kSmooth);
    case EditVerb::kGrow:
      return filter(BallFilter::kGrow);
    case EditVerb::kShrink:
      return filter(BallFilter::kShrink);
    case EditVerb::kCopy:
    case EditVerb::kMove:
      return dag.copy(step.box, step.to, step.verb == EditVerb::kMove);
    case EditVerb::kUndo:
      if (!dag.undo()) throw Error("there is nothing to undo");
      return;
    case EditVerb::kRedo:
      if (!dag.redo()) throw Error("there is nothing to redo");
      return;
  }
}

Value8 edit_color(std::string_view text) {
  std::uint32_t bits = 0;
  const char* end = text.data() + text.size();
  if (text.size() != 7 || text[0] != '#' ||
      std::from_chars(text.data() + 1, end, bits, 16).ptr != end)
    throw Error(in_quotes(text) + " is no colour: use #rrggbb");
  return {static_cast<std::uint8_t>(bits >> 16), static_cast<std::uint8_t>(bits >> 8),
          static_cast<std::uint8_t>(bits)};
}

}  // namespace voxdag

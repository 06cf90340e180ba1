#include "voxdag/formats/readers/obj/obj_chunk.hpp"

namespace voxdag {
namespace {

bool has_six_numbers(std::string_view line) {
  for (int n = 0; n < 6; ++n)
    if (next_token(line).empty()) return false;
  return true;
}

}  // namespace

std::size_t count_fan_triangles(std::string_view corners, CancelPoll& poll) {
  std::size_t count = 0;
  for (; !next_corner(corners).empty(); ++count) poll.step();
  return count < 3 ? 0 : count - 2;
}

ObjChunk::ObjChunk(const MeshSource& source, std::string_view text, char line_end)
    : materials(source.work().memory), libraries(source.work().memory) {
  CancelPoll poll(source.work());
  for_each_line(text, line_end, source.work().memory, [&](std::string_view line, const char*) {
    switch (take_keyword(line)) {
      case ObjStatement::kVertex:
        ++counts.vertices;
        has_colors = has_colors || has_six_numbers(line);
        break;
      case ObjStatement::kUv:
        ++counts.uvs;
        break;
      case ObjStatement::kNormal:
        ++counts.normals;
        break;
      case ObjStatement::kFace:
        counts.triangles += count_fan_triangles(line, poll);
        faces_before_material |= materials.empty();
        break;
      case ObjStatement::kMaterial:
        last_material = materials.find_or_add(trim(line));
        break;
      case ObjStatement::kLibrary:
        libraries.find_or_add(trim(line));
        break;
      case ObjStatement::kOther:
        break;
    }
  });
}

}  // namespace voxdag

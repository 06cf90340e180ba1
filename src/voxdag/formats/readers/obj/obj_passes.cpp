#include "voxdag/formats/readers/obj/obj_passes.hpp"

#include "voxdag/formats/readers/obj/obj_attributes.hpp"

namespace voxdag {
namespace {

bool has_six_numbers(std::string_view line) {
  for (int n = 0; n < 6; ++n)
    if (next_token(line).empty()) return false;
  return true;
}

/// Returns the number of triangles that a face line becomes.
std::size_t count_triangles(std::string_view line, CancelPoll& poll) {
  std::size_t corners = 0;
  for (; !next_corner(line).empty(); ++corners) poll.step();
  return corners < 3 ? 0 : corners - 2;
}

/// Removes three coordinates from a line and returns them as a vertex.
Vec3f take_vertex(std::string_view& numbers, Vec3d origin, const char* position) {
  Vec3f vertex;
  for (int axis = 0; axis < 3; ++axis) {
    const std::string_view token = next_token(numbers);
    if (token.empty()) throw Fault{position, "the vertex has fewer than three coordinates"};
    if (!parse_coordinate(token, origin[axis], vertex[axis]))
      throw Fault{position, "coordinate " + in_quotes(token) + " is not a number"};
  }
  return vertex;
}

/// Returns the index of the vertex that a corner (`v`, `v/vt`, `v//vn` or `v/vt/vn`) names. `seen`
/// vertices precede the line in the file, `total` are in the file.
std::uint32_t parse_vertex_index(std::string_view corner, std::size_t seen, std::size_t total,
                                 const char* position) {
  const std::string_view reference = corner.substr(0, corner.find('/'));
  std::int64_t index = 0;
  if (!parse_int(reference, index) || corner.find_first_not_of("0123456789+-/") != corner.npos)
    throw Fault{position, "face corner " + in_quotes(corner) + " is not a vertex index"};
  if (index > 0 && static_cast<std::uint64_t>(index) <= total)
    return static_cast<std::uint32_t>(index - 1);
  // -1 is the last vertex before the line. -(index + 1) does not overflow.
  if (index < 0 && static_cast<std::uint64_t>(-(index + 1)) < seen)
    return static_cast<std::uint32_t>(seen - static_cast<std::uint64_t>(-(index + 1)) - 1);
  const std::string range =
      index < 0 ? std::to_string(seen) + " vertices so far" : std::to_string(total) + " vertices";
  throw Fault{position, "vertex index " + std::to_string(index) + " is out of range: " + range};
}

}  // namespace

ObjFile::ObjFile(const MeshSource& source, std::size_t chunk_bytes)
    : source_(source),
      chunks_{without_byte_order_mark(source.bytes), line_end_of(source.bytes), chunk_bytes} {}

ObjChunk ObjFile::count(std::string_view chunk, ReadParts parts) const {
  ObjChunk counted(source_.work().memory);
  CancelPoll poll(source_.work());
  const auto end_run = [&](const char* at) {
    if (counted.runs.empty()) return;
    std::string_view& text = counted.runs.back().text;
    text = {text.data(), static_cast<std::size_t>(at - text.data())};
  };
  bool has_few_runs = true;
  const auto add_to_run = [&](bool is_value, const char* position) {
    if (!has_few_runs || (!counted.runs.empty() && counted.runs.back().has_values == is_value))
      return;
    end_run(position);
    has_few_runs = counted.runs.size() < ObjChunk::kMaxRuns;
    counted.runs.push_back({{position, 0}, is_value, counted.counts});
  };
  for_each_statement(
      chunk, [&](ObjStatement statement, std::string_view line, const char* position) {
        if (is_value(statement))
          add_to_run(true, position);
        else if (statement == ObjStatement::kFace || statement == ObjStatement::kMaterial)
          add_to_run(false, position);
        counted.counts.add_value(statement);
        switch (statement) {
          case ObjStatement::kVertex:
            if (parts == ReadParts::kMeshAndAppearance && !counted.has_colors)
              counted.has_colors = has_six_numbers(line);
            break;
          case ObjStatement::kFace:
            counted.counts.triangles += count_triangles(line, poll);
            counted.has_faces = true;
            counted.has_faces_before_material |= counted.materials.empty();
            break;
          case ObjStatement::kMaterial:
            counted.last_material = counted.materials.find_or_add(trim(line));
            break;
          case ObjStatement::kLibrary:
            counted.libraries.find_or_add(trim(line));
            break;
          case ObjStatement::kObject:
          case ObjStatement::kGroup:
            if (source_.options.objects)
              counted.parts.push_back({counted.counts.triangles,
                                       counted.objects.find_or_add(trim(line)),
                                       statement == ObjStatement::kGroup});
            break;
          default:
            break;
        }
      });
  end_run(chunk.data() + chunk.size());
  if (!has_few_runs) counted.runs.clear();
  return counted;
}

void ObjFile::read_vertices(std::string_view chunk, std::span<Vec3f> vertices, ObjCounts seen,
                            ObjAttributes* attributes) const {
  std::size_t done = 0;
  for_each_statement(chunk,
                     [&](ObjStatement statement, std::string_view line, const char* position) {
                       if (statement == ObjStatement::kVertex) {
                         if (done == vertices.size()) throw Fault{position, kFileChanged};
                         const Vec3f vertex = take_vertex(line, source_.origin, position);
                         vertices[done++] = vertex;
                         if (attributes != nullptr && attributes->has_colors() && is_finite(vertex))
                           attributes->set_color(seen.vertices, line);
                       } else if (attributes != nullptr && statement == ObjStatement::kUv) {
                         attributes->set_uv(seen.uvs, line);
                       } else if (attributes != nullptr && statement == ObjStatement::kNormal) {
                         attributes->set_normal(seen.normals, line);
                       }
                       seen.add_value(statement);
                     });
  if (done != vertices.size()) throw source_.error(kFileChanged);
}

ObjFaces::ObjFaces(const MeshSource& source, const AllVertices& vertices,
                   std::span<Triangle> triangles, ObjAttributes* attributes)
    : vertices_(vertices),
      attributes_(attributes),
      writer_(source, vertices, triangles),
      references_(source.work().memory) {}

std::size_t ObjFaces::read(std::string_view line, const char* position, const ObjCounts& seen) {
  references_.clear();
  for (std::string_view corner; !(corner = next_corner(line)).empty();) {
    writer_.add_corner(parse_vertex_index(corner, seen.vertices, vertices_.count, position));
    if (attributes_ != nullptr) references_.push_back(attributes_->parse_references(corner, seen));
  }
  const std::size_t before = writer_.written();
  writer_.finish_face(position, [&](std::size_t t, const Triangle& corners) {
    if (attributes_ != nullptr)
      attributes_->set_references(seen.triangles + t - before, references_[corners[0]],
                                  references_[corners[1]], references_[corners[2]]);
  });
  return writer_.written() - before;
}

}  // namespace voxdag

#include "voxdag/formats/readers/off/off_reader.hpp"

#include <limits>

#include "voxdag/formats/readers/chunks.hpp"
#include "voxdag/formats/readers/face_writer.hpp"

namespace voxdag {
namespace {

class OffReader {
 public:
  explicit OffReader(const MeshSource& source)
      : source_(source),
        line_end_(line_end_of(source.bytes)),
        memory_(source.work().memory, 0),
        rest_(without_byte_order_mark(source.bytes)),
        mesh_(empty_mesh(source.options.arrays)) {}

  Mesh read() {
    try {
      std::string_view line = read_header();
      read_vertices(count(line, "vertices", kMinVertexBytes));
      const std::size_t faces = count(line, "faces", kMinFaceBytes);
      const std::size_t triangles = count_triangles(faces);
      memory_.resize(memory_.bytes() + source_.options.counted(triangles * sizeof(Triangle)));
      mesh_.triangles.resize(triangles);
      if (mesh_.triangles.empty())
        throw source_.error("no face has three corners or more: there is no surface to read");
      read_faces(faces);
    } catch (const Fault& fault) {
      throw_fault(source_, fault, line_end_);
    }
    return std::move(mesh_);
  }

 private:
  static constexpr std::size_t kMinVertexBytes = 6, kMinFaceBytes = 2;

  /// Returns the next line that is not blank, without its comment.
  std::string_view next_row() {
    while (!rest_.empty()) {
      std::string_view line = next_line(rest_, line_end_);
      line = trim(line.substr(0, line.find('#')));
      if (!line.empty()) return line;
    }
    throw Fault{source_.bytes.data() + source_.bytes.size(), "the file ends before its last face"};
  }

  /// Skips the magic word and returns the line of counts, which may be the same line.
  std::string_view read_header() {
    std::string_view line = next_row();
    const std::string_view magic = next_token(line);
    if (!is_off(magic)) throw Fault{magic.data(), "not an OFF file: it does not start with 'OFF'"};
    if (magic.find('4') != magic.npos || magic.find('n') != magic.npos)
      throw Fault{magic.data(),
                  "4OFF and nOFF are not supported: vertices must have three coordinates"};
    if (trim(line).starts_with("BINARY"))
      throw Fault{magic.data(), "binary OFF is not supported: save it as text"};
    return trim(line).empty() ? next_row() : line;
  }

  std::size_t count(std::string_view& line, const std::string& what, std::size_t least) const {
    const std::string_view token = next_token(line);
    std::int64_t value = 0;
    if (!parse_int(token, value) || value < 0)
      throw Fault{line.data(), "expected the number of " + what + ", not " + in_quotes(token)};
    if (static_cast<std::uint64_t>(value) > source_.bytes.size() / least ||
        value >= std::numeric_limits<std::uint32_t>::max())
      throw Fault{line.data(), "the file is too short for " + std::to_string(value) + " " + what};
    return static_cast<std::size_t>(value);
  }

  void read_vertices(std::size_t vertices) {
    memory_.resize(source_.options.counted(vertices * sizeof(Vec3f)));
    mesh_.vertices.resize(vertices);
    for (Vec3f& vertex : mesh_.vertices) {
      std::string_view row = next_row();
      for (int axis = 0; axis < 3; ++axis) {
        const std::string_view token = next_token(row);
        if (!parse_float(token, vertex[axis]))
          throw Fault{row.data(), "coordinate " + in_quotes(token) + " is not a number"};
      }
      release();
    }
  }

  std::size_t count_triangles(std::size_t faces) {
    const std::string_view start = rest_;
    std::size_t triangles = 0;
    for (std::size_t face = 0; face < faces; ++face) {
      std::string_view row = next_row();
      const std::size_t corners = corner_count(row);
      if (corners > 2) triangles += corners - 2;
      release();
    }
    rest_ = start;
    return triangles;
  }

  static std::size_t corner_count(std::string_view& row) {
    const std::string_view token = next_token(row);
    std::int64_t corners = 0;
    // A corner needs at least two characters, so a count that is too large for the line is refused
    // before it is used.
    if (!parse_int(token, corners) || corners < 0 ||
        static_cast<std::uint64_t>(corners) > row.size() / 2)
      throw Fault{row.data(),
                  "the number of vertex indices is missing, or the row is too short for it"};
    return static_cast<std::size_t>(corners);
  }

  void read_faces(std::size_t faces) {
    const AllVertices vertices{0, mesh_.vertices.size(),
                               [this](std::uint32_t vertex) { return mesh_.vertices[vertex]; }};
    FaceWriter writer(source_, vertices, mesh_.triangles);
    for (std::size_t face = 0; face < faces; ++face) {
      std::string_view row = next_row();
      const std::size_t corners = corner_count(row);
      for (std::size_t corner = 0; corner < corners; ++corner) writer.add_corner(vertex_index(row));
      writer.finish_face(row.data());
      release();
    }
  }

  std::uint32_t vertex_index(std::string_view& row) const {
    const std::string_view token = next_token(row);
    std::int64_t index = 0;
    if (!parse_int(token, index))
      throw Fault{row.data(), "expected a vertex index, not " + in_quotes(token)};
    if (index < 0 || static_cast<std::uint64_t>(index) >= mesh_.vertices.size())
      throw Fault{row.data(), "vertex index " + std::to_string(index) + " is out of range: " +
                                  std::to_string(mesh_.vertices.size()) + " vertices"};
    if (!is_finite(mesh_.vertices[index]))
      throw Fault{row.data(),
                  "vertex " + std::to_string(index) + " is not finite and this face uses it"};
    return static_cast<std::uint32_t>(index);
  }

  /// Releases the pages that have been read, one chunk at a time.
  void release() {
    const auto here = static_cast<std::size_t>(rest_.data() - source_.bytes.data());
    if (here < released_) released_ = here;  // The faces are read twice.
    if (here - released_ < kChunkBytes) return;
    source_.done_with(source_.bytes.substr(released_, here - released_), "read");
    released_ = here;
  }

  const MeshSource& source_;
  const char line_end_;
  MemoryReservation memory_;
  std::string_view rest_;
  std::size_t released_ = 0;
  Mesh mesh_;
};

}  // namespace

bool is_off(std::string_view bytes) {
  bytes = without_byte_order_mark(bytes);
  for (const std::string_view prefix : {"ST", "C", "N", "4", "n"})
    if (bytes.starts_with(prefix)) bytes.remove_prefix(prefix.size());
  return bytes.starts_with("OFF") && (bytes.size() == 3 || bytes[3] == '\n' || is_blank(bytes[3]));
}

Mesh read_off(const MeshSource& source) {
  if (source.bytes.empty()) throw source.error("the file is empty");
  return OffReader(source).read();
}

}  // namespace voxdag

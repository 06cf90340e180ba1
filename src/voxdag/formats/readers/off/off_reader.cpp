#include "voxdag/formats/readers/off/off_reader.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "voxdag/formats/readers/chunks.hpp"
#include "voxdag/formats/readers/face_writer.hpp"
#include "voxdag/formats/readers/plain_colors.hpp"

namespace voxdag {
namespace {

/// How the rows of a file are divided.
enum class Rows {
  kLines,          ///< One row per line; the rest of a line is no part of the mesh.
  kList,           ///< Rows follow each other without anything between them.
  kListWithEdges,  ///< The same, and the number of edges follows that of faces.
};

class OffReader {
 public:
  OffReader(const MeshSource& source, ReadParts parts, Rows rows)
      : source_(source),
        has_appearance_(parts == ReadParts::kMeshAndAppearance),
        rows_(rows),
        memory_(source.work().memory, 0),
        rest_(without_byte_order_mark(source.bytes)),
        vertex_colors_(source.work().memory),
        face_colors_(source.work().memory),
        mesh_(empty_mesh(source.options.arrays)) {}

  /// Throws Fault.
  MeshWithAppearance read() {
    read_header();
    const std::size_t vertices = count("vertices", kMinVertexBytes);
    const std::size_t faces = count("faces", kMinFaceBytes);
    if (rows_ == Rows::kListWithEdges) next_number();
    read_vertices(vertices);
    const std::size_t triangles = count_triangles(faces);
    memory_.resize(memory_.bytes() + source_.options.counted(triangles * sizeof(Triangle)));
    mesh_.triangles.resize(triangles);
    if (mesh_.triangles.empty() && rows_ != Rows::kLines) throw Fault{row_.data(), "no faces"};
    if (mesh_.triangles.empty())
      throw source_.error("no face has three corners or more: there is no surface to read");
    read_faces(faces);
    if (rows_ != Rows::kLines && has_more())
      throw Fault{row_.data(), "the file goes on after its last face"};
    MeshWithAppearance result{std::move(mesh_), {}, {}};
    if (!has_magic_)
      result.warnings.push_back(source_.name + ": the first word, 'OFF', is missing");
    if (has_appearance_) add_colors(result);
    return result;
  }

 private:
  static constexpr std::size_t kMinVertexBytes = 6, kMinFaceBytes = 2;
  static constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  static constexpr Vec3f kNoColor{kNone, kNone, kNone};

  /// Goes to the next row.
  void start_row() {
    if (rows_ == Rows::kLines) row_ = next_line_of_row();
  }
  /// Removes the next number from the row; empty if the row has no more.
  std::string_view next_number() {
    if (rows_ != Rows::kLines && trim(row_).empty()) row_ = next_line_of_row();
    return next_token(row_);
  }

  /// Sets row_ to the next line that is not blank, without its comment. Returns false at the end.
  bool find_line() {
    while (!rest_.empty()) {
      row_ = next_line(rest_, line_end_);
      const char* const last = row_.data() + row_.size();
      std::size_t end = row_.find('#');
      while (end != row_.npos && find_windows_nan_end(row_.data(), row_.data() + end, last))
        end = row_.find('#', end + 1);
      row_ = trim(row_.substr(0, end));
      if (!row_.empty()) return true;
    }
    return false;
  }
  std::string_view next_line_of_row() {
    if (find_line()) return row_;
    throw Fault{source_.bytes.data() + source_.bytes.size(), "the file ends before its last face"};
  }
  bool has_more() { return !trim(row_).empty() || find_line(); }

  /// Skips the magic word. The counts may be in the same line, even in the same word. Without the
  /// word, the first line must be the counts.
  void read_header() {
    row_ = next_line_of_row();
    has_magic_ = !are_counts(row_);
    if (!has_magic_) return;
    const bool is_lower = row_ == "off";
    const std::string_view magic = row_.substr(0, row_.find(is_lower ? "off" : "OFF"));
    if (!is_lower && !is_off(row_))
      throw Fault{row_.data(), "not an OFF file: it does not start with 'OFF'"};
    row_.remove_prefix(magic.size() + 3);
    if (magic.find('4') != magic.npos || magic.find('n') != magic.npos)
      throw Fault{magic.data(),
                  "4OFF and nOFF are not supported: vertices must have three coordinates"};
    if (trim(row_).starts_with("BINARY"))
      throw Fault{magic.data(), "binary OFF is not supported: save it as text"};
    const auto has = [magic](char c) { return magic.find(c) != magic.npos; };
    has_colors_ = has('C');
    numbers_before_color_ = has('N') ? 3 : 0;
    numbers_of_vertex_ = 3 + numbers_before_color_ + (has_colors_ ? 4 : 0) + (has('S') ? 2 : 0);
    if (trim(row_).empty()) row_ = next_line_of_row();
  }

  static bool are_counts(std::string_view row) {
    std::int64_t number = 0;
    int numbers = 0;
    for (std::string_view token; !(token = next_token(row)).empty(); ++numbers)
      if (!parse_int(token, number) || number < 0) return false;
    return numbers == 2 || numbers == 3;
  }

  std::size_t count(const std::string& what, std::size_t least) {
    const std::string_view token = next_number();
    std::int64_t value = 0;
    if (!parse_int(token, value) || value < 0)
      throw Fault{row_.data(), "expected the number of " + what + ", not " + in_quotes(token)};
    if (static_cast<std::uint64_t>(value) > source_.bytes.size() / least ||
        value >= std::numeric_limits<std::uint32_t>::max())
      throw Fault{row_.data(), "the file is too short for " + std::to_string(value) + " " + what};
    return static_cast<std::size_t>(value);
  }

  void read_vertices(std::size_t vertices) {
    memory_.resize(source_.options.counted(vertices * sizeof(Vec3f)));
    mesh_.vertices.resize(vertices);
    if (has_appearance_ && has_colors_) vertex_colors_.resize(vertices, kNoColor);
    for (std::size_t v = 0; v < vertices; ++v) {
      start_row();
      for (int axis = 0; axis < 3; ++axis) {
        const std::string_view token = next_number();
        if (!parse_coordinate(token, source_.origin[axis], mesh_.vertices[v][axis]))
          throw Fault{row_.data(), "coordinate " + in_quotes(token) + " is not a number"};
      }
      const bool is_list = rows_ != Rows::kLines;
      if (!vertex_colors_.empty()) {
        for (std::size_t i = 0; i < numbers_before_color_; ++i) next_number();
        vertex_colors_[v] = take_color();
      }
      const std::size_t taken = 3 + (vertex_colors_.empty() ? 0 : numbers_before_color_ + 3);
      for (std::size_t i = taken; i < numbers_of_vertex_ && is_list; ++i) next_number();
      release();
    }
  }

  /// Removes three numbers from the row and returns them as a colour.
  Vec3f take_color() {
    Vec3f color;
    for (int channel = 0; channel < 3; ++channel)
      if (!parse_float(next_number(), color[channel]) || !std::isfinite(color[channel]))
        return kNoColor;
    for (int channel = 0; channel < 3; ++channel) greatest_ = std::max(greatest_, color[channel]);
    return color;
  }

  std::size_t count_triangles(std::size_t faces) {
    const std::string_view start = rest_, row = row_;
    std::size_t triangles = 0;
    for (std::size_t face = 0; face < faces; ++face) {
      start_row();
      const std::size_t corners = corner_count();
      if (corners > 2) triangles += corners - 2;
      for (std::size_t i = 0; i < corners && rows_ != Rows::kLines; ++i) next_number();
      release();
    }
    rest_ = start;
    row_ = row;
    return triangles;
  }

  std::size_t corner_count() {
    const std::string_view token = next_number();
    std::int64_t corners = 0;
    // A corner needs at least two characters, so a count that is too large for the line is refused
    // before it is used.
    const std::size_t room = row_.size() + (rows_ == Rows::kLines ? 0 : rest_.size() + 1);
    if (!parse_int(token, corners) || corners < 0 || static_cast<std::uint64_t>(corners) > room / 2)
      throw Fault{row_.data(),
                  "the number of vertex indices is missing, or the row is too short for it"};
    return static_cast<std::size_t>(corners);
  }

  void read_faces(std::size_t faces) {
    const AllVertices vertices{0, mesh_.vertices.size(),
                               [this](std::uint32_t vertex) { return mesh_.vertices[vertex]; }};
    FaceWriter writer(source_, vertices, mesh_.triangles);
    for (std::size_t face = 0; face < faces; ++face) {
      start_row();
      const std::size_t corners = corner_count();
      for (std::size_t corner = 0; corner < corners; ++corner) writer.add_corner(vertex_index());
      const char* const end = row_.data();
      const Vec3f color = has_appearance_ && rows_ == Rows::kLines ? take_color() : kNoColor;
      if (!std::isnan(color.x) && face_colors_.empty())
        face_colors_.resize(mesh_.triangles.size(), kNoColor);
      writer.finish_face(end, [&](std::size_t t, const Triangle&) {
        if (!face_colors_.empty()) face_colors_[t] = color;
      });
      release();
    }
  }

  std::uint32_t vertex_index() {
    const std::string_view token = next_number();
    std::int64_t index = 0;
    if (!parse_int(token, index))
      throw Fault{row_.data(), "expected a vertex index, not " + in_quotes(token)};
    if (index < 0 || static_cast<std::uint64_t>(index) >= mesh_.vertices.size())
      throw Fault{row_.data(), "vertex index " + std::to_string(index) + " is out of range: " +
                                   std::to_string(mesh_.vertices.size()) + " vertices"};
    return static_cast<std::uint32_t>(index);
  }

  void add_colors(MeshWithAppearance& read) {
    const StoredVector<Triangle>& triangles = read.mesh.triangles;
    const bool has_colors = !vertex_colors_.empty() || !face_colors_.empty();
    const MemoryReservation counted(source_.work().memory,
                                    has_colors ? 3 * triangles.size() * sizeof(Rgba16) : 0);
    if (has_colors) read.appearance.colors.resize(3 * triangles.size());
    const float scale = plain_color_scale(greatest_);
    for (std::size_t t = 0; t < triangles.size() && has_colors; ++t)
      for (std::size_t c = 0; c < 3; ++c) {
        Vec3f color = face_colors_.empty() ? kNoColor : face_colors_[t];
        if (std::isnan(color.x) && !vertex_colors_.empty()) color = vertex_colors_[triangles[t][c]];
        read.appearance.colors[3 * t + c] =
            std::isnan(color.x) ? to_rgba16(kDefaultColor, 1) : from_srgb(color * scale);
      }
    add_plain_materials(source_, read);
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
  const bool has_appearance_;
  const Rows rows_;
  const char line_end_ = line_end_of(source_.bytes);
  MemoryReservation memory_;
  std::string_view rest_, row_;  ///< After the line that is read; the rest of that line.
  std::size_t released_ = 0;
  bool has_magic_ = true, has_colors_ = false;
  std::size_t numbers_before_color_ = 0, numbers_of_vertex_ = 3;
  CountedVector<Vec3f> vertex_colors_, face_colors_;  ///< As in the file. Faces: per triangle.
  float greatest_ = 0;                                ///< Of the components of all colours.
  Mesh mesh_;
};

}  // namespace

bool is_off(std::string_view bytes) {
  bytes = without_byte_order_mark(bytes);
  for (int i = 0; i < 4; ++i)  // Prefixes, in any order.
    for (const std::string_view prefix : {"ST", "C", "N", "4", "n"})
      if (bytes.starts_with(prefix)) bytes.remove_prefix(prefix.size());
  return bytes.starts_with("OFF") && (bytes.size() == 3 || bytes[3] == '\n' || is_blank(bytes[3]) ||
                                      (bytes[3] >= '0' && bytes[3] <= '9'));
}

MeshWithAppearance read_off(const MeshSource& source, ReadParts parts) {
  if (source.bytes.empty()) throw source.error("the file is empty");
  std::optional<Fault> fault;
  for (const Rows rows : {Rows::kLines, Rows::kListWithEdges, Rows::kList}) try {
      MeshWithAppearance read = OffReader(source, parts, rows).read();
      if (rows != Rows::kLines)
        read.warnings.push_back(source.name +
                                ": rows are not one per line: the numbers are read as one list");
      return read;
    } catch (const Fault& found) {
      if (!fault) fault = found;
    }
  throw_fault(source, *fault, line_end_of(source.bytes));
}

}  // namespace voxdag

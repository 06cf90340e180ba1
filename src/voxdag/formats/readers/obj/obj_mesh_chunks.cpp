#include "voxdag/formats/readers/obj/obj_mesh_chunks.hpp"

#include <algorithm>
#include <utility>

#include "voxdag/formats/readers/bad_vertex.hpp"
#include "voxdag/formats/readers/face_cutter.hpp"
#include "voxdag/formats/readers/obj/obj_chunk.hpp"
#include "voxdag/formats/readers/obj/obj_values.hpp"

namespace voxdag {
namespace {

class ObjMeshChunks final : public MeshChunks {
 public:
  ObjMeshChunks(MappedFile file, const std::filesystem::path& path, const ReadOptions& options,
                std::size_t chunk_bytes)
      : MeshChunks(std::move(file), path, options),
        chunk_bytes_(chunk_bytes),
        line_end_(line_end_of(source().bytes)),
        text_(without_byte_order_mark(source().bytes)) {}

  std::uint64_t count() const override { return text_.size() / chunk_bytes_ + 1; }

  std::optional<ChunkCounts> counts(std::uint64_t chunk) const override {
    const std::string_view text = this->text(chunk);
    ChunkCounts counts;
    read(text, line_end_, [&] {
      const ObjChunk counted(source(), text, line_end_);
      counts = {counted.counts.vertices, counted.counts.triangles};
    });
    return counts;
  }

  void read_vertices(std::uint64_t chunk, std::span<Vec3f> vertices) const override {
    std::size_t i = 0;
    for_each_statement(chunk, ObjStatement::kVertex,
                       [&](std::string_view line, const char* position) {
                         if (i == vertices.size()) throw Fault{position, kFileChanged};
                         vertices[i++] = take_vertex(line, position);
                       });
    if (i != vertices.size()) throw source().error(kFileChanged);
  }

  void read_triangles(std::uint64_t chunk, const AllVertices& vertices,
                      std::span<Triangle> triangles) const override {
    const std::string_view text = this->text(chunk);
    FaceReader faces(source(), vertices, triangles);
    read(text, line_end_, [&] {
      std::uint64_t seen = vertices.before;
      for_each_line(text, line_end_, source().work().memory,
                    [&](std::string_view line, const char* position) {
                      const ObjStatement statement = take_keyword(line);
                      if (statement == ObjStatement::kVertex) ++seen;
                      if (statement == ObjStatement::kFace) faces.read(line, position, seen);
                    });
    });
    if (!faces.is_done()) throw source().error(kFileChanged);
  }

  [[noreturn]] void throw_bad_vertex(std::uint64_t chunk, std::uint64_t index) const override {
    const char* found = nullptr;
    std::uint64_t i = 0;
    for_each_statement(chunk, ObjStatement::kVertex, [&](std::string_view, const char* position) {
      if (i++ == index) found = position;
    });
    if (found == nullptr) throw source().error(kFileChanged);
    throw_fault(source(), {found, kBadVertex}, line_end_);
  }

 private:
  /// Reads the faces of one chunk.
  class FaceReader {
   public:
    FaceReader(const MeshSource& source, const AllVertices& vertices, std::span<Triangle> triangles)
        : vertices_(vertices),
          triangles_(triangles),
          cutter_(source),
          poll_(source.work()),
          corners_(source.work().memory),
          positions_(source.work().memory) {}

    void read(std::string_view line, const char* position, std::uint64_t seen) {
      corners_.clear();
      for (;;) {
        poll_.step();
        const std::string_view corner = next_corner(line);
        if (corner.empty()) break;
        corners_.push_back(parse_vertex_index(corner, seen, vertices_.count, position));
      }
      if (corners_.size() < 3) return;
      if (corners_.size() - 2 > triangles_.size() - done_) throw Fault{position, kFileChanged};
      const std::span<Triangle> fan = triangles_.subspan(done_, corners_.size() - 2);
      done_ += fan.size();
      // Indices into corners_, until the polygon is cut.
      for (std::uint32_t t = 0; t < fan.size(); ++t) fan[t] = {0, t + 1, t + 2};
      if (fan.size() > 1) {
        positions_.clear();
        for (const std::uint32_t corner : corners_)
          positions_.push_back(vertices_.position(corner));
        cutter_.cut(fan, positions_);
      }
      for (Triangle& triangle : fan)
        for (std::uint32_t& corner : triangle) corner = corners_[corner];
    }

    /// Returns whether all triangles are set.
    bool is_done() const { return done_ == triangles_.size(); }

   private:
    const AllVertices& vertices_;
    std::span<Triangle> triangles_;
    std::size_t done_ = 0;
    FaceCutter cutter_;
    CancelPoll poll_;
    CountedVector<std::uint32_t> corners_;
    CountedVector<Vec3f> positions_;
  };

  /// Returns the lines of a chunk: those that begin after byte chunk * chunk_bytes_, and not after
  /// byte (chunk + 1) * chunk_bytes_. Chunk 0 also has the first line.
  std::string_view text(std::uint64_t chunk) const {
    const std::size_t at = chunk * chunk_bytes_, next = std::min(at + chunk_bytes_, text_.size());
    std::size_t begin = 0;
    if (chunk > 0) {
      // Looks no further than this chunk: a line may be as long as the file.
      const std::string_view known = text_.substr(0, std::min(next + 1, text_.size()));
      begin = end_of_line(known, at, line_end_);
      if (begin > next || begin == text_.size()) return {};
    }
    return text_.substr(begin, end_of_line(text_, next, line_end_) - begin);
  }

  template <class Body>
  void for_each_statement(std::uint64_t chunk, ObjStatement wanted, const Body& body) const {
    const std::string_view text = this->text(chunk);
    read(text, line_end_, [&] {
      for_each_line(text, line_end_, source().work().memory,
                    [&](std::string_view line, const char* position) {
                      if (take_keyword(line) == wanted) body(line, position);
                    });
    });
  }

  std::size_t chunk_bytes_;
  char line_end_;
  std::string_view text_;
};

}  // namespace

std::unique_ptr<MeshChunks> open_obj_chunks(MappedFile file, const std::filesystem::path& path,
                                            const ReadOptions& options, std::size_t chunk_bytes) {
  return std::make_unique<ObjMeshChunks>(std::move(file), path, options, chunk_bytes);
}

}  // namespace voxdag

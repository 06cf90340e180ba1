/// Two passes over the chunks that the reader of the mesh used: values into arrays of their own,
/// then the references of faces, which select from them what each corner has.
#include "voxdag/readers/obj/obj_appearance.hpp"

#include <array>
#include <atomic>
#include <set>
#include <span>

#include "voxdag/image/color.hpp"
#include "voxdag/readers/chunks.hpp"
#include "voxdag/readers/obj/mtl_reader.hpp"
#include "voxdag/readers/obj/obj_lines.hpp"

namespace voxdag {
namespace {

constexpr std::int64_t kNone = -1;

enum class Statement { kVertex, kUv, kNormal, kFace, kLibrary, kOther };

Statement take_keyword(std::string_view& line) {
  const std::string_view keyword = next_token(line);
  return keyword == "v"        ? Statement::kVertex
         : keyword == "vt"     ? Statement::kUv
         : keyword == "vn"     ? Statement::kNormal
         : keyword == "f"      ? Statement::kFace
         : keyword == "mtllib" ? Statement::kLibrary
                               : Statement::kOther;
}

/// Numbers at the start of a line, as far as they are finite.
std::size_t parse_numbers(std::string_view line, std::span<float> numbers) {
  std::size_t count = 0;
  while (count < numbers.size() && parse_float(next_token(line), numbers[count]) &&
         std::isfinite(numbers[count]))
    ++count;
  return count;
}

struct Counts {
  std::size_t vertices = 0, uvs = 0, normals = 0, triangles = 0;
};

/// The place in its array that a reference names, or kNone. `seen` values precede it in the file,
/// `total` are in the file.
std::int64_t resolve(std::string_view reference, std::size_t seen, std::size_t total) {
  std::int64_t index = 0;
  if (!parse_int(reference, index)) return kNone;
  if (index < 0) index += static_cast<std::int64_t>(seen) + 1;
  return index >= 1 && static_cast<std::uint64_t>(index) <= total ? index - 1 : kNone;
}

struct Corner {
  std::int64_t vertex = kNone, uv = kNone, normal = kNone;
};

class ObjAppearanceReader {
 public:
  ObjAppearanceReader(const MeshBytes& source, const Mesh& mesh, std::vector<std::string>& warnings)
      : source_(source),
        mesh_(mesh),
        warnings_(warnings),
        line_end_(line_end_of(source.bytes)),
        texts_(split_lines(without_byte_order_mark(source.bytes), line_end_)),
        starts_(texts_.size() + 1),
        libraries_(texts_.size()),
        colored_(texts_.size(), 0) {}

  Appearance read() {
    for_each_chunk(source_, texts_, line_end_, "scan attributes",
                   [this](std::size_t i) { count(i); });
    for (std::size_t i = 0; i < texts_.size(); ++i) {
      starts_[i + 1].vertices += starts_[i].vertices;
      starts_[i + 1].uvs += starts_[i].uvs;
      starts_[i + 1].normals += starts_[i].normals;
      starts_[i + 1].triangles += starts_[i].triangles;
    }
    uvs_.resize(starts_.back().uvs);
    normals_.resize(starts_.back().normals);
    if (std::find(colored_.begin(), colored_.end(), 1) != colored_.end())
      colors_.resize(starts_.back().vertices);
    const std::size_t corners = 3 * mesh_.triangles.size();
    if (!uvs_.empty()) appearance_.uvs.resize(corners);
    if (!normals_.empty()) appearance_.normals.resize(corners);
    if (!colors_.empty()) appearance_.colors.resize(corners);
    for_each_chunk(source_, texts_, line_end_, "read attributes",
                   [this](std::size_t i) { parse(i); });
    if (!uvs_.empty() || !normals_.empty() || !colors_.empty())
      for_each_chunk(source_, texts_, line_end_, "read attributes",
                     [this](std::size_t i) { give(i); });
    warn_of_references();
    read_materials();
    return std::move(appearance_);
  }

 private:
  void count(std::size_t i) {
    Counts& counts = starts_[i + 1];
    for_each_line(texts_[i], line_end_, [&](std::string_view line, const char*) {
      switch (take_keyword(line)) {
        case Statement::kVertex:
          ++counts.vertices;
          colored_[i] |= static_cast<char>(has_color(line));
          break;
        case Statement::kUv:
          ++counts.uvs;
          break;
        case Statement::kNormal:
          ++counts.normals;
          break;
        case Statement::kFace:
          counts.triangles += count_fan_triangles(line);
          break;
        case Statement::kLibrary:
          libraries_[i].emplace_back(trim(line));
          break;
        case Statement::kOther:
          break;
      }
    });
  }

  /// Whether six numbers follow.
  static bool has_color(std::string_view line) {
    for (int n = 0; n < 6; ++n)
      if (next_token(line).empty()) return false;
    return true;
  }

  void parse(std::size_t i) {
    std::size_t vertex = starts_[i].vertices, uv = starts_[i].uvs, normal = starts_[i].normals;
    for_each_line(texts_[i], line_end_, [&](std::string_view line, const char*) {
      std::array<float, 6> numbers{};
      switch (take_keyword(line)) {
        case Statement::kVertex:
          if (colors_.empty()) break;
          if (parse_numbers(line, numbers) == 6)
            colors_[vertex] = to_rgba16({srgb_to_linear(numbers[3]), srgb_to_linear(numbers[4]),
                                         srgb_to_linear(numbers[5])},
                                        1);
          ++vertex;
          break;
        case Statement::kUv:
          if (parse_numbers(line, numbers) >= 1) uvs_[uv] = {numbers[0], 1 - numbers[1]};
          ++uv;
          break;
        case Statement::kNormal:
          if (parse_numbers(line, numbers) >= 3)
            normals_[normal] = normalized_or(Vec3f{numbers[0], numbers[1], numbers[2]}, {});
          ++normal;
          break;
        default:
          break;
      }
    });
  }

  /// Gives the corners of the chunk's triangles what their faces refer to.
  void give(std::size_t i) {
    Counts seen = starts_[i];
    std::vector<Corner> corners;
    for_each_line(texts_[i], line_end_, [&](std::string_view line, const char*) {
      switch (take_keyword(line)) {
        case Statement::kVertex:
          ++seen.vertices;
          break;
        case Statement::kUv:
          ++seen.uvs;
          break;
        case Statement::kNormal:
          ++seen.normals;
          break;
        case Statement::kFace:
          parse_corners(line, seen, corners);
          for (std::size_t n = 0; n + 2 < corners.size(); ++n) give(seen.triangles++, n, corners);
          break;
        default:
          break;
      }
    });
  }

  void parse_corners(std::string_view line, const Counts& seen, std::vector<Corner>& corners) {
    const Counts& total = starts_.back();
    corners.clear();
    for (std::string_view text; !(text = next_corner(line)).empty();) {
      const auto part = [&] {
        const std::size_t slash = text.find('/');
        const std::string_view reference = text.substr(0, slash);
        text.remove_prefix(slash == text.npos ? text.size() : slash + 1);
        return reference;
      };
      Corner corner;
      corner.vertex = resolve(part(), seen.vertices, total.vertices);
      const std::string_view uv = part(), normal = part();
      corner.uv = resolve(uv, seen.uvs, total.uvs);
      corner.normal = resolve(normal, seen.normals, total.normals);
      if ((corner.uv == kNone && !uv.empty()) || (corner.normal == kNone && !normal.empty()))
        bad_references_.fetch_add(1, std::memory_order_relaxed);
      corners.push_back(corner);
    }
  }

  /// Triangle `t` is number `n` of a face: of its fan, or of what it was cut into.
  void give(std::size_t t, std::size_t n, const std::vector<Corner>& face) {
    const std::size_t fan[3] = {0, n + 1, n + 2};
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t vertex = mesh_.triangles[t][c];
      const Corner* corner = &face[fan[c]];
      if (corner->vertex != vertex)
        for (const Corner& other : face)
          if (other.vertex == vertex) {
            corner = &other;
            break;
          }
      if (corner->uv != kNone)
        appearance_.uvs[3 * t + c] = uvs_[static_cast<std::size_t>(corner->uv)];
      if (corner->normal != kNone)
        appearance_.normals[3 * t + c] = normals_[static_cast<std::size_t>(corner->normal)];
      if (!colors_.empty()) appearance_.colors[3 * t + c] = colors_[vertex];
    }
  }

  void warn_of_references() {
    if (bad_references_ > 0)
      warnings_.push_back(source_.name + ": " + std::to_string(bad_references_) +
                          " corners of faces refer to texture coordinates or normals that do not "
                          "exist: they have none");
  }

  void read_materials() {
    appearance_.materials.resize(std::max<std::size_t>(mesh_.materials.size(), 1));
    for (std::size_t i = 0; i < mesh_.materials.size(); ++i)
      appearance_.materials[i].name = mesh_.materials[i];
    // Without a description the usual grey; coloured vertices have their colour undimmed.
    for (Material& material : appearance_.materials)
      if (colors_.empty()) material.base_color = kDefaultColor;
    std::set<std::string> described, opened;
    bool has_library = false;
    for (const auto& chunk : libraries_)
      for (const std::string& names : chunk)
        if (has_library = true; opened.insert(names).second) read_libraries(names, described);
    if (!colors_.empty())
      for (Material& material : appearance_.materials) material.base_color = {1, 1, 1};
    if (!has_library) return;
    for (const Material& material : appearance_.materials)
      if (!material.name.empty() && !described.contains(material.name))
        warnings_.push_back(source_.name + ": no MTL file describes material '" + material.name +
                            "': it is grey");
  }

  /// One file whose name may have blanks, or several.
  void read_libraries(const std::string& names, std::set<std::string>& described) {
    std::error_code ignored;
    if (std::filesystem::exists(path_of(names), ignored)) return read_library(names, described);
    std::string_view rest = names;
    for (std::string_view name; !(name = next_token(rest)).empty();)
      read_library(std::string(name), described);
  }

  std::filesystem::path path_of(std::string name) const {
    std::replace(name.begin(), name.end(), '\\', '/');
    return source_.folder / name;
  }

  void read_library(const std::string& name, std::set<std::string>& described) {
    const std::filesystem::path path = path_of(name);
    try {
      const MappedFile file(path, MappedFile::Access::kSequential);
      for (std::string& material : read_mtl(file.text(), path, appearance_, warnings_))
        described.insert(std::move(material));
    } catch (const Error& error) {
      warnings_.push_back(std::string(error.what()) + ": its materials are grey");
    }
  }

  const MeshBytes& source_;
  const Mesh& mesh_;
  std::vector<std::string>& warnings_;
  const char line_end_;
  const std::vector<std::string_view> texts_;
  std::vector<Counts> starts_;  ///< Of each chunk and, last, the totals.
  std::vector<std::vector<std::string>> libraries_;
  std::vector<char> colored_;
  std::vector<Vec2f> uvs_;
  std::vector<Vec3f> normals_;
  std::vector<Rgba16> colors_;  ///< Per vertex.
  std::atomic<std::size_t> bad_references_{0};
  Appearance appearance_;
};

}  // namespace

Appearance read_obj_appearance(const MeshBytes& source, const Mesh& mesh,
                               std::vector<std::string>& warnings) {
  return ObjAppearanceReader(source, mesh, warnings).read();
}

}  // namespace voxdag

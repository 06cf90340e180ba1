#include "voxdag/formats/exports/grids/vox_writer.hpp"

#include <utility>

namespace voxdag {
namespace {

constexpr std::int32_t kVersion = 200;
constexpr std::size_t kMainContent = 20;  ///< Where the children of MAIN begin.

/// Appends little-endian numbers, strings and dictionaries.
void put(std::string& out, std::int32_t value) {
  for (int shift = 0; shift < 32; shift += 8)
    out.push_back(static_cast<char>(static_cast<std::uint32_t>(value) >> shift & 0xFF));
}
void put(std::string& out, const std::string& text) {
  put(out, static_cast<std::int32_t>(text.size()));
  out += text;
}
void put_dictionary(std::string& out,
                    const std::vector<std::pair<std::string, std::string>>& pairs) {
  put(out, static_cast<std::int32_t>(pairs.size()));
  for (const auto& [key, value] : pairs) {
    put(out, key);
    put(out, value);
  }
}

std::string transform(std::int32_t node, std::int32_t child, const std::string& translation) {
  std::string out;
  put(out, node);
  put_dictionary(out, {});
  put(out, child);
  put(out, -1);  // reserved
  put(out, -1);  // layer: none
  put(out, 1);   // frames
  if (translation.empty())
    put_dictionary(out, {});
  else
    put_dictionary(out, {{"_t", translation}});
  return out;
}

}  // namespace

VoxWriter::VoxWriter(const std::filesystem::path& path) : file_(path) {
  std::string head = "VOX ";
  put(head, kVersion);
  head += "MAIN";
  put(head, 0);
  put(head, 0);  // bytes of children: commit() writes them
  file_.write(head);
}

void VoxWriter::add_model(Vec3i position, Vec3i size, std::span<const VoxVoxel> voxels) {
  std::string content;
  put(content, size.x);
  put(content, size.y);
  put(content, size.z);
  write_chunk("SIZE", content);
  std::string head = "XYZI";
  const auto count = static_cast<std::int32_t>(voxels.size());
  put(head, 4 + 4 * count);
  put(head, 0);
  put(head, count);
  file_.write(head);
  file_.write(voxels);
  instances_.push_back({position, size});
}

void VoxWriter::write_chunk(const char (&name)[5], const std::string& content) {
  std::string head = name;
  put(head, static_cast<std::int32_t>(content.size()));
  put(head, 0);
  file_.write(head);
  file_.write(content);
}

void VoxWriter::write_scene() {
  // Node 0 places the group, node 1; nodes 2i + 2 and 2i + 3 are the place and the shape of model
  // i.
  const auto count = static_cast<std::int32_t>(instances_.size());
  write_chunk("nTRN", transform(0, 1, ""));
  std::string group;
  put(group, 1);
  put_dictionary(group, {});
  put(group, count);
  for (std::int32_t i = 0; i < count; ++i) put(group, 2 * i + 2);
  write_chunk("nGRP", group);
  for (std::int32_t i = 0; i < count; ++i) {
    const auto& [position, size] = instances_[i];
    std::string translation;  // of the middle voxel of the model
    for (int axis = 0; axis < 3; ++axis) {
      if (axis > 0) translation += ' ';
      translation += std::to_string(position[axis] + size[axis] / 2);
    }
    write_chunk("nTRN", transform(2 * i + 2, 2 * i + 3, translation));
    std::string shape;
    put(shape, 2 * i + 3);
    put_dictionary(shape, {});
    put(shape, 1);
    put(shape, i);
    put_dictionary(shape, {});
    write_chunk("nSHP", shape);
  }
}

void VoxWriter::commit(std::span<const Value8> palette) {
  write_scene();
  std::string colors;
  for (std::size_t i = 0; i < 256; ++i) {
    const Value8 color = i < palette.size() ? palette[i] : Value8{};
    for (const std::uint8_t channel : {color.x, color.y, color.z, std::uint8_t{255}})
      colors.push_back(static_cast<char>(channel));
  }
  write_chunk("RGBA", colors);
  std::string children;
  put(children, static_cast<std::int32_t>(file_.position() - kMainContent));
  file_.overwrite(kMainContent - 4, children.data(), children.size());
  file_.commit();
}

}  // namespace voxdag

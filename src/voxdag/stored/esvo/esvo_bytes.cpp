#include "voxdag/stored/esvo/esvo_bytes.hpp"

#include <cstring>

namespace voxdag {
namespace {

EsvoBytes bytes_of(const EsvoBlockInfo& info) {
  EsvoBytes bytes;
  bytes.descriptors = std::uint64_t{info.descriptors} * 8;
  bytes.far_pointers = std::uint64_t{info.far_pointers} * 8;
  bytes.gaps = (std::uint64_t{info.descriptor_slots} - info.descriptors - info.far_pointers) * 8;
  bytes.info = sizeof info;
  bytes.contours = std::uint64_t{info.contour_count} * 4;
  for (std::uint32_t i = 0; i < info.attachment_count; ++i) {
    const EsvoAttachment& attachment = info.attachments[i];
    const std::uint64_t size = std::uint64_t{attachment.count} * attachment.slots_per_pair * 8;
    (attachment.kind == EsvoAttachmentKind::kColors ? bytes.colors : bytes.normals) += size;
  }
  bytes.padding = std::uint64_t{info.slots} * 8 - bytes.total();
  return bytes;
}

}  // namespace

EsvoBytes& EsvoBytes::operator+=(const EsvoBytes& other) {
  descriptors += other.descriptors;
  far_pointers += other.far_pointers;
  gaps += other.gaps;
  info += other.info;
  contours += other.contours;
  colors += other.colors;
  normals += other.normals;
  padding += other.padding;
  return *this;
}

EsvoBytes esvo_bytes(std::span<const std::uint64_t> blocks) {
  EsvoBytes bytes;
  for (std::size_t begin = 0; begin < blocks.size();) {
    // The first slot of a page holds the distance to the block's info.
    EsvoBlockInfo info;
    std::memcpy(&info, blocks.data() + begin + blocks[begin], sizeof info);
    bytes += bytes_of(info);
    begin += info.slots;
  }
  return bytes;
}

EsvoBytes esvo_bytes(const EsvoView& view, std::span<const EsvoBlockEntry> directory) {
  EsvoBytes bytes;
  for (const EsvoBlockEntry& block : directory) bytes += bytes_of(view.info(block.begin));
  return bytes;
}

}  // namespace voxdag

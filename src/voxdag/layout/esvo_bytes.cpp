#include "voxdag/layout/esvo_bytes.hpp"

namespace voxdag {

EsvoBytes esvo_bytes(const EsvoView& view, std::span<const EsvoBlockEntry> directory) {
  EsvoBytes bytes;
  for (const EsvoBlockEntry& block : directory) {
    const EsvoBlockInfo& info = view.info(block.begin);
    const std::uint64_t before = bytes.total();
    bytes.descriptors += std::uint64_t{info.descriptors} * 8;
    bytes.far_pointers += std::uint64_t{info.far_pointers} * 8;
    bytes.gaps += (std::uint64_t{info.descriptor_slots} - info.descriptors - info.far_pointers) * 8;
    bytes.info += sizeof info;
    bytes.contours += std::uint64_t{info.contour_count} * 4;
    for (std::uint32_t i = 0; i < info.attachment_count; ++i) {
      const EsvoAttachment& attachment = info.attachments[i];
      const std::uint64_t size = std::uint64_t{attachment.count} * attachment.slots_per_pair * 8;
      (attachment.kind == EsvoAttachmentKind::kColors ? bytes.colors : bytes.normals) += size;
    }
    bytes.padding += std::uint64_t{info.slots} * 8 - (bytes.total() - before);
  }
  return bytes;
}

}  // namespace voxdag

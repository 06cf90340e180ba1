#include "voxdag/layout/validate_esvo.hpp"

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

[[noreturn]] void fail(const std::string& place, const std::string& reason) {
  throw Error("", place, reason);
}

std::string slot_place(std::uint64_t slot) { return "slot " + std::to_string(slot); }

std::uint32_t slots_per_pair(EsvoAttachmentKind kind) {
  return kind == EsvoAttachmentKind::kColors ? 1 : kind == EsvoAttachmentKind::kNormals ? 2 : 0;
}

/// Walks from the root and remembers which slots it has seen.
class Walk {
 public:
  Walk(const EsvoView& view, std::span<const EsvoBlockEntry> directory)
      : view_(view), directory_(directory), seen_(view.slot_count) {}

  EsvoCounts run() {
    counts_.voxels_per_level[0] = 1;
    counts_.blocks = directory_.size();
    check_group(view_.root, 1);
    std::vector<Step> stack{{view_.root, {0, {}}}};
    if (block_of(view_.root).parent != EsvoBlockEntry::kNoParent)
      fail(slot_place(view_.root), "the root is in a block that has a parent");
    while (!stack.empty()) {
      const Step step = stack.back();
      stack.pop_back();
      visit(step, stack);
    }
    return counts_;
  }

 private:
  struct Where {
    int level;
    Vec3i cell;
  };
  struct Step {
    std::uint64_t slot;
    Where where;  // of the voxel of this descriptor
  };

  const EsvoBlockEntry& block_of(std::uint64_t slot) const {
    const auto after =
        std::upper_bound(directory_.begin(), directory_.end(), slot,
                         [](std::uint64_t s, const EsvoBlockEntry& b) { return s < b.begin; });
    return *std::prev(after);
  }
  const EsvoBlockInfo& info_of(const EsvoBlockEntry& block) const {
    return view_.info(block.begin);
  }

  /// Siblings may stand there, and have not been seen before.
  void check_group(std::uint64_t first, std::uint32_t count) {
    if (first >= view_.slot_count) fail(slot_place(first), "a pointer out of the octree");
    const EsvoBlockEntry& block = block_of(first);
    const std::uint64_t end = first + count;
    if (end - block.begin > info_of(block).descriptor_slots)
      fail(slot_place(first), "a pointer to something else than descriptors");
    if (first % kEsvoPageSlots == 0 || first / kEsvoPageSlots != (end - 1) / kEsvoPageSlots)
      fail(slot_place(first), "siblings lie across a page header");
    for (std::uint64_t slot = first; slot < end; ++slot) {
      if (seen_[slot]) fail(slot_place(slot), "reached twice");
      seen_[slot] = true;
    }
  }

  void visit(const Step& step, std::vector<Step>& stack) {
    const std::uint64_t slot = step.slot;
    const ChildDescriptor d = view_.descriptor(slot);
    const EsvoBlockEntry& block = block_of(slot);
    const int level = step.where.level + 1;
    ++counts_.descriptors;
    if (d.valid_mask() == 0) fail(slot_place(slot), "a descriptor without children");
    if ((d.leaf_mask() & ~d.valid_mask()) != 0) fail(slot_place(slot), "a leaf that is no child");
    if ((d.contour_mask() & ~d.valid_mask()) != 0) fail(slot_place(slot), "a contour of no child");
    counts_.voxels_per_level[static_cast<std::size_t>(level)] +=
        static_cast<std::uint64_t>(popcount8(d.valid_mask()));
    counts_.leaves_per_level[static_cast<std::size_t>(level)] +=
        static_cast<std::uint64_t>(popcount8(d.leaf_mask()));
    check_contours(slot, d, block);
    if (d.inner_mask() == 0) return;
    if (level == view_.levels) fail(slot_place(slot), "children below the finest level");

    const std::uint64_t pointer = slot + d.child_pointer();
    if (d.child_pointer() == 0 || pointer - block.begin >= info_of(block).descriptor_slots)
      fail(slot_place(slot), "a child pointer out of its block");
    if (d.is_far()) {
      if (pointer % kEsvoPageSlots == 0 || seen_[pointer])
        fail(slot_place(slot), "no far pointer where one should be");
      seen_[pointer] = true;
      ++counts_.far_pointers;
    }
    const std::uint64_t first = view_.first_child(slot, d);
    const auto count = static_cast<std::uint32_t>(popcount8(d.inner_mask()));
    check_group(first, count);
    const EsvoBlockEntry& below = block_of(first);
    if (below.begin != block.begin &&
        (below.parent != slot || below.level != step.where.level || below.cell != step.where.cell ||
         first - below.begin != info_of(below).first_descriptor))
      fail(slot_place(slot), "the directory tells otherwise of the block of its children");
    std::uint64_t at = first;
    for (int child = 0; child < 8; ++child)
      if ((d.inner_mask() >> child & 1) != 0)
        stack.push_back(
            {at++, {level, step.where.cell * 2 + Vec3i{child & 1, child >> 1 & 1, child >> 2}}});
  }

  void check_contours(std::uint64_t slot, ChildDescriptor d, const EsvoBlockEntry& block) {
    const auto count = static_cast<std::uint64_t>(popcount8(d.contour_mask()));
    if (count == 0) return;
    counts_.contours += count;
    const EsvoBlockInfo& info = info_of(block);
    const std::uint64_t begin = 2 * (block.begin + info.contour_begin);
    const std::uint64_t first = 2 * slot + d.contour_pointer();
    if (first < begin || first + count > begin + info.contour_count)
      fail(slot_place(slot), "a contour pointer to something else than contours");
    for (int child = 0; child < 8; ++child) {
      if ((d.contour_mask() >> child & 1) == 0) continue;
      const Contour contour = view_.contour(slot, d, child);
      if (contour.normal() == Vec3i{}) fail(slot_place(slot), "a contour without a normal");
      if (contour.low() > contour.high()) fail(slot_place(slot), "a contour inside out");
    }
  }

  const EsvoView& view_;
  std::span<const EsvoBlockEntry> directory_;
  std::vector<bool> seen_;
  EsvoCounts counts_;
};

}  // namespace

void check_esvo_block(std::span<const std::uint64_t> slots) {
  constexpr std::size_t kInfoSlots = sizeof(EsvoBlockInfo) / 8;
  if (slots.size() < kEsvoPageSlots || slots.size() % kEsvoPageSlots != 0 ||
      slots.size() > 0xFFFFFFFFu)
    fail("", "not a number of pages");
  const std::uint64_t at = slots[0];
  if (at == 0 || at % kEsvoPageSlots != 0 || at + kInfoSlots > slots.size())
    fail("", "its page header points to no info section");
  EsvoBlockInfo info;
  std::memcpy(&info, slots.data() + at, sizeof info);
  if (info.slots != slots.size() || info.descriptor_slots != at)
    fail("", "its info section has other sizes");
  for (std::uint64_t page = 0; page < at; page += kEsvoPageSlots)
    if (slots[page] != at - page) fail("", "a page header is wrong");
  const auto fits = [&](std::uint64_t begin, std::uint64_t count) {
    return begin >= at + kInfoSlots && begin + count <= slots.size();
  };
  if (!fits(info.contour_begin, (std::uint64_t{info.contour_count} + 1) / 2))
    fail("", "its contours are not in it");
  if (info.attachment_count > EsvoBlockInfo::kMaxAttachments) fail("", "too many attachments");
  for (std::uint32_t i = 0; i < info.attachment_count; ++i) {
    const EsvoAttachment& attachment = info.attachments[i];
    const std::uint32_t expected = slots_per_pair(attachment.kind);
    if (expected == 0 || attachment.slots_per_pair != expected ||
        attachment.count != info.descriptor_slots / 2 ||
        !fits(attachment.begin, std::uint64_t{attachment.count} * expected))
      fail("", "attachment " + std::to_string(i) + " is not what it should be");
  }
}

EsvoCounts validate_esvo(const EsvoView& view, std::span<const EsvoBlockEntry> directory) {
  std::uint64_t end = 0;
  for (std::size_t i = 0; i < directory.size(); ++i) {
    const EsvoBlockEntry& block = directory[i];
    const std::string place = "block " + std::to_string(i);
    if (block.begin != end || block.slots > view.slot_count - end)
      fail(place, "not where the directory says");
    if (block.reserved != 0) fail(place, "reserved bytes are not zero");
    end += block.slots;
    try {
      check_esvo_block({view.slots + block.begin, block.slots});
    } catch (const Error& error) {
      fail(place, error.reason());
    }
  }
  if (end != view.slot_count) fail("directory", "slots that belong to no block");
  if (view.is_empty()) return {};
  if (view.root >= view.slot_count) fail("root", "out of the octree");
  return Walk(view, directory).run();
}

}  // namespace voxdag

#include "voxdag/stored/esvo/validate_esvo.hpp"

#include <algorithm>
#include <cstring>
#include <string>

#include "voxdag/core/error.hpp"
#include "voxdag/core/morton.hpp"

namespace voxdag {
namespace {

std::uint32_t slots_per_pair(EsvoAttachmentKind kind) {
  return kind == EsvoAttachmentKind::kColors ? 1 : kind == EsvoAttachmentKind::kNormals ? 2 : 0;
}

/// Returns the info section, after checking it against the page headers and the block's size.
EsvoBlockInfo check_info(std::span<const std::uint64_t> slots) {
  constexpr std::size_t kInfoSlots = sizeof(EsvoBlockInfo) / 8;
  if (slots.size() < kEsvoPageSlots || slots.size() % kEsvoPageSlots != 0 ||
      slots.size() > 0xFFFFFFFFu)
    fail_at("", "its size is not a whole number of pages");
  const std::uint64_t at = slots[0];
  if (at < 2 || at % 2 != 0 || at + kInfoSlots > slots.size())
    fail_at("", "its page header does not point to an info section");
  EsvoBlockInfo info;
  std::memcpy(&info, slots.data() + at, sizeof info);
  if (info.slots != slots.size() || info.descriptor_slots != at)
    fail_at("", "its info section states another size");
  for (std::uint64_t page = 0; page < at; page += kEsvoPageSlots)
    if (slots[page] != at - page) fail_at("", "a page header does not point to the info section");
  const auto fits = [&](std::uint64_t begin, std::uint64_t count) {
    return begin >= at + kInfoSlots && begin + count <= slots.size();
  };
  if (!fits(info.contour_begin, (std::uint64_t{info.contour_count} + 1) / 2))
    fail_at("", "its contours extend past its end");
  if (info.attachment_count > EsvoBlockInfo::kMaxAttachments)
    fail_at("",
            "it has more than " + std::to_string(EsvoBlockInfo::kMaxAttachments) + " attachments");
  for (std::uint32_t i = 0; i < info.attachment_count; ++i) {
    const EsvoAttachment& attachment = info.attachments[i];
    const std::uint32_t expected = slots_per_pair(attachment.kind);
    if (expected == 0 || attachment.slots_per_pair != expected ||
        attachment.count != info.descriptor_slots / 2 ||
        !fits(attachment.begin, std::uint64_t{attachment.count} * expected))
      fail_at("", "attachment " + std::to_string(i) + " is malformed");
  }
  return info;
}

/// Walks a block from its first group and marks the slots that it has visited.
class BlockWalk {
 public:
  BlockWalk(std::span<const std::uint64_t> slots, const EsvoBlockInfo& info, int levels)
      : view_{slots.data(), slots.size(), 0, levels}, info_(info), seen_(info.descriptor_slots) {}

  EsvoBlockCheck run(const EsvoBlockEntry& entry, std::span<const Vec3i> siblings) {
    const std::uint64_t first = info_.first_descriptor;
    check_group(first, siblings.size());
    const int level = entry.parent == EsvoBlockEntry::kNoParent ? 0 : entry.level + 1;
    for (std::size_t i = 0; i < siblings.size(); ++i)
      stack_.push_back({first + i, level, siblings[i]});
    while (!stack_.empty()) {
      const Step step = stack_.back();
      stack_.pop_back();
      visit(step);
    }
    return std::move(check_);
  }

 private:
  struct Step {
    std::uint64_t slot;
    int level;  // level of this descriptor's voxel
    Vec3i cell;
  };

  /// Checks that a group of siblings may be stored at `first`, and that its slots were not visited
  /// before.
  void check_group(std::uint64_t first, std::uint64_t count) {
    const std::uint64_t end = first + count;
    if (end > info_.descriptor_slots)
      fail_at(ErrorPlace::slot(first), "the siblings extend past the descriptors");
    if (first % kEsvoPageSlots == 0 || first / kEsvoPageSlots != (end - 1) / kEsvoPageSlots)
      fail_at(ErrorPlace::slot(first), "the siblings cross a page header");
    for (std::uint64_t slot = first; slot < end; ++slot) {
      if (seen_[slot]) fail_at(ErrorPlace::slot(slot), "two pointers point to this descriptor");
      seen_[slot] = true;
    }
  }

  void visit(const Step& step) {
    const std::uint64_t slot = step.slot;
    const ChildDescriptor d = view_.descriptor(slot);
    const int level = step.level + 1;
    if (d.valid_mask() == 0) fail_at(ErrorPlace::slot(slot), "the descriptor has no children");
    if ((d.leaf_mask() & ~d.valid_mask()) != 0)
      fail_at(ErrorPlace::slot(slot), "the leaf mask marks an absent child");
    if ((d.contour_mask() & ~d.valid_mask()) != 0)
      fail_at(ErrorPlace::slot(slot), "the contour mask marks an absent child");
    EsvoCounts& counts = check_.counts;
    ++counts.descriptors;
    counts.voxels_per_level[static_cast<std::size_t>(level)] +=
        static_cast<std::uint64_t>(popcount8(d.valid_mask()));
    counts.leaves_per_level[static_cast<std::size_t>(level)] +=
        static_cast<std::uint64_t>(popcount8(d.leaf_mask()));
    check_contours(slot, d);
    if (d.inner_mask() == 0) return;
    if (level == view_.levels)
      fail_at(ErrorPlace::slot(slot), "a voxel of the finest level has children");

    const std::uint64_t pointer = slot + d.child_pointer();
    if (d.child_pointer() == 0 || pointer >= info_.descriptor_slots)
      fail_at(ErrorPlace::slot(slot), "the child pointer points outside the block");
    Vec3i cells[8];
    std::size_t count = 0;
    for (int child = 0; child < 8; ++child)
      if ((d.inner_mask() >> child & 1) != 0) cells[count++] = step.cell * 2 + child_offset(child);
    if (d.is_far()) {
      if (pointer % kEsvoPageSlots == 0 || seen_[pointer])
        fail_at(ErrorPlace::slot(slot), "the far pointer is missing");
      seen_[pointer] = true;
      ++counts.far_pointers;
      check_.links.push_back({static_cast<std::uint32_t>(slot),
                              static_cast<std::int64_t>(view_.first_child(slot, d)),
                              step.level,
                              step.cell,
                              {cells, cells + count}});
      return;
    }
    check_group(pointer, count);
    for (std::size_t i = 0; i < count; ++i) stack_.push_back({pointer + i, level, cells[i]});
  }

  void check_contours(std::uint64_t slot, ChildDescriptor d) {
    const auto count = static_cast<std::uint64_t>(popcount8(d.contour_mask()));
    if (count == 0) return;
    check_.counts.contours += count;
    const std::uint64_t begin = 2 * std::uint64_t{info_.contour_begin};
    const std::uint64_t first = 2 * slot + d.contour_pointer();
    if (first < begin || first + count > begin + info_.contour_count)
      fail_at(ErrorPlace::slot(slot), "the contour pointer points outside the contours");
    for (int child = 0; child < 8; ++child) {
      if ((d.contour_mask() >> child & 1) == 0) continue;
      const Contour contour = view_.contour(slot, d, child);
      if (contour.normal() == Vec3i{})
        fail_at(ErrorPlace::slot(slot), "the normal of a contour is zero");
      if (contour.low() > contour.high())
        fail_at(ErrorPlace::slot(slot), "the low plane of a contour is above the high one");
    }
  }

  EsvoView view_;  // a view of this block alone
  const EsvoBlockInfo& info_;
  std::vector<bool> seen_;
  std::vector<Step> stack_;
  EsvoBlockCheck check_;
};

}  // namespace

EsvoBlockCheck check_esvo_block(std::span<const std::uint64_t> slots, const EsvoBlockEntry& entry,
                                std::span<const Vec3i> siblings, int levels) {
  const EsvoBlockInfo info = check_info(slots);
  EsvoBlockCheck check = BlockWalk(slots, info, levels).run(entry, siblings);
  if (check.counts.descriptors != info.descriptors ||
      check.counts.far_pointers != info.far_pointers || check.counts.contours < info.contour_count)
    fail_at("", "the counts in its info section differ from its contents");
  check.counts.blocks = 1;
  return check;
}

EsvoCounts validate_esvo(const EsvoView& view, std::span<const EsvoBlockEntry> directory) {
  std::uint64_t end = 0;
  for (std::size_t i = 0; i < directory.size(); ++i) {
    const EsvoBlockEntry& block = directory[i];
    if (block.begin != end || block.slots > view.slot_count - end || block.slots == 0)
      fail_at(ErrorPlace::block(i),
              "its place in the directory does not follow the previous block");
    if (block.reserved != 0) fail_at(ErrorPlace::block(i), "reserved bytes are not zero");
    end += block.slots;
  }
  if (end != view.slot_count) fail_at("directory", "some slots belong to no block");
  if (view.is_empty()) return {};
  if (view.root >= view.slot_count) fail_at("root", "is outside the octree");

  const auto block_at = [&](std::uint64_t slot) {
    const auto after =
        std::upper_bound(directory.begin(), directory.end(), slot,
                         [](std::uint64_t s, const EsvoBlockEntry& b) { return s < b.begin; });
    return static_cast<std::size_t>(after - directory.begin()) - 1;
  };
  struct Open {
    std::size_t block;
    std::vector<Vec3i> siblings;
  };
  const std::size_t root_block = block_at(view.root);
  if (directory[root_block].parent != EsvoBlockEntry::kNoParent)
    fail_at("root", "the root's block has a parent");
  std::vector<Open> stack{{root_block, {Vec3i{}}}};
  std::vector<bool> seen(directory.size());
  seen[root_block] = true;
  EsvoCounts counts;
  counts.voxels_per_level[0] = 1;
  while (!stack.empty()) {
    const Open open = std::move(stack.back());
    stack.pop_back();
    const EsvoBlockEntry& entry = directory[open.block];
    const ErrorPlace place = ErrorPlace::block(open.block);
    EsvoBlockCheck check;
    try {
      check = check_esvo_block({view.slots + entry.begin, entry.slots}, entry, open.siblings,
                               view.levels);
    } catch (const Error& error) {
      throw error.within(place);
    }
    if (open.block == root_block &&
        view.root - entry.begin != view.info(entry.begin).first_descriptor)
      fail_at("root", "is not the first descriptor of its block");
    counts += check.counts;
    for (EsvoFarLink& link : check.links) {
      const std::int64_t target = static_cast<std::int64_t>(entry.begin) + link.target;
      const ErrorPlace from = place / ErrorPlace::slot(link.slot);
      if (target < 0 || static_cast<std::uint64_t>(target) >= view.slot_count)
        fail_at(from, "the far pointer points outside the octree");
      const std::size_t below = block_at(static_cast<std::uint64_t>(target));
      const EsvoBlockEntry& child = directory[below];
      if (seen[below]) fail_at(from, "two far pointers point to the same block");
      seen[below] = true;
      if (child.parent != entry.begin + link.slot || child.level != link.level ||
          child.cell != link.cell)
        fail_at(from, "the directory disagrees with this slot about its child block");
      // The complete info section is checked when the walk visits the block.
      const std::span<const std::uint64_t> slots(view.slots + child.begin, child.slots);
      if (check_info(slots).first_descriptor != static_cast<std::uint64_t>(target) - child.begin)
        fail_at(from, "the far pointer does not point to the first descriptor of a block");
      stack.push_back({below, std::move(link.siblings)});
    }
  }
  if (counts.blocks != directory.size())
    fail_at("directory", "no far pointer points to one of the blocks");
  return counts;
}

}  // namespace voxdag

#pragma once
/// Makes octrees with contours and packs them in the simplest way: the reference for readers of
/// ESVOs. Shares only the types of stored words with the library.
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <vector>

#include "voxdag/stored/esvo/esvo.hpp"

namespace voxdag {

/// A voxel; a leaf if it has no children.
struct TestVoxel {
  std::optional<Contour> contour;
  std::array<std::unique_ptr<TestVoxel>, 8> children;

  bool is_leaf() const {
    for (const auto& child : children)
      if (child) return false;
    return true;
  }
};

/// Returns the leaf that is found by following first children.
inline TestVoxel& first_leaf(TestVoxel& voxel) {
  for (const auto& child : voxel.children)
    if (child) return first_leaf(*child);
  return voxel;
}

/// Packs an octree into one block. Descriptors are in depth-first order; siblings start at an even
/// slot. About one in `far_in` child pointers is far, and every pointer that must be.
class TestEsvoAssembler {
 public:
  TestEsvoAssembler(unsigned far_in, unsigned seed) : far_in_(far_in), rng_(seed) {}

  /// Returns the packed octree. `root` must not be a leaf.
  Esvo assemble(const TestVoxel& root, int levels) {
    Esvo esvo;
    esvo.levels = levels;
    const std::uint64_t at = place({&root});
    esvo.root = at;
    fill(root, at, place_far_pointer());
    pad(kEsvoPageSlots);
    const std::uint64_t descriptor_slots = slots_.size();
    for (std::uint64_t page = 0; page < descriptor_slots; page += kEsvoPageSlots)
      slots_[page] = descriptor_slots - page;
    for (std::size_t i = 0; i < 12; ++i) slots_.push_back(0);
    EsvoBlockInfo info{};
    info.descriptor_slots = static_cast<std::uint32_t>(descriptor_slots);
    info.first_descriptor = static_cast<std::uint32_t>(at);
    info.contour_begin = static_cast<std::uint32_t>(slots_.size());
    info.contour_count = static_cast<std::uint32_t>(contours_.size());
    for (const Reference& reference : references_) {
      ChildDescriptor descriptor = ChildDescriptor::from_slot(slots_[reference.slot]);
      const std::uint64_t word = 2 * slots_.size() + reference.contour;
      descriptor.set_contour_pointer(static_cast<std::uint32_t>(word - 2 * reference.slot));
      slots_[reference.slot] = descriptor.to_slot();
    }
    if (contours_.size() % 2 != 0) contours_.push_back({});
    for (std::size_t i = 0; i < contours_.size(); i += 2)
      slots_.push_back(contours_[i].bits | std::uint64_t{contours_[i + 1].bits} << 32);
    pad(kEsvoPageSlots);
    info.slots = static_cast<std::uint32_t>(slots_.size());
    *reinterpret_cast<EsvoBlockInfo*>(&slots_[descriptor_slots]) = info;
    esvo.slots = slots_;
    return esvo;
  }

 private:
  struct Reference {
    std::uint64_t slot, contour;
  };

  void pad(std::uint64_t to) {
    while (slots_.size() % to != 0) slots_.push_back(0);
  }

  /// Appends slots for the descriptors of siblings; returns the first slot.
  std::uint64_t place(const std::vector<const TestVoxel*>& siblings) {
    const std::uint64_t count = siblings.size();
    if (slots_.size() / kEsvoPageSlots != (slots_.size() + count) / kEsvoPageSlots ||
        slots_.size() % kEsvoPageSlots == 0) {
      pad(kEsvoPageSlots);
      slots_.push_back(0);
    }
    pad(2);
    if (slots_.size() % kEsvoPageSlots + count > kEsvoPageSlots) return place(siblings);
    const std::uint64_t first = slots_.size();
    slots_.resize(first + count);
    return first;
  }

  static std::vector<const TestVoxel*> inner_children(const TestVoxel& voxel) {
    std::vector<const TestVoxel*> inner;
    for (const auto& child : voxel.children)
      if (child && !child->is_leaf()) inner.push_back(child.get());
    return inner;
  }

  /// Appends a slot for a far pointer that is not a page header; returns it.
  std::uint64_t place_far_pointer() {
    if (slots_.size() % kEsvoPageSlots == 0) slots_.push_back(0);
    slots_.push_back(0);
    return slots_.size() - 1;
  }

  /// Writes the descriptors of `voxel` and its descendants.
  void fill(const TestVoxel& voxel, std::uint64_t slot, std::uint64_t far_slot) {
    std::uint32_t valid = 0, leaf = 0, with_contour = 0;
    const std::uint64_t first_contour = contours_.size();
    for (std::uint32_t i = 0; i < 8; ++i) {
      const TestVoxel* child = voxel.children[i].get();
      if (child == nullptr) continue;
      valid |= 1u << i;
      if (child->is_leaf()) leaf |= 1u << i;
      if (!child->contour) continue;
      with_contour |= 1u << i;
      contours_.push_back(*child->contour);
    }
    ChildDescriptor descriptor = ChildDescriptor::make(valid, leaf, with_contour);
    if (with_contour != 0) references_.push_back({slot, first_contour});
    const auto inner = inner_children(voxel);
    if (!inner.empty()) {
      const std::uint64_t first = place(inner);
      const bool is_far = rng_() % far_in_ == 0 || first - slot > ChildDescriptor::kMaxChildPointer;
      if (is_far) slots_[far_slot] = static_cast<std::uint32_t>(first - slot);
      descriptor.set_child_pointer(static_cast<std::uint32_t>((is_far ? far_slot : first) - slot),
                                   is_far);
      std::vector<std::uint64_t> far_slots;
      for (std::size_t i = 0; i < inner.size(); ++i) far_slots.push_back(place_far_pointer());
      for (std::size_t i = 0; i < inner.size(); ++i) fill(*inner[i], first + i, far_slots[i]);
    }
    slots_[slot] = descriptor.to_slot();
  }

  unsigned far_in_;
  std::mt19937 rng_;
  std::vector<std::uint64_t> slots_;
  std::vector<Contour> contours_;
  std::vector<Reference> references_;
};

/// Returns the octree of voxels of the finest level, without contours.
inline std::unique_ptr<TestVoxel> test_octree(int levels, const std::vector<Vec3i>& voxels) {
  auto root = std::make_unique<TestVoxel>();
  for (const Vec3i v : voxels) {
    TestVoxel* at = root.get();
    for (int shift = levels - 1; shift >= 0; --shift) {
      const int index = (v.x >> shift & 1) | (v.y >> shift & 1) << 1 | (v.z >> shift & 1) << 2;
      auto& child = at->children[static_cast<std::size_t>(index)];
      if (!child) child = std::make_unique<TestVoxel>();
      at = child.get();
    }
  }
  return root;
}

/// Replaces eight sibling leaves by their parent as a leaf, up to level 1.
inline void merge_full_voxels(TestVoxel& voxel, bool is_root = true) {
  bool is_full = true;
  for (auto& child : voxel.children) {
    if (child && !child->is_leaf()) merge_full_voxels(*child, false);
    is_full = is_full && child && child->is_leaf();
  }
  if (is_full && !is_root) voxel.children = {};
}

/// Returns a random contour.
inline Contour random_contour(std::mt19937& rng) {
  const auto below = [&](int n) { return static_cast<int>(rng() % static_cast<unsigned>(n)); };
  Vec3i normal{};
  while (normal == Vec3i{}) {
    for (int axis = 0; axis < 3; ++axis) normal[axis] = below(63) - 31;
    if (below(4) == 0) normal[below(3)] = 0;
    if (below(4) == 0) normal[below(3)] = 0;
  }
  const int low = below(128), high = below(128);
  return Contour::make(normal, low < high ? low : high, low < high ? high : low);
}

/// Returns a random octree: some voxels are leaves above the finest level, some have contours.
inline std::unique_ptr<TestVoxel> random_octree(std::mt19937& rng, int level, int levels) {
  auto voxel = std::make_unique<TestVoxel>();
  if (level > 0 && rng() % 5 < 3) voxel->contour = random_contour(rng);
  if (level == levels || (level > 1 && rng() % 8 == 0)) return voxel;
  bool is_leaf = true;
  while (is_leaf) {
    for (auto& child : voxel->children)
      if (rng() % 2 == 0) child = random_octree(rng, level + 1, levels);
    is_leaf = voxel->is_leaf();
  }
  return voxel;
}

}  // namespace voxdag

#pragma once
/// Finds the corners and edges of a displaced mesh that coincide, and where their displacements
/// differ.
#include <cstdint>
#include <span>

#include "voxdag/core/memory_budget.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/mesh/displace/displaced_mesh.hpp"

namespace voxdag {

/// Groups corners at one position, and edges between the same two positions. Immutable.
class DisplacementSeams {
 public:
  /// A set of coinciding corners or edges.
  struct Group {
    /// One corner or edge for each distinct displacement; at least one.
    std::span<const CornerIndex> members;
    bool is_pinned;  ///< It does not move: a triangle without displacement has it too, or its
                     ///< displacements are more than kMaxMembers.

    /// Returns whether triangles disagree on how the group moves.
    bool is_seam() const { return members.size() > 1 || is_pinned; }
  };

  /// A corner or edge with more distinct displacements is pinned: comparing and averaging them
  /// would take quadratic time.
  static constexpr std::uint32_t kMaxMembers = 64;

  DisplacementSeams() = default;
  /// Finds the seams of the mesh. Throws Cancelled and OverMemory.
  explicit DisplacementSeams(const DisplacedMesh& mesh, Work work = {});

  Group corner_group(CornerIndex corner) const { return group(corner_groups_[corner]); }
  Group edge_group(CornerIndex edge) const { return group(edge_groups_[edge]); }

  /// The two ends of an edge, in an order that all coinciding edges share.
  struct Ends {
    CornerIndex first, last;
  };
  Ends ends(CornerIndex edge) const {
    const CornerIndex next = next_corner(edge);
    return places_[next] < places_[edge] ? Ends{next, edge} : Ends{edge, next};
  }

 private:
  struct StoredGroup {
    std::uint32_t first = 0, count = 0;  ///< Range in `members_`.
    bool is_pinned = false;
  };

  Group group(std::uint32_t index) const {
    const StoredGroup& stored = groups_[index];
    return {{members_.data() + stored.first, stored.count}, stored.is_pinned};
  }
  void number_places(const Mesh& mesh, Work work);
  void group_corners(const DisplacedMesh& mesh, Work work);
  void group_edges(const DisplacedMesh& mesh, Work work);
  template <class Agree>
  void add_group(const DisplacedMesh& mesh, std::span<const CornerIndex> all, const Agree& agree);
  bool edges_agree(const DisplacedMesh& mesh, CornerIndex a, CornerIndex b) const;

  std::size_t place_count_ = 0;
  CountedVector<std::uint32_t> places_;  ///< Per CornerIndex; equal for equal positions.
  CountedVector<std::uint32_t> corner_groups_, edge_groups_;  ///< Per CornerIndex.
  CountedVector<StoredGroup> groups_;
  CountedVector<CornerIndex> members_;
};

}  // namespace voxdag

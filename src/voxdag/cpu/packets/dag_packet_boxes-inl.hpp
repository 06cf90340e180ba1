// Tests the rays of a packet against the boxes of a node's children (bounded_dag.hpp). A box is a
// lane: one vector holds the boxes of all eight children.
#if defined(VOXDAG_DAG_PACKET_BOXES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXDAG_DAG_PACKET_BOXES_INL
#undef VOXDAG_DAG_PACKET_BOXES_INL
#else
#define VOXDAG_DAG_PACKET_BOXES_INL
#endif

#include "voxdag/cpu/packets/dag_packet_walk-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace voxdag {
namespace HWY_NAMESPACE {

#if VOXDAG_PACKET_LANES

/// Sets the planes of the children's boxes, one box per lane, for the node of `level` at `corner`.
/// Rounds the boxes outwards to the cells at which rays may end.
HWY_INLINE void DagPacketWalk::set_planes(const std::uint32_t corner[3], int level,
                                          hn::Vec<DU8> boxes) {
  const DU8 d;
  const DF8 df;
  int below = CellBox::kBits - (stop_level_ - (level + 1));
  below = below < 0 ? 0 : below > CellBox::kBits ? CellBox::kBits : below;
  const std::uint32_t rounded = (1u << below) - 1;
  const auto kept = hn::Set(d, ~rounded & (CellBox::kParts - 1)), filled = hn::Set(d, rounded);
  const auto side = hn::Set(d, 1u << (22 - level));
  const int shift = 22 - CellBox::kBits - level;  // log2 of a part's side
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    // Mirroring makes the last part the first.
    const bool is_mirrored = (rays_.mirrored >> axis & 1u) != 0;
    const auto flip = hn::Set(d, is_mirrored ? CellBox::kParts - 1 : 0u);
    const auto parts_at = [&](std::uint32_t field) HWY_ATTR {
      const auto parts = hn::ShiftRightSame(boxes, static_cast<int>(CellBox::kBits * field));
      return hn::And(hn::Xor(parts, flip), kept);
    };
    const auto first = parts_at(is_mirrored ? axis + 3 : axis);
    const auto last = hn::Or(parts_at(is_mirrored ? axis : axis + 3), filled);
    const auto at = hn::Or(hn::Set(d, corner[axis]), hn::And(hn::Load(d, kUpper[axis]), side));
    const auto low = hn::Add(at, hn::ShiftLeftSame(first, shift));
    const auto high = hn::Add(at, hn::ShiftLeftSame(hn::Add(last, hn::Set(d, 1)), shift));
    hn::Store(hn::BitCast(df, low), df, planes_[axis]);
    hn::Store(hn::BitCast(df, high), df, planes_[axis + 3]);
  }
}

/// Sets the children at which rays end. `enter` and `exit` bound the T at which the rays enter and
/// leave the children; `start` and `per_t` are the least and greatest values of their levels of
/// detail.
HWY_INLINE void DagPacketWalk::set_ends(int child_level, hn::Vec<DF8> enter, hn::Vec<DF8> exit,
                                        const float start[2], const float per_t[2],
                                        Children& children) const {
  const DF8 d;
  children.all_end = children.some_end = 0;
  children.octants_end = children.octants_may_end = 0;
  const int levels = levels_;
  const auto ends = [&](int level, int of, hn::Vec<DF8> t) HWY_ATTR {
    const auto limit = hn::Add(hn::Set(d, start[of]), hn::Mul(hn::Set(d, per_t[of]), t));
    return bits_of_children(hn::Le(hn::Set(d, side_of(level)), limit));
  };
  // From stop_level_ on, the boxes are whole cells.
  if (child_level >= stop_level_) {
    children.all_end = ends(child_level, 0, enter);
    children.some_end = ends(child_level, 1, exit);
  }
  if (child_level == levels - 2 && stop_level_ < levels) {
    children.octants_end = ends(levels - 1, 0, enter);
    children.octants_may_end = ends(levels - 1, 1, exit);
  }
}

/// Returns which boxes the rays can meet, by the bounds on all rays.
HWY_INLINE DagPacketWalk::Children DagPacketWalk::bound_children(int child_level) const {
  const DF8 d;
  auto enter = hn::Set(d, t_range_[0]), exit = hn::Set(d, HUGE_VALF);
  for (int axis = 0; axis < 3; ++axis)
    bound_by_sides(axis, hn::Load(d, planes_[axis]), hn::Load(d, planes_[axis + 3]), enter, exit);
  Children children;
  children.met = bits_of_children(hn::Lt(enter, hn::Min(exit, hn::Set(d, t_range_[1]))));
  set_ends(child_level, enter, exit, stop_start_, stop_per_t_, children);
  return children;
}

/// Narrows the range of T in which ray i is in each box.
HWY_INLINE void DagPacketWalk::cut_by_boxes(int i, hn::Vec<DF8>& enter, hn::Vec<DF8>& exit) const {
  const DF8 d;
  for (int axis = 0; axis < 3; ++axis) {
    const auto origin = hn::Set(d, rays_.origin[axis][i]),
               inverse = hn::Set(d, rays_.inverse[axis][i]);
    enter = hn::Max(enter, hn::Mul(hn::Sub(origin, hn::Load(d, planes_[axis + 3])), inverse));
    exit = hn::Min(exit, hn::Mul(hn::Sub(origin, hn::Load(d, planes_[axis])), inverse));
  }
}

/// Returns which boxes ray i meets.
HWY_INLINE std::uint32_t DagPacketWalk::boxes_met_by(int i) const {
  const DF8 d;
  auto enter = hn::Set(d, rays_.t_min[i]), exit = hn::Set(d, rays_.t_end[i]);
  cut_by_boxes(i, enter, exit);
  return bits_of_children(hn::Lt(enter, exit));
}

/// Returns which boxes ray i meets, and at which of their cells it ends.
HWY_INLINE DagPacketWalk::Children DagPacketWalk::children_met_by(int i, int child_level) const {
  const DF8 d;
  auto enter = hn::Set(d, rays_.t_min[i]), exit = hn::Set(d, HUGE_VALF);
  cut_by_boxes(i, enter, exit);
  Children children;
  children.met = bits_of_children(hn::Lt(enter, hn::Min(exit, hn::Set(d, rays_.t_end[i]))));
  const float start[2] = {rays_.stop_start[i], rays_.stop_start[i]};
  const float per_t[2] = {rays_.stop_per_t[i], rays_.stop_per_t[i]};
  set_ends(child_level, enter, exit, start, per_t, children);
  return children;
}

/// Returns which of `rays` meet the box of child `child`.
HWY_INLINE DagPacketWalk::Rays DagPacketWalk::rays_meeting(std::uint32_t child, Rays rays) const {
  const DF d;
  const auto x0 = hn::Set(d, planes_[0][child]), x1 = hn::Set(d, planes_[3][child]);
  const auto y0 = hn::Set(d, planes_[1][child]), y1 = hn::Set(d, planes_[4][child]);
  const auto z0 = hn::Set(d, planes_[2][child]), z1 = hn::Set(d, planes_[5][child]);
  Rays met = 0;
  for (Rays rest = rays; rest != 0;) {
    const std::size_t first = take_vector(rest);
    const auto t = [&](int axis, VF position) HWY_ATTR {
      return hn::Mul(hn::Sub(hn::Load(d, rays_.origin[axis] + first), position),
                     hn::Load(d, rays_.inverse[axis] + first));
    };
    const auto enter =
        hn::Max(hn::Max(t(0, x1), t(1, y1)), hn::Max(t(2, z1), hn::Load(d, rays_.t_min + first)));
    const auto exit =
        hn::Min(hn::Min(t(0, x0), t(1, y0)), hn::Min(t(2, z0), hn::Load(d, rays_.t_end + first)));
    met |= bits_of(hn::Lt(enter, exit)) << first;
  }
  return met & rays;
}

/// Returns which of `rays` end at the cell of child `child` of level `child_level`, by ends_at().
/// All of them must meet the cell.
HWY_NOINLINE DagPacketWalk::Rays DagPacketWalk::rays_ending(std::uint32_t child, int child_level,
                                                            Rays rays) const {
  if (child_level < rays_.coarsest) return 0;
  const DF d;
  const auto side = hn::Set(d, side_of(child_level));
  const auto x = hn::Set(d, planes_[0][child]), y = hn::Set(d, planes_[1][child]),
             z = hn::Set(d, planes_[2][child]);
  Rays ending = 0;
  for (Rays rest = rays; rest != 0;) {
    const std::size_t first = take_vector(rest);
    const auto t = [&](int axis, VF position) HWY_ATTR {
      return hn::Mul(hn::Sub(hn::Load(d, rays_.origin[axis] + first), position),
                     hn::Load(d, rays_.inverse[axis] + first));
    };
    const auto exit = hn::Min(hn::Min(t(0, x), t(1, y)), t(2, z));
    const auto limit = hn::Add(hn::Load(d, rays_.stop_start + first),
                               hn::Mul(hn::Load(d, rays_.stop_per_t + first), exit));
    ending |= bits_of(hn::Le(side, limit)) << first;
  }
  return ending & rays;
}

/// Pushes the children that rays meet onto the stack, the nearest on top. A child at which rays end
/// is pushed with these rays alone.
inline void DagPacketWalk::visit_children(const Visit& visit, Visit* stack, std::size_t& top) {
  const auto level = static_cast<int>(visit.level);
  const std::uint32_t* node = words_of(visit.node, level);
  const std::uint32_t present = node[0];
  const std::uint32_t* pointers = node + 2;
  const DU8 d;
  const std::uint8_t* rank_of = ranks_of(present);
  const auto ranks = hn::PromoteTo(d, hn::Load(hn::Rebind<std::uint8_t, DU8>(), rank_of));
  const auto boxes = hn::TableLookupLanes(hn::LoadU(d, pointers + popcount8(present)),
                                          hn::IndicesFromVec(d, ranks));
  set_planes(visit.corner, level, boxes);
  const std::uint32_t not_skipped = mirrored(present) & ~visit.skipped;
  const bool is_single = (visit.rays & (visit.rays - 1)) == 0;
  const Children children =
      is_single ? children_met_by(lowest_bit64(visit.rays), level + 1) : bound_children(level + 1);
  std::uint32_t met = children.met & not_skipped;
  if (met == 0) return;
  const bool are_few = !is_single && (met & (met - 1)) != 0 && popcount64(visit.rays) <= kFew;
  std::uint32_t met_by[kFew] = {};
  Rays few[kFew] = {};  // one ray each
  if (are_few) {
    std::uint32_t met_by_any = 0;
    int at = 0;
    for (Rays rest = visit.rays; rest != 0; rest &= rest - 1) {
      few[at] = rest & -rest;
      met_by[at] = boxes_met_by(lowest_bit64(rest));
      met_by_any |= met_by[at++];
    }
    met &= met_by_any;
    if (met == 0) return;
  }
  if ((met & ~children.all_end) == 0) {
    end_at_children(visit, met);
    return;
  }
  const bool are_as_one = is_single || (are_many(visit.rays) && are_narrow(visit, t_range_[0]));
  for (std::uint32_t rest = met; rest != 0; rest &= rest - 1) {
    const auto child = static_cast<std::uint32_t>(__builtin_ctz(rest));
    const bool may_end = (children.some_end >> child & 1u) != 0;
    Visit& next = stack[top];
    if (are_few) {
      // Has no branches on the number of rays, because they would be hard to predict.
      next.rays = 0;
      for (int at = 0; at < kFew; ++at) next.rays |= few[at] & (0 - Rays{met_by[at] >> child & 1u});
    } else {
      next.rays = are_as_one && !may_end ? visit.rays : rays_meeting(child, visit.rays);
    }
    next.skipped = ((children.octants_end >> child & 1u) != 0 ? kOctantsEnd : 0u) |
                   ((children.octants_may_end >> child & 1u) != 0 ? kOctantsMayEnd : 0u);
    next.node = pointers[rank_of[child]];
    // The number of a unit is no place in words_, but a prefetch of any address is harmless.
    if (level == levels_ - 3)
      hwy::Prefetch(leaf_blocks_ + next.node);
    else
      hwy::Prefetch(words_of(next.node, level));
    set_child(visit, child, next);
    if (!may_end) {
      top += next.rays != 0 ? 1 : 0;
      continue;
    }
    const Rays ending = rays_ending(child, level + 1, next.rays);
    next.rays ^= ending;
    top += next.rays != 0 ? 1 : 0;
    if (ending == 0) continue;
    Visit& end = stack[top++];
    end.rays = ending;
    end.node = 0;
    end.skipped = kEndsHere;
    set_child(visit, child, end);
  }
}

/// Ends rays at the children in the mask `met`: all rays that meet one of them end there.
inline void DagPacketWalk::end_at_children(const Visit& visit, std::uint32_t met) {
  const auto end_at = [&](std::uint32_t child, Rays hits) {
    Cell cell;
    set_child(visit, child, cell);
    end(hits, cell.corner, static_cast<int>(cell.level));
  };
  Rays rays = visit.rays;
  if (popcount64(rays) <= kFew) {
    for (; rays != 0; rays &= rays - 1) {
      const std::uint32_t met_by = boxes_met_by(lowest_bit64(rays)) & met;
      if (met_by != 0) end_at(static_cast<std::uint32_t>(highest_bit(met_by)), rays & -rays);
    }
    return;
  }
  while (met != 0 && rays != 0) {
    const auto child = static_cast<std::uint32_t>(highest_bit(met));
    met ^= 1u << child;
    const Rays hits = rays_meeting(child, rays);
    if (hits != 0) end_at(child, hits);
    rays ^= hits;
  }
}

#endif  // VOXDAG_PACKET_LANES

}  // namespace HWY_NAMESPACE
}  // namespace voxdag
HWY_AFTER_NAMESPACE();

#endif

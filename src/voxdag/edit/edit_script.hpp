#pragma once
/// Scripts of edits: text with one edit a line, in world units.
///
///   # Comments begin with # at the start of a line.
///   remove,ball,X,Y,Z,R
///   add,box,X0,Y0,Z0,X1,Y1,Z1,\#rrggbb
///   paint,capsule,X0,Y0,Z0,X1,Y1,Z1,R,material=3
///   copy,X0,Y0,Z0,X1,Y1,Z1,TX,TY,TZ
///   undo
///
/// A verb, a shape if the verb takes one, the numbers of edit_fields() (edit_step.hpp), then for
/// add and paint a colour, a material or both. Spaces around fields and a carriage return at the
/// end do not count.
#include <cstdint>
#include <optional>
#include <string_view>

#include "voxdag/core/error.hpp"
#include "voxdag/core/memory_budget.hpp"
#include "voxdag/edit/edit_step.hpp"

namespace voxdag {

/// Returns the edit of a line without its line end; nothing for a comment or an empty line. Throws
/// Error without a place.
std::optional<EditStep> parse_edit_line(std::string_view line, const Grid& grid);

/// Calls work() and returns its result. An Error that it throws gets the place "line N"; N counts
/// from 1. Cancelled and OverMemory pass unchanged.
template <class Work>
auto at_edit_line(std::uint64_t number, const Work& work) {
  try {
    return work();
  } catch (const Cancelled&) {
    throw;
  } catch (const OverMemory&) {
    throw;
  } catch (const Error& error) {
    throw error.within(ErrorPlace::line(number));
  }
}

}  // namespace voxdag

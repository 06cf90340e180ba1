#pragma once
/// 128-bit integers, an extension of every compiler that we support.
namespace voxdag {

// `using` cannot carry the mark of an extension.
// NOLINTBEGIN(modernize-use-using)
__extension__ typedef __int128 Int128;
__extension__ typedef unsigned __int128 Uint128;
// NOLINTEND(modernize-use-using)

}  // namespace voxdag

#pragma once
/// 128-bit integers, an extension of all supported compilers.
namespace voxdag {

// `__extension__` does not work with `using`. NOLINTBEGIN(modernize-use-using)
__extension__ typedef __int128 Int128;
__extension__ typedef unsigned __int128 Uint128;
// NOLINTEND(modernize-use-using)

}  // namespace voxdag

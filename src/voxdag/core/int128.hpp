#pragma once
/// 128-bit integers, an extension of every compiler that we support.
namespace voxdag {

__extension__ typedef __int128 Int128;
__extension__ typedef unsigned __int128 Uint128;

}  // namespace voxdag

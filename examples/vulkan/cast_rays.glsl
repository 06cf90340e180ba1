#version 450
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
layout(constant_id = 0) const int voxdag_levels = 0;
layout(std430, binding = 0) readonly buffer Nodes { uint voxdag_nodes[]; };
layout(std430, binding = 1) readonly buffer Leaves { uvec2 voxdag_leaves[]; };
#include "voxdag.glsl"
layout(std430, binding = 2) readonly buffer Rays { VoxdagRay rays[]; };
layout(std430, binding = 3) writeonly buffer Hits { uvec4 hits[]; };  // of each ray T, the voxel; face, whether it hits

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= rays.length()) return;
  VoxdagHit hit;
  bool is_hit = voxdagCast(rays[i], vec2(0.0), hit);
  hits[2u * i] = uvec4(floatBitsToUint(hit.t), hit.cell);
  hits[2u * i + 1u] = uvec4(hit.face, is_hit, 0u, 0u);
}

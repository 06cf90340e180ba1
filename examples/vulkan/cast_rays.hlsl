[[vk::constant_id(0)]] const int voxdag_levels = 0;
StructuredBuffer<uint> voxdag_nodes : register(t0);
StructuredBuffer<uint2> voxdag_leaves : register(t1);
#include "voxdag.hlsl"
StructuredBuffer<VoxdagRay> rays : register(t2);
RWStructuredBuffer<uint4> hits : register(u3);  // of each ray T, the voxel; face, whether it hits

[numthreads(64, 1, 1)] void main(uint3 id : SV_DispatchThreadID) {
  uint count, size;
  rays.GetDimensions(count, size);
  if (id.x >= count) return;
  VoxdagHit hit;
  bool is_hit = voxdagCast(rays[id.x], float2(0, 0), hit);
  hits[2 * id.x] = uint4(asuint(hit.t), hit.cell);
  hits[2 * id.x + 1] = uint4(hit.face, is_hit, 0, 0);
}

// Prints a digest of all answers that voxdag.h gives about a file: info, voxels, attributes of
// cells, and 30,000 rays. compilers_test.py compiles it in many ways, which must print one line.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define VOXDAG_IMPLEMENTATION
#include "voxdag.h"

static uint64_t digest = 0xCBF29CE484222325u;

// Adds the bytes of a value, lowest first, to the digest (FNV-1a).
static void add(uint64_t value) {
  for (int i = 0; i < 8; ++i, value >>= 8) digest = (digest ^ (value & 0xFF)) * 0x100000001B3u;
}
static void add_float(float value) {
  uint32_t bits;
  memcpy(&bits, &value, sizeof bits);
  add(bits);
}
static void add_double(double value) {
  uint64_t bits;
  memcpy(&bits, &value, sizeof bits);
  add(bits);
}

// Returns the next of the numbers 0 to 1 - 2^-24.
static double next_number(void) {
  static uint32_t state = 1;
  state = state * 1664525u + 1013904223u;
  return (state >> 8) / 16777216.0;
}

static void add_info(const voxdag_info* info) {
  add((uint64_t)info->levels);
  for (int axis = 0; axis < 3; ++axis) add_double(info->origin[axis]);
  add_double(info->voxel_size);
  add(info->voxels);
  add((uint64_t)info->up);
  add((uint64_t)(info->has_colors + 2 * info->has_normals + 4 * info->has_materials));
}

static void add_cell(const voxdag_scene* scene, int level, const int32_t cell[3]) {
  uint64_t number;
  uint8_t color[3];
  float normal[3];
  uint32_t material;
  add((uint64_t)voxdag_contains(scene, level, cell));
  if (!voxdag_find_number(scene, level, cell, &number)) return;
  add(number);
  if (voxdag_color(scene, number, color))
    for (int c = 0; c < 3; ++c) add(color[c]);
  if (voxdag_normal(scene, number, normal))
    for (int axis = 0; axis < 3; ++axis) add_float(normal[axis]);
  if (voxdag_material(scene, number, &material)) add(material);
}

static uint64_t add_voxels(const voxdag_scene* scene) {
  const int levels = scene->info.levels;
  const int32_t n = scene->info.resolution, lo[3] = {1, 0, 0}, hi[3] = {n, n, n};
  voxdag_walk walk;
  int32_t voxel[3];
  uint64_t count = 0;
  voxdag_walk_begin(&walk, scene, lo, hi);
  while (voxdag_walk_next(&walk, voxel)) {
    const int finer = (int)(count++ % (uint64_t)(levels + 1));
    const int32_t cell[3] = {voxel[0] >> finer, voxel[1] >> finer, voxel[2] >> finer};
    add_cell(scene, levels - finer, cell);
  }
  return count;
}

// Casts rays between random points, and from corner to corner of voxels: there, an error in the
// last bit of a sum makes a ray hit another voxel.
static int add_rays(const voxdag_scene* scene) {
  const double size = scene->info.voxel_size, n = scene->info.resolution;
  int hits = 0;
  for (int i = 0; i < 30000; ++i) {
    voxdag_ray ray = {{0, 0, 0}, {0, 0, 0}, 0, 1e30f};
    voxdag_hit hit;
    for (int axis = 0; axis < 3; ++axis) {
      double from = n * (3 * next_number() - 1), to = n * next_number();
      if (i % 2 == 0) from = (double)(int)from;
      if (i % 2 == 0) to = (double)(int)to;
      ray.origin[axis] = scene->info.origin[axis] + size * from;
      ray.direction[axis] = i % 3 == axis && i % 5 == 0 ? 0 : size * (to - from);
    }
    if (i % 7 == 0) ray.t_min = -1;
    if (i % 7 == 1) ray.t_min = 0.5f;
    hits += voxdag_cast(scene, &ray, &hit);
    for (int axis = 0; axis < 3; ++axis) add((uint64_t)hit.voxel[axis]);
    add_float(hit.t);
    add((uint64_t)(hit.face + 1));
  }
  return hits;
}

int main(int argc, char** argv) {
  static unsigned char bytes[1 << 24], scratch[VOXDAG_SCRATCH_BYTES(sizeof bytes)];
  FILE* const file = argc == 2 ? fopen(argv[1], "rb") : NULL;
  if (file == NULL) return fprintf(stderr, "usage: digest FILE.vdag\n"), 2;
  const size_t size = fread(bytes + 1, 1, sizeof bytes - 1, file);  // at an odd address
  fclose(file);
  voxdag_scene scene;
  const char* const error = voxdag_open(&scene, bytes + 1, size, scratch, sizeof scratch);
  if (error != NULL)
    return fprintf(stderr, "%s: byte %lu: %s\n", argv[1], (unsigned long)scene.error_at, error), 1;
  add_info(&scene.info);
  const uint64_t voxels = add_voxels(&scene);
  const int hits = add_rays(&scene);
  printf("%lu voxels, %d hits, digest %08lx%08lx\n", (unsigned long)voxels, hits,
         (unsigned long)(digest >> 32), (unsigned long)(digest & 0xFFFFFFFFu));
  return 0;
}

// Reads a .vdag file with the header alone, prints what it holds, and casts a ray.
#include <stdio.h>
#include <stdlib.h>

#define VOXDAG_IMPLEMENTATION
#include <voxdag.h>

int main(int argc, char** argv) {
  FILE* const file = argc == 2 ? fopen(argv[1], "rb") : NULL;
  if (file == NULL) return fprintf(stderr, "usage: %s FILE.vdag\n", argv[0]), 2;
  fseek(file, 0, SEEK_END);
  const size_t size = (size_t)ftell(file), scratch_size = VOXDAG_SCRATCH_BYTES(size);
  rewind(file);
  void *const bytes = malloc(size), *const scratch = malloc(scratch_size);
  if (bytes == NULL || scratch == NULL || fread(bytes, 1, size, file) != size) return 1;
  fclose(file);

  voxdag_scene scene;
  const char* const error = voxdag_open(&scene, bytes, size, scratch, scratch_size);
  free(scratch);
  if (error != NULL) return fprintf(stderr, "byte %.0f: %s\n", (double)scene.error_at, error), 1;
  const voxdag_info* const info = &scene.info;
  printf("%.0f voxels in a grid of %d a side\n", (double)info->voxels, (int)info->resolution);

  voxdag_ray ray = {{0, 0, 0}, {0, -1, 0}, 0, 1e30f};  // from the grid's centre along -y
  for (int axis = 0; axis < 3; ++axis)
    ray.origin[axis] = info->origin[axis] + info->voxel_size * info->resolution / 2;
  voxdag_hit hit;
  if (voxdag_cast(&scene, &ray, &hit)) {
    const int x = (int)hit.voxel[0], y = (int)hit.voxel[1], z = (int)hit.voxel[2];
    printf("voxel %d %d %d at t = %g\n", x, y, z, (double)hit.t);
    uint64_t number;
    uint8_t color[3];
    if (voxdag_find_number(&scene, info->levels, hit.voxel, &number) &&
        voxdag_color(&scene, number, color))
      printf("colour %d %d %d\n", color[0], color[1], color[2]);
  }
  free(bytes);
  return 0;
}

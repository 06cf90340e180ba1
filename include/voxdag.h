/// voxdag.h reads sparse voxel DAGs: .vdag files in the plain form, version 1.
///
/// One header in C99, which also compiles as C++11. One source file of a program defines
/// VOXDAG_IMPLEMENTATION before it includes voxdag.h; others just include it. To use it, read a
/// file into memory, then
///
///     void* scratch = malloc(VOXDAG_SCRATCH_BYTES(size));
///     voxdag_scene scene;
///     const char* error = voxdag_open(&scene, bytes, size, scratch, VOXDAG_SCRATCH_BYTES(size));
///     free(scratch);
///     if (error != NULL) return fail(error, scene.error_at);
///     voxdag_ray ray = {{0, 10, 0}, {0, -1, 0}, 0, 1000};
///     voxdag_hit hit;
///     uint64_t number; uint8_t color[3];
///     if (voxdag_cast(&scene, &ray, &hit) &&
///         voxdag_find_number(&scene, scene.info.levels, hit.voxel, &number) &&
///         voxdag_color(&scene, number, color))
///       paint(color);
///
/// Rays hit the voxels that voxdag's library finds, with equal faces and distances, to the bit.
/// The header allocates nothing, prints nothing and has no state. voxdag_open() checks all that the
/// other functions rely on, so any bytes are safe. A scene refers to the bytes of the file, which
/// must live unchanged as long as the scene is used. Any number of threads may use a scene at once.
///
/// It needs <float.h>, <stddef.h> and <stdint.h>, which compilers have without a C library, and
/// memcpy, fma and sqrtf. To replace <string.h> and <math.h>, define VOXDAG_MEMCPY, VOXDAG_FMA and
/// VOXDAG_SQRTF as functions of your own; the last two must round as IEEE 754 says. Machines may
/// have either byte order.
///
/// It does not read ESVOs, the compact form, and DAGs with 2^32 node words or more, and it skips
/// attributes in the wire form. `voxdag convert FILE --plain -o OUT` rewrites compact and wire
/// forms.
///
/// The format, of which docs/format.md has every bit; all words are little-endian:
///
///     header       64 bytes: magic, version, number of chunks, size of the file, checksum
///     chunk table  32 bytes per chunk: id, flags, offset, length, checksum
///     META         JSON: levels, origin and voxel size of the grid, and more about the scene
///     LEVL         64-bit words: where the nodes of each level begin
///     NODE         32-bit words: inner nodes, a child mask and a pointer per child
///     LEAF         64-bit words: leaf blocks, the masks of 4^3 voxels
///     CIDX         the numbers of cells, by which attributes are stored
///     COLR, NRML   colours and normals of cells, in compressed pages
///     MTID         materials of cells, in pages of runs
#ifndef VOXDAG_H
#define VOXDAG_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define VOXDAG_MAX_LEVELS 20  ///< The largest grid has 2^20 voxels a side.
#define VOXDAG_NO_FACE (-1)
/// The bytes of scratch memory that suffice to open a file of `size` bytes.
#define VOXDAG_SCRATCH_BYTES(size) ((size) / 32 + 8)

/// What a file says about its scene.
typedef struct voxdag_info {
  int levels;          ///< L, 2 to 20: the grid has 2^L voxels a side.
  int32_t resolution;  ///< 2^L
  /// The lower corner of voxel (0,0,0), in world units. Voxel (i,j,k) is the half-open cube that
  /// begins at origin + (i,j,k) * voxel_size and is voxel_size wide.
  double origin[3];
  double voxel_size;   ///< In world units; positive.
  char up;             ///< The axis that points up, 'x', 'y' or 'z'; 0 if the file does not say.
  uint64_t voxels;     ///< Number of set voxels as the file states it. It is not counted again.
  uint64_t dag_bytes;  ///< Bytes of nodes and leaf blocks.
  int has_colors, has_normals, has_materials;  ///< 1 if cells have these attributes, else 0.
  int has_wire_form;  ///< 1 if the file has attributes in the wire form, which are skipped.
  /// The finest level with attributes, 0 to L. Finer cells have those of their ancestor there.
  int attribute_level;
  uint32_t materials;    ///< Number of materials: ids are less than this. 0 without materials.
  const char* metadata;  ///< The JSON of the chunk META, without a terminating zero.
  size_t metadata_bytes;
} voxdag_info;

/// Compressed values of cells, by number.
typedef struct voxdag_pages {
  const unsigned char *groups, *words, *pages;
  uint64_t word_count, values;
  uint32_t kind;  ///< The precision of colours and normals; the number of materials.
} voxdag_pages;

/// An open file: a plain value, which may be copied. Read only `info` and `error_at`.
typedef struct voxdag_scene {
  voxdag_info info;
  uint64_t error_at;  ///< After a refusal: the byte of the file at or near which the fault is.

  const unsigned char* bytes;
  const unsigned char *nodes, *leaves, *slots;  ///< The words of NODE, LEAF and CIDX.
  uint64_t leaf_count;
  uint64_t level_begin[VOXDAG_MAX_LEVELS + 1];  ///< First word in NODE; from L-2 on, its end.
  uint64_t slot_begin[VOXDAG_MAX_LEVELS];       ///< First word of the level's slots.
  unsigned char slot_bits[VOXDAG_MAX_LEVELS];
  uint64_t cells;  ///< Number of cells that CIDX numbers.
  voxdag_pages colors, normals, materials;
} voxdag_scene;

/// Opens the `size` bytes of a plain .vdag file. Returns null, or a text of one line that says why
/// the bytes are refused; then `scene` has no voxels, and scene->error_at says where the fault is.
/// `scratch` is memory of VOXDAG_SCRATCH_BYTES(size) bytes, which is free again when the call
/// returns. Neither pointer needs an alignment. Takes linear time: it reads each byte two or three
/// times, and a bit of `scratch` per pointer.
const char* voxdag_open(voxdag_scene* scene, const void* bytes, size_t size, void* scratch,
                        size_t scratch_bytes);

/// Returns 1 if the cell of `level`, 0 to L, has voxels, else 0. Cells of level l have 2^(L-l)
/// voxels a side, and coordinates from 0 to 2^l - 1; other cells have no voxels. With level L, the
/// cell is a voxel. O(level) time.
int voxdag_contains(const voxdag_scene* scene, int level, const int32_t cell[3]);

/// Sets `voxel` to the voxel, in or outside of the grid, that contains a point in world units.
/// Coordinates are clamped to 32 bits; NaN becomes the least one.
void voxdag_voxel_at(const voxdag_scene* scene, const double point[3], int32_t voxel[3]);

/// Returns 1 if the point, in world units, lies in a voxel that is set, else 0.
int voxdag_contains_point(const voxdag_scene* scene, const double point[3]);

/// Sets `number` to the number of a cell (see voxdag_contains()), by which its attributes are
/// stored; cells finer than info.attribute_level have that of their ancestor. Returns 1, or 0 if
/// the cell has no voxels or the file numbers no cells. O(level) time.
int voxdag_find_number(const voxdag_scene* scene, int level, const int32_t cell[3],
                       uint64_t* number);

/// Read the attributes of the cell with a number: its colour (red, green, blue, sRGB encoded), its
/// normal (unit length, in the world's axes) and the id of its material, 0 to info.materials - 1.
/// Return 1, or 0 if the scene has no such attribute. They read half of a page on average.
int voxdag_color(const voxdag_scene* scene, uint64_t number, uint8_t color[3]);
int voxdag_normal(const voxdag_scene* scene, uint64_t number, float normal[3]);
int voxdag_material(const voxdag_scene* scene, uint64_t number, uint32_t* material);

/// The points origin + t * direction, t_min <= t <= t_max, in world units. The direction need not
/// have unit length. t_min may be negative or -infinity, t_max may be infinity. A ray with NaN, an
/// infinite origin or direction, a direction of zero length, or t_min > t_max meets nothing.
typedef struct voxdag_ray {
  double origin[3], direction[3];
  float t_min, t_max;
} voxdag_ray;

/// The first voxel along a ray.
typedef struct voxdag_hit {
  float t;           ///< In [t_min, t_max]; t_min if the ray starts inside the voxel.
  int32_t voxel[3];  ///< 0 to 2^L - 1.
  /// The side through which the ray enters, by its outward normal: -x, +x, -y, +y, -z, +z are 0 to
  /// 5. VOXDAG_NO_FACE if the ray starts inside the voxel.
  int face;
} voxdag_hit;

/// Finds the first voxel along the ray. Returns 1 and sets `hit`, or returns 0 and sets it to zeros
/// and VOXDAG_NO_FACE. O(cells on the way) time.
int voxdag_cast(const voxdag_scene* scene, const voxdag_ray* ray, voxdag_hit* hit);

/// A ray in the grid, for walks on other devices (shaders/). The section "Rays" explains it.
typedef struct voxdag_grid_ray {
  float origin[3], t_min;       ///< In [1,2], mirrored. The range of T.
  float inverse[3], t_max;      ///< 1 / |component|; 2^32 on parallel axes.
  uint32_t mirrored, parallel;  ///< Bit a: axis a is mirrored; the ray does not move along axis a.
  double t_start, t_scale;      ///< The t of the ray in the world is t_start + t_scale * T.
} voxdag_grid_ray;

/// Converts a ray to the coordinates of the grid. Returns 0 if it misses the grid.
int voxdag_enter_grid(const voxdag_scene* scene, const voxdag_ray* ray, voxdag_grid_ray* out);

/// A walk through the voxels of a window. It may be paused, copied and given up at any time.
typedef struct voxdag_walk {
  const voxdag_scene* scene;
  int32_t lo[3], hi[3];  ///< The window.
  /// The lowest voxel of the last voxel's leaf block, which has 4^3 voxels, and the mask of its
  /// voxels that are still to come. Voxel (x,y,z) of a block is bit (x & 1) + 2 (y & 1) + 4 (z & 1)
  /// + 8 (x >> 1) + 16 (y >> 1) + 32 (z >> 1). To leave out the rest of a block, set `left` to 0.
  int32_t block[3];
  uint64_t left;
  int level;                             ///< Of the last node of the path; -1: no node is left.
  uint32_t node[VOXDAG_MAX_LEVELS];      ///< The path: the node of each level,
  uint32_t children[VOXDAG_MAX_LEVELS];  ///< and its children that are still to come.
} voxdag_walk;

/// Begins a walk through the voxels with lo <= voxel < hi on each axis. The window may extend
/// beyond the grid. The scene must live as long as the walk.
void voxdag_walk_begin(voxdag_walk* walk, const voxdag_scene* scene, const int32_t lo[3],
                       const int32_t hi[3]);

/// Sets `voxel` to the next voxel, in Morton order. Returns 1, or 0 after the last one. The whole
/// walk takes time in the number of leaf blocks and voxels that it meets.
int voxdag_walk_next(voxdag_walk* walk, int32_t voxel[3]);

#ifdef __cplusplus
}  // extern "C"
#endif

#endif  // VOXDAG_H

#if defined(VOXDAG_IMPLEMENTATION) && !defined(VOXDAG_IMPLEMENTED)
#define VOXDAG_IMPLEMENTED

#include <float.h>
#ifndef VOXDAG_MEMCPY
#include <math.h>
#include <string.h>
#define VOXDAG_MEMCPY memcpy
#define VOXDAG_FMA fma
#define VOXDAG_SQRTF sqrtf
#endif

#if defined(__FAST_MATH__) || defined(_M_FP_FAST)
#error "voxdag.h: compile without fast mathematics, which changes the voxels that rays hit"
#elif defined(FLT_EVAL_METHOD) && FLT_EVAL_METHOD != 0 && FLT_EVAL_METHOD != 16  // 16: halves, too
#error "voxdag.h: floats must have float precision; on 32-bit x86 use -msse2 -mfpmath=sse"
#endif

// ---- Words and bits ----

typedef const unsigned char* vdag_ptr;
// Little-endian machines load a word at once, others byte by byte.
#if !defined(VOXDAG_BYTEWISE) && \
    (defined(_MSC_VER) || (defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__))
static uint32_t vdag_u32(vdag_ptr at) {
  uint32_t word;
  VOXDAG_MEMCPY(&word, at, sizeof word);
  return word;
}
static uint64_t vdag_u64(vdag_ptr at) {
  uint64_t word;
  VOXDAG_MEMCPY(&word, at, sizeof word);
  return word;
}
#else
static uint32_t vdag_u32(vdag_ptr at) {
  return at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
}
static uint64_t vdag_u64(vdag_ptr at) { return vdag_u32(at) | (uint64_t)vdag_u32(at + 4) << 32; }
#endif

// Return the place of a word in an array, and the word. Indices are those of checked arrays.
static vdag_ptr vdag_at32(vdag_ptr words, uint64_t index) { return words + (size_t)index * 4; }
static vdag_ptr vdag_at64(vdag_ptr words, uint64_t index) { return words + (size_t)index * 8; }
static uint32_t vdag_word32(vdag_ptr words, uint64_t i) { return vdag_u32(vdag_at32(words, i)); }
static uint64_t vdag_word64(vdag_ptr words, uint64_t i) { return vdag_u64(vdag_at64(words, i)); }
static void vdag_clear(void* at, size_t bytes) {
  for (size_t i = 0; i < bytes; ++i) ((unsigned char*)at)[i] = 0;
}
static int vdag_is_zero(vdag_ptr at, vdag_ptr end) {
  while (at < end && *at == 0) ++at;
  return at == end;
}
static float vdag_float(uint32_t bits) {
  float value;
  VOXDAG_MEMCPY(&value, &bits, sizeof value);
  return value;
}
static double vdag_double(uint64_t bits) {
  double value;
  VOXDAG_MEMCPY(&value, &bits, sizeof value);
  return value;
}
// Returns a * b, rounded to double. Without `volatile`, compilers may fuse the product with a sum
// that follows; then rays could hit other voxels.
static double vdag_product(double a, double b) {
  volatile double product = a * b;
  return product;
}
// Return the number of set bits; of v < 256.
static uint32_t vdag_count8(uint32_t v) {
  return ((v * 0x08040201u >> 3) & 0x11111111u) * 0x11111111u >> 28;
}
static uint32_t vdag_count64(uint64_t v) {
  v -= v >> 1 & 0x5555555555555555u;
  v = (v & 0x3333333333333333u) + (v >> 2 & 0x3333333333333333u);
  v = (v + (v >> 4)) & 0x0F0F0F0F0F0F0F0Fu;
  return (uint32_t)(v * 0x0101010101010101u >> 56);
}
static int vdag_lowest_bit(uint64_t v) { return (int)vdag_count64((v & (~v + 1)) - 1); }

// Returns the number of `width` bits, 0 to 64, that begins at bit `bit` of an array of 64-bit
// words, lowest bit first. Reads a second word only if the number reaches into it.
static uint64_t vdag_bits(vdag_ptr words, uint64_t bit, uint32_t width) {
  const uint32_t shift = (uint32_t)(bit & 63);
  if (width == 0) return 0;
  uint64_t value = vdag_word64(words, bit >> 6) >> shift;
  if (shift + width > 64) value |= vdag_word64(words, (bit >> 6) + 1) << (64 - shift);
  return width == 64 ? value : value & (((uint64_t)1 << width) - 1);
}

// ---- Checksums: XXH3, 64 bits, seed 0 (Yann Collet, xxHash, doc/xxhash_spec.md) ----

static const unsigned char vdag_secret[192] = {
    0xb8, 0xfe, 0x6c, 0x39, 0x23, 0xa4, 0x4b, 0xbe, 0x7c, 0x01, 0x81, 0x2c, 0xf7, 0x21, 0xad, 0x1c,
    0xde, 0xd4, 0x6d, 0xe9, 0x83, 0x90, 0x97, 0xdb, 0x72, 0x40, 0xa4, 0xa4, 0xb7, 0xb3, 0x67, 0x1f,
    0xcb, 0x79, 0xe6, 0x4e, 0xcc, 0xc0, 0xe5, 0x78, 0x82, 0x5a, 0xd0, 0x7d, 0xcc, 0xff, 0x72, 0x21,
    0xb8, 0x08, 0x46, 0x74, 0xf7, 0x43, 0x24, 0x8e, 0xe0, 0x35, 0x90, 0xe6, 0x81, 0x3a, 0x26, 0x4c,
    0x3c, 0x28, 0x52, 0xbb, 0x91, 0xc3, 0x00, 0xcb, 0x88, 0xd0, 0x65, 0x8b, 0x1b, 0x53, 0x2e, 0xa3,
    0x71, 0x64, 0x48, 0x97, 0xa2, 0x0d, 0xf9, 0x4e, 0x38, 0x19, 0xef, 0x46, 0xa9, 0xde, 0xac, 0xd8,
    0xa8, 0xfa, 0x76, 0x3f, 0xe3, 0x9c, 0x34, 0x3f, 0xf9, 0xdc, 0xbb, 0xc7, 0xc7, 0x0b, 0x4f, 0x1d,
    0x8a, 0x51, 0xe0, 0x4b, 0xcd, 0xb4, 0x59, 0x31, 0xc8, 0x9f, 0x7e, 0xc9, 0xd9, 0x78, 0x73, 0x64,
    0xea, 0xc5, 0xac, 0x83, 0x34, 0xd3, 0xeb, 0xc3, 0xc5, 0x81, 0xa0, 0xff, 0xfa, 0x13, 0x63, 0xeb,
    0x17, 0x0d, 0xdd, 0x51, 0xb7, 0xf0, 0xda, 0x49, 0xd3, 0x16, 0x55, 0x26, 0x29, 0xd4, 0x68, 0x9e,
    0x2b, 0x16, 0xbe, 0x58, 0x7d, 0x47, 0xa1, 0xfc, 0x8f, 0xf8, 0xb8, 0xd1, 0x7a, 0xd0, 0x31, 0xce,
    0x45, 0xcb, 0x3a, 0x8f, 0x95, 0x16, 0x04, 0x28, 0xaf, 0xd7, 0xfb, 0xca, 0xbb, 0x4b, 0x40, 0x7e};

#define VDAG_PRIME32_1 0x9E3779B1u
#define VDAG_PRIME64_1 0x9E3779B185EBCA87u
#define VDAG_PRIME64_2 0xC2B2AE3D27D4EB4Fu
#define VDAG_PRIME64_3 0x165667B19E3779F9u
// Returns the low half of the 128-bit product XOR the high half.
static uint64_t vdag_folded_product(uint64_t a, uint64_t b) {
  const uint64_t a0 = (uint32_t)a, a1 = a >> 32, b0 = (uint32_t)b, b1 = b >> 32;
  const uint64_t low = a0 * b0, middle = a1 * b0 + (low >> 32), cross = a0 * b1 + (uint32_t)middle;
  return (cross << 32 | (uint32_t)low) ^ (a1 * b1 + (middle >> 32) + (cross >> 32));
}
static uint64_t vdag_avalanche(uint64_t h) {
  h = (h ^ h >> 37) * 0x165667919E3779F9u;
  return h ^ h >> 32;
}
static uint64_t vdag_avalanche64(uint64_t h) {
  h = (h ^ h >> 33) * VDAG_PRIME64_2;
  h = (h ^ h >> 29) * VDAG_PRIME64_3;
  return h ^ h >> 32;
}
static uint64_t vdag_rotated(uint64_t v, int by) { return v << by | v >> (64 - by); }
static uint64_t vdag_mix16(vdag_ptr at, vdag_ptr key) {
  return vdag_folded_product(vdag_u64(at) ^ vdag_u64(key), vdag_u64(at + 8) ^ vdag_u64(key + 8));
}

static uint64_t vdag_checksum_16(vdag_ptr at, size_t size) {
  const vdag_ptr key = vdag_secret;
  if (size > 8) {
    const uint64_t low = vdag_u64(at) ^ vdag_u64(key + 24) ^ vdag_u64(key + 32);
    const uint64_t high = vdag_u64(at + size - 8) ^ vdag_u64(key + 40) ^ vdag_u64(key + 48);
    uint64_t swapped = (low & 0x00FF00FF00FF00FFu) << 8 | (low >> 8 & 0x00FF00FF00FF00FFu);
    swapped = (swapped & 0x0000FFFF0000FFFFu) << 16 | (swapped >> 16 & 0x0000FFFF0000FFFFu);
    return vdag_avalanche(size + vdag_rotated(swapped, 32) + high + vdag_folded_product(low, high));
  }
  if (size >= 4) {
    uint64_t h = vdag_u32(at + size - 4) | (uint64_t)vdag_u32(at) << 32;
    h ^= vdag_u64(key + 8) ^ vdag_u64(key + 16);
    h = (h ^ vdag_rotated(h, 49) ^ vdag_rotated(h, 24)) * 0x9FB21C651E98DF25u;
    h = (h ^ ((h >> 35) + size)) * 0x9FB21C651E98DF25u;
    return h ^ h >> 28;
  }
  if (size == 0) return vdag_avalanche64(vdag_u64(key + 56) ^ vdag_u64(key + 64));
  const uint32_t first = at[0], middle = at[size >> 1], last = at[size - 1];
  return vdag_avalanche64((first << 16 | middle << 24 | last | (uint32_t)size << 8) ^
                          vdag_u32(key) ^ vdag_u32(key + 4));
}

static uint64_t vdag_checksum_240(vdag_ptr at, size_t size) {
  const vdag_ptr key = vdag_secret;
  uint64_t sum = size * VDAG_PRIME64_1;
  if (size <= 128) {
    for (size_t i = 0; i <= (size - 1) / 32; ++i)
      sum += vdag_mix16(at + 16 * i, key + 32 * i) +
             vdag_mix16(at + size - 16 * (i + 1), key + 32 * i + 16);
    return vdag_avalanche(sum);
  }
  for (size_t i = 0; i < 8; ++i) sum += vdag_mix16(at + 16 * i, key + 16 * i);
  sum = vdag_avalanche(sum);
  for (size_t i = 8; i < size / 16; ++i) sum += vdag_mix16(at + 16 * i, key + 16 * (i - 8) + 3);
  return vdag_avalanche(sum + vdag_mix16(at + size - 16, key + 119));
}

static void vdag_add_stripe(uint64_t sums[8], vdag_ptr at, vdag_ptr key) {
  for (size_t i = 0; i < 8; ++i) {
    const uint64_t word = vdag_u64(at + 8 * i), keyed = word ^ vdag_u64(key + 8 * i);
    sums[i ^ 1] += word;
    sums[i] += (uint64_t)(uint32_t)keyed * (keyed >> 32);
  }
}

// Returns the checksum of `size` bytes. `first` has the first 240 of them, or as many as there are:
// for the header, a copy in which the checksum is zero.
static uint64_t vdag_checksum(vdag_ptr first, vdag_ptr at, size_t size) {
  const vdag_ptr key = vdag_secret;
  if (size <= 16) return vdag_checksum_16(first, size);
  if (size <= 240) return vdag_checksum_240(first, size);
  uint64_t sums[8] = {0xC2B2AE3Du,         VDAG_PRIME64_1, VDAG_PRIME64_2,      VDAG_PRIME64_3,
                      0x85EBCA77C2B2AE63u, 0x85EBCA77u,    0x27D4EB2F165667C5u, VDAG_PRIME32_1};
  for (size_t stripe = 0; stripe < (size - 1) / 64; ++stripe) {
    vdag_add_stripe(sums, stripe == 0 ? first : at + 64 * stripe, key + 8 * (stripe % 16));
    for (size_t i = 0; stripe % 16 == 15 && i < 8; ++i)
      sums[i] = (sums[i] ^ sums[i] >> 47 ^ vdag_u64(key + 128 + 8 * i)) * VDAG_PRIME32_1;
  }
  vdag_add_stripe(sums, at + size - 64, key + 121);
  uint64_t sum = size * VDAG_PRIME64_1;
  for (size_t i = 0; i < 4; ++i)
    sum += vdag_folded_product(sums[2 * i] ^ vdag_u64(key + 11 + 16 * i),
                               sums[2 * i + 1] ^ vdag_u64(key + 19 + 16 * i));
  return vdag_avalanche(sum);
}

// ---- Numbers in decimal, rounded to the nearest double ----

// Functions of whole numbers of 128 words, the lowest first.
static void vdag_big_multiply(uint32_t* n, uint32_t factor, uint32_t add) {
  uint64_t carry = add;
  for (int i = 0; i < 128; ++i) {
    carry += (uint64_t)n[i] * factor;
    n[i] = (uint32_t)carry;
    carry >>= 32;
  }
}
static int vdag_big_compare(const uint32_t* a, const uint32_t* b) {  // -1, 0, 1: a <, =, > b
  for (int i = 127; i >= 0; --i)
    if (a[i] != b[i]) return a[i] < b[i] ? -1 : 1;
  return 0;
}
static void vdag_big_subtract(uint32_t* a, const uint32_t* b) {
  uint64_t borrow = 0;
  for (int i = 0; i < 128; ++i) {
    const uint64_t difference = a[i] - (b[i] + borrow);
    a[i] = (uint32_t)difference;
    borrow = difference >> 63;
  }
}

// Returns the double nearest to 0.DIGITS * 10^exponent; infinity if that is too large. The digits
// from `at` to `end`, at most 800, among which may be a point, begin with one that is not zero.
static double vdag_decimal(vdag_ptr at, vdag_ptr end, int32_t exponent) {
  const double infinity = vdag_double((uint64_t)0x7FF << 52);
  if (exponent > 310) return infinity;
  if (exponent < -330) return 0;
  uint32_t above[128] = {0}, below[128] = {1};  // the number is above / below * 2^power
  int power = 0;
  for (; at < end; ++at) {
    if (*at == '.') continue;
    vdag_big_multiply(above, 10, (uint32_t)(*at - '0'));
    --exponent;
  }
  for (; exponent > 0; --exponent) vdag_big_multiply(above, 10, 0);
  for (; exponent < 0; ++exponent) vdag_big_multiply(below, 10, 0);
  for (; vdag_big_compare(above, below) >= 0; ++power) vdag_big_multiply(below, 2, 0);
  for (; vdag_big_compare(above, below) < 0; --power) vdag_big_multiply(above, 2, 0);
  // Now 1 <= above / below < 2.
  if (power < -1075) return 0;
  if (power > 1023) return infinity;
  uint64_t bits = 0;
  for (int left = power >= -1022 ? 53 : power + 1075; left > 0; --left) {
    const int is_set = vdag_big_compare(above, below) >= 0;
    if (is_set) vdag_big_subtract(above, below);
    vdag_big_multiply(above, 2, 0);
    bits = bits << 1 | (uint64_t)is_set;
  }
  // `above` is twice the rest: rounds up above a half, and at a half to an even number.
  const int half = vdag_big_compare(above, below);
  if (half > 0 || (half == 0 && bits % 2 != 0)) ++bits;
  return vdag_double(bits + (power >= -1022 ? (uint64_t)(power + 1022) << 52 : 0));
}

// ---- JSON (RFC 8259) ----
//
// These functions read valid JSON as it is meant, and any bytes safely. They do not check the parts
// that they skip. `at` is the first byte of a value, or null: then there is no value.

static vdag_ptr vdag_skip_space(vdag_ptr at, vdag_ptr end) {
  while (at < end && (*at == ' ' || *at == '\t' || *at == '\n' || *at == '\r')) ++at;
  return at;
}
// Returns the byte after the string that begins at `at`.
static vdag_ptr vdag_skip_string(vdag_ptr at, vdag_ptr end) {
  for (++at; at < end && *at != '"'; ++at)
    if (*at == '\\' && at + 1 < end) ++at;
  return at < end ? at + 1 : end;
}
// Returns the comma or bracket after the value that begins at `at`.
static vdag_ptr vdag_skip_value(vdag_ptr at, vdag_ptr end) {
  for (uint32_t depth = 0; at < end;) {
    if (depth == 0 && (*at == ',' || *at == '}' || *at == ']')) return at;
    if (*at == '{' || *at == '[') ++depth;
    if (*at == '}' || *at == ']') --depth;
    at = *at == '"' ? vdag_skip_string(at, end) : at + 1;
  }
  return end;
}
// Returns the value of the member `key` of an object, of several the last; null if there is none.
static vdag_ptr vdag_member(vdag_ptr at, vdag_ptr end, const char* key) {
  vdag_ptr found = NULL;
  if (at == NULL || at == end || *at != '{') return NULL;
  do {
    at = vdag_skip_space(at + 1, end);
    if (at == end || *at != '"') return found;
    const vdag_ptr name = at + 1;
    at = vdag_skip_string(at, end);
    size_t same = 0;
    while (name + same < at && key[same] != '\0' && name[same] == (unsigned char)key[same]) ++same;
    const int is_key = key[same] == '\0' && name + same + 1 == at;
    at = vdag_skip_space(at, end);
    if (at == end || *at != ':') return NULL;
    at = vdag_skip_space(at + 1, end);
    if (is_key) found = at;
    at = vdag_skip_value(at, end);
  } while (at < end && *at == ',');
  return found;
}
// Returns element `index` of an array; null if there is none.
static vdag_ptr vdag_element(vdag_ptr at, vdag_ptr end, uint32_t index) {
  if (at == NULL || at == end || *at != '[') return NULL;
  at = vdag_skip_space(at + 1, end);
  for (; index > 0; --index) {
    at = vdag_skip_value(at, end);
    if (at == end || *at != ',') return NULL;
    at = vdag_skip_space(at + 1, end);
  }
  return at == end || *at == ']' ? NULL : at;
}
static int vdag_is_digit(vdag_ptr at, vdag_ptr end) { return at < end && *at >= '0' && *at <= '9'; }
// Reads the number at `at`. Returns 0 if it is malformed, or larger than the largest double. Sets
// `count`, if it is not null, and returns 0 if the number is no whole number from 0 to 2^64 - 1.
static int vdag_read_number(vdag_ptr at, vdag_ptr end, double* value, uint64_t* count) {
  if (at == NULL) return 0;
  const int is_negative = at < end && *at == '-';
  at += is_negative;
  const vdag_ptr begin = at;
  vdag_ptr first = NULL;  // the first digit that is not zero
  int32_t exponent = 0, given = 0;
  int is_whole = 1, is_count = !is_negative;
  uint64_t whole = 0;
  for (; vdag_is_digit(at, end); ++at) {
    const uint32_t digit = (uint32_t)(*at - '0');
    is_count = is_count && whole <= (UINT64_MAX - digit) / 10;
    whole = whole * 10 + digit;
    if (first == NULL && digit != 0) first = at;
    if (first != NULL) ++exponent;
  }
  if (at == begin || (*begin == '0' && at - begin > 1)) return 0;
  if (at < end && *at == '.') {
    is_whole = 0;
    if (!vdag_is_digit(++at, end)) return 0;
    for (; vdag_is_digit(at, end); ++at) {
      if (first == NULL && *at != '0') first = at;
      if (first == NULL) --exponent;
    }
  }
  const vdag_ptr last = at;
  if (at < end && (*at == 'e' || *at == 'E')) {
    is_whole = 0;
    const int is_down = ++at < end && *at == '-';
    if (at < end && (*at == '+' || *at == '-')) ++at;
    if (!vdag_is_digit(at, end)) return 0;
    for (; vdag_is_digit(at, end); ++at)
      if (given < 100000000) given = given * 10 + (*at - '0');
    exponent += is_down ? -given : given;
  }
  at = vdag_skip_space(at, end);
  if (at < end && *at != ',' && *at != '}' && *at != ']') return 0;
  if (first != NULL && last - first > 800) return 0;
  if (count != NULL) *count = whole;
  *value = first != NULL ? vdag_decimal(first, last, exponent) : 0;
  if (is_negative && (first != NULL || !is_whole)) *value = -*value;
  return *value >= -DBL_MAX && *value <= DBL_MAX && (count == NULL || (is_whole && is_count));
}

// ---- The container ----

static const char* vdag_refuse(voxdag_scene* scene, vdag_ptr at, const char* fault) {
  scene->error_at = (uint64_t)(at - scene->bytes);
  return fault;
}
// Refuses the file, for a fault at a place in it, unless a rule of the format holds.
#define VDAG_CHECK(rule, at, fault) \
  if (!(rule)) return vdag_refuse(scene, at, fault)

// A chunk's bytes; `at` is null if the file does not have the chunk.
typedef struct vdag_chunk {
  vdag_ptr at;
  uint64_t bytes;
} vdag_chunk;

static uint32_t vdag_id(const char* name) { return vdag_u32((vdag_ptr)name); }

// Returns the chunk `name` of a file whose chunk table is valid.
static vdag_chunk vdag_find_chunk(const voxdag_scene* scene, const char* name) {
  vdag_ptr entry = scene->bytes + 64;
  vdag_chunk chunk = {NULL, 0};
  for (uint32_t left = vdag_u32(scene->bytes + 12); left > 0; --left, entry += 32)
    if (vdag_u32(entry) == vdag_id(name)) {
      chunk.at = scene->bytes + (size_t)vdag_u64(entry + 8);
      chunk.bytes = vdag_u64(entry + 16);
    }
  return chunk;
}

//   header                                   entry of the chunk table
//   0   8   magic                            0   4   id
//   8   4   version                          4   4   flags: bit 0: the chunk is required
//   12  4   number of chunks                 8   8   offset
//   16  8   size of the file                 16  8   length, without padding
//   24  8   checksum of header and table     24  8   checksum
//   32  32  zero
//
// Chunks follow each other in the order of the table, each padded with zeros to a multiple of 64.
static const char* vdag_check_header(voxdag_scene* scene, size_t size) {
  static const unsigned char magic[8] = {0x89, 'V', 'D', 'A', 'G', '\r', '\n', 0x1A};
  const vdag_ptr file = scene->bytes;
  VDAG_CHECK(size >= 8 && vdag_u64(file) == vdag_u64(magic), file, "not a .vdag file");
  VDAG_CHECK(size >= 64, file + size, "truncated: the file ends in its header");
  VDAG_CHECK(vdag_u32(file + 8) == 1, file + 8, "header: unknown version");
  VDAG_CHECK(vdag_u64(file + 16) <= size, file + size, "truncated: the header states more");
  VDAG_CHECK(vdag_u64(file + 16) == size, file + 16, "the file is longer than it states");
  VDAG_CHECK(vdag_u32(file + 12) <= 1024 && vdag_u32(file + 12) <= (size - 64) / 32, file + 12,
             "header: so many chunks do not fit into the file");
  const size_t table_end = 64 + 32 * (size_t)vdag_u32(file + 12);
  unsigned char first[240];
  for (size_t i = 0; i < sizeof first && i < table_end; ++i)
    first[i] = i >= 24 && i < 32 ? 0 : file[i];
  VDAG_CHECK(vdag_checksum(first, file, table_end) == vdag_u64(file + 24), file + 24,
             "header: checksum is wrong");
  VDAG_CHECK(vdag_is_zero(file + 32, file + 64), file + 32, "header: reserved bytes are not zero");
  return NULL;
}

// Checks the chunk table and the padding, but not the contents of chunks.
static const char* vdag_check_table(voxdag_scene* scene, size_t size) {
  static const char known[] = "METALEVLNODENODXLEAFCHEDCSTRESVOEBLK";
  const vdag_ptr file = scene->bytes, table_end = file + 64 + 32 * (size_t)vdag_u32(file + 12);
  size_t end = (size_t)(table_end - file);
  for (vdag_ptr entry = file + 64;; entry += 32) {
    const size_t padding = (64 - end % 64) % 64;
    VDAG_CHECK(padding <= size - end, file + size, "truncated: the file ends in its padding");
    VDAG_CHECK(vdag_is_zero(file + end, file + end + padding), file + end, "padding is not zero");
    end += padding;
    if (entry == table_end) break;
    for (vdag_ptr other = file + 64; other < entry; other += 32)
      VDAG_CHECK(vdag_u32(other) != vdag_u32(entry), entry, "chunk table: duplicate chunk");
    const uint32_t flags = vdag_u32(entry + 4);
    VDAG_CHECK(flags <= 1, entry + 4, "chunk table: unknown flags");
    VDAG_CHECK(vdag_u64(entry + 8) == end, entry + 8, "chunk table: wrong offset of a chunk");
    VDAG_CHECK(vdag_u64(entry + 16) <= size - end, entry + 16, "chunk table: chunk is too long");
    size_t at = 0;
    while (at + 4 < sizeof known && vdag_u32(entry) != vdag_id(known + at)) at += 4;
    VDAG_CHECK(flags == 0 || at + 4 < sizeof known, entry, "the file needs a newer reader");
    end += (size_t)vdag_u64(entry + 16);
  }
  VDAG_CHECK(end == size, file + end, "the file has bytes after its last chunk");
  return NULL;
}

// ---- META ----

// Reads the members that voxdag_info has. Others are not checked.
static const char* vdag_read_metadata(voxdag_scene* scene) {
  const vdag_chunk chunk = vdag_find_chunk(scene, "META");
  const vdag_ptr at = chunk.at;
  voxdag_info* const info = &scene->info;
  uint64_t count;
  double value;
  VDAG_CHECK(at != NULL, scene->bytes + 64, "chunk META is missing");
  VDAG_CHECK(chunk.bytes <= 1 << 20, at, "chunk META: longer than 1 MiB");
  info->metadata = (const char*)at;
  info->metadata_bytes = (size_t)chunk.bytes;
  const vdag_ptr end = at + info->metadata_bytes, root = vdag_skip_space(at, end);
  const vdag_ptr grid = vdag_member(root, end, "grid"), origin = vdag_member(grid, end, "origin");
  VDAG_CHECK(vdag_read_number(vdag_member(grid, end, "levels"), end, &value, &count), at,
             "chunk META: grid.levels is no whole number");
  VDAG_CHECK(count >= 2 && count <= 20, at, "chunk META: grid.levels is not 2 to 20");
  info->levels = (int)count;
  info->resolution = (int32_t)1 << info->levels;
  VDAG_CHECK(vdag_read_number(vdag_member(grid, end, "voxel_size"), end, &value, NULL), at,
             "chunk META: grid.voxel_size is no number");
  VDAG_CHECK(value > 0 && 1 / value <= DBL_MAX, at, "chunk META: grid.voxel_size is too small");
  info->voxel_size = value;
  for (uint32_t axis = 0; axis < 3; ++axis) {
    VDAG_CHECK(vdag_read_number(vdag_element(origin, end, axis), end, &value, NULL), at,
               "chunk META: grid.origin is no point");
    VDAG_CHECK(value + vdag_product(info->voxel_size, info->resolution) <= DBL_MAX, at,
               "chunk META: the far corner of the grid is not finite");
    info->origin[axis] = value;
  }
  VDAG_CHECK(vdag_element(origin, end, 3) == NULL, at, "chunk META: grid.origin is too long");
  const vdag_ptr voxels = vdag_member(vdag_member(root, end, "counts"), end, "voxels");
  VDAG_CHECK(vdag_read_number(voxels, end, &value, &info->voxels), at, "chunk META: no counts");
  const vdag_ptr up = vdag_member(root, end, "up");
  if (up != NULL) {
    VDAG_CHECK(end - up > 2 && up[0] == '"' && up[1] >= 'x' && up[1] <= 'z' && up[2] == '"', up,
               "chunk META: up is none of x, y and z");
    info->up = (char)up[1];
  }
  return NULL;
}

// ---- LEVL, NODE and LEAF: the voxels ----
//
// Level 0 is the root. Levels 0 to L-3 have inner nodes, level L-2 has leaf blocks:
//
//   inner node   | child mask | pointer | ... |      1 + popcount(child mask) words of 32 bits
//   child mask   bit i is set if child i has voxels; i = x + 2y + 4z, each 1 for the upper half
//   pointer      the word of NODE at which the child begins; of level L-3: index of a leaf block
//   leaf block   64-bit mask of 4^3 voxels; byte i is the child mask of the block's octant i

static const char* vdag_check_levels(voxdag_scene* scene, size_t scratch_bytes) {
  const vdag_chunk table = vdag_find_chunk(scene, "LEVL");
  const vdag_chunk nodes = vdag_find_chunk(scene, "NODE"), leaves = vdag_find_chunk(scene, "LEAF");
  const uint64_t words = nodes.bytes / 4, most = (uint64_t)1 << 32;
  const vdag_ptr at = table.at;
  const int levels = scene->info.levels;
  VDAG_CHECK(at != NULL && nodes.at != NULL && leaves.at != NULL, scene->bytes + 64,
             "chunk LEVL, NODE or LEAF is missing");
  VDAG_CHECK(table.bytes == 8 * (uint64_t)(levels - 1), at, "chunk LEVL: needs L-1 values");
  VDAG_CHECK(nodes.bytes % 4 == 0, nodes.at, "chunk NODE: length is no multiple of 4");
  VDAG_CHECK(leaves.bytes % 8 == 0, leaves.at, "chunk LEAF: length is no multiple of 8");
  VDAG_CHECK(vdag_word64(at, (uint64_t)levels - 2) == words, at, "chunk LEVL: wrong last value");
  VDAG_CHECK(words <= most && leaves.bytes / 8 <= most, at, "chunk NODE or LEAF: too long");
  VDAG_CHECK(vdag_u64(at) == 0, at, "chunk LEVL: level 0 does not begin at word 0");
  for (int level = 0; level <= VOXDAG_MAX_LEVELS; ++level)
    scene->level_begin[level] = level < levels - 2 ? vdag_word64(at, (uint64_t)level) : words;
  for (int level = 0; level < levels - 2; ++level) {
    const uint64_t begin = scene->level_begin[level], end = scene->level_begin[level + 1];
    VDAG_CHECK(end >= begin, at + 8 * level, "chunk LEVL: a level ends before it begins");
    VDAG_CHECK(end > begin || leaves.bytes == 0, at + 8 * level, "chunk LEVL: empty level");
    VDAG_CHECK((end - begin + 7) / 8 <= scratch_bytes, at, "the scratch memory is too small");
  }
  VDAG_CHECK(leaves.bytes != 0 || words == 0, nodes.at, "chunk LEAF is empty, but not NODE");
  VDAG_CHECK(levels > 2 || leaves.bytes <= 8, leaves.at, "chunk LEAF: more than one root");
  scene->nodes = nodes.at;
  scene->leaves = leaves.at;
  scene->leaf_count = leaves.bytes / 8;
  scene->info.dag_bytes = nodes.bytes + leaves.bytes;
  return NULL;
}

// Checks the masks of a level, and sets bit i of `starts` where word i of the level begins a node.
static const char* vdag_mark_nodes(voxdag_scene* scene, int level, unsigned char* starts) {
  const uint64_t begin = scene->level_begin[level], end = scene->level_begin[level + 1];
  vdag_clear(starts, (size_t)((end - begin + 7) / 8));
  for (uint64_t at = begin; at < end;) {
    const vdag_ptr word = vdag_at32(scene->nodes, at);
    const uint32_t mask = vdag_u32(word);
    VDAG_CHECK(mask >= 1 && mask <= 255, word, "chunk NODE: child mask is not 1 to 255");
    starts[(at - begin) / 8] |= (unsigned char)(1u << (at - begin) % 8);
    at += 1 + vdag_count8(mask);
    VDAG_CHECK(at <= end, word, "chunk NODE: node reaches past the end of its level");
  }
  return NULL;
}

// Checks that the pointers of a level, whose masks must be valid, lead to nodes of the next one or
// to leaf blocks. `starts` belongs to the next level.
static const char* vdag_check_pointers(voxdag_scene* scene, int level, vdag_ptr starts) {
  const uint64_t begin = scene->level_begin[level], end = scene->level_begin[level + 1];
  const int to_leaves = level == scene->info.levels - 3;
  const uint64_t first = to_leaves ? 0 : end;
  const uint64_t count = to_leaves ? scene->leaf_count : scene->level_begin[level + 2] - end;
  for (uint64_t at = begin; at < end;) {
    const uint64_t next = at + 1 + vdag_count8(vdag_word32(scene->nodes, at));
    while (++at < next) {
      const vdag_ptr word = vdag_at32(scene->nodes, at);
      const uint64_t place = vdag_u32(word) - first;  // huge if the pointer is too low
      VDAG_CHECK(place < count, word, "chunk NODE: pointer leads outside of the next level");
      VDAG_CHECK(to_leaves || (starts[place / 8] >> place % 8 & 1) != 0, word,
                 "chunk NODE: pointer does not lead to a node");
    }
  }
  return NULL;
}

static const char* vdag_check_nodes(voxdag_scene* scene, unsigned char* starts) {
  const int inner_levels = scene->info.levels - 2;
  const char* error = NULL;
  if (scene->leaf_count == 0) return NULL;
  if (inner_levels > 0) error = vdag_mark_nodes(scene, 0, starts);
  for (int level = 0; level < inner_levels && error == NULL; ++level) {
    if (level + 1 < inner_levels) error = vdag_mark_nodes(scene, level + 1, starts);
    if (error == NULL) error = vdag_check_pointers(scene, level, starts);
  }
  if (error != NULL) return error;
  const uint64_t root_words = inner_levels > 0 ? 1 + vdag_count8(vdag_u32(scene->nodes)) : 0;
  VDAG_CHECK(scene->level_begin[1] == root_words, scene->nodes, "chunk NODE: no single root");
  for (uint64_t i = 0; i < scene->leaf_count; ++i)
    VDAG_CHECK(vdag_word64(scene->leaves, i) != 0, scene->leaves, "chunk LEAF: empty leaf block");
  return NULL;
}

// Returns the child index of the ancestor `up` levels above a cell; of the cell itself if `up` is
// 0.
static uint32_t vdag_child(const int32_t cell[3], int up) {
  return (uint32_t)((cell[0] >> up & 1) | (cell[1] >> up & 1) << 1 | (cell[2] >> up & 1) << 2);
}
// Returns the bits of a child mask that belong to the children before child `child`.
static uint32_t vdag_before(uint32_t mask, uint32_t child) { return mask & ((1u << child) - 1); }
// Returns the child mask of a leaf block: bit i is set if octant i has voxels.
static uint32_t vdag_octants(uint64_t block) {
  block |= block >> 4;
  block |= block >> 2;
  block |= block >> 1;
  return (uint32_t)((block & 0x0101010101010101u) * 0x0102040810204080u >> 56);
}

// ---- CIDX: the numbers of cells ----
//
//   0   4   m, the finest level with attributes
//   4   4   zero
//   8   8   number of cells of levels 0 to m
//   16  20  bits of a slot of each level
//   36  28  zero
//   64      slots of level 0, of level 1, ...; each level begins at a 64-bit word
//
// Cells are numbered depth first: the root has number 0, parents come before their children, and
// children follow in the order of i. A level of inner nodes whose grandchildren have attributes has
// slots, one beside each word of NODE; s(k) is the number of cells in the subtree of child k:
//
//   node   | child mask | pointer 0 | pointer 1       | ... |
//   slot   | zero       | 1 + s(0)  | 1 + s(0) + s(1) | ... |
//
// So the slot of pointer k is the distance from a node's number to that of its child k + 1; child 0
// is 1 away. Children of level m have no cells below them, and leaf blocks tell theirs by bits.

static int vdag_has_slots(const voxdag_scene* scene, int level) {
  return level + 1 < scene->info.attribute_level && level < scene->info.levels - 2;
}
// Returns the slot beside a word of NODE, of a level with slots.
static uint64_t vdag_slot(const voxdag_scene* scene, int level, uint64_t word) {
  const uint32_t bits = scene->slot_bits[level];
  return vdag_bits(vdag_at64(scene->slots, scene->slot_begin[level]),
                   (word - scene->level_begin[level]) * bits, bits);
}
// Returns the number of cells in the subtree of a leaf block, itself included.
static uint64_t vdag_block_cells(const voxdag_scene* scene, uint64_t block) {
  const int levels_below = scene->info.attribute_level - (scene->info.levels - 2);
  return 1 + (levels_below > 0 ? vdag_count8(vdag_octants(block)) : 0) +
         (levels_below > 1 ? vdag_count64(block) : 0);
}
// Returns the number of cells in the subtree of a node of `level` < m, whose slots must be valid.
static uint64_t vdag_subtree_cells(const voxdag_scene* scene, int level, uint32_t node) {
  if (level == scene->info.levels - 2)
    return vdag_block_cells(scene, vdag_word64(scene->leaves, node));
  const uint32_t children = vdag_count8(vdag_word32(scene->nodes, node));
  if (!vdag_has_slots(scene, level)) return 1 + children;
  return vdag_slot(scene, level, (uint64_t)node + children);
}

// Checks the slots of a level. Those of the next level must be valid.
static const char* vdag_check_slots(voxdag_scene* scene, int level) {
  const uint64_t begin = scene->level_begin[level], end = scene->level_begin[level + 1];
  const vdag_ptr slots = vdag_at64(scene->slots, scene->slot_begin[level]);
  uint64_t largest = 0;
  for (uint64_t at = begin; at < end;) {
    const uint64_t next = at + 1 + vdag_count8(vdag_word32(scene->nodes, at));
    VDAG_CHECK(vdag_slot(scene, level, at) == 0, slots, "chunk CIDX: slot of a mask is not zero");
    uint64_t sum = 1;
    while (++at < next) {
      sum += vdag_subtree_cells(scene, level + 1, vdag_word32(scene->nodes, at));
      VDAG_CHECK(vdag_slot(scene, level, at) == sum, slots, "chunk CIDX: wrong slot");
    }
    if (largest < sum) largest = sum;
  }
  VDAG_CHECK(largest >> (scene->slot_bits[level] - 1) == 1, slots, "chunk CIDX: slots too wide");
  const uint64_t bits = (end - begin) * scene->slot_bits[level];
  VDAG_CHECK(bits % 64 == 0 || vdag_word64(slots, bits / 64) >> bits % 64 == 0, slots,
             "chunk CIDX: padding is not zero");
  return NULL;
}

static const char* vdag_read_index(voxdag_scene* scene, vdag_chunk chunk) {
  const vdag_ptr at = chunk.at;
  const int levels = scene->info.levels, is_empty = scene->leaf_count == 0;
  VDAG_CHECK(chunk.bytes >= 64 && chunk.bytes % 8 == 0, at, "chunk CIDX: wrong length");
  VDAG_CHECK(vdag_u32(at + 4) == 0, at + 4, "chunk CIDX: reserved bytes are not zero");
  VDAG_CHECK(vdag_is_zero(at + 36, at + 64), at + 36, "chunk CIDX: reserved bytes are not zero");
  VDAG_CHECK(vdag_u32(at) <= (uint32_t)levels, at, "chunk CIDX: attributes finer than voxels");
  scene->info.attribute_level = (int)vdag_u32(at);
  scene->slots = at + 64;
  uint64_t words = 0;
  for (int level = 0; level < VOXDAG_MAX_LEVELS; ++level) {
    const unsigned char bits = at[16 + level];
    VDAG_CHECK(bits <= 64 && (bits != 0) == (!is_empty && vdag_has_slots(scene, level)),
               at + 16 + level, "chunk CIDX: wrong size of slots");
    scene->slot_bits[level] = bits;
    scene->slot_begin[level] = words;
    words += ((scene->level_begin[level + 1] - scene->level_begin[level]) * bits + 63) / 64;
  }
  VDAG_CHECK(words == (chunk.bytes - 64) / 8, at, "chunk CIDX: not the words for these slots");
  for (int level = levels - 3; level >= 0; --level) {
    const char* const error = scene->slot_bits[level] ? vdag_check_slots(scene, level) : NULL;
    if (error != NULL) return error;
  }
  if (!is_empty)
    scene->cells = scene->info.attribute_level > 0 ? vdag_subtree_cells(scene, 0, 0) : 1;
  VDAG_CHECK(scene->cells == vdag_u64(at + 8), at + 8, "chunk CIDX: wrong number of cells");
  return NULL;
}

int voxdag_find_number(const voxdag_scene* scene, int level, const int32_t cell[3],
                       uint64_t* number) {
  const int levels = scene->info.levels, m = scene->info.attribute_level;
  const int numbered = level < m ? level : m;  // finer levels have the number of this one
  if (scene->leaf_count == 0 || level < 0 || level > levels) return 0;
  if ((uint32_t)(cell[0] | cell[1] | cell[2]) >> level != 0) return 0;
  uint64_t sum = 0;
  uint32_t node = 0;
  for (int l = 0; l < level && l < levels - 2; ++l) {
    const uint32_t mask = vdag_word32(scene->nodes, node), child = vdag_child(cell, level - 1 - l);
    if ((mask >> child & 1) == 0) return 0;
    const uint32_t before = vdag_count8(vdag_before(mask, child));
    if (l < numbered && number != NULL)
      sum += before == 0 || !vdag_has_slots(scene, l)
                 ? 1 + before
                 : vdag_slot(scene, l, (uint64_t)node + before);
    node = vdag_word32(scene->nodes, (uint64_t)node + 1 + before);
  }
  if (level > levels - 2) {  // in a leaf block: an octant, or a voxel
    const uint64_t block = vdag_word64(scene->leaves, node);
    const uint32_t child = vdag_child(cell, level - levels + 1);
    const uint32_t octant = (uint32_t)(block >> 8 * child) & 0xFF;
    if (octant == 0) return 0;
    if (levels - 2 < numbered && number != NULL)
      sum += vdag_block_cells(scene, block & (((uint64_t)1 << 8 * child) - 1));
    if (level == levels) {
      const uint32_t voxel = vdag_child(cell, 0);
      if ((octant >> voxel & 1) == 0) return 0;
      if (numbered == levels) sum += 1 + vdag_count8(vdag_before(octant, voxel));
    }
  }
  if (number != NULL) *number = sum;
  return number == NULL || scene->cells != 0;
}

// ---- COLR, NRML and MTID: pages of values ----
//
//   0   4   precision, 0 to 7 (COLR, NRML), or number of materials, 1 to 65,535 (MTID)
//   4   4   zero
//   8   8   number of values: of cells
//   16  8   number of words of the pages
//   24  40  zero
//   64      groups: a 64-bit word per 64 pages, the first byte of the group
//           words: the pages, from the lowest bit of each 64-bit word up
//           pages: 16 bits per page, its first byte, counted from that of its group
//
// A page has the values of 256 cells with consecutive numbers, and begins at a byte. A page of
// colours or normals is a sequence of blocks:
//
//   3 bits       type
//   6 or 8 bits  length: n / 4 - 1, or n - 1 in the precisions 4 to 7
//   ends         type 0: e0; 1, 2, 3: e0 and 6 bits s; 4: the n values; 5, 6, 7: e0 and e1
//   weights      n of w bits, with w = type in types 1, 2, 3, and w = type - 3 in types 5, 6, 7
//
// An end has three channels: of 5, 6, 5 bits, or of 6, 7 or 8 bits each (precision modulo 4). With
// s, channels of e1 are those of e0 plus 4 (s + 1), at most 255. A value of weight k is the mean of
// e0 and e1 with weights q - k and k, q = 2^w - 1. A page of materials is a sequence of runs:
//
//   id           as many bits as the largest possible id has
//   1 bit        1: the run is the page's last and ends with it
//   3 bits       b; only if it is not the last
//   b bits       the length of the run without its leading one; only if it is not the last

// A block's header, and the bits of its parts.
typedef struct vdag_block {
  uint32_t type, length;
  uint32_t end, ends;  // one end; all ends and s
  uint32_t weight;     // one weight
  uint64_t all;        // the whole block
} vdag_block;

static uint32_t vdag_header_bits(uint32_t precision) { return precision < 4 ? 9 : 11; }
static uint32_t vdag_channel_bits(uint32_t precision, int channel) {
  return precision % 4 > 0 ? precision % 4 + 5 : channel == 1 ? 6 : 5;
}

static vdag_block vdag_read_block(const voxdag_pages* pages, uint64_t at) {
  const uint32_t precision = pages->kind, header_bits = vdag_header_bits(precision);
  const uint32_t header = (uint32_t)vdag_bits(pages->words, at, header_bits);
  vdag_block block;
  block.type = header & 7;
  block.length = ((header >> 3) + 1) * (precision < 4 ? 4 : 1);
  block.end = 2 * vdag_channel_bits(precision, 0) + vdag_channel_bits(precision, 1);
  block.weight = block.type % 4 == 0 ? 0 : block.type < 4 ? block.type : block.type - 3;
  const uint32_t ends = block.type < 4 ? 1 : block.type == 4 ? block.length : 2;
  block.ends = ends * block.end + (block.type >= 1 && block.type <= 3 ? 6 : 0);
  block.all = header_bits + block.ends + (uint64_t)block.weight * block.length;
  return block;
}

// A run of cells of one material. The last of a page has length 0.
typedef struct vdag_run {
  uint32_t id, length, bits;
} vdag_run;

static uint32_t vdag_id_bits(const voxdag_pages* pages) {
  uint32_t bits = 0;
  while (pages->kind > 1u << bits) ++bits;
  return bits;
}
// Reads the run that begins at bit `at`. `bits` is 0 if it does not end before bit `end`.
static vdag_run vdag_read_run(const voxdag_pages* pages, uint64_t at, uint64_t end) {
  const uint32_t id_bits = vdag_id_bits(pages);
  vdag_run run = {0, 0, 0};
  if (at + id_bits + 1 > end) return run;
  run.id = (uint32_t)vdag_bits(pages->words, at, id_bits);
  run.bits = id_bits + 1;
  at += run.bits;
  if (vdag_bits(pages->words, at - 1, 1) != 0) return run;
  const uint32_t b = at + 3 <= end ? (uint32_t)vdag_bits(pages->words, at, 3) : 8;
  run.bits = at + 3 + b <= end ? run.bits + 3 + b : 0;
  if (run.bits != 0) run.length = 1u << b | (uint32_t)vdag_bits(pages->words, at + 3, b);
  return run;
}

// Returns the bit at which a page begins.
static uint64_t vdag_page_begin(const voxdag_pages* pages, uint64_t page) {
  const vdag_ptr in_group = pages->pages + 2 * (size_t)page;
  return 8 * (vdag_word64(pages->groups, page / 64) + (in_group[0] | (uint32_t)in_group[1] << 8));
}
// Return the first bit after the page that begins at bit `at`; 0 if the page is malformed, or does
// not end before bit `end`. The last page of colours is full, too; that of materials has `cells`.
static uint64_t vdag_value_page_end(const voxdag_pages* pages, uint64_t at, uint64_t end) {
  uint32_t values = 0;
  while (values < 256) {
    if (at + vdag_header_bits(pages->kind) > end) return 0;
    const vdag_block block = vdag_read_block(pages, at);
    values += block.length;
    at += block.all;
    if (at > end) return 0;
  }
  return values == 256 ? at : 0;
}
static uint64_t vdag_material_page_end(const voxdag_pages* pages, uint64_t at, uint64_t end,
                                       uint64_t cells) {
  uint32_t id_before = pages->kind;  // not an id
  for (uint64_t done = 0; done < cells;) {
    const vdag_run run = vdag_read_run(pages, at, end);
    if (run.bits == 0 || run.id >= pages->kind || run.id == id_before) return 0;
    at += run.bits;
    if (run.length == 0) return at;
    id_before = run.id;
    done += run.length;
  }
  return 0;
}

static const char* vdag_read_pages(voxdag_scene* scene, vdag_chunk chunk, voxdag_pages* pages,
                                   int are_materials) {
  const vdag_ptr at = chunk.at;
  const uint64_t cells = scene->cells, count = (cells + 255) / 256, groups = (count + 63) / 64;
  VDAG_CHECK(chunk.bytes >= 64 && chunk.bytes % 8 == 0, at, "attributes: wrong length");
  VDAG_CHECK(vdag_u32(at + 4) == 0, at + 4, "attributes: reserved bytes are not zero");
  VDAG_CHECK(vdag_is_zero(at + 24, at + 64), at + 24, "attributes: reserved bytes are not zero");
  pages->kind = vdag_u32(at);
  VDAG_CHECK(are_materials || pages->kind <= 7, at, "attributes: precision is not 0 to 7");
  VDAG_CHECK(!are_materials || (pages->kind >= 1 && pages->kind <= 65535), at,
             "attributes: not 1 to 65,535 materials");
  VDAG_CHECK(vdag_u64(at + 8) == cells, at + 8, "attributes: not as many values as cells");
  const uint64_t words = (chunk.bytes - 64) / 8;
  pages->word_count = vdag_u64(at + 16);
  VDAG_CHECK(pages->word_count <= words && words - pages->word_count == groups + (count + 3) / 4,
             at + 16, "attributes: wrong number of words");
  pages->groups = at + 64;
  pages->words = vdag_at64(pages->groups, groups);
  pages->pages = vdag_at64(pages->words, pages->word_count);
  VDAG_CHECK(vdag_is_zero(pages->pages + 2 * (size_t)count, at + (size_t)chunk.bytes), at,
             "attributes: padding is not zero");
  const uint64_t all_bits = 64 * pages->word_count;
  uint64_t begin = 0;
  for (uint64_t page = 0; page < count; ++page) {
    const uint64_t group = vdag_word64(pages->groups, page / 64), left = cells - 256 * page;
    // The first test keeps vdag_page_begin() from an overflow.
    VDAG_CHECK(group <= 8 * pages->word_count && vdag_page_begin(pages, page) == begin &&
                   (page % 64 != 0 || 8 * group == begin),
               pages->pages + 2 * (size_t)page, "attributes: wrong table");
    const vdag_ptr place = pages->words + (size_t)(begin / 8);
    const uint64_t end =
        are_materials ? vdag_material_page_end(pages, begin, all_bits, left < 256 ? left : 256)
                      : vdag_value_page_end(pages, begin, all_bits);
    VDAG_CHECK(end != 0, place, "attributes: malformed page");
    begin = (end + 7) / 8 * 8;
    VDAG_CHECK(vdag_bits(pages->words, end, (uint32_t)(begin - end)) == 0, place,
               "attributes: page without zero padding");
  }
  VDAG_CHECK((begin + 63) / 64 == pages->word_count, at, "attributes: words after the last page");
  VDAG_CHECK(begin % 64 == 0 || vdag_word64(pages->words, begin / 64) >> begin % 64 == 0, at,
             "attributes: padding after the last page is not zero");
  pages->values = cells;
  return NULL;
}

static void vdag_read_end(const voxdag_pages* pages, uint64_t at, uint32_t channels[3]) {
  for (int c = 0; c < 3; ++c) {
    const uint32_t bits = vdag_channel_bits(pages->kind, c);
    const uint32_t field = (uint32_t)vdag_bits(pages->words, at, bits);
    channels[c] = field << (8 - bits) | field >> (2 * bits - 8);  // repeats the highest bits
    at += bits;
  }
}

// Reads the value of a number below pages->values.
static void vdag_read_value(const voxdag_pages* pages, uint64_t number, uint32_t channels[3]) {
  uint64_t at = vdag_page_begin(pages, number / 256);
  uint32_t index = (uint32_t)(number % 256), e1[3] = {0, 0, 0};
  vdag_block block = vdag_read_block(pages, at);
  while (index >= block.length) {
    index -= block.length;
    at += block.all;
    block = vdag_read_block(pages, at);
  }
  at += vdag_header_bits(pages->kind);
  vdag_read_end(pages, block.type == 4 ? at + (uint64_t)index * block.end : at, channels);
  if (block.weight == 0) return;
  if (block.type > 4) vdag_read_end(pages, at + block.end, e1);
  const uint32_t s = block.type > 4 ? 0 : (uint32_t)vdag_bits(pages->words, at + block.end, 6);
  at += block.ends + (uint64_t)index * block.weight;
  const uint32_t k = (uint32_t)vdag_bits(pages->words, at, block.weight);
  const uint32_t q = (1u << block.weight) - 1;
  for (int c = 0; c < 3; ++c) {
    const uint32_t stepped = channels[c] + 4 * (s + 1);
    const uint32_t other = block.type > 4 ? e1[c] : stepped < 255 ? stepped : 255;
    channels[c] = (2 * (channels[c] * (q - k) + other * k) + q) / (2 * q);
  }
}

int voxdag_color(const voxdag_scene* scene, uint64_t number, uint8_t color[3]) {
  uint32_t channels[3];
  if (number >= scene->colors.values) return 0;
  vdag_read_value(&scene->colors, number, channels);
  for (int c = 0; c < 3; ++c) color[c] = (uint8_t)channels[c];
  return 1;
}

// A channel of 128 + 127 x stands for x.
int voxdag_normal(const voxdag_scene* scene, uint64_t number, float normal[3]) {
  uint32_t channels[3];
  float length2 = 0;
  if (number >= scene->normals.values) return 0;
  vdag_read_value(&scene->normals, number, channels);
  for (int c = 0; c < 3; ++c) {
    normal[c] = (float)((int)channels[c] - 128);
    length2 += normal[c] * normal[c];  // exact
  }
  const float scale = length2 > 0 ? 1.0f / VOXDAG_SQRTF(length2) : 1.0f;
  for (int c = 0; c < 3; ++c) normal[c] *= scale;
  if (!(length2 > 0)) normal[1] = 1;
  return 1;
}

int voxdag_material(const voxdag_scene* scene, uint64_t number, uint32_t* material) {
  const voxdag_pages* const pages = &scene->materials;
  if (number >= pages->values) return 0;
  uint64_t at = vdag_page_begin(pages, number / 256);
  uint32_t left = (uint32_t)(number % 256);
  vdag_run run = vdag_read_run(pages, at, UINT64_MAX);
  while (run.length != 0 && left >= run.length) {
    left -= run.length;
    at += run.bits;
    run = vdag_read_run(pages, at, UINT64_MAX);
  }
  *material = run.id;
  return 1;
}

// ---- Opening ----

static const char* vdag_read_attributes(voxdag_scene* scene) {
  static const char* const names[] = {"COLR", "NRML", "MTID"};
  static const char* const wire_names[] = {"WCOL", "WNRM", "WMTI"};
  voxdag_pages* const pages[] = {&scene->colors, &scene->normals, &scene->materials};
  const vdag_chunk index = vdag_find_chunk(scene, "CIDX");
  const char* error = index.at != NULL ? vdag_read_index(scene, index) : NULL;
  for (int i = 0; i < 3 && error == NULL; ++i) {
    const vdag_chunk chunk = vdag_find_chunk(scene, names[i]);
    const vdag_chunk wire = vdag_find_chunk(scene, wire_names[i]);
    VDAG_CHECK(chunk.at == NULL || wire.at == NULL, wire.at, "attributes: in both forms");
    if (wire.at != NULL) scene->info.has_wire_form = 1;
    if (chunk.at == NULL && wire.at == NULL) continue;
    VDAG_CHECK(index.at != NULL, scene->bytes + 64, "chunk CIDX is missing");
    if (chunk.at != NULL) error = vdag_read_pages(scene, chunk, pages[i], i == 2);
  }
  scene->info.has_colors = scene->colors.values != 0;
  scene->info.has_normals = scene->normals.values != 0;
  scene->info.has_materials = scene->materials.values != 0;
  scene->info.materials = scene->info.has_materials ? scene->materials.kind : 0;
  return error;
}

static const char* vdag_open(voxdag_scene* scene, size_t size, unsigned char* scratch,
                             size_t scratch_bytes) {
  const char* error = vdag_check_header(scene, size);
  if (error == NULL) error = vdag_check_table(scene, size);
  if (error != NULL) return error;
  VDAG_CHECK(vdag_find_chunk(scene, "ESVO").at == NULL, scene->bytes + 64,
             "the file holds an ESVO, not a DAG");
  VDAG_CHECK(vdag_find_chunk(scene, "CSTR").at == NULL, scene->bytes + 64,
             "the DAG is in the compact form: `voxdag convert FILE --plain` makes the plain form");
  vdag_ptr entry = scene->bytes + 64;
  for (uint32_t left = vdag_u32(scene->bytes + 12); left > 0; --left, entry += 32) {
    const vdag_ptr at = scene->bytes + (size_t)vdag_u64(entry + 8);
    const uint64_t checksum = vdag_checksum(at, at, (size_t)vdag_u64(entry + 16));
    VDAG_CHECK(checksum == vdag_u64(entry + 24), at, "the checksum of a chunk is wrong");
  }
  error = vdag_read_metadata(scene);
  if (error != NULL) return error;
  VDAG_CHECK(vdag_find_chunk(scene, "NODX").at == NULL, scene->bytes + 64,
             "the DAG has long pointers: `voxdag crop` and `voxdag coarsen` make smaller ones");
  error = vdag_check_levels(scene, scratch_bytes);
  if (error == NULL) error = vdag_check_nodes(scene, scratch);
  if (error == NULL) error = vdag_read_attributes(scene);
  return error;
}

const char* voxdag_open(voxdag_scene* scene, const void* bytes, size_t size, void* scratch,
                        size_t scratch_bytes) {
  vdag_clear(scene, sizeof *scene);
  scene->bytes = (vdag_ptr)bytes;
  const char* const error = vdag_open(scene, size, (unsigned char*)scratch, scratch_bytes);
  if (error == NULL) return NULL;
  const uint64_t error_at = scene->error_at;
  vdag_clear(scene, sizeof *scene);
  scene->error_at = error_at;
  return error;
}

// ---- Cells and points ----

int voxdag_contains(const voxdag_scene* scene, int level, const int32_t cell[3]) {
  return voxdag_find_number(scene, level, cell, NULL);
}

void voxdag_voxel_at(const voxdag_scene* scene, const double point[3], int32_t voxel[3]) {
  const double per_unit = 1 / scene->info.voxel_size;
  for (int axis = 0; axis < 3; ++axis) {
    const double at = (point[axis] - scene->info.origin[axis]) * per_unit;
    voxel[axis] = at >= 2147483647.0 ? INT32_MAX : at >= -2147483647.0 ? (int32_t)at : -INT32_MAX;
    if (voxel[axis] > at && voxel[axis] > -INT32_MAX) --voxel[axis];  // rounds down
  }
}

int voxdag_contains_point(const voxdag_scene* scene, const double point[3]) {
  int32_t voxel[3];
  voxdag_voxel_at(scene, point, voxel);
  return voxdag_contains(scene, scene->info.levels, voxel);
}

// ---- Rays ----
//
// Source: Laine and Karras, "Efficient Sparse Voxel Octrees", I3D 2010, section 4.
//
// The grid is the cube [1,2]^3, so that the bits of a coordinate's mantissa are the child indices
// of the cells around it. Axes along which the ray runs up are mirrored (p -> 3 - p), so that it
// runs down along every axis. Its origin is rounded to multiples of 2^-23 in [1,2]. Its parameter T
// is 0 there, and grows by 1 while the ray crosses the grid along its longest axis.
//
// The ray meets the plane p of an axis at T(p) = (origin - p) * inverse, in float: the difference
// is exact, and the product is rounded once. So every machine finds the same T. At T the ray is,
// along each axis, beyond exactly the planes with T(p) <= T: in one cell of every level. The ray
// meets the voxels that it is in at some T from t_min to t_max. Where it crosses several planes at
// once, it passes to the diagonal neighbour. Along an axis whose component is below 2^-32 of the
// longest, it stays in the voxels of floor(origin).

int voxdag_enter_grid(const voxdag_scene* scene, const voxdag_ray* ray, voxdag_grid_ray* out) {
  const double parallel = 2.3283064365386962890625e-10;           // 2^-32
  const double zero = vdag_double((uint64_t)(1023 - 960) << 52);  // 2^-960
  const double to_unit = 1.0 / vdag_product(scene->info.voxel_size, scene->info.resolution);
  const double t_min = (double)ray->t_min, t_max = (double)ray->t_max;
  if (!(t_min <= t_max)) return 0;

  // The grid as [0,1]^3, the direction with its longest component 1.
  double start[3], direction[3], length = 0;
  for (int axis = 0; axis < 3; ++axis) {
    start[axis] = vdag_product(ray->origin[axis] - scene->info.origin[axis], to_unit);
    direction[axis] = vdag_product(ray->direction[axis], to_unit);
    const double size = direction[axis] < 0 ? -direction[axis] : direction[axis];
    if (!(start[axis] >= -DBL_MAX && start[axis] <= DBL_MAX && size <= DBL_MAX)) return 0;
    if (length < size) length = size;
  }
  out->t_scale = 1.0 / length;
  if (!(length > 0 && out->t_scale <= DBL_MAX)) return 0;
  for (int axis = 0; axis < 3; ++axis) direction[axis] *= out->t_scale;

  // The t at which the line enters and leaves the grid, and the axis of the side of entrance.
  double enter = vdag_product(t_min < 0 ? t_min : 0.0, length), leave = DBL_MAX;
  int enter_axis = -1;
  out->mirrored = out->parallel = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double d = direction[axis], p = start[axis], size = d < 0 ? -d : d;
    const uint32_t bit = 1u << axis;
    if (size < parallel) {
      out->parallel |= bit;
      out->mirrored |= bit;
      out->inverse[axis] = 4294967296.0f;
    }
    if (size < zero) {  // it has no finite inverse, or almost none
      if (!(p >= 0 && p < 1)) return 0;
      continue;
    }
    const double inverse = 1.0 / d;
    const double near_t = vdag_product((d > 0 ? 0.0 : 1.0) - p, inverse);
    const double far_t = vdag_product((d > 0 ? 1.0 : 0.0) - p, inverse);
    if (near_t > enter) {
      enter = near_t;
      enter_axis = axis;
    }
    if (far_t < leave) leave = far_t;
    if (size < parallel) continue;
    if (d > 0) out->mirrored |= bit;
    out->inverse[axis] = (float)(inverse < 0 ? -inverse : inverse);
  }
  if (!(enter <= leave)) return 0;

  for (int axis = 0; axis < 3; ++axis) {
    const int is_still = (out->parallel >> axis & 1) != 0;
    double p = start[axis];
    if (axis == enter_axis)
      p = direction[axis] > 0 ? 0.0 : 1.0;
    else if (enter != 0)
      p = VOXDAG_FMA(enter, direction[axis], p);
    if (is_still && p >= 1 && direction[axis] > 0) return 0;  // it only touches the grid
    float q = (float)(1.0 + (p < 0 ? 0.0 : p > 1 ? 1.0 : p));
    // Rounding must not carry a ray out of the grid along an axis on which it does not move.
    const float last = 1.99999988079071044921875f;  // 2 - 2^-23
    if (is_still && q > last) q = last;
    out->origin[axis] = (out->mirrored >> axis & 1) != 0 ? 3.0f - q : q;
  }
  out->t_start = enter * out->t_scale;
  const double first = vdag_product(t_min, length) - enter;
  out->t_min = first > 0 ? (float)first : 0.0f;
  out->t_max = (float)(vdag_product(t_max, length) - enter);
  return out->t_min <= out->t_max;
}

// Sets `hit` to the voxel whose lower corner has these float bits, which the ray meets at T = t.
static void vdag_set_hit(const voxdag_scene* scene, const voxdag_ray* ray,
                         const voxdag_grid_ray* in, float t, const uint32_t corner[3],
                         voxdag_hit* hit) {
  const int bit = 23 - scene->info.levels;
  for (int axis = 2; axis >= 0; --axis) {
    const int32_t low = (int32_t)((corner[axis] & 0x7FFFFF) >> bit);
    const int is_mirrored = (in->mirrored >> axis & 1) != 0;
    hit->voxel[axis] = is_mirrored ? scene->info.resolution - 1 - low : low;
    // The ray enters through the first axis whose plane it meets at exactly this T.
    const float entry = vdag_float(corner[axis] + (1u << bit));
    if ((in->parallel >> axis & 1) == 0 && (in->origin[axis] - entry) * in->inverse[axis] == t)
      hit->face = 2 * axis + (is_mirrored ? 0 : 1);
  }
  hit->t = (float)VOXDAG_FMA((double)t, in->t_scale, in->t_start);
  hit->t = hit->t < ray->t_min ? ray->t_min : hit->t > ray->t_max ? ray->t_max : hit->t;
  if (hit->t > FLT_MAX) hit->t = FLT_MAX;
}

int voxdag_cast(const voxdag_scene* scene, const voxdag_ray* ray, voxdag_hit* hit) {
  voxdag_grid_ray in;
  vdag_clear(hit, sizeof *hit);
  hit->face = VOXDAG_NO_FACE;
  if (scene->leaf_count == 0 || !voxdag_enter_grid(scene, ray, &in)) return 0;
  const float ox = in.origin[0], oy = in.origin[1], oz = in.origin[2];
  const float ix = in.inverse[0], iy = in.inverse[1], iz = in.inverse[2];
  float t = in.t_min;
  if ((ox - 1) * ix <= t || (oy - 1) * iy <= t || (oz - 1) * iz <= t) return 0;  // it has left

  // The path to the parent of the current cell: nodes, and their child masks.
  uint32_t nodes[VOXDAG_MAX_LEVELS], masks[VOXDAG_MAX_LEVELS];
  const int leaf_level = scene->info.levels - 2;
  uint32_t node = 0;  // word of NODE, or index of a leaf block
  uint64_t block = leaf_level == 0 ? vdag_u64(scene->leaves) : 0;  // the last leaf block
  uint32_t octants = vdag_octants(block);                          // its child mask
  uint32_t mask = leaf_level == 0 ? octants : vdag_u32(scene->nodes);

  // The cell of level 23 - bit that the ray is in at t: float bits of its lower corner, and its
  // child index. Neighbours of its size differ in this bit of the corner.
  uint32_t x = 0x3F800000u, y = x, z = x, child = 0;
  int bit = 23, descends = 1;
  for (;;) {
    if (descends) {  // to the child that the ray is in at t
      --bit;
      const uint32_t half = 1u << bit;
      const uint32_t up_x = (ox - vdag_float(x | half)) * ix > t;
      const uint32_t up_y = (oy - vdag_float(y | half)) * iy > t;
      const uint32_t up_z = (oz - vdag_float(z | half)) * iz > t;
      x |= up_x << bit;
      y |= up_y << bit;
      z |= up_z << bit;
      child = up_x | up_y << 1 | up_z << 2;
    }
    const uint32_t index = child ^ in.mirrored;
    const int level = 23 - bit;
    descends = (mask >> index & 1) != 0;
    if (descends) {
      if (level == leaf_level + 2) {
        const uint32_t corner[3] = {x, y, z};
        vdag_set_hit(scene, ray, &in, t, corner, hit);
        return 1;
      }
      // PUSH
      if (level == leaf_level + 1) {
        mask = (uint32_t)(block >> 8 * index) & 0xFF;
        continue;
      }
      nodes[level - 1] = node;
      masks[level - 1] = mask;
      node = vdag_word32(scene->nodes, (uint64_t)node + 1 + vdag_count8(vdag_before(mask, index)));
      if (level < leaf_level) {
        mask = vdag_word32(scene->nodes, node);
      } else {
        block = vdag_word64(scene->leaves, node);
        mask = octants = vdag_octants(block);
      }
      continue;
    }
    // ADVANCE: over all planes that the ray meets where it leaves the cell
    const float tx = (ox - vdag_float(x)) * ix, ty = (oy - vdag_float(y)) * iy;
    const float tz = (oz - vdag_float(z)) * iz, txy = tx < ty ? tx : ty;
    t = txy < tz ? txy : tz;
    if (t > in.t_max) return 0;
    const uint32_t step_x = tx == t, step_y = ty == t, step_z = tz == t;
    const uint32_t next_x = x - (step_x << bit), next_y = y - (step_y << bit);
    const uint32_t next_z = z - (step_z << bit);
    const uint32_t changed = (x ^ next_x) | (y ^ next_y) | (z ^ next_z);
    x = next_x, y = next_y, z = next_z;
    child ^= step_x | step_y << 1 | step_z << 2;
    if (changed >> bit == 1) continue;  // a sibling
    // POP: to the highest level at which the cell changed
    while (changed >> bit > 1) ++bit;
    if (bit > 22) return 0;  // the ray has left the grid
    x &= ~0u << bit, y &= ~0u << bit, z &= ~0u << bit;
    child = (x >> bit & 1) | (y >> bit & 1) << 1 | (z >> bit & 1) << 2;
    if (23 - bit > leaf_level) {
      mask = octants;
    } else {
      node = nodes[22 - bit];
      mask = masks[22 - bit];
    }
  }
}

// ---- Walks ----

// Returns the mask of the voxels of a leaf block that lie in the window.
static uint64_t vdag_window_mask(const voxdag_walk* walk) {
  // The voxels of which the lower bit, and the upper bit, of the coordinate is 0.
  static const uint64_t low[3] = {0x5555555555555555u, 0x3333333333333333u, 0x0F0F0F0F0F0F0F0Fu};
  static const uint64_t high[3] = {0x00FF00FF00FF00FFu, 0x0000FFFF0000FFFFu, 0x00000000FFFFFFFFu};
  uint64_t mask = ~(uint64_t)0;
  for (int axis = 0; axis < 3; ++axis) {
    uint64_t inside = 0;
    for (int k = 0; k < 4; ++k)
      if (walk->block[axis] + k >= walk->lo[axis] && walk->block[axis] + k < walk->hi[axis])
        inside |= (k % 2 == 0 ? low[axis] : ~low[axis]) & (k < 2 ? high[axis] : ~high[axis]);
    mask &= inside;
  }
  return mask;
}

void voxdag_walk_begin(voxdag_walk* walk, const voxdag_scene* scene, const int32_t lo[3],
                       const int32_t hi[3]) {
  vdag_clear(walk, sizeof *walk);
  walk->scene = scene;
  walk->level = scene->info.levels > 2 && scene->leaf_count != 0 ? 0 : -1;
  for (int axis = 0; axis < 3; ++axis) {
    walk->lo[axis] = lo[axis];
    walk->hi[axis] = hi[axis];
  }
  if (walk->level == 0)
    walk->children[0] = vdag_u32(scene->nodes);
  else if (scene->leaf_count != 0)  // the root is a leaf block
    walk->left = vdag_u64(scene->leaves) & vdag_window_mask(walk);
}

// Goes to the next leaf block with voxels in the window; returns 0 if there is none.
static int vdag_next_block(voxdag_walk* walk) {
  const voxdag_scene* const scene = walk->scene;
  walk->left = 0;
  while (walk->level >= 0 && walk->left == 0) {
    const int level = walk->level;
    const uint32_t node = walk->node[level], children = walk->children[level];
    if (children == 0) {
      --walk->level;
      continue;
    }
    walk->children[level] = children & (children - 1);
    const uint32_t child = (uint32_t)vdag_lowest_bit(children);
    const int32_t half = scene->info.resolution >> (level + 1);
    int is_outside = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const int32_t parent = walk->block[axis] & ~(2 * half - 1);
      const int32_t corner = parent + ((child >> axis & 1) != 0 ? half : 0);
      walk->block[axis] = corner;
      is_outside |= corner >= walk->hi[axis] || corner + half <= walk->lo[axis];
    }
    if (is_outside) continue;
    const uint32_t before = vdag_count8(vdag_before(vdag_word32(scene->nodes, node), child));
    const uint32_t below = vdag_word32(scene->nodes, (uint64_t)node + 1 + before);
    if (level + 1 == scene->info.levels - 2) {
      walk->left = vdag_word64(scene->leaves, below) & vdag_window_mask(walk);
    } else {
      walk->level = level + 1;
      walk->node[level + 1] = below;
      walk->children[level + 1] = vdag_word32(scene->nodes, below);
    }
  }
  return walk->left != 0;
}

int voxdag_walk_next(voxdag_walk* walk, int32_t voxel[3]) {
  if (walk->left == 0 && !vdag_next_block(walk)) return 0;
  const int bit = vdag_lowest_bit(walk->left);
  walk->left &= walk->left - 1;
  for (int axis = 0; axis < 3; ++axis)
    voxel[axis] = walk->block[axis] + ((bit >> (3 + axis) & 1) << 1 | (bit >> axis & 1));
  return 1;
}

#endif  // VOXDAG_IMPLEMENTATION
